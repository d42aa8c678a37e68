"""Speed against accuracy: how far the runs of a plan are off, what they cost, and which of them are Pareto-optimal.

The error of a run in one quantity is its distance from the exact value or from the reference run of the same repeat,
over the quantity's scale; of a curve or field, the rms distance over its places.  That of a run is the rms over
quantities; that of a point the rms over repeats, with their standard deviation beside it, and the mean of
their errors as a sample, with what that is worth.  Grains are chaotic, so that
an error never falls below what a last digit changes: beside all errors stands ``packings``, how far the reference runs
of different repeats are off their mean, measured in the same way.
"""

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from porescale.common.core.errors import Fault, InputError
from porescale.common.core.statistics import Sample
from porescale.common.studies.parameter_table import Point
from porescale.common.studies.quantities import Columns, curve, measured
from porescale.common.studies.runner import FINISHED, Ended
from porescale.common.studies.trade_plan import Plan, Quantity

Tables = Callable[[Path, str], Columns]
Features = Mapping[str, Callable[[Path, float | None], NDArray[Any]]]
"""What a package makes of a run folder at a time (None: the last snapshot), by name."""
Answer = tuple[NDArray[Any] | None, NDArray[Any]]
"""Places, where there are any, and values."""
Costs = tuple[float, float, float, int, float, float, float]
"""Core-seconds, seconds, peak bytes, steps, simulated time, core-seconds besides, pace of a point: means of repeats."""


@dataclass(frozen=True)
class Traded:
    """A point of the trade.

    errors : of each quantity;  error, scatter : of all together, over repeats;  core_seconds (of steps), seconds,
    peak_bytes, steps, time (s, simulated), besides (core-seconds of other things: snapshots, pictures, film), pace
    (core-seconds of a step as runs began) : means over repeats;  outcome : "finished", or the first other one, and
    errors are infinite;  each : error of each repeat.
    """

    knob: str
    label: str
    point: Point
    outcome: str
    errors: dict[str, float]
    error: float
    scatter: float
    core_seconds: float
    seconds: float
    peak_bytes: float
    steps: int
    time: float
    besides: float = 0.0
    pace: float = 0.0
    on_front: bool = False
    problem: str = ""
    each: tuple[float, ...] = ()

    @property
    def sample(self) -> Sample:
        """Errors of the repeats; none where one did not finish, or has no error."""
        return Sample(self.each if all(map(math.isfinite, self.each)) else ())


@dataclass
class Errors:
    """Answers of runs and their errors.  tables, features : of the package;  references : runs, one for each repeat."""

    plan: Plan
    tables: Tables
    features: Features
    references: Sequence[Ended] = ()
    _kept: dict[tuple[Path, str], Answer] = field(default_factory=dict)

    def answer(self, ended: Ended, quantity: Quantity) -> Answer:
        """The value of a quantity in a run; InputError where it has no such column."""
        key = (ended.folder, quantity.name)
        if key not in self._kept:
            self._kept[key] = self._answer(ended, quantity)
        return self._kept[key]

    def _answer(self, ended: Ended, quantity: Quantity) -> Answer:
        if quantity.feature:
            at = None if quantity.at == "end" else float(str(quantity.at))
            return None, np.asarray(self.features[quantity.feature](ended.folder, at), float).ravel()
        columns = self.tables(ended.folder, quantity.file)
        try:
            if quantity.is_curve:
                return curve(columns, quantity.row())
            return None, np.array([measured(columns, quantity.row())])
        except KeyError as error:
            missing, problem = error.args[0] if columns else quantity.column, f"is not in {quantity.file}.csv"
            allowed, where = ", ".join(columns), f"quantity {quantity.name!r}"
            raise InputError(Fault("column", missing, problem, allowed=allowed, file=where)) from None

    def error(self, ended: Ended, repeat: int, quantity: Quantity) -> float:
        """How far a run is off in one quantity; infinite where it has no answer."""
        places, values = self.answer(ended, quantity)
        if quantity.exact is not None:
            return distance(values, np.array([quantity.exact]), quantity.scale)
        at, truth = self.answer(self.references[repeat], quantity)
        if places is not None and at is not None:
            values = np.interp(at, places, values)
        return distance(values, truth, quantity.scale)

    def answers(self) -> list[dict[str, list[float]]]:
        """Values in the references of each quantity that is a number, so that a run can be held against them later.

        InputError where a reference has none of any quantity: all errors would be infinite.
        """
        for quantity in self.plan.quantity:
            every = [self.answer(it, quantity)[1] for it in self.references]
            if not all(values.size and np.isfinite(values).all() for values in every):
                at = None if quantity.feature else str(quantity.at)
                repair, where = "name a time within its run, at which it has one", f"quantity {quantity.name!r}"
                raise InputError(Fault("at", at, "the reference has no number there", repair=repair, file=where))
        numbers = [quantity for quantity in self.plan.quantity if not (quantity.is_curve or quantity.feature)]
        return [
            {quantity.name: self.answer(ended, quantity)[1].tolist() for quantity in numbers if quantity.exact is None}
            for ended in self.references
        ]

    def packings(self) -> dict[str, float]:
        """How far the references are off their mean, for each quantity that is not exact; {} for a single one."""
        if len(self.references) < 2:
            return {}
        made = {}
        for quantity in self.plan.quantity:
            answers = [self.answer(ended, quantity)[1] for ended in self.references]
            if quantity.exact is None and len({len(values) for values in answers}) == 1:
                mean = np.mean(answers, axis=0)
                share = len(answers) / (len(answers) - 1)  # the mean is the sample's own
                made[quantity.name] = math.sqrt(share) * rms([distance(v, mean, quantity.scale) for v in answers])
        return made

    def trade(self, knob: str, label: str, point: Point, ends: Sequence[Ended]) -> Traded:
        """What a point came to over its repeats."""
        bad = next((ended for ended in ends if ended.outcome != FINISHED), None)
        if bad is not None:
            nothing = dict.fromkeys((quantity.name for quantity in self.plan.quantity), math.inf)
            done = sum(ended.outcome == FINISHED for ended in ends)
            said = f"{done} of {len(ends)} repeats finished; {bad.point.name}: {bad.problem}"
            problem = said if len(ends) > 1 else bad.problem
            return Traded(knob, label, point, bad.outcome, nothing, math.inf, 0.0, *costs(ends), problem=problem)
        names = [quantity.name for quantity in self.plan.quantity]
        table = np.array([[self.error(ended, k, it) for it in self.plan.quantity] for k, ended in enumerate(ends)])
        return of_errors((knob, label, point), names, table, costs(ends))


def of_errors(named: tuple[str, str, Point], names: Sequence[str], table: NDArray[Any], spent: Costs) -> Traded:
    """A point of which every repeat finished.

    named : knob, label and point;  names : of the quantities;  table (repeats, quantities) : errors, shares;
    spent : as `costs` has it.
    """
    errors = {name: rms(table[:, k]) for k, name in enumerate(names)}
    each = tuple(rms(row) for row in table)
    knob, label, point = named
    made = Traded(knob, label, point, FINISHED, errors, rms(each), 0.0, *spent, each=each)
    return replace(made, scatter=made.sample.deviation) if len(made.sample.values) > 1 else made


def distance(values: NDArray[Any], truth: NDArray[Any], scale: float) -> float:
    """Rms distance over ``scale``; infinite where one of them is no number or they do not match."""
    if values.shape != truth.shape or not len(values):
        return math.inf
    found = rms((values - truth) / scale)
    return found if math.isfinite(found) else math.inf


def rms(values: Any) -> float:
    """Root mean square of ``values``."""
    return float(np.sqrt(np.mean(np.square(np.asarray(values, float)))))


def costs(ends: Sequence[Ended]) -> Costs:
    """Core-seconds, seconds, bytes, steps, simulated time, core-seconds besides, pace: means over runs that have them;
    seconds stand in for core-seconds, all steps for the first ones.  Where some have their pace, costs are those of
    these runs: a pace goes with the core-seconds of its own run, since machines have better and worse hours.
    """
    ends = [ended for ended in ends if ended.card.get("core_pace")] or ends

    def mean(key: str) -> float:
        """Mean over the runs that have it, 0 where none has."""
        known = [float(ended.card[key]) for ended in ends if ended.card.get(key)]
        return sum(known) / len(known) if known else 0.0

    core_seconds, steps = mean("core_seconds") or mean("seconds"), round(mean("step"))
    pace = mean("core_pace") or core_seconds / max(steps, 1)
    return (
        core_seconds, mean("seconds"), mean("peak_bytes"), steps, mean("time"), mean("core_seconds_besides"), pace,
    )  # fmt: skip


def front(points: Sequence[Traded]) -> list[Traded]:
    """The same points, each saying whether no other is both no dearer and no worse, and one of the two better."""

    def beaten(one: Traded) -> bool:
        """Whether another point is as good in both and better in one, or there is no error."""
        return not math.isfinite(one.error) or any(
            other.core_seconds <= one.core_seconds and other.error <= one.error
            and (other.core_seconds < one.core_seconds or other.error < one.error)
            for other in points
        )  # fmt: skip

    return [replace(one, on_front=not beaten(one)) for one in points]
