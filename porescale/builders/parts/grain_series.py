"""What a collapse is measured by: front, run-out, centre of mass, energies."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from porescale.builders.initial.frames import free_rows
from porescale.builders.parts.frame_measures import coordination_of_bodies
from porescale.builders.stepper import Row
from porescale.builders.system import System
from porescale.common.record.part import Part
from porescale.dem.discs import FIELDS, Discs
from porescale.dem.measures.survey import centre_of_mass, coordination, kinetic_energy, max_overlap


class GrainSeries(Part):
    """Follows the grains from where they start.

    The front is the foremost edge of any grain on the side to which the packing can flow: left if it starts right of
    the middle of the box, right otherwise.  Run-out is how far the front has come since the start.  Discs that are held
    come after the grains and are none of them, nor are bodies whose motion is prescribed in all components.
    """

    def __init__(self, system: System) -> None:
        assert system.grains
        self.grains, self.held, self.placed = system.grains, system.held, system.frames
        self.rows: slice | NDArray[np.int64] = free_rows(self.grains, self.placed, self.held)
        self.alone = len(self.rows) == self.grains.discs.count - self.held
        if self.alone:  # a view, where all others are grains
            self.rows = slice(self.grains.discs.count - self.held)
        middle = 0.5 * system.scene.domain.width
        self.leftward = bool(centre_of_mass(self.free())[0] > middle)
        self.start = self.front()

    def free(self) -> Discs:
        """The grains without what is held or moved as prescribed; views where there is no such thing but held discs."""
        return Discs(*(getattr(self.grains.discs, name)[self.rows] for name in FIELDS))

    def front(self) -> float:
        """Position of the front, m."""
        x, r = self.grains.discs.position[self.rows, 0], self.grains.discs.radius[self.rows]
        return float((x - r).min() if self.leftward else (x + r).max())

    def row(self) -> Row:
        """Columns of the grains in series.csv.

        front (m) : foremost edge of any grain, on the side to which the packing can flow
        run-out (m) : how far the front has come since the start
        centre of mass x (m) : of the grains, from the left side
        centre of mass y (m) : of the grains, from the bottom
        highest grain (m) : highest point of any grain, frames included
        kinetic energy of grains (J/m) : of translation and rotation, per metre of depth
        largest grain speed (m/s) : of the centre of any grain
        largest overlap over diameter () : deepest contact now, over the diameter
        coordination number () : mean number of other bodies that touch one
        """
        discs, front = self.free(), self.front()
        x, y = centre_of_mass(discs)
        return {
            "front (m)": front,
            "run-out (m)": self.start - front if self.leftward else front - self.start,
            "centre of mass x (m)": float(x),
            "centre of mass y (m)": float(y),
            "highest grain (m)": float((discs.position[:, 1] + discs.radius).max()),
            "kinetic energy of grains (J/m)": kinetic_energy(discs),
            "largest grain speed (m/s)": float(np.hypot(*discs.velocity.T).max()),
            "largest overlap over diameter ()": 0.5 * max_overlap(self.grains).share,
            "coordination number ()": self.coordination(),
        }

    def coordination(self) -> float:
        """Mean number of other bodies that touch one."""
        if self.alone and not self.placed:
            return coordination(self.grains)
        return coordination_of_bodies(self.grains, self.placed, self.held)

    def state(self) -> dict[str, Any]:
        """Position of the front at the start."""
        return {"watch": {"start": self.start, "leftward": self.leftward}}

    def restore(self, state: dict[str, Any]) -> None:
        """Restore the state of a checkpoint."""
        self.start, self.leftward = float(state["watch"]["start"]), bool(state["watch"]["leftward"])
