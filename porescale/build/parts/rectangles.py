"""Rectangles in motion, for fluid and grains alike."""

from __future__ import annotations

from collections.abc import Sequence

from porescale.coupling.coverage.rectangle import Rectangle as LatticeRectangle
from porescale.coupling.step import Coupled
from porescale.dem.forces.rectangle import LEFT, RIGHT, VELOCITY_X
from porescale.dem.grains import Grains
from porescale.lbm.scales import Scales
from porescale.scene.scene import Scene

MAKE_GOOD = 64
"""Steps after which what left with rectangles is made good: even, and too few for a density to change that is seen."""


class Movers:
    """Moves the rectangles of a scene, for fluid and grains alike."""

    def __init__(
        self, scene: Scene, lattice: Sequence[LatticeRectangle], scales: Scales | None, grains: Grains | None
    ) -> None:
        self.sections, self.lattice, self.scales, self.grains = scene.rectangle, list(lattice), scales, grains
        closed = not any(side.open for side in scene.domain.sides.values())
        wanted = [it.make_good for it in self.sections if it.make_good is not None]
        self.make_good = wanted[0] if wanted else closed
        self.made_good = 0.0  # cells

    def place(self, step: int, step_seconds: float) -> None:
        """Put all where they are at the start of ``step``."""
        for k, section in enumerate(self.sections):
            here = section.travelled(step * step_seconds)
            for a in range(2):
                if self.scales:
                    self.lattice[k].lower[a] = (section.lower[a] + here[a]) / self.scales.spacing
                if self.grains:
                    self.grains.rectangles[k, LEFT + a] = section.lower[a] + here[a]
                    self.grains.rectangles[k, RIGHT + a] = section.upper[a] + here[a]

    def advance(self, step: int, step_seconds: float, coupled: Coupled | None) -> None:
        """Give all the velocity that takes them through ``step``, and now and then make the fluid's mass good."""
        time = step * step_seconds
        for k, section in enumerate(self.sections):
            here, there = section.travelled(time), section.travelled(time + step_seconds)
            for a in range(2):
                speed = (there[a] - here[a]) / step_seconds
                if self.scales:
                    self.lattice[k].velocity[a] = speed / self.scales.velocity
                if self.grains:
                    self.grains.rectangles[k, VELOCITY_X + a] = speed
        if coupled and self.make_good and step % MAKE_GOOD == 0:
            self.made_good += coupled.saturated.restore_mass(coupled.fluid)

    def row(self, coupled: Coupled) -> dict[str, float]:
        """Columns of the series."""
        area = coupled.scales.spacing**2
        through = self.made_good + coupled.saturated.mass_through_sides
        return {"fluid in with rectangles (m²)": through * area, "of it taken out again (m²)": self.made_good * area}


def rectangle_loads(numbers: Sequence[int], coupled: Coupled) -> dict[str, float]:
    """Forces of the fluid and of the grains on rectangles by number, columns of loads.csv."""
    row: dict[str, float] = {}
    for k in numbers:
        fluid, grains = coupled.rectangle_force[k], coupled.grains.rectangle_force[k]
        for a, axis in enumerate("xy"):
            row[f"rectangle {k} force {axis} (N/m)"] = float(fluid[a])
            row[f"rectangle {k} force of grains {axis} (N/m)"] = float(grains[a])
    return row
