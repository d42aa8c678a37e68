"""``porescale run``: a scene, its model and its run folder."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from porescale.builders.scene import Scene
    from porescale.builders.simulation import Simulation
    from porescale.common.core.types import AnyArray
    from porescale.common.record.drive import Outcome


def scene_type() -> type[Scene]:
    """The type of a porescale scene."""
    from porescale.builders.scene import Scene

    return Scene


def build(scene: Scene) -> Simulation:
    """The simulation of a scene."""
    from porescale.builders.build import build as build_scene

    return build_scene(scene)


def drive(
    model: Simulation,
    folder: Path,
    scene: Scene,
    *,
    card: dict[str, Any],
    resume: bool,
    quiet: bool,
    overwrite: bool = False,
) -> Outcome:
    """Run the model to the scene's end, write the run folder, and note how fast this machine is."""
    from porescale.analysis.bed_permeability import write_permeability
    from porescale.builders.cost import remember
    from porescale.cli.show import show
    from porescale.common.record.drive import drive as drive_model
    from porescale.common.record.open_run import open_run
    from porescale.common.schema.migrations import completing

    def after(finished: Path) -> None:
        """Leave the pictures, and the permeability of the bed if there is one."""
        show(finished)
        write_permeability(open_run(finished), finished)

    packing = scene.grains.packing if scene.grains else None
    outcome = drive_model(
        model,
        folder,
        scene.time.end,
        snapshot_interval=scene.output.snapshot_interval,
        series_interval=scene.output.series_interval,
        checkpoint_seconds=scene.output.checkpoint_seconds,
        card={**card, "seeds": {"grains.packing.seed": packing.seed} if packing else {}},
        resume=resume,
        overwrite=overwrite,
        quiet=quiet,
        after=after,
        today=completing(scene_type(), card),
    )
    remember(model.derived, outcome.steps_per_second)
    return outcome


def check_resume(folder: Path, card: dict[str, Any]) -> None:
    """InputError where the run in ``folder`` cannot be gone on with as ``card`` requests."""
    from porescale.common.record.drive import check_resume
    from porescale.common.schema.migrations import completing

    check_resume(folder, card, today=completing(scene_type(), card))


def table(folder: Path, name: str) -> dict[str, AnyArray]:
    """Columns of a table of the run in ``folder``, "series" for series.csv; {} when there is none."""
    from porescale.common.record.series import read_series

    return read_series(folder / f"{name}.csv")


def features() -> Mapping[str, Callable[[Path, float | None], AnyArray]]:
    """What a trade study may read of a run besides its tables."""
    from porescale.analysis.features import FEATURES

    return FEATURES
