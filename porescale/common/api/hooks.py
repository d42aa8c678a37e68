"""Hooks: functions of the user's that a simulation calls while it runs; nothing of them is there without one."""

from __future__ import annotations

import inspect
from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from porescale.common.api.hook_source import hash_of, source_of
from porescale.common.core.errors import Fault, InputError, Unstable
from porescale.common.core.ranges import is_number
from porescale.common.record.columns import TIME
from porescale.common.record.schedule import Schedule, positive

if TYPE_CHECKING:
    from porescale.common.core.types import AnyArray, Floats
    from porescale.common.record.model import Model

ForceFunction = Callable[[float, "AnyArray", "AnyArray", "AnyArray"], None]
SampleFunction = Callable[[Any], Mapping[str, float] | None]


class Hook:
    """A function of the user's, by its name.

    source, hash : its text, and what tells it from another one (`hook_source`), as they were when it was added.
    """

    kind: ClassVar[str]
    arguments: ClassVar[str]

    def __init__(self, function: Callable[..., Any]) -> None:
        """InputError where it has no name, or does not take what it is given."""
        self.function, self.name = function, str(getattr(function, "__name__", ""))
        if not self.name.isidentifier():
            raise InputError(Fault(self.kind, self.name, "is not the name of a function", repair="write it with def"))
        try:
            inspect.signature(function).bind(*self.arguments.split(", "))
        except TypeError:
            problem = "does not take what it is given"
            raise self.fault(problem, f"def {self.name}({self.arguments})") from None
        except ValueError:  # no signature to be seen, as of some built-in functions
            pass
        self.source, self.hash = source_of(function), hash_of(function)

    def fault(self, problem: str, repair: str) -> InputError:
        """What is wrong with the function."""
        return InputError(Fault(f"{self.kind} {self.name}", None, problem, repair=repair))

    def note(self, error: BaseException, step: int, time: float) -> None:
        """Say in an error which hook raised it, and when."""
        error.add_note(f"raised by the hook {self.name} ({self.kind}) at step {step}, t = {time:.6g} s")

    def on_card(self) -> dict[str, Any]:
        """What card.json holds of it."""
        return {"kind": self.kind, "interval": None, "source": self.source, "hash": self.hash}


class ForceHook(Hook):
    """A force on every grain or particle.  force : (n, 2) N/m of the last call."""

    kind = "force"
    arguments = "time, positions, velocities, out"

    def __init__(self, function: ForceFunction) -> None:
        super().__init__(function)
        self.force: Floats = np.zeros((0, 2))

    def call(self, step: int, time: float, positions: AnyArray, velocities: AnyArray) -> Floats:
        """The force, (n, 2) N/m, at a ``time`` (s); positions (n, 2) m and velocities (n, 2) m/s are read-only."""
        force = self.force
        if len(force) != len(positions):
            force = self.force = np.zeros((len(positions), 2))
        else:
            force.fill(0.0)
        try:
            returned = self.function(time, positions, velocities, force)
        except Exception as error:
            self.note(error, step, time)
            raise
        if returned is not None:
            raise self.fault("returns something", "write the force into out, and return nothing")
        return force

    def check(self, step: int, time: float) -> None:
        """Raise Unstable where the force is no number."""
        lost = ~np.isfinite(self.force).all(axis=1)
        if lost.any():
            cause = f"the hook {self.name} wrote it"
            raise Unstable(f"row {int(lost.argmax())}", f"force {self.name}", float("nan"), "N/m", step, time, cause)


class EveryHook(Hook):
    """A function that is called now and then, with the rows that it gave; a `Sampler`.

    schedule : when;  columns : what it has given so far, by name, "time (s)" first.
    """

    kind = "every"
    arguments = "sim"

    def __init__(self, function: SampleFunction, simulation: Model, interval: str, schedule: Schedule) -> None:
        super().__init__(function)
        self.simulation, self.interval, self.schedule = simulation, interval, schedule
        self.asked = False
        self.restart()

    def restart(self) -> None:
        """Forget all rows of this hook, as before the first step."""
        self.columns: dict[str, list[float]] = {}
        self.last_step, self.loose = -1, False
        self.schedule.done = -1

    def sample(self, *, scheduled: bool) -> dict[str, float] | None:
        """Call the function; the row that it gives, which is kept, or None.

        A row that was there only because the run ended is dropped when it goes on.
        """
        sim, step = self.simulation, self.simulation.step
        if self.loose:
            for column in self.columns.values():
                column.pop()
            self.loose = False
        self.last_step = step
        if self.asked:
            raise self.fault("ran the simulation", "only measure in it")
        self.asked = True
        try:
            given = self.function(sim)
        except Exception as error:
            self.note(error, step, sim.time)
            raise
        finally:
            self.asked = False
        if sim.step != step:
            raise self.fault("did steps of the simulation", "only measure in it")
        if given is None:
            return None
        row = {TIME: sim.time, **self._numbers(given)}
        if self.columns and list(row) != list(self.columns):
            other = ", ".join(sorted(set(row) ^ set(self.columns))) or "another order"
            raise self.fault(f"gave other columns than before: {other}", "give the same ones every time")
        for name, value in row.items():
            self.columns.setdefault(name, []).append(value)
        self.loose = not scheduled
        return row

    def _numbers(self, given: Any) -> dict[str, float]:
        """What the function gave, as numbers."""
        if not isinstance(given, Mapping):
            raise self.fault(f"returned {type(given).__name__}", "return a dict of columns, or nothing")
        row = {}
        for name, value in given.items():
            if not str(name).strip() or set(str(name)) & set(',"\r\n'):
                raise self.fault(f"{str(name)!r} is no name of a column", 'name it as "height (m)"')
            try:
                row[str(name)] = float(value)
            except (TypeError, ValueError, OverflowError):
                raise self.fault(f"column {str(name)!r} is no number", "give one number a column") from None
        row.pop(TIME, None)
        return row

    def on_card(self) -> dict[str, Any]:
        """What card.json holds of it."""
        return {**super().on_card(), "interval": self.interval}


def when(seconds: float | None, steps: int | None, step_seconds: float | None) -> tuple[str, Schedule]:
    """The interval as text, and the schedule; step_seconds : None where the length of steps varies."""
    if (seconds is None) == (steps is None) or callable(seconds):
        problem = "needs an interval" if steps is None else "has two intervals"
        raise InputError(Fault("every", None, problem, repair="write @sim.every(seconds=1e-3) or @sim.every(steps=10)"))
    if steps is not None:
        if not is_number(steps) or not steps >= 1 or steps % 1:
            raise InputError(Fault("every.steps", steps, "is no number of steps", allowed=">= 1, whole"))
        return f"{int(steps)} steps", Schedule(float(steps), 1.0)
    assert seconds is not None
    interval = positive("every.seconds", seconds, endless=True)
    return f"{interval!r} s", Schedule(interval, step_seconds)
