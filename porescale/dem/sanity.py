"""Whether the state of a system of grains still makes sense."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from porescale.common.core.errors import Unstable
from porescale.dem.forces.walls import HIGH, LOW, PRESENT, X
from porescale.dem.step import first_without_number

if TYPE_CHECKING:
    from porescale.dem.grains import Grains

WORST_OVERLAP = 0.3  # of the smaller radius: the linear law and its lever arms mean nothing beyond
WORST_OF_CORNERS = 0.8  # of the thicknesses of two segments: small beside bodies, which go through each other at 1
WORST_TRAVEL = 0.1  # of the smallest radius in one step: a contact would be met after the fact


class Health:
    """What is beyond sense: a number that is none; a speed beyond 0.1 smallest radii per step; an overlap beyond 30 %
    of the radius (of a corner of a frame: 80 % of the thicknesses); a centre behind a solid side (a corner: by 30 % of
    its segments), or through a plate since the last check.
    """

    def __init__(self, plates: int, count: int) -> None:
        self._seen = np.zeros((plates, 3, count))  # right of the plate, beside it, height: at the last check
        self._looked = False  # that there was one since the discs were last moved by hand

    def forget(self) -> None:
        """The discs were moved by hand: what was seen of them says nothing."""
        self._looked = False

    def check(self, grains: Grains) -> None:
        """Raise Unstable, naming grain, quantity and step."""
        from porescale.dem.measures.survey import max_overlap

        discs = grains.discs
        if discs.count == 0:
            return
        self.check_finite(grains)
        if grains.last_dt > 0.0:
            speed = np.hypot(discs.velocity[:, 0], discs.velocity[:, 1])
            fastest = int(speed.argmax())
            smallest = float(discs.radius.min(where=discs.radius > 0.0, initial=np.inf))
            if speed[fastest] * grains.last_dt > WORST_TRAVEL * smallest:
                raise _unstable(
                    grains, f"grain {fastest}", "speed", float(speed[fastest]), "m/s",
                    f"more than {WORST_TRAVEL:g} of the smallest radius in a step: shorten the contact step",
                )  # fmt: skip
        for name, wall in zip(grains.wall_names, grains.walls, strict=True):
            distance = (discs.position - wall[:2]) @ wall[2:4]
            if grains.segments is not None:
                distance = distance + WORST_OVERLAP * grains.segments.beside_corner
            out = int(distance.argmin())
            if distance[out] < 0.0:
                raise _unstable(
                    grains, f"grain {out}", f"distance to the {name} wall", float(distance[out]), "m",
                    "it went through the wall: raise the stiffness or shorten the contact step",
                )  # fmt: skip
        grains.current_pairs()
        self._check_plates(grains)
        deepest = max_overlap(grains)
        corner = grains.segments is not None and deepest.disc >= 0 and grains.segments.is_corner[deepest.disc]
        if deepest.share > (WORST_OF_CORNERS if corner else WORST_OVERLAP):
            raise _unstable(
                grains, f"grain {deepest.disc}", f"overlap with {deepest.against} over radius", deepest.share, "",
                "raise the stiffness or shorten the contact step",
            )  # fmt: skip

    def check_finite(self, grains: Grains) -> None:
        """Raise Unstable at a position, velocity, spin or angle, or a place of a plate, that is no number."""
        d = grains.discs
        if np.isnan(grains.plates).any():
            nowhere = int(np.isnan(grains.plates).any(axis=1).argmax())
            raise _unstable(
                grains, f"plate {grains.plate_names[nowhere]}", "place", float("nan"), "m", "a motion without numbers"
            )
        if grains.sleep is not None and not np.isfinite(grains.sleep.removed.sum()):
            nowhere = int((~np.isfinite(grains.sleep.removed)).argmax())
            raise _unstable(
                grains, f"grain {nowhere}", "energy taken by sleep", float("nan"), "J/m", "it slept without a speed",
            )  # fmt: skip
        bad, column = first_without_number(d.position, d.velocity, d.spin, d.angle)
        if bad >= 0:
            quantity, unit = (("position", "m"), ("velocity", "m/s"), ("spin", "rad/s"), ("angle", "rad"))[column]
            raise _unstable(
                grains, f"grain {bad}", quantity, float("nan"), unit,
                "two centres met or the contact step is beyond its stability limit",
            )  # fmt: skip

    def _check_plates(self, grains: Grains) -> None:
        """Raise Unstable when a centre that was beside a plate at the last check is now on its other side.

        Only for discs that are wholly above the present lower end, then and now: the others may have gone below.
        """
        at, radius = grains.discs.position, grains.discs.radius
        for name, plate, seen in zip(grains.plate_names, grains.plates, self._seen, strict=True):
            right = at[:, 0] > plate[X]
            beside = (at[:, 1] - radius > plate[LOW]) & (at[:, 1] < plate[HIGH]) & (plate[PRESENT] != 0.0)
            if self._looked:
                through = beside & (seen[2] - radius > plate[LOW]) & (seen[1] != 0.0) & (right != (seen[0] != 0.0))
                if through.any():
                    out = int(through.argmax())
                    raise _unstable(
                        grains, f"grain {out}", f"distance to the {name}", -abs(float(at[out, 0] - plate[X])), "m",
                        "it went through: raise the stiffness or shorten the contact step",
                    )  # fmt: skip
            seen[0], seen[1], seen[2] = right, beside, at[:, 1]
        self._looked = True


def _unstable(grains: Grains, where: str, quantity: str, value: float, unit: str, cause: str) -> Unstable:
    return Unstable(where, quantity, value, unit, grains.steps, grains.time, cause)
