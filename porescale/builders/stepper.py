"""The clock that the parts of a simulation share, and the part that carries the physics through a step."""

from abc import ABC, abstractmethod
from dataclasses import dataclass

from porescale.common.core.errors import Unstable
from porescale.common.core.types import AnyArray
from porescale.common.record.part import Part

Row = dict[str, float]
Fields = tuple[AnyArray, AnyArray, AnyArray, AnyArray]
"""Density excess (kg/m³), velocity (m/s, two arrays) and solid fraction of every cell, each (ny, nx)."""


@dataclass
class Clock:
    """The time of a simulation, shared by its parts.

    seconds : of a step;  step : steps done (fluid steps, or contact steps without fluid);  time : s.
    """

    seconds: float
    step: int = 0
    time: float = 0.0

    def put(self, step: int) -> None:
        """Set the number of steps done."""
        self.step = step
        self.time = step * self.seconds

    def step_of(self, time: float) -> float:
        """A step that is over, at the latest, half a step before ``time`` (s): what acts in the step that begins
        nearest to it has nothing to do before."""
        return time / self.seconds - 1.5

    def in_steps(self, error: Unstable) -> Unstable:
        """``error`` of the grains, which count contact steps, in steps and time of the simulation."""
        e = error
        return Unstable(e.where, e.quantity, e.value, e.unit, self.step, self.time, e.cause)


class Stepper(Part, ABC):
    """The part that carries the physics through a step: fluid, dry grains, or both.  A simulation has exactly one."""

    clock: Clock

    @abstractmethod
    def advance(self) -> None:
        """Do a step; may raise Unstable."""

    @property
    def takes_many(self) -> bool:
        """Whether `advance_many` is less work than so many times `advance`, where no other part acts between steps."""
        return False

    def advance_many(self, steps: int) -> None:
        """Do ``steps`` steps with nothing between them, and set the clock."""
        for _ in range(steps):
            self.advance()
            self.clock.put(self.clock.step + 1)

    def fields(self) -> Fields:
        """Fields of a simulation with fluid; raises TypeError without fluid."""
        raise TypeError("a simulation without fluid has no fields of it")

    @abstractmethod
    def explained(self, error: Unstable) -> Unstable:
        """``error``, raised within a step, in steps of the simulation; raises one that is nearer to the cause."""
