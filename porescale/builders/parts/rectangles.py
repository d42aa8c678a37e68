"""Rectangles in motion, for fluid and grains alike."""

from math import inf
from typing import Any

from porescale.builders.stepper import Row
from porescale.builders.system import System
from porescale.common.record.part import Part
from porescale.dem.forces.rectangle import LEFT, RIGHT, VELOCITY_X
from porescale.scene.bodies.rectangle import Rectangle as RectangleSection

MAKE_GOOD = 64
"""Steps after which what left with rectangles is made good: even, and too few for a density to change that is seen."""


class RectanglesPart(Part):
    """Moves the rectangles.

    lattice : as the fluid has them, none without fluid;  make_good : whether the fluid's mass is;  made_good : fluid
    taken out again of what came in with them, cells.
    """

    def __init__(self, system: System) -> None:
        self.clock, self.sections, self.lattice = system.clock, system.scene.rectangle, list(system.rectangles)
        self.grains, self.coupled = system.grains, system.coupled
        self.scales = self.coupled.scales if self.coupled else None
        closed = not any(side.open for side in system.scene.domain.sides.values())
        self.make_good = next((it.make_good for it in self.sections if it.make_good is not None), closed)
        self.made_good = 0.0

    @property
    def acts_from(self) -> float:
        """The first step of one that is still to start; now while one moves, and in the step that ends it."""
        return min((self._acts_from(it) for it in self.sections if it.fastest), default=inf)

    def _acts_from(self, section: RectangleSection) -> float:
        """The same of one rectangle that moves at some time."""
        if section.stops_at is not None and self.clock.step > section.stops_at / self.clock.seconds + 1.5:
            return inf
        return self.clock.step_of(section.starts_at)

    def after(self) -> None:
        """Put all where they are now."""
        for k, section in enumerate(self.sections):
            here = section.travelled(self.clock.step * self.clock.seconds)
            for a in range(2):
                if self.scales:
                    self.lattice[k].lower[a] = (section.lower[a] + here[a]) / self.scales.spacing
                if self.grains:
                    self.grains.rectangles[k, LEFT + a] = section.lower[a] + here[a]
                    self.grains.rectangles[k, RIGHT + a] = section.upper[a] + here[a]

    def before(self) -> None:
        """Give all the velocity that takes them through the step, and now and then make the fluid's mass good."""
        step, step_seconds, coupled = self.clock.step, self.clock.seconds, self.coupled
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

    def row(self) -> Row:
        """Columns of the series, in fluid.

        fluid in with rectangles (m²) : area of fluid that moving rectangles have let in through sides, since the start
        of it taken out again (m²) : what rectangle.make_good has taken out since the start
        """
        coupled = self.coupled
        if coupled is None:
            return {}
        area = coupled.scales.spacing**2
        through = self.made_good + coupled.saturated.mass_through_sides
        return {"fluid in with rectangles (m²)": through * area, "of it taken out again (m²)": self.made_good * area}

    def state(self) -> dict[str, Any]:
        """What was made good; where they are follows from the time."""
        return {"made_good": self.made_good}

    def restore(self, state: dict[str, Any]) -> None:
        """Restore the state of a checkpoint."""
        self.made_good = float(state["made_good"])
        self.after()
