"""`study trade SCENE`: speed against accuracy over a scene's knobs."""

import shlex
from collections.abc import Callable
from datetime import UTC, datetime
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

from cyclopts import Parameter

from porescale.common.api.folders import output_folder
from porescale.common.cli.options import Scene, Settings, ThreadsOfEach, each_threads, require_scene, say, use_threads
from porescale.common.cli.package import Package
from porescale.common.cli.sweep import (
    Again,
    Jobs,
    OverKey,
    Repeat,
    Scheduler,
    conclude,
    enlist,
    laid_over,
)
from porescale.common.core.errors import Fault, InputError
from porescale.common.core.version import VERSION
from porescale.common.studies.sweep import check_points, require_folder

if TYPE_CHECKING:
    from porescale.common.studies.parameter_table import Point


def command(package: Package) -> Callable[..., int]:
    """The `study trade` command of a package."""

    def trade(
        scene: Scene,
        /,
        *,
        plan: Annotated[Path | None, Parameter(help="what is measured and varied; trade.toml beside the scene")] = None,
        repeat: Repeat = None,
        over: OverKey = None,
        settings: Settings = None,
        out: Annotated[str | None, Parameter(help="folder; runs/ and the scene's name and _trade if not given")] = None,
        jobs: Jobs = None,
        threads: ThreadsOfEach = 1,
        scheduler: Scheduler = None,
        again: Again = False,
    ) -> int:
        """Measure error, core-seconds and memory of a scene over its knobs, and find the front.

        front.json, trade.csv, .md and .png; put front.json beside the scene, and `run --error 5%` or `--budget 3min`
        pick from it.  Every point is repeated as [over] of the plan says, or `--repeat`.  A study that was stopped goes
        on when called again.
        """
        from porescale.common.record.series import run_table
        from porescale.common.schema.sections import load, scene_as_dict
        from porescale.common.studies import trade_files
        from porescale.common.studies.ensemble import Repeats, repeated
        from porescale.common.studies.runner import Campaign
        from porescale.common.studies.trade import Errors, front
        from porescale.common.studies.trade_plan import read_plan

        each_run = each_threads(threads)
        start = require_scene(scene, package.name)
        planned = read_plan(start, plan)
        features = package.features() if package.features else {}
        unknown = [quantity.feature for quantity in planned.quantity if quantity.feature not in ("", *features)]
        if unknown:
            known = ", ".join(features) or "none"
            raise InputError(Fault("quantity.feature", unknown[0], "is not known", "", known))
        reference = planned.reference_point()
        variants = planned.variants()
        called = ("--repeat", "--over", "a point of the plan")
        asked = Repeats(repeat, over, called) or Repeats(None, planned.over.option() if planned.over else None, called)

        def repeats(point: "Point") -> "list[Point]":
            """The runs of a point."""
            return repeated(package, start, [point], asked, None, settings or ()) if asked else [point]

        truth = repeats(reference) if reference else []
        groups = [repeats(point) for _, _, point in variants]
        points = [*truth, *(point for group in groups for point in group)]
        over_key = "--over" if asked else ""
        file, name = check_points(package, start, points, None, settings or (), over_key, len(groups[0]))
        folder = output_folder(out, f"{name}_trade")
        campaign = Campaign(package.module, file, folder / "runs", tuple(settings or ()), None, each_run, again)
        enlist(campaign, jobs, scheduler)
        require_folder(package, start, campaign, points)
        ends = {ended.point.name: ended for ended in campaign.all(points, jobs, say)}
        if code := conclude([ends[point.name] for point in truth]):
            say("the reference did not finish: nothing to hold the others against")
            return code
        reference_ends = [ends[point.name] for point in truth]
        errors = Errors(planned, run_table, features, reference_ends)
        traded = front(
            [errors.trade(knob, label, point, [ends[one.name] for one in group])
             for (knob, label, point), group in zip(variants, groups, strict=True)]
        )  # fmt: skip
        use_threads(each_run)
        words = [package.name, "study", "trade", str(scene), *(["--plan", str(plan)] if plan else [])]
        words += Repeats(repeat, over).options()
        about = circumstances(package, shlex.join([*words, *laid_over(None, settings)]), each_run)
        about["settings"], about["over"] = list(settings or ()), key_of(groups[0][0])
        about["scene"] = scene_as_dict(load(start, package.scene(), overrides=settings or ()))
        about["quantities"] = [one.model_dump(mode="json", exclude_none=True) for one in planned.quantity]
        about["references"] = errors.answers()
        if reference:
            about["reference"] = trade_files.as_dict(errors.trade("", "reference", reference, reference_ends))
        if planned.draft is not None:
            about["draft"] = planned.draft
        trade_files.write(folder, about, traded, errors.packings(), planned.caveats())
        print(f"{folder / trade_files.FRONT}, {trade_files.NAME}.csv, .md, .png")
        return conclude(list(ends.values()))

    return trade


def key_of(point: "Point") -> str | None:
    """The key that the repeats of a point differ in; None for one that is no repeat."""
    return point.over[0].partition("=")[0] if point.over else None


def circumstances(package: Package, command: str, threads: int) -> dict[str, Any]:
    """What made the numbers: command, version, machine, date."""
    from porescale.common.core.machine import machine

    return {
        "command": command, "package": package.name, "version": VERSION, "threads": threads,
        "machine": machine(),
        "date": datetime.now(UTC).date().isoformat(),
    }  # fmt: skip
