"""Dry grains: their steps, and checks of their state."""

from typing import Any

from porescale.builders.stepper import Stepper
from porescale.builders.system import System
from porescale.common.core.errors import Unstable


class GrainsPart(Stepper):
    """Grains without fluid.  weight : (n, 2) N/m."""

    def __init__(self, system: System) -> None:
        assert system.grains
        self.clock, self.grains, self.weight = system.clock, system.grains, system.weight

    def advance(self) -> None:
        """Advance the grains by one contact step."""
        self.grains.step(self.clock.seconds, self.weight)

    @property
    def takes_many(self) -> bool:
        """Unless grains sleep, which fall asleep and wake between calls."""
        return self.grains.sleep is None

    def advance_many(self, steps: int) -> None:
        """All in one call, and the last in one more where loads are means over a call, so that they are those of the
        last step; where a grain gets lost the clock stands at the step in which it did."""
        grains, seconds = self.grains, self.clock.seconds
        before = grains.steps - self.clock.step
        last = 1 if steps > 1 and (grains.steered or len(grains.held)) else 0
        try:
            grains.step(seconds, self.weight, count=steps - last)
            if last:
                grains.step(seconds, self.weight)
        finally:
            self.clock.put(grains.steps - before)

    def explained(self, error: Unstable) -> Unstable:
        """The ``error`` with its step counted in steps of the simulation."""
        return self.clock.in_steps(error)

    def check(self) -> None:
        """Raise Unstable where a grain is not finite or out of bounds."""
        try:
            self.grains.check()
        except Unstable as error:
            raise self.clock.in_steps(error) from None

    def state(self) -> dict[str, Any]:
        """The grains; ``mass``, of the fluid, is that of none."""
        return {"mass": 0.0, "grains": self.grains.state()}

    def restore(self, state: dict[str, Any]) -> None:
        """Restore the state of a checkpoint."""
        self.grains.restore(state["grains"])
