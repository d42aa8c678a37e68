"""porescale as a program: the type of its scenes, their report, model, run folder and pictures."""

from __future__ import annotations

from contextlib import AbstractContextManager
from pathlib import Path
from typing import TYPE_CHECKING, Any

from porescale.common.api.program import Program

if TYPE_CHECKING:
    from porescale.builders.scene import Scene
    from porescale.builders.simulation import Simulation
    from porescale.common.api.report import Report
    from porescale.common.pictures.look import Look
    from porescale.common.record.drive import Outcome
    from porescale.common.record.open_run import Run


def scene_type() -> type[Scene]:
    """The type of a porescale scene."""
    from porescale.builders.scene import Scene

    return Scene


def report(scene: Scene) -> Report:
    """Every derived number of a scene; raises InputError with all refusals."""
    from porescale.builders.report import report as scene_report

    return scene_report(scene)


def build(scene: Scene) -> Simulation:
    """The simulation of a scene, which knows how long it took to build."""
    from porescale.builders.build import build as build_scene
    from porescale.common.duration.quiet import moment

    began = moment()
    model = build_scene(scene)
    model.building = began, moment()
    return model


def rehearsed(scene: Scene) -> AbstractContextManager[None]:
    """Within this, a second process compiles kernels of the scene."""
    from porescale.builders.rehearsal import rehearsed as rehearsed_scene

    return rehearsed_scene(scene)


def drive(model: Simulation, folder: Path, scene: Scene, *, card: dict[str, Any], **options: Any) -> Outcome:
    """Run the model to the scene's end, write the run folder, and note how fast this machine is."""
    from porescale.analysis.bed_permeability import write_permeability
    from porescale.builders.after_run import density_doubt
    from porescale.builders.checks.device import gpu_of
    from porescale.builders.cost import work
    from porescale.common.api.run_scene import drive_scene
    from porescale.common.core.errors import warn
    from porescale.common.page.page import write_report
    from porescale.common.record.open_run import open_run
    from porescale.common.record.series import run_table

    def after(finished: Path) -> None:
        """Leave the pictures, the permeability of the bed if there is one, and the page unless the scene has none; warn
        of a density too far from that at rest."""
        if doubt := density_doubt(run_table(finished, "series")):
            warn(doubt)
        pictures = show(finished)
        write_permeability(open_run(finished), finished)
        if pictures and scene.output.report:
            write_report(finished, PROGRAM)

    gpu, driver = gpu_of(scene)
    device = {"name": gpu, "driver": driver} if gpu else {"name": "cpu"}
    card = {**card, "seeds": seeds(scene), "device": device}
    return drive_scene(model, folder, scene, card=card, after=after, work=work(scene, model.derived, gpu), **options)


def seeds(scene: Scene) -> dict[str, int]:
    """Seeds of all that the scene draws at random, by key: of its packing, and of polygons placed at random."""
    packing = scene.grains.packing if scene.grains else None
    drawn = {f"polygon[{at}].seed": it.seed for at, it in enumerate(scene.polygon) if it.number is not None}
    return ({"grains.packing.seed": packing.seed} if packing else {}) | drawn


def show(folder: Path) -> list[Path]:
    """Write pictures, film, surface and profiles of the run in ``folder``; returns their paths."""
    from porescale.output.show import show as show_run

    return show_run(folder)


def look(run: Run) -> Look:
    """How pictures and films show a run, of a scene or of a deck of DEMseg."""
    from porescale.output.show import look_of

    return look_of(run)


def measure(run: Run, scene: Scene) -> dict[str, dict[str, list[float]]]:
    """What the measuring sections of ``scene`` read at every snapshot of a run."""
    from porescale.builders.measure_run import measure_run

    return measure_run(run, scene)


def widget(run: Run) -> Any:
    """A run in notebooks: its page, with all frames and tables."""
    from porescale.common.watch.widget import widget as widget_of

    return widget_of(run.folder, PROGRAM)


PROGRAM = Program(
    name="porescale",
    module="porescale",
    scene=scene_type,
    build=build,
    rehearsed=rehearsed,
    drive=drive,
    report=report,
    show=show,
    look=look,
    seeds=seeds,
    measured=("probe", "flux", "line", "region"),
    measure=measure,
    widget=widget,
)
