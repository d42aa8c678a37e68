"""A front that was measured, and the point of it that fits what is asked: an error, a time, or both.

front.json lies beside the scene it was measured for (`study trade` makes it).  Its times are of another machine: every
point of the front keeps its pace there, seconds of a step of a run that has just begun, and the same is timed here
before anything is promised.
"""

from __future__ import annotations

import json
import math
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from porescale.ground.check import Fault, InputError
from porescale.workbench.trade_files import FORMAT, FRONT

WARM_UP = 3
"""Steps before a pace is taken: kernels compile, steps in place have two kinds."""
SECONDS, LEAST = 1.0, 5
"""A pace is the median of blocks over this long, at least so many."""
GENTLE = 0.95
"""Share of a budget that is planned with."""


@dataclass(frozen=True)
class FrontPoint:
    """A point of the front.

    error, scatter : shares;  seconds : of the run where it was measured;  time : that it simulated, s;  pace : of a
    step, s.
    """

    label: str
    quality: str | None
    settings: tuple[str, ...]
    error: float
    scatter: float
    core_seconds: float
    seconds: float
    time: float
    pace: float


@dataclass(frozen=True)
class Front:
    """Points from cheap to dear, and where and when they were measured."""

    file: Path
    machine: str
    date: str
    points: tuple[FrontPoint, ...]


@dataclass(frozen=True)
class Choice:
    """A point, the seconds that it should take on this machine, and how much slower this machine is."""

    point: FrontPoint
    seconds: float
    slowness: float

    def as_dict(self) -> dict[str, Any]:
        """What a run card keeps of it."""
        point = self.point
        return {"label": point.label, "error": point.error, "scatter": point.scatter, "expected_seconds": self.seconds,
                "slowness": self.slowness}  # fmt: skip

    def line(self, front: Front) -> str:
        """What was picked and what to expect."""
        point = self.point
        return (
            f"picked {point.label}: error {percent(point.error)} ± {percent(point.scatter)}, about {self.seconds:.3g} s"
            f" here ({self.slowness:.2g} times the {point.seconds:.3g} s of {front.machine}, {front.date})"
        )


def percent(share: float) -> str:
    """A share in per cent, two digits."""
    return f"{100 * share:.2g} %"


def read_front(scene: Path) -> Front:
    """The front beside the scene file; InputError where there is none, or one that is damaged."""
    file = scene.parent / FRONT
    repair = f"measure one: study trade {scene.parent}, and put its {FRONT} beside the scene; or name a --quality"
    if not file.is_file():
        raise InputError(Fault(str(file), None, "no front was measured for this scene", repair=repair))
    try:
        table = json.loads(file.read_text(encoding="utf-8"))
        if table["format"] != FORMAT:
            raise InputError(Fault(str(file), table["format"], "is of another format", "", str(FORMAT), repair))
        points = [_point(row) for row in table["points"] if row["on_front"] and row["error"] is not None]
        machine = str(table["machine"]["processor"])
        found = Front(file, machine, str(table["date"]), tuple(sorted(points, key=lambda one: one.core_seconds)))
    except (ValueError, KeyError, TypeError, AttributeError, OverflowError, RecursionError) as error:
        said = " ".join(f"{type(error).__name__}: {error}".split())[:80]
        raise InputError(Fault(str(file), None, f"is damaged ({said})", repair=repair)) from None
    if not found.points:
        raise InputError(Fault(str(file), None, "holds no point of a front", repair=repair))
    return found


def _point(row: dict[str, Any]) -> FrontPoint:
    numbers = [float(row[key]) for key in ("error", "scatter", "core_seconds", "seconds", "time", "pace")]
    if not all(math.isfinite(value) and value >= 0 for value in numbers) or not all(numbers[3:]):
        raise ValueError(f"numbers of {row['label']}")
    quality = None if row["quality"] is None else str(row["quality"])
    return FrontPoint(str(row["label"]), quality, tuple(map(str, row["settings"])), *numbers)


Try = Callable[[FrontPoint], tuple[float, float | None]]
"""Times a step of a point here, s, and says which time (s) is to be simulated, None for that of the front."""


def choose(front: Front, error: float | None, budget: float | None, try_here: Try) -> Choice:
    """The cheapest point whose error is at most ``error``; without one the best that ``budget`` (s) allows.

    InputError where no point is good enough, or none is cheap enough.
    """
    if error is not None:
        good = [point for point in front.points if point.error <= error]
        if not good:
            best = min(point.error for point in front.points)
            raise InputError(Fault("--error", percent(error), "is below the best point measured", "", percent(best)))
        found = _here(good[0], try_here)
        if budget is not None and found.seconds > budget:
            problem = f"is not enough for an error of {percent(error)}: {found.point.label} takes {found.seconds:.3g} s"
            raise InputError(Fault("--budget", f"{budget:.3g}", problem, "s", repair="allow more of one of them"))
        return found
    assert budget is not None
    cheapest = _here(front.points[0], try_here)
    if cheapest.seconds > budget:
        problem = f"is not enough: {cheapest.point.label}, the cheapest point, takes {cheapest.seconds:.3g} s"
        raise InputError(Fault("--budget", f"{budget:.3g}", problem, "s", repair="allow more"))
    likely = cheapest.seconds / front.points[0].seconds
    for point in sorted(front.points, key=lambda one: one.error):
        if point.seconds * likely > 2.0 * budget:  # far out of reach: not worth building
            continue
        found = cheapest if point is front.points[0] else _here(point, try_here)
        if found.seconds <= GENTLE * budget or point is front.points[0]:
            return found
    return cheapest


def _here(point: FrontPoint, try_here: Try) -> Choice:
    pace, end = try_here(point)
    slowness = pace / point.pace
    return Choice(point, point.seconds * slowness * (1.0 if end is None else end / point.time), slowness)


def pace_of(model: Any) -> float:
    """Wall-clock seconds of a step of a model that has just been built, kernels compiled: the median of blocks."""
    for _ in range(WARM_UP):
        model.advance(1)
    blocks: list[float] = []
    count, begun = 1, time.perf_counter()
    while len(blocks) < LEAST or time.perf_counter() - begun < SECONDS:
        before, step = time.perf_counter(), model.step
        model.advance(count)
        spent = time.perf_counter() - before
        blocks.append(spent / (model.step - step))
        count = max(1, int(0.05 * SECONDS / max(blocks[-1], 1e-9)))
    return _median(blocks)


def _median(values: Sequence[float]) -> float:
    ordered = sorted(values)
    return ordered[len(ordered) // 2]
