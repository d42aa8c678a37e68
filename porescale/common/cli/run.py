"""`run SCENE`: a simulation and its run folder."""

from __future__ import annotations

import sys
from collections.abc import Callable
from pathlib import Path
from shlex import quote
from typing import TYPE_CHECKING, Annotated, Any, Literal

from cyclopts import Parameter

from porescale.common.api.folders import check_folder, named_folder
from porescale.common.api.run_scene import card_of, check_scene_resume
from porescale.common.cli import pick
from porescale.common.cli.options import Quality, Scene, Settings, Threads, require_scene, use_threads
from porescale.common.cli.package import Package
from porescale.common.core.errors import Fault, InputError
from porescale.common.core.machine import age, peak_bytes

if TYPE_CHECKING:
    from porescale.common.record.drive import Outcome


def command(package: Package) -> Callable[..., int]:
    """The `run` command of a package."""

    def run(
        scene: Scene,
        /,
        *,
        out: Annotated[str | None, Parameter(help="run folder; runs/ and the name of the scene if not given")] = None,
        quality: Quality = None,
        settings: Settings = None,
        threads: Threads = None,
        device: Annotated[Literal["cpu", "gpu"] | None, Parameter(help="run.device, of porescale alone")] = None,
        resume: Annotated[bool, Parameter(help="go on with the run in the run folder")] = False,
        overwrite: Annotated[bool, Parameter(help="replace the run in the run folder")] = False,
        error: Annotated[
            str | None, Parameter(help="5%: the cheapest point of the scene's front that is as good")
        ] = None,
        budget: Annotated[
            str | None, Parameter(help="3min: the best point of its front whose command takes no longer")
        ] = None,
        quiet: Annotated[bool, Parameter(help="no progress, no summary")] = False,
    ) -> int:
        """Run a scene and write its run folder."""
        from porescale.common.record.progress import Watch
        from porescale.common.schema.sections import load

        place = require_scene(scene, package.name)
        if device is not None:
            _require_device(package)
            settings = [*(settings or ()), f"run.device={device}"]
        chosen = None
        if error is not None or budget is not None:
            _require_free_choice(quality, resume)
            use_threads(threads)
            chosen = pick.pick(package, place, error, budget, settings or (), quiet=quiet)
            settings = [*chosen.point.settings, *(settings or ())]
        level = chosen.point.quality if chosen else quality
        read = load(place, package.scene(), quality=level, overrides=settings or ())
        folder = named_folder(out, read.name)
        check_folder(folder, package.name, resume=resume, overwrite=overwrite)
        card = card_of(package, read)
        if chosen is not None:
            card["picked"] = chosen.as_dict()
        with Watch(read.name, 0.0, 0.0, quiet=quiet):
            warnings = package.report_of(read).warnings  # what contradicts itself is refused
        if resume:
            check_scene_resume(package, folder, card)
        use_threads(threads)  # numba counts them; unless moving frames were to be checked, it is imported only now
        for warning in warnings:
            print(f"warning: {warning}", file=sys.stderr)
        with package.rehearsed(read):
            with Watch(read.name, 0.0, _end(read), quiet=quiet):
                model = package.build(read)
            outcome = package.drive(model, folder, read, card=card, resume=resume, quiet=quiet, overwrite=overwrite)
        if not quiet:
            print(summary(package.name, read.name, folder, outcome))
            if chosen is not None:
                print(f"expected {chosen.seconds:.3g} s, took {age():.3g} s, start-up and pictures included")
        return 0

    return run


def _end(scene: Any) -> float:
    """Time that a scene is to simulate, s; 0 where it does not say so."""
    return float(getattr(getattr(scene, "time", None), "end", 0.0))


def _require_device(package: Package) -> None:
    """InputError where scenes of a package have no run.device."""
    if "run" not in package.scene().model_fields:
        raise InputError(Fault("--device", None, f"is of porescale: {package.name} runs on the CPU alone",
                               repair="leave it out"))  # fmt: skip


def _require_free_choice(quality: str | None, resume: bool) -> None:
    """InputError where what a front picks is given, too."""
    for option, given in (("--quality", quality), ("--resume", resume)):
        if given:
            repair = "leave one of them out; a run that was picked is resumed with the --quality and --set on its card"
            raise InputError(Fault(option, None, "contradicts --error and --budget", repair=repair))


def summary(command: str, name: str, folder: Path, outcome: Outcome) -> str:
    """Text with the cost of the run and the files to look at."""
    speed = f", {outcome.steps_per_second:.4g} steps/s" if outcome.steps_per_second else ""
    names = [path.name for path in folder.iterdir() if path.is_file()] if folder.is_dir() else []
    files = ", ".join(sorted(it for it in names if not it.startswith(".")))
    return (
        f"{name}: {outcome.outcome} at t = {outcome.time:.6g} s, step {outcome.step}; "
        f"{outcome.seconds:.3g} s{speed}, {outcome.snapshots} snapshots, {peak_bytes() / 2**20:.0f} MiB at most\n"
        f"look at {folder}: {files}\n"
        f"more pictures: {command} show {quote(str(folder))}"
    )
