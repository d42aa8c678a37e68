"""Ensembles: repeats of one run that differ in a seed, and what their mean is worth.

A number of an ensemble has a mean, the standard deviation of a single run, the standard error of the mean, Student's
interval of the mean at 95 % and the bootstrap's beside it; with fewer than three values there is no interval.  A row of
expected.toml is judged by Student's interval [L, U] and the row's band, its value ± its tolerance:

pass          all of [L, U] lies in the band
fail          nothing of it does, or no run ever comes to what the row asks for
not resolved  anything else: an end of the band is within the interval, there is no interval, or a run has no number

So "pass" for a true mean outside the band, and "fail" for one within it, each come up in at most 2.5 % of ensembles of
normal numbers: either needs one end of the interval on the wrong side of the true mean.  These are the two one-sided
tests of Schuirmann 1987 (J. Pharmacokinet. Biopharm. 15, 657), each at half of what the interval leaves out.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from porescale.common.core.errors import Fault, InputError
from porescale.common.core.statistics import Sample, needed
from porescale.common.studies.parameter_table import Point, named, repeats, split
from porescale.common.studies.runner import FINISHED, Ended

if TYPE_CHECKING:
    from pathlib import Path

    from porescale.common.api.program import Program

PASS, FAIL, OPEN = "pass", "fail", "not resolved"
MOST = 10_000
"""Repeats of a point."""


@dataclass(frozen=True)
class Repeats:
    """How a run is repeated.

    count : how often, None: as ``over`` says;  over : key that repeats are numbered by, with ``=a,b,c`` its values;
    None: every seed of the scene;  words : what messages call the two, and a setting of a point.
    """

    count: int | None = None
    over: str | None = None
    words: tuple[str, str, str] = ("--repeat", "--over", "--vary")

    def __bool__(self) -> bool:
        """Whether anything is repeated."""
        return self.count is not None or self.over is not None

    def options(self) -> list[str]:
        """As they are written on a command line."""
        count = [] if self.count is None else [self.words[0], str(self.count)]
        return count + ([] if self.over is None else [self.words[1], self.over])

    def choices(self, program: Program, scene: Any) -> list[tuple[str, ...]]:
        """Settings of each repeat of ``scene``; InputError where nothing is there to repeat it by."""
        count, over = self.words[:2]
        if self.count is not None and not 1 <= self.count <= MOST:
            raise InputError(Fault(count, self.count, "is out of range", "", f"1 to {MOST}"))
        key, equals, values = (self.over or "").partition("=")
        if equals:
            return self._given(key.strip(), split(values))
        if self.count is None:
            repair = f"give {count} N with it, or values, {over} {key}=a,b,c"
            raise InputError(Fault(over, self.over, "does not say how often", repair=repair))
        if self.over is not None:
            first = {key: self._whole(scene, key)}
        else:
            first = dict(program.seeds(scene)) if program.seeds else {}
        if not first:
            problem = "repeats the same run: the scene draws nothing at random"
            repair = f"name a key that differs between repeats, {over} section.key=a,b,c"
            raise InputError(Fault(count, self.count, problem, repair=repair))
        step = max(first.values()) - min(first.values()) + 1  # several seeds: no repeat draws with another's
        return [tuple(f"{it}={number + k * step}" for it, number in first.items()) for k in range(self.count)]

    def _whole(self, scene: Any, key: str) -> int:
        """The whole number at ``key`` of a scene; InputError where there is something else."""
        from porescale.common.schema.scene_file import holds, parse_name
        from porescale.common.schema.sections import scene_as_dict

        at: Any = scene_as_dict(scene)
        parts = parse_name(key)
        for part in parts if holds(at, parts) else ():
            at = at[part]
        if not isinstance(at, int) or isinstance(at, bool):
            problem, repair = "is no whole number in the scene", f"give its values, {self.words[1]} {key}=a,b,c"
            raise InputError(Fault(self.words[1], key, problem, repair=repair))
        return at

    def _given(self, key: str, values: Sequence[str]) -> list[tuple[str, ...]]:
        """A repeat for each value."""
        over = self.words[1]
        if not key or not all(values):
            raise InputError(Fault(over, self.over, "is not section.key, or section.key=a,b,c"))
        if self.count not in (None, len(values)):
            problem = f"contradicts the {len(values)} values of {over}"
            raise InputError(Fault(self.words[0], self.count, problem, repair="leave it out"))
        return [(f"{key}={value}",) for value in values]


def repeated(
    program: Program, scene: Path, points: Sequence[Point], asked: Repeats, quality: str | None, settings: Sequence[str]
) -> list[Point]:
    """Every point as often as is asked, on the same seeds, counted from the scene's own; InputError where it cannot."""
    from porescale.common.schema.sections import load

    key, equals, _ = (asked.over or "").partition("=")
    if equals and any(text.partition("=")[0] == key.strip() for text in settings):
        problem = f"is set by every repeat, too, as {asked.words[1]} says"
        raise InputError(Fault(key.strip(), None, problem, repair="leave one out", file="--set"))
    made: list[Point] = []
    for point in points:
        over = (*settings, *point.settings)
        read = load(scene, program.scene(), quality=point.quality or quality, overrides=over)
        choices = asked.choices(program, read)
        keys = {text.partition("=")[0] for text in choices[0]}
        own = sorted(key for key in keys if point.value(key))
        if own:
            problem = f"is varied by the sweep and by {asked.words[0]}"
            repair = f"leave one of them out; {asked.words[1]} names another key"
            raise InputError(Fault(asked.words[2], own[0], problem, repair=repair))
        made += repeats(point, choices)
    if len(made) > MOST:
        raise InputError(Fault(asked.words[0], len(made), "are too many runs", "", f"<= {MOST}"))
    return named(made)


@dataclass(frozen=True, eq=False)
class Ensemble:
    """All repeats of a point.  of : the point;  over : keys in which they differ;  members : their names, in their
    order;  ends : of those that have ended."""

    of: Point
    over: tuple[str, ...]
    members: tuple[str, ...]
    ends: tuple[Ended, ...]

    @property
    def asked(self) -> int:
        """How many there are to be."""
        return len(self.members)

    @property
    def finished(self) -> list[Ended]:
        """Those that came to their end."""
        return [ended for ended in self.ends if ended.outcome == FINISHED]

    @property
    def complete(self) -> bool:
        """Whether all runs that were asked for came to their end."""
        return len(self.finished) == self.asked

    def said(self) -> str:
        """How many finished of how many, with what became of the others."""
        others = [ended.outcome for ended in self.ends if ended.outcome != FINISHED]
        counts = [f"{others.count(it)} {it}" for it in dict.fromkeys(others)]
        if left := self.asked - len(self.ends):
            counts.append(f"{left} not run yet")
        words = f"{len(self.finished)} of {self.asked} finished"
        return f"{words} ({', '.join(counts)})" if counts else words


def ensembles(points: Sequence[Point], ends: Sequence[Ended]) -> list[Ensemble]:
    """The ensembles among ``points``, in their order, with what has ended of them; [] where nothing is repeated."""
    ended = {it.point.name: it for it in ends}
    groups: dict[Point, list[Point]] = {}
    for point in points:
        if point.of is not None:
            groups.setdefault(point.of, []).append(point)
    return [
        Ensemble(
            of,
            tuple(text.partition("=")[0] for text in members[0].over),
            tuple(it.name for it in members),
            tuple(ended[it.name] for it in members if it.name in ended),
        )
        for of, members in groups.items()
    ]


@dataclass(frozen=True)
class Judged:
    """A number of an ensemble beside what is expected.

    sample : its finite values;  absent : finished runs without a number;  never : those that never come to what the row
    asks for (an infinite time);  verdict : "" where the row has no band, or PASS, FAIL, OPEN;  inside : runs within
    the band;  needed : repeats that would resolve the mean if it stays where it is, None where
    nothing tells, or where a run has no number: more runs do not bring it.
    """

    sample: Sample
    absent: int
    never: int
    verdict: str = ""
    inside: int = 0
    needed: float | None = None


def judged(values: Sequence[float], complete: bool, row: Mapping[str, Any]) -> Judged:
    """The numbers of the finished runs, nan where one has none, against the band of a row of expected.toml, if it has
    one.  complete : whether all runs that were asked for finished."""
    sample = Sample(tuple(float(it) for it in values if math.isfinite(it)))
    never = sum(math.isinf(it) for it in values)
    absent = len(values) - len(sample.values) - never
    if not {"value", "tolerance"} <= row.keys():
        return Judged(sample, absent, never)
    value, tolerance = float(row["value"]), float(row["tolerance"])
    inside = sum(abs(it - value) <= tolerance for it in sample.values)
    off, half = abs(sample.mean - value), sample.half
    if complete and 0 < never == len(values):
        return Judged(sample, absent, never, FAIL)
    if complete and len(sample.values) == len(values) and math.isfinite(half):
        if off + half <= tolerance:
            return Judged(sample, absent, never, PASS, inside)
        if off - half > tolerance:
            return Judged(sample, absent, never, FAIL, inside)
    some = len(sample.values) > 1 and len(sample.values) == len(values)  # no repeat brings a missing number
    return Judged(sample, absent, never, OPEN, inside, needed(sample.values, abs(off - tolerance)) if some else None)


def judge(ensemble: Ensemble, row: Mapping[str, Any], number: Callable[[Ended, Mapping[str, Any]], float]) -> Judged:
    """A row of an ensemble.  number : gives that of a finished run, nan where it has none."""
    return judged([number(ended, row) for ended in ensemble.finished], ensemble.complete, row)
