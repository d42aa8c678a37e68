"""continuum_sph as a program: the type of its scenes, their report, model, run folder and pictures."""

from __future__ import annotations

from contextlib import AbstractContextManager
from pathlib import Path
from typing import TYPE_CHECKING, Any

from porescale.common.api.program import Program
from porescale.common.api.run_scene import drive_scene

if TYPE_CHECKING:
    from continuum_sph.builders.simulation import Simulation
    from continuum_sph.scene.sections import Scene
    from porescale.common.api.report import Report
    from porescale.common.pictures.look import Look
    from porescale.common.record.drive import Outcome
    from porescale.common.record.open_run import Run

FORMERLY = {"numerics": {"noise_floor": 0.0}}
"""What was done before keys were there whose defaults do something else: no run changes its physics when resumed."""


def scene_type() -> type[Scene]:
    """The type of a continuum scene."""
    from continuum_sph.scene.sections import Scene

    return Scene


def build(scene: Scene) -> Simulation:
    """The simulation of a scene, which knows how long it took to build; raises InputError with all that `report`
    refuses."""
    from continuum_sph.builders.simulation import Simulation
    from porescale.common.duration.quiet import moment

    began = moment()
    report(scene)
    model = Simulation(scene)
    model.building = began, moment()
    return model


def rehearsed(scene: Scene) -> AbstractContextManager[None]:
    """Within this, a second process compiles kernels of the scene."""
    from continuum_sph.builders.rehearsal import rehearsed as rehearsed_scene

    return rehearsed_scene(scene)


def drive(model: Simulation, folder: Path, scene: Scene, **options: Any) -> Outcome:
    """Run the model to the scene's end and write the run folder; options as of `Program`."""
    from porescale.common.page.page import write_report

    def after(finished: Path) -> None:
        """Leave the pictures, and the page unless the scene has none."""
        if show(finished) and scene.output.report:
            write_report(finished, PROGRAM)

    work = report(scene).work
    assert work is not None
    return drive_scene(model, folder, scene, after=after, work=work, formerly=FORMERLY, **options)


def report(scene: Scene) -> Report:
    """Every derived number of a scene; raises InputError with all refusals."""
    from continuum_sph.builders.report import report as scene_report

    return scene_report(scene)


def show(folder: Path) -> list[Path]:
    """Write pictures and film of the run in ``folder``; returns their paths."""
    from dataclasses import replace

    from continuum_sph.look import is_dry
    from porescale.common.pictures.film import painted
    from porescale.common.pictures.picture import paint_last
    from porescale.common.record.open_run import open_run

    run = open_run(folder)
    look, scene = look_of(run), run.card["scene"]
    names = () if not scene["soil"] else SOIL if is_dry(scene) else SEEPAGE
    more = [paint_last(folder, name, replace(look, colour=name, kinds={})) for name in names]
    return [*painted(folder, look), *more]


def look_of(run: Run) -> Look:
    """How pictures and films show a run: the speed of water, or where fluids and soil are, or how far soil has come."""
    from continuum_sph.builders.parts.phreatic import NAME, line_of
    from continuum_sph.look import look_of_scene

    scene = run.card["scene"]
    surface = run.table(NAME) if (run.folder / f"{NAME}.csv").exists() else {}
    return look_of_scene(scene, run.card.get("name", ""), line_of(surface, scene["numerics"]["spacing"]))


SEEPAGE = ("pressure", "velocity", "porosity")
"""What is shown of soil and water at the end, besides where they are."""
SOIL = ("mean_stress", "plastic_strain", "velocity")
"""What is shown of soil at the end, besides how far it has come."""


def measure(run: Run, scene: Scene) -> dict[str, dict[str, list[float]]]:
    """What the measuring sections of ``scene`` read at every snapshot of a run."""
    from continuum_sph.measure_run import measure_run

    return measure_run(run, scene)


def widget(run: Run) -> Any:
    """A run in notebooks: its page, with all frames and tables."""
    from porescale.common.watch.widget import widget as widget_of

    return widget_of(run.folder, PROGRAM)


PROGRAM = Program(
    name="continuum-sph",
    module="continuum_sph",
    scene=scene_type,
    build=build,
    rehearsed=rehearsed,
    drive=drive,
    report=report,
    show=show,
    look=look_of,
    measured=("probe", "level"),
    measure=measure,
    widget=widget,
    formerly=FORMERLY,
)
