"""What a collapse is measured by: front, run-out, centre of mass, energies."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from porescale.build.initial.frames import Placed, free_rows
from porescale.build.parts.frame_measures import coordination_of_bodies
from porescale.dem.discs import FIELDS, Discs
from porescale.dem.grains import Grains
from porescale.dem.measures.energy import energy_book
from porescale.dem.measures.survey import centre_of_mass, coordination, kinetic_energy, max_overlap
from porescale.scene.scene import Scene


class Watch:
    """Follows the grains from where they start.

    The front is the foremost edge of any grain on the side to which the packing can flow: left if it starts right of
    the middle of the box, right otherwise.  Run-out is how far the front has come since the start.  Discs that are held
    come after the grains and are none of them, nor are frames that move as told (``placed``).
    """

    def __init__(self, scene: Scene, grains: Grains, placed: Sequence[Placed] = ()) -> None:
        self.held, self.placed = len(scene.disc), placed
        held = self.held
        self.rows: slice | NDArray[np.int64] = slice(grains.discs.count - held)
        if placed:
            self.rows = free_rows(grains, placed, held)
        middle = 0.5 * scene.domain.width
        self.leftward = bool(centre_of_mass(self.free(grains))[0] > middle)
        self.start = self.front(grains)

    def free(self, grains: Grains) -> Discs:
        """The grains without the discs that are held; views where there are no frames."""
        return Discs(*(getattr(grains.discs, name)[self.rows] for name in FIELDS))

    def front(self, grains: Grains) -> float:
        """Position of the front, m."""
        x, r = grains.discs.position[self.rows, 0], grains.discs.radius[self.rows]
        return float((x - r).min() if self.leftward else (x + r).max())

    def row(self, grains: Grains) -> dict[str, float]:
        """Columns of the series."""
        discs, front = self.free(grains), self.front(grains)
        x, y = centre_of_mass(discs)
        return {
            "front (m)": front,
            "run-out (m)": self.start - front if self.leftward else front - self.start,
            "centre of mass x (m)": float(x),
            "centre of mass y (m)": float(y),
            "highest grain (m)": float((discs.position[:, 1] + discs.radius).max()),
            "kinetic energy of grains (J/m)": kinetic_energy(discs),
            "largest grain speed (m/s)": float(np.hypot(*discs.velocity.T).max()),
            "largest overlap over diameter ()": 0.5 * max_overlap(grains).share,
            "coordination number ()": self.coordination(grains),
        }

    def coordination(self, grains: Grains) -> float:
        """Mean number of other bodies that touch one."""
        if not self.placed:
            return coordination(grains)
        return coordination_of_bodies(grains, self.placed, self.held)

    def state(self) -> dict[str, Any]:
        """Where the front started."""
        return {"start": self.start, "leftward": self.leftward}

    def restore(self, state: dict[str, Any]) -> None:
        """Take up a state."""
        self.start, self.leftward = float(state["start"]), bool(state["leftward"])


RESIDUAL = "residual (J/m)"


def energy_row(grains: Grains, acceleration: tuple[float, float]) -> dict[str, float]:
    """Columns of the series: the energy book since the first step, J/m, its residual last.

    acceleration : of free fall, m/s^2, whose work is the potential energy.
    """
    book = energy_book(grains, acceleration)
    return {**{name: value for name, value in book.items() if name != RESIDUAL}, RESIDUAL: book[RESIDUAL]}
