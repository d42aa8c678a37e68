"""Checks of a system of grains: what a call of ``step`` is given, and that the state is finite and within bounds."""

import numpy as np

from porescale.common.core.ranges import Range, misfit, require_in_range
from porescale.common.core.types import Floats
from porescale.dem.bodies.rigid import clumps_of
from porescale.dem.finite import check_finite, unstable
from porescale.dem.forces.walls import HIGH, LOW, PRESENT, X
from porescale.dem.listing import current_pairs
from porescale.dem.measures.survey import max_overlap, name_of
from porescale.dem.motion.control import AXIS, CLUMP, INDEX, KIND, PUSH
from porescale.dem.state import State, StepNumbers

WORST_OVERLAP = 0.3  # of the smaller radius: the linear law and its lever arms are not valid beyond
WORST_OF_CORNERS = 0.8  # of the thicknesses of two segments: small beside bodies, which go through each other at 1
WORST_TRAVEL = 0.1  # of the smallest radius in one step: a contact would be detected too late
WORST_OF_TRAVELLING_CORNERS = 0.2  # of the smallest thickness: two corners meet at two of them, a disc at more

STIFFER = "raise the stiffness or shorten the contact step"
PRESCRIBED = "its motion is prescribed, and no force stops it: end the motion before, or move what is in its way"


STEP = {"dt": Range("s", gt=0), "count": Range(ge=0, whole=True), "drag": Range("1/s", ge=0)}
"""What a call of ``step`` may be given."""


def check_step(grains: State, given: StepNumbers, force: Floats | None, torque: Floats | None) -> None:
    """Raise InputError where dt (s), count or drag (1/s) of ``given``, or a load is no such number.

    force (n, 2) N/m, torque (n,) N m/m, or None: their shapes alone; `check` finds loads that are not finite.  What
    passed is kept in ``checked``, so that further calls with the same numbers and arrays cost nothing.
    """
    require_in_range("step", dict(zip(STEP, given, strict=False)), STEP)
    count = grains.discs.count
    for key, given_array, shape, unit in (
        ("step.external_force", force, (count, 2), "N/m"), ("step.external_torque", torque, (count,), "N m/m"),
    ):  # fmt: skip
        try:
            np.broadcast_to(np.asarray(0.0 if given_array is None else given_array, np.float64), shape)
        except (TypeError, ValueError):
            raise misfit(key, given_array, shape, Range(unit), spread=True) from None
    grains.checked = given, force, torque


def check(grains: State) -> None:
    """Raise Unstable, naming grain, quantity and step, where the state is not finite or out of bounds.

    That is: a number that is none; a speed beyond 0.1 smallest radii (of corners: 0.2 smallest thicknesses) per step;
    an overlap beyond 30 % of the radius (of a corner of a frame: 80 % of the thicknesses); a centre behind a solid side
    (a corner: by 30 % of its segments), or through a plate since the last check.
    """
    discs = grains.discs
    if discs.count == 0:
        return
    check_finite(grains)
    if grains.last_dt > 0.0:
        _check_travel(grains)
    for name, wall in zip(grains.wall_names, grains.walls, strict=True):
        distance = (discs.position - wall[:2]) @ wall[2:4]
        if grains.segments is not None:
            distance = distance + WORST_OVERLAP * grains.segments.beside_corner
        out = int(distance.argmin())
        if distance[out] < 0.0:
            raise unstable(
                grains, name_of(grains, out), f"distance to the {name} wall", float(distance[out]), "m",
                f"it went through the wall: {PRESCRIBED if _prescribed(grains, out) else STIFFER}",
            )  # fmt: skip
    current_pairs(grains)
    _check_plates(grains)
    deepest = max_overlap(grains)
    corner = grains.segments is not None and deepest.disc >= 0 and grains.segments.is_corner[deepest.disc]
    if deepest.share > (WORST_OF_CORNERS if corner else WORST_OVERLAP):
        surface = deepest.other < 0 and not deepest.against.startswith(("segment", "corner"))
        moved = _prescribed(grains, deepest.disc) and (surface or _prescribed(grains, deepest.other))
        raise unstable(
            grains, name_of(grains, deepest.disc), f"overlap with {deepest.against} over radius", deepest.share, "",
            PRESCRIBED if moved else STIFFER,
        )  # fmt: skip


def _prescribed(grains: State, disc: int) -> bool:
    """Whether the velocity of a disc is prescribed, whatever the forces: by a hold or a control of x or y, of one of a
    body also of its rotation."""
    if 0 <= disc < len(grains.held) and grains.held[disc, :2].any():
        return True
    if disc < 0 or grains.drivers is None:
        return False
    control, clumps, body = grains.drivers.arrays.control, clumps_of(grains), -1
    if clumps is not None and len(row := np.flatnonzero(clumps.member == disc)):
        body = int(np.searchsorted(clumps.start, row[0], "right")) - 1
    free, alone = control[:, KIND] == PUSH, control[:, CLUMP] == 0
    if body < 0:
        own = alone & (control[:, INDEX] == disc) & (control[:, AXIS] < 2)
    else:  # the rotation of a body moves its members
        own = ~alone & (control[:, INDEX] == body)
    return bool((own & ~free).any())


def _check_travel(grains: State) -> None:
    """Raise Unstable where a disc or a corner of a frame goes too far in a step of ``last_dt`` (s).

    Thin corners do not limit discs: a disc of radius r meets a frame of thickness t at r + t.
    """
    discs = grains.discs
    speed = np.hypot(discs.velocity[:, 0], discs.velocity[:, 1])
    corner = np.zeros(discs.count, bool) if grains.segments is None else grains.segments.is_corner
    for chosen, share, what in (
        (~corner, WORST_TRAVEL, "radius"),
        (corner, WORST_OF_TRAVELLING_CORNERS, "thickness"),
    ):
        smallest = float(discs.radius.min(where=chosen & (discs.radius > 0.0), initial=np.inf))
        fastest = int(np.where(chosen, speed, 0.0).argmax())
        if speed[fastest] * grains.last_dt > share * smallest:
            raise unstable(
                grains, name_of(grains, fastest), "speed", float(speed[fastest]), "m/s",
                f"more than {share:g} of the smallest {what} in a step: shorten the contact step",
            )  # fmt: skip


def _check_plates(grains: State) -> None:
    """Raise Unstable when a centre that was beside a plate at the last check is now on its other side.

    Only for discs that are wholly above the present lower end, then and now: the others may have gone below.
    """
    at, radius = grains.discs.position, grains.discs.radius
    for name, plate, seen in zip(grains.plate_names, grains.plates, grains.plate_sides, strict=True):
        right = at[:, 0] > plate[X]
        beside = (at[:, 1] - radius > plate[LOW]) & (at[:, 1] < plate[HIGH]) & (plate[PRESENT] != 0.0)
        if grains.plates_checked:
            through = beside & (seen[2] - radius > plate[LOW]) & (seen[1] != 0.0) & (right != (seen[0] != 0.0))
            if through.any():
                out = int(through.argmax())
                raise unstable(
                    grains, f"grain {out}", f"distance to the {name}", -abs(float(at[out, 0] - plate[X])), "m",
                    "it went through: raise the stiffness or shorten the contact step",
                )  # fmt: skip
        seen[0], seen[1], seen[2] = right, beside, at[:, 1]
    grains.plates_checked = True
