"""A simulation in Python: what the simulations of both packages can do besides their steps."""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping
from numbers import Integral
from types import MappingProxyType
from typing import TYPE_CHECKING, Any, Self, TypeVar

import numpy as np

from porescale.common.api.hooks import EveryHook, ForceFunction, ForceHook, Hook, SampleFunction, when
from porescale.common.compiled import jit
from porescale.common.core.errors import Fault, InputError
from porescale.common.core.ranges import is_number
from porescale.common.duration.threads import Threads
from porescale.common.record.columns import Columns
from porescale.common.record.model import Snapshot, variable_step
from porescale.common.record.record import MADE_LATER
from porescale.common.record.schedule import CHECK_EVERY, SLACK, block
from porescale.common.record.stop import polite_stop

if TYPE_CHECKING:
    from porescale.common.core.types import Floats
    from porescale.common.duration.quiet import Moment
    from porescale.common.record.part import Part
    from porescale.common.record.progress import Watch

P = TypeVar("P", bound="Part")

FILES = ("series", *(name.removesuffix(".csv") for name in MADE_LATER if name.endswith(".csv")))
"""Tables that a run writes anyway."""


class BaseSimulation(ABC):
    """A `Model` of a scene that is run, looked at and changed from Python.

    scene : what it was built from;  parts : what it consists of, in the order of their columns;  hooks : functions
    that are called while it runs, by name;  building : when building it began and ended, if that is known.
    """

    scene: Any
    building: tuple[Moment, Moment] | None = None
    parts: list[Part]
    hooks: Mapping[str, Hook] = MappingProxyType({})
    _threads: Threads | None = None

    @property
    @abstractmethod
    def step(self) -> int:
        """Number of steps done since time 0."""

    @property
    @abstractmethod
    def time(self) -> float:
        """Time reached, in seconds."""

    @property
    @abstractmethod
    def step_seconds(self) -> float:
        """Length of a step, s (of the next one, if it varies)."""

    @abstractmethod
    def advance(self, steps: int) -> None:
        """Do ``steps`` steps (0 or more), and nothing else; may raise Unstable.  InputError for other values."""

    @staticmethod
    def _require_steps(steps: int) -> None:
        """InputError unless ``steps`` is a whole number from 0 on."""
        if not (isinstance(steps, Integral) and steps >= 0):
            repair = "give a whole number as 10"
            raise InputError(Fault("steps", str(steps), "is no number of steps", allowed=">= 0, whole", repair=repair))

    def check(self) -> None:
        """Raise Unstable, naming cell, grain or particle, quantity and step, where the state is not finite or out of
        bounds."""
        self._check_forces()
        for part in self.parts:
            part.check()

    @abstractmethod
    def series(self) -> dict[str, float]:
        """One row of series.csv: the time, and what is measured now, by column with unit."""

    def snapshot(self) -> Snapshot:
        """Grids and clouds now, as they are recorded; arrays may be views."""
        snapshot = Snapshot(self.time, self.step)
        for part in self.parts:
            part.show(snapshot)
        return snapshot

    @abstractmethod
    def state(self) -> dict[str, Any]:
        """Everything needed to go on bit for bit."""

    @abstractmethod
    def restore(self, state: dict[str, Any]) -> None:
        """Take up a state of a simulation built from the same scene."""

    @abstractmethod
    def motion(self) -> tuple[Floats, Floats]:
        """Positions (n, 2) m and velocities (n, 2) m/s of the discs or particles, as they lie in memory."""

    @property
    @abstractmethod
    def radii(self) -> Floats:
        """Radii of the grains, or half the spacing of the particles, (n,) m; a copy."""

    @property
    @abstractmethod
    def masses(self) -> Floats:
        """Masses of the grains or particles, (n,) kg per metre of depth; a copy."""

    @property
    def positions(self) -> Floats:
        """Where the grains or particles are, (n, 2) m; a copy, which later steps leave as it is.

        Positions go on counting where a side is periodic.  InputError where there is none.
        """
        return self.motion()[0].copy()

    @property
    def velocities(self) -> Floats:
        """Velocities of the grains or particles, (n, 2) m/s, in the order of `positions`; a copy."""
        return self.motion()[1].copy()

    def part(self, kind: type[P]) -> P:
        """The first part of this class; InputError, with those that there are, where the scene builds none."""
        found = self._part_or_none(kind)
        if found is None:
            built = ", ".join(dict.fromkeys(type(part).__name__ for part in self.parts))
            name = kind.__name__ if isinstance(kind, type) else repr(kind)
            raise InputError(Fault("part", name, "is not built by this scene", allowed=built))
        return found

    def _part_or_none(self, kind: type[P]) -> P | None:
        """The first part of this class, if there is one."""
        return next((part for part in self.parts if isinstance(kind, type) and isinstance(part, kind)), None)

    @property
    def name(self) -> str:
        """What the simulation is called in progress and pictures: title or name of its scene."""
        return str(self.scene.title or self.scene.name or "scene")

    def force(self, function: ForceFunction) -> ForceFunction:
        """Decorator: a force on every grain or particle, ``function(time, positions, velocities, out)``.

        It is called once a step (of the fluid; of contacts where grains are dry) with the time (s), positions (n, 2) m
        and velocities (n, 2) m/s in the order of `positions`, read-only, and ``out`` (n, 2), zero, into which it writes
        N per metre of depth.  What it writes is added to weight and fluid; for grains that are held it is left out, and
        bodies of segments have none.  Several forces add up; one of the same name takes the other's place.  It must
        follow from its arguments alone for a run to be gone on with bit for bit.  InputError where there is nothing to
        move.
        """
        hook = ForceHook(function)
        self._require_free_name(hook)
        self._add_force(hook, self.hooks.get(hook.name))
        self.hooks = {**self.hooks, hook.name: hook}
        return function

    @abstractmethod
    def _add_force(self, hook: ForceHook, instead_of: Hook | None) -> None:
        """Let a hook act from the next step on, in place of another one if given."""

    def _check_forces(self) -> None:
        """Raise Unstable where a hook gave what is no number: it is the cause of what follows."""
        for hook in self.hooks.values():
            if isinstance(hook, ForceHook):
                hook.check(self.step, self.time)

    def every(
        self, seconds: float | None = None, *, steps: int | None = None
    ) -> Callable[[SampleFunction], SampleFunction]:
        """Decorator: ``function(sim)`` is called at time 0, at multiples of an interval and at the end of a run.

        seconds : interval, s;  steps : interval in steps.  A dict of numbers that it returns is a row of a table:
        `records`, and <name of the function>.csv in a run folder, with "time (s)" as the first column.  It is called by
        `run`, not by `advance`, and must only measure.  One of the same name takes the other's place.
        """
        interval = seconds, steps, None if variable_step(self) else self.step_seconds
        when(*interval)  # what is wrong with it is said at once

        def add(function: SampleFunction) -> SampleFunction:
            """Add the hook; the function stays as it is."""
            text, schedule = when(*interval)
            hook = EveryHook(function, self, text, schedule)
            self._require_free_name(hook)
            if hook.name in FILES or hook.name in self.tables():
                raise hook.fault(f"would write {hook.name}.csv, which the run writes", "give it another name")
            if self.step and schedule.ratio is None:  # the first event is after now
                schedule.restore({"interval": math.nan, "done": -1}, self.time)
            self.hooks = {**self.hooks, hook.name: hook}
            return function

        return add

    def _require_free_name(self, hook: Hook) -> None:
        """InputError where a hook of another kind has the name."""
        other = self.hooks.get(hook.name)
        if other is not None and other.kind != hook.kind:
            raise hook.fault(f"is the name of another hook ({other.kind})", "give it another name")

    @property
    def samplers(self) -> list[EveryHook]:
        """The hooks that are called now and then."""
        return [hook for hook in self.hooks.values() if isinstance(hook, EveryHook)]

    @property
    def records(self) -> dict[str, Columns]:
        """What hooks of `every` have given so far, by the name of the hook: columns by name, each (rows,)."""
        return {
            hook.name: Columns({name: np.array(values) for name, values in hook.columns.items()}, hook.name)
            for hook in self.samplers
        }

    def tables(self) -> dict[str, dict[str, float]]:
        """A row of each further table that the scene asks for."""
        return {}

    def run(
        self,
        until: float | None = None,
        *,
        seconds: float | None = None,
        steps: int | None = None,
        progress: bool = False,
    ) -> Self:
        """Go on to a time, for a while, or for some steps; writes no file.  Returns the simulation.

        until : s, as the time of the scene counts; rounded to whole steps, and the first step at or after it where the
        length of steps varies.  seconds : s from now;  steps : from now.  Without any of them: to the scene's end.
        progress : a bar with the time left, in terminals and notebooks.

        The state is checked every 100 steps and at the end.  Pieces of a run give the same bits as all in one.  Ctrl-C
        ends it after a whole step with KeyboardInterrupt; it can be gone on with.  Raises Unstable, naming cell, grain
        or particle, quantity and step, and InputError for a time that is past or no number.
        """
        end, last = self._end(until, seconds, steps)
        if progress:
            from porescale.common.record.progress import Watch

            expected = self.time + (last or 0) * self.step_seconds - self.step * self.step_seconds
            with Watch(self.name, self.time, expected if end is None else end) as watch:
                self._go_on(end, last, watch)
        else:
            self._go_on(end, last, None)
        return self

    def _end(self, until: float | None, seconds: float | None, steps: int | None) -> tuple[float | None, int | None]:
        """Time, s, and step of the end; the step is None where only the time decides, the time where only steps do."""
        given = {"until": until, "seconds": seconds, "steps": steps}
        if sum(value is not None for value in given.values()) > 1:
            names = [name for name, value in given.items() if value is not None]
            raise InputError(Fault(names[0], given[names[0]], f"contradicts {names[1]}", repair="give one of them"))
        if steps is not None:
            if not is_number(steps) or not steps >= 0 or steps % 1:
                raise InputError(Fault("steps", steps, "is no number of steps", allowed=">= 0, whole"))
            last = self.step + int(steps)
            return (None if variable_step(self) else last * self.step_seconds), last
        key, value = ("seconds", seconds) if seconds is not None else ("until", until)
        if value is not None and not is_number(value):
            raise InputError(Fault(key, str(value), "is no time", repair="give it in s, as 0.001"))
        end = float(self.scene.time.end if value is None else value) + (self.time if seconds is not None else 0.0)
        if not np.isfinite(end):
            raise InputError(Fault(key, value, "is no time", "s"))
        if end < self.time - (0.0 if variable_step(self) else 0.5 * self.step_seconds) - SLACK * abs(self.time):
            problem, repair = f"is past: the simulation is at {self.time:.6g} s", "build another, or name a later time"
            raise InputError(Fault(key, end if value is None else value, problem, "s", repair=repair))
        return end, None if variable_step(self) else round(end / self.step_seconds)

    def _go_on(self, end: float | None, last: int | None, watch: Watch | None) -> None:
        """Blocks of steps to the end, with checks; between them the state is whole."""
        rate, samplers = 0.0, self.samplers
        schedules = [it.schedule for it in samplers]

        def ended() -> bool:
            """Whether the end is reached."""
            if last is not None:
                return self.step >= last
            return end is None or self.time >= end - SLACK * abs(end)

        def sample(*, scheduled: bool) -> None:
            """Call the hooks that are due, or all that were not called at the end."""
            for it in samplers:
                if it.schedule.due(self.step, self.time) if scheduled else it.last_step != self.step:
                    it.sample(scheduled=scheduled)

        with polite_stop() as stop, self._as_many_as_pay() as threads:
            if self.step == 0 and any(it.last_step < 0 for it in samplers):
                sample(scheduled=True)
            while not ended():
                before = self.step
                took = threads.advance(self, block(self, last, schedules, rate))
                rate = (self.step - before) / max(took, 1e-9)
                if watch is not None:
                    watch.update(self.step, self.time)
                if self.step % CHECK_EVERY == 0:
                    self.check()
                sample(scheduled=True)
                if stop and not ended():
                    self.check()
                    where = f"stopped at step {self.step} (t = {self.time:.6g} s)"
                    raise KeyboardInterrupt(f"{where}; the simulation can be gone on with")
        self.check()
        sample(scheduled=False)

    def _as_many_as_pay(self) -> Threads:
        """Threads of the kernels: what earlier pieces of the run have measured counts while as many are allowed."""
        if self._threads is None or self._threads.most != jit.threads():
            self._threads = Threads()
        return self._threads


def absent(what: str, lacks: str, repair: str = "") -> InputError:
    """The error of asking for ``what`` of a scene that ``lacks`` what it is of."""
    return InputError(Fault(what, None, f"this scene has no {lacks}", repair=repair))
