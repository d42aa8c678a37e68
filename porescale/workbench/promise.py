"""What `run --error` promises, held against a new run: a benchmark of each package that has a front beside a case.

The cheapest point of the front is asked for by its error and run anew as a process of its own.  Kept is a promise
whose run takes within 30 % of the time said, and is off by no more than said and scattered, from the answers of the
reference that the front keeps.  Core-seconds stand beside: on a machine that others use, too, seconds promise little.
"""

from __future__ import annotations

import json
import tempfile
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from porescale.ground.check import Fault, InputError
from porescale.workbench.benchmarks import Benchmarks, Dtype, Work
from porescale.workbench.campaign import FINISHED, Campaign
from porescale.workbench.commands.sweep import module_of
from porescale.workbench.front import Choice, Front, FrontPoint, choose, pace_of, percent, read_front
from porescale.workbench.package import Package
from porescale.workbench.points import Point
from porescale.workbench.quantities import measured
from porescale.workbench.scene_file import find
from porescale.workbench.sections import open_scene, validate
from porescale.workbench.trade import rms
from porescale.workbench.trade_plan import Quantity

WITHIN = 0.3
"""Share of the time said by which a run may be off."""
SCATTERS = 3.0
"""Standard deviations: one run in 370 lies beyond."""


@dataclass(frozen=True)
class Promise:
    """expected, took : s;  core_expected, core_took : core-seconds, of the front and of the run;  said, scatter,
    found : errors, shares; found is None where the front keeps no answers of the reference."""

    label: str
    expected: float
    took: float
    core_expected: float
    core_took: float
    said: float
    scatter: float
    found: float | None

    @property
    def on_time(self) -> bool:
        """Whether the run took within 30 % of what was said."""
        return abs(self.took / self.expected - 1.0) <= WITHIN

    @property
    def as_good(self) -> bool:
        """Whether its error is not beyond the scatter."""
        return self.found is None or self.found <= self.said + SCATTERS * self.scatter

    def line(self) -> str:
        """What was said and what came of it."""
        time = "kept" if self.on_time else "not kept"
        good = "not known" if self.found is None else f"{percent(self.found)}, {'kept' if self.as_good else 'not kept'}"
        return (
            f"{self.label} promised {self.expected:.3g} s, took {self.took:.3g} s ({time}; {self.core_took:.3g} "
            f"core-seconds, {self.core_expected:.3g} when it was measured); error {percent(self.said)} ± "
            f"{percent(self.scatter)}, found {good}"
        )


def asked_again(package: Package, scene: Path) -> Promise:
    """The promise of the cheapest point of the front beside ``scene``, and a new run of it."""
    front = read_front(scene)
    choice = choose(front, front.points[0].error, None, lambda point: (pace_of(_model(package, scene, point)), None))
    with tempfile.TemporaryDirectory() as folder:
        point = Point("again", settings(choice.point), choice.point.quality)
        ended = Campaign(module_of(package), scene, Path(folder)).one(point)
        if ended.outcome != FINISHED:
            raise InputError(Fault(str(scene), choice.point.label, f"{ended.outcome}: {ended.problem}"))
        return judged(front, choice, ended.card, error_of(package, front, ended.folder))


def judged(front: Front, choice: Choice, card: dict[str, float], found: float | None) -> Promise:
    """A choice of a front beside the card of its run."""
    point = choice.point
    return Promise(
        point.label, choice.seconds, float(card["seconds"]), point.core_seconds, float(card["core_seconds"]),
        point.error, point.scatter, found,
    )  # fmt: skip


def settings(point: FrontPoint) -> tuple[str, ...]:
    """What makes the point of a scene, for as long as it was measured."""
    return (f"time.end={point.time!r}", *point.settings)


def error_of(package: Package, front: Front, folder: Path) -> float | None:
    """Rms distance of a run from the answers of the first reference that the front keeps, over quantities."""
    table = json.loads(front.file.read_text(encoding="utf-8"))
    told = table.get("references") or [{}]
    asked = [validate(Quantity, row) for row in table["quantities"] if row["name"] in told[0]]
    if not asked or len(asked) < len(table["quantities"]):
        return None
    distances = [
        (measured(package.table(folder, it.file), it.row()) - told[0][it.name][0]) / it.scale for it in asked
    ]  # fmt: skip
    return rms(distances)


def _model(package: Package, scene: Path, point: FrontPoint) -> Any:
    opened = open_scene(scene, package.scene(), quality=point.quality, overrides=settings(point))
    return package.build(opened.scene)


def benchmark(package: Package, case: Path) -> Benchmarks:
    """The row "promise" of a package, empty where the case has no front."""
    rows = Benchmarks()
    if not (case / "front.json").is_file():
        return rows

    @rows.row("promise")
    def promise(size: int | None, threads: int, dtype: Dtype) -> Work:
        """Steps of the cheapest point of the front beside a case, and what its promise is worth."""
        scene = find(case)
        model = _model(package, scene, read_front(scene).points[0])
        steps = 50
        model.advance(steps)
        return Work(
            lambda: model.advance(steps), float(steps), "steps/s", steps,
            remark=lambda: asked_again(package, scene).line(),
        )  # fmt: skip

    return rows
