"""Predicted error and time of `run --error`, compared with a new run: a benchmark of each package that has a front
beside a case.

A point of the front, the cheapest if not said which, is begun to rescale its time, and run anew.  A prediction is
kept if the run takes within 30 % of the predicted time, from building the model to the last picture, and its error is
at most the predicted one plus scatter, in the quantities whose reference values the front keeps.  Core-seconds of the
steps stand beside, also rescaled: on a shared machine seconds predict little.
"""

import json
import tempfile
import time
from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from porescale.common.api.run_scene import card_of
from porescale.common.cli.package import Package
from porescale.common.core.errors import Fault, InputError
from porescale.common.duration.expected import besides
from porescale.common.evidence.benchmarks import Benchmarks, Dtype, Work
from porescale.common.record.read_card import read_card
from porescale.common.record.series import run_table
from porescale.common.schema.scene_file import find
from porescale.common.schema.sections import load, validate
from porescale.common.studies.front import Choice, Front, FrontPoint, begun, choose, read_front
from porescale.common.studies.quantities import measured
from porescale.common.studies.trade import rms
from porescale.common.studies.trade_files import percent
from porescale.common.studies.trade_plan import Quantity

WITHIN = 0.3
"""Share of the expected time by which a run may be off."""
SCATTERS = 3.0
"""Standard deviations: one run in 370 lies beyond."""
ALIKE = 0.01
"""Share of its error that stands in for the scatter of a point that was run once: last digits of another machine."""


@dataclass(frozen=True)
class Promise:
    """expected, took : s;  core_expected, core_took : core-seconds of the steps;  said, scatter, found : errors,
    shares; found is None where the front keeps no answers of the reference."""

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
        """Whether the run took within 30 % of the expected time."""
        return abs(self.took / self.expected - 1.0) <= WITHIN

    @property
    def as_good(self) -> bool:
        """Whether its error is not beyond the scatter."""
        return self.found is None or self.found <= self.said + max(SCATTERS * self.scatter, ALIKE * self.said)

    def line(self) -> str:
        """Expected and measured time and error."""
        time = "kept" if self.on_time else "not kept"
        good = "not known" if self.found is None else f"{percent(self.found)}, {'kept' if self.as_good else 'not kept'}"
        return (
            f"{self.label} promised {self.expected:.3g} s, took {self.took:.3g} s ({time}; {self.core_took:.3g} "
            f"core-seconds in steps, {self.core_expected:.3g} promised); error {percent(self.said)} ± "
            f"{percent(self.scatter)}, found {good}"
        )


def repeat(package: Package, scene: Path, which: int = 1) -> Promise:
    """Predicted error and time of a point of the front beside ``scene``, 1 the cheapest, and a new run of it."""
    front = read_front(scene)
    chosen = replace(front, points=front.points[which - 1 :][:1])
    if not chosen.points:
        raise InputError(Fault("--size", which, "is not a point of the front", "", f"1 to {len(front.points)}"))
    point = chosen.points[0]
    made = load(scene, package.scene(), quality=point.quality, overrides=settings(point))
    more = besides(package.report(made).work)
    choice = choose(chosen, point.error, None, lambda _: begun(lambda: package.build(made), None, more))
    with tempfile.TemporaryDirectory() as place:
        folder, before = Path(place) / "run", time.perf_counter()
        model = package.build(made)
        package.drive(model, folder, made, card=card_of(package, made), resume=False, quiet=True)
        took = time.perf_counter() - before
        return compare(choice, took, read_card(folder), *error_of(front, point, folder))


def compare(choice: Choice, took: float, card: Mapping[str, Any], said: float, found: float | None) -> Promise:
    """A choice of a front beside its run: seconds, card, and the error expected and found in what can be compared."""
    point, core_took = choice.point, float(card["core_seconds"])
    return Promise(point.label, choice.seconds, took, choice.core_seconds, core_took, said, point.scatter, found)


def settings(point: FrontPoint) -> tuple[str, ...]:
    """What makes the point of a scene, for as long as it was measured."""
    return (f"time.end={point.time!r}", *point.settings)


def error_of(front: Front, point: FrontPoint, folder: Path) -> tuple[float, float | None]:
    """Error of the front and rms distance of a run from the answers of its first reference, over the quantities
    whose answers it keeps: numbers, not curves and fields.  The error in all quantities and None where there are none.
    """
    table = json.loads(front.file.read_text(encoding="utf-8"))
    answers = (table.get("references") or [{}])[0]
    known = [validate(Quantity, row) for row in table["quantities"] if row["name"] in answers]
    if not known:
        return point.error, None
    distances = [(measured(run_table(folder, it.file), it.row()) - answers[it.name][0]) / it.scale for it in known]
    return rms([point.errors[it.name] for it in known]), rms(distances)


def benchmark(package: Package, case: Path) -> Benchmarks:
    """The benchmark row "promise" of a package, empty where the case has no front."""
    rows = Benchmarks()
    if not (case / "front.json").is_file():
        return rows

    @rows.row("promise")
    def promise(size: int | None, threads: int, dtype: Dtype) -> Work:
        """Steps of a point of the front beside a case (size: which, 1 the cheapest), and how well its prediction
        holds."""
        scene, which = find(case), size or 1
        points = read_front(scene).points
        point = points[min(which, len(points)) - 1]
        model = package.build(load(scene, package.scene(), quality=point.quality, overrides=settings(point)))
        steps = 50
        model.advance(steps)
        return Work(
            lambda: model.advance(steps), float(steps), "steps/s", steps,
            remark=lambda: repeat(package, scene, which).line(),
        )  # fmt: skip

    return rows
