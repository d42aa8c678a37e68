"""`sweep SCENE [TABLE]`: any keys of a scene varied, the runs compared."""

from __future__ import annotations

import shlex
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

from cyclopts import Parameter

from porescale.common.api.folders import output_folder
from porescale.common.cli.options import Quality, Scene, Settings, ThreadsOfEach, each_threads, require_scene, say
from porescale.common.cli.package import Package
from porescale.common.core.errors import Fault, InputError
from porescale.common.studies.sweep import check_points, columns_at_end, expected, require_folder, run_points

if TYPE_CHECKING:
    from porescale.common.studies.ensemble import Repeats
    from porescale.common.studies.parameter_table import Point
    from porescale.common.studies.runner import Campaign, Ended

Vary = Annotated[list[str] | None, Parameter(name="--vary", help="section.key=a,b,c; repeatable: all combinations")]
Repeat = Annotated[
    int | None, Parameter(help="how often each run is repeated, on other seeds: means with intervals in ensemble.csv")
]
OverKey = Annotated[
    str | None,
    Parameter(
        help="what repeats differ in, in place of the scene's seeds: section.key, counted up, or section.key=a,b,c"
    ),
]
Jobs = Annotated[
    int | None, Parameter(help="runs at a time; if not given one here, as many as it takes with a scheduler")
]
Scheduler = Annotated[
    str | None,
    Parameter(help="slurm, slurm:partition=long,time=2h,account=abc, or the address of a dask scheduler, tcp://…"),
]
Again = Annotated[bool, Parameter(help="retry points that went unstable or failed")]


def command(package: Package) -> Callable[..., int]:
    """The `sweep` command of a package."""

    def sweep(
        scene: Scene,
        table: Annotated[Path | None, Parameter(help="CSV or TOML file, a run for each row")] = None,
        /,
        *,
        vary: Vary = None,
        repeat: Repeat = None,
        over: OverKey = None,
        quality: Quality = None,
        settings: Settings = None,
        out: Annotated[str | None, Parameter(help="folder; runs/ and the scene's name and _sweep if not given")] = None,
        jobs: Jobs = None,
        threads: ThreadsOfEach = 1,
        scheduler: Scheduler = None,
        again: Again = False,
    ) -> int:
        """Run a scene with keys varied from a table, or repeated on other seeds, and compare the runs.

        Every point has its run folder; sweep.csv, .md and .png compare the quantities of expected.toml beside the
        scene, else how every column of the series ends.  Of repeats ensemble.csv has means with intervals, judged by
        expected.toml.  A sweep that was stopped goes on when called again.
        """
        from porescale.common.record.series import run_table
        from porescale.common.studies import ensemble_files, sweep_files
        from porescale.common.studies.ensemble import Repeats, ensembles, repeated
        from porescale.common.studies.parameter_table import ENSEMBLE, SWEEP, varied
        from porescale.common.studies.runner import Campaign

        each_run = each_threads(threads)
        start = require_scene(scene, package.name)
        asked = Repeats(repeat, over)
        points = chosen_points(table, vary or (), asked)
        combined, each = "--vary" if vary else "", len(varied(vary)) if vary and table else 0
        file, name = check_points(package, start, points, quality, settings or (), combined, each)
        if asked:
            single, points = len(points), repeated(package, start, points, asked, quality, settings or ())
            check_points(package, start, points, quality, settings or (), "--over", len(points) // single)
        folder = output_folder(out, f"{name}_sweep")
        campaign = Campaign(package.module, file, folder, tuple(settings or ()), quality, each_run, again)
        enlist(campaign, jobs, scheduler)
        require_folder(package, start, campaign, points)
        varying = [word for text in vary or () for word in ("--vary", text)]
        words = [package.name, "sweep", str(scene), *([str(table)] if table else []), *varying, *asked.options()]
        command_line = shlex.join([*words, *laid_over(quality, settings)])
        rows = expected(file)
        ends = run_points(campaign, points, jobs, rows, command_line, say)
        lines = sweep_files.ensemble_lines(ensembles(points, ends), rows or columns_at_end(ends), run_table)
        for text in ensemble_files.printed(lines):
            print(text)
        print(f"{folder / SWEEP}.csv, .md, .png" + (f", {ENSEMBLE}.csv" if asked else ""))
        return conclude(ends) or int(not settings and not quality and ensemble_files.failed(lines))

    return sweep


def chosen_points(table: Path | None, vary: Sequence[str], asked: Repeats) -> list[Point]:
    """The points of a table, of options, or of both crossed; InputError if there is neither, and no repeats."""
    from porescale.common.studies.parameter_table import AS_IT_IS, Point, crossed, read_points, varied

    if table is None and not vary:
        if asked:
            return [Point(AS_IT_IS, ())]
        repair = "give a table, --vary section.key=a,b,c, or --repeat N"
        raise InputError(Fault("sweep", None, "varies nothing", repair=repair))
    options = varied(vary) if vary else []
    if table is None:
        return options
    points = read_points(table)
    return crossed(points, options) if options else points


def laid_over(quality: str | None, settings: Sequence[str] | None) -> list[str]:
    """The options of quality and settings as they were written."""
    level = ["--quality", quality] if quality else []
    return level + [word for text in settings or () for word in ("--set", text)]


def enlist(campaign: Campaign, jobs: int | None, scheduler: str | None) -> None:
    """Give the points to the scheduler that is named, this machine if none is; InputError where it cannot be had."""
    if jobs is not None and jobs < 1:
        raise InputError(Fault("--jobs", jobs, "is out of range", "", ">= 1"))
    if scheduler is not None:
        from porescale.common.studies.schedulers.law import scheduler_of

        campaign.scheduler = scheduler_of(scheduler, campaign.threads)


def conclude(ends: Sequence[Ended]) -> int:
    """Say which points did not finish; the exit code."""
    bad = [ended for ended in ends if ended.outcome != "finished"]
    for ended in bad:
        say(f"{ended.point.name}: {ended.outcome}: {ended.problem}")
    return 1 if bad else 0
