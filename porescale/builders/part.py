"""What a simulation is a list of: parts, each built from its section and driven through time with the others.

In every step: ``before`` of all parts, ``advance`` of the one that carries the physics, the clock, ``after`` of all.
Records take from each part its columns, tables and arrays; checkpoints for its state.  A part of an absent section is
neither built nor imported.
"""

from abc import ABC, abstractmethod
from dataclasses import dataclass
from typing import Any

from porescale.common.core.errors import Unstable
from porescale.common.core.types import AnyArray
from porescale.common.record.model import Snapshot

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

    def in_steps(self, error: Unstable) -> Unstable:
        """``error`` of the grains, which count contact steps, in steps and time of the simulation."""
        e = error
        return Unstable(e.where, e.quantity, e.value, e.unit, self.step, self.time, e.cause)


class Part:
    """One part of a simulation.  Every method may be left out; what is left out costs nothing in the loop over steps.

    Reading methods (row, tables, show, state) leave the state of the simulation as it is.
    """

    def before(self) -> None:
        """What is to be done before a step; the clock stands at its begin."""

    def after(self) -> None:
        """What is to be done after a step; the clock stands at its end."""

    @property
    def idle(self) -> bool:
        """Whether `before` and `after` have nothing to do in any step to come."""
        return not _between(self)

    def row(self) -> Row:
        """Columns of series.csv, by name with unit."""
        return {}

    def tables(self) -> dict[str, Row]:
        """A row of each further table: {"loads": {"time (s)": …, …}} for loads.csv."""
        return {}

    def show(self, snapshot: Snapshot) -> None:
        """Add grids and clouds, or arrays of those that are there, to a snapshot."""

    def check(self) -> None:
        """Raise Unstable, naming cell or grain, quantity and step, where the state is not finite or out of bounds."""

    def state(self) -> dict[str, Any]:
        """What is needed to go on bit for bit, by keys of the checkpoint that no other part has."""
        return {}

    def restore(self, state: dict[str, Any]) -> None:
        """Take up what `state` of a part built from the same scene gave; called in the reverse order of the parts."""


class Stepper(Part, ABC):
    """The part that carries the physics through a step: fluid, dry grains, or both.  A simulation has exactly one."""

    clock: Clock

    @abstractmethod
    def advance(self) -> None:
        """Do a step; may raise Unstable."""

    @property
    def takes_many(self) -> bool:
        """Whether `advance_many` is less work than so many times `advance`, where all other parts are idle."""
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


def overrides(part: Part, name: str) -> bool:
    """Whether a part has a method of its own instead of the empty one."""
    return getattr(type(part), name) is not getattr(Part, name)


def _between(part: Part) -> bool:
    return overrides(part, "before") or overrides(part, "after")
