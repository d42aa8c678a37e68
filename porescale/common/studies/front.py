"""A front that was measured, and the point of it that fits the request: an error, a time, or both.

front.json lies beside the scene it was measured for (`study trade` makes it).  What it keeps are core-seconds, of steps
and besides, of another machine, which hardly depend on the load of that machine; and every point's pace, core-seconds
of a step of a run that had just begun.  The same beginning is timed here before a prediction is given: its wall-clock
pace over that of the front rescales the steps; start-up is timed, and rows, snapshots and pictures are what they are
expected to take here (duration/expected.py).  Expected seconds are those of the whole command, from the start of its
process.

A point of which trade.toml says a ``but`` is none of the front for runs to which that applies.
"""

import json
import math
import shlex
import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

from porescale.common.core.errors import Fault, InputError
from porescale.common.duration.quiet import moment, share
from porescale.common.duration.threads import Threads
from porescale.common.schema.scene_file import SCENE_FILE
from porescale.common.studies.trade_files import FORMAT, FRONT, percent

WARM_UP = 3
"""Steps before a pace is taken: kernels compile, steps in place have two kinds."""
SECONDS, LEAST = 2.0, 5
"""A pace is the mean of blocks over this long, at least so many."""
TRIALS = 8
"""Of numbers of threads at most, before a pace is taken: each is a second, and loads that come and go never settle."""
GENTLE = 0.95
"""Share of a budget that is planned with."""


@dataclass(frozen=True)
class FrontPoint:
    """A point of the front.

    error, scatter : shares, errors : of each quantity;  core_seconds : of all steps, besides : of what else a run
    does, pace : of a step as it began;  time : simulated, s;  but : what the errors do not show of runs beyond
    but_after, s.
    """

    label: str
    quality: str | None
    settings: tuple[str, ...]
    error: float
    scatter: float
    core_seconds: float
    time: float
    pace: float
    besides: float = 0.0
    errors: Mapping[str, float] = field(default_factory=dict)
    but: str = ""
    but_after: float = 0.0

    @property
    def whole(self) -> float:
        """Core-seconds of steps and what else a run does."""
        return self.core_seconds + self.besides


@dataclass(frozen=True)
class Front:
    """Points from cheap to dear, where, when and with what settings and scene (None: not kept) they were measured.

    over : key that repeats differ in;  every : all points that have an error;  reference : what they were held against.
    """

    file: Path
    machine: str
    date: str
    points: tuple[FrontPoint, ...]
    settings: tuple[str, ...] = ()
    scene: Mapping[str, Any] | None = None
    over: str | None = None
    every: tuple[FrontPoint, ...] = ()
    reference: FrontPoint | None = None


@dataclass(frozen=True)
class Here:
    """A point as it begins on this machine.  wall, core : seconds and core-seconds of a step;  start : seconds until
    the first;  end : time that is to be simulated, s, None for that of the front;  besides : seconds of all that is
    no step, None where that of the front is scaled."""

    wall: float
    core: float
    start: float = 0.0
    end: float | None = None
    besides: float | None = None


@dataclass(frozen=True)
class Choice:
    """A point, the seconds of the whole command and core-seconds (of steps) that it should take on this machine, how
    much slower this machine is, and how many times as long as in the front is simulated."""

    point: FrontPoint
    seconds: float
    slowness: float
    core_seconds: float = 0.0
    longer: float = 1.0

    def as_dict(self) -> dict[str, Any]:
        """The fields that a run card keeps."""
        point = self.point
        return {"label": point.label, "error": point.error, "scatter": point.scatter, "expected_seconds": self.seconds,
                "slowness": self.slowness}  # fmt: skip

    def line(self, front: Front) -> str:
        """Text with the chosen point and its expected cost and error."""
        point, there = self.point, self.longer * self.point.whole
        return (
            f"picked {point.label}: error {percent(point.error)} ± {percent(point.scatter)}, about {self.seconds:.3g} s"
            f" in all here ({self.seconds / there:.2g} times the {there:.3g} core-seconds of {front.machine}, "
            f"{front.date})" + (f"; but {point.but}" if point.but else "")
        )


def read_front(scene: Path, end: float | None = None) -> Front:
    """The front beside the scene file for runs until ``end`` (s; None: all remarks apply); InputError where there is
    none, or one that is damaged."""
    file = scene.parent / FRONT
    named = shlex.quote(str(scene.parent if scene.name == SCENE_FILE else scene))
    repair = f"measure one: study trade {named}, and put its {FRONT} beside the scene; or name a --quality"
    if not file.is_file():
        raise InputError(Fault(str(file), None, "no front was measured for this scene", repair=repair))
    try:
        table = json.loads(file.read_text(encoding="utf-8"))
        if table["format"] != FORMAT:
            raise InputError(Fault(str(file), table["format"], "is of another format", "", str(FORMAT), repair))
        every = tuple(point_of(row) for row in table["points"] if row["error"] is not None)
        reference = point_of(table["reference"]) if table.get("reference") else None
        settings = table.get("settings", _settings_in(str(table.get("command", ""))))
        found = Front(
            file, str(table["machine"]["processor"]), str(table["date"]), _unbeaten(every, end), tuple(settings),
            table.get("scene"), table.get("over"), every, reference,
        )  # fmt: skip
    except (ValueError, KeyError, TypeError, AttributeError, OverflowError, RecursionError) as error:
        said = " ".join(f"{type(error).__name__}: {error}".split())[:80]
        raise InputError(Fault(str(file), None, f"is damaged ({said})", repair=repair)) from None
    if not found.points:
        raise InputError(Fault(str(file), None, "holds no point of a front", repair=repair))
    return found


def _unbeaten(every: tuple[FrontPoint, ...], end: float | None) -> tuple[FrontPoint, ...]:
    """The points whose remark does not apply, that no cheaper one is as good as, from cheap to dear."""
    made: list[FrontPoint] = []
    for point in sorted(every, key=lambda one: (one.core_seconds, one.error)):
        applies = point.but and not (end is not None and end <= point.but_after)
        if not applies and (not made or point.error < made[-1].error):
            made.append(point)
    return tuple(made)


def _settings_in(command: str) -> list[str]:
    """What the ``--set`` of a command line give."""
    words = shlex.split(command)
    return [words[k + 1] for k, word in enumerate(words[:-1]) if word == "--set"]


def point_of(row: Mapping[str, Any]) -> FrontPoint:
    """A point as front.json keeps it; ValueError, KeyError or TypeError where a number is none."""
    keys = "error", "scatter", "core_seconds", "time", "pace", "besides"
    numbers = {key: float(row[key]) for key in keys}
    if not all(math.isfinite(value) and value >= 0 for value in numbers.values()):
        raise ValueError(f"numbers of {row['label']}")
    if not all(numbers[key] for key in ("core_seconds", "time", "pace")):
        raise ValueError(f"nothing taken by {row['label']}")
    quality = None if row["quality"] is None else str(row["quality"])
    errors = {str(name): float(error) for name, error in row["errors"].items() if error is not None}
    return FrontPoint(
        str(row["label"]), quality, tuple(map(str, row["settings"])), errors=errors, but=str(row["but"]),
        but_after=float(row.get("but_after", 0.0)), **numbers,
    )  # fmt: skip


Try = Callable[[FrontPoint], Here]
"""Begins a point on this machine."""


def choose(
    front: Front, error: float | None, budget: float | None, try_here: Try, age: Callable[[], float] = lambda: 0.0
) -> Choice:
    """The cheapest point whose error is at most ``error``; without one the best that ``budget`` (s) allows.

    age : gives the seconds that the command has taken so far.  InputError where no point is good enough, or none is
    cheap enough.
    """

    def here(point: FrontPoint) -> Choice:
        """The point with what the command takes from here on."""
        found = _here(point, try_here)
        return replace(found, seconds=age() + found.seconds)

    if error is not None:
        good = [point for point in front.points if point.error <= error]
        if not good:
            best = min(front.points, key=lambda point: point.error)
            least = f"{math.ceil(1000 * best.error) / 10:g}%"  # rounded up: what is named here is accepted
            problem, repair = "is below the best point measured", f"--error {least} takes {best.label}"
            raise InputError(Fault("--error", percent(error), problem, "", f">= {least}", repair))
        found = here(good[0])
        if budget is not None and found.seconds > budget:
            problem = f"is not enough for an error of {percent(error)}: {found.point.label} takes {found.seconds:.3g} s"
            raise InputError(Fault("--budget", f"{budget:.3g}", problem, "s", repair="allow more of one of them"))
        return found
    assert budget is not None
    before = age()
    cheapest = here(front.points[0])
    if cheapest.seconds > budget:
        problem = f"is not enough: {cheapest.point.label}, the cheapest point, takes {cheapest.seconds:.3g} s"
        raise InputError(Fault("--budget", f"{budget:.3g}", problem, "s", repair="allow more"))
    tried = age()  # what a try takes is of the budget, too
    likely = (cheapest.seconds - before) / (cheapest.longer * front.points[0].whole)
    for point in sorted(front.points[1:], key=lambda one: one.error):
        left = budget - age() - (tried - before)
        if cheapest.longer * point.whole * likely > 2.0 * left:  # far out of reach: not worth building
            continue
        found = here(point)
        if found.seconds <= GENTLE * budget:
            return found
    return replace(cheapest, seconds=cheapest.seconds + age() - tried)


def _here(point: FrontPoint, try_here: Try) -> Choice:
    here = try_here(point)
    longer = 1.0 if here.end is None else here.end / point.time
    slowness, alone = here.wall / point.pace, max(here.wall, here.core) / point.pace  # what is besides has one thread
    besides = longer * point.besides * alone if here.besides is None else here.besides
    seconds = here.start + longer * point.core_seconds * slowness + besides
    return Choice(point, seconds, slowness, longer * point.core_seconds * here.core / point.pace, longer)


def begun(build: Callable[[], Any], end: float | None = None, besides: float | None = None) -> Here:
    """What a model takes to be built and to begin: built twice, since the first time its kernels compile.

    besides : seconds of all that is no step, on a quiet machine; here they take as much longer as the steps.
    """
    build()
    before = time.perf_counter()
    model = build()
    start = time.perf_counter() - before
    began = moment()
    wall, core = pace_of(model)
    return Here(wall, core, start, end, None if besides is None else besides / share(began, moment()))


def pace_of(model: Any) -> tuple[float, float]:
    """Seconds and core-seconds of a step of a model that has just been built, means over blocks, compiling left out; on
    as many threads as are fastest, which are found first."""
    for _ in range(WARM_UP):
        model.advance(1)
    with Threads() as threads:
        count = 1
        while not threads.settled and threads.trials < TRIALS:
            count = _block(threads.advance(model, count) / count)
        first, before, busy = model.step, time.perf_counter(), time.process_time()
        blocks, spent = 0, 0.0
        while blocks < LEAST or spent < SECONDS:
            model.advance(count)
            blocks, spent = blocks + 1, time.perf_counter() - before
            count = _block(spent / (model.step - first))
    steps = model.step - first
    return spent / steps, (time.process_time() - busy) / steps


def _block(step: float) -> int:
    """Steps of so many seconds each that are advanced at once."""
    return max(1, int(0.05 * SECONDS / max(step, 1e-9)))
