"""What the common commands need of porescale: the scene, its template, report, model and run folder."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from importlib.resources import files
from pathlib import Path
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from porescale.builders.scene import Scene
    from porescale.builders.simulation import Simulation
    from porescale.common.cli.report import Report
    from porescale.common.core.types import AnyArray
    from porescale.common.record.drive import Outcome


def scene_type() -> type[Scene]:
    """The type of a porescale scene."""
    from porescale.builders.scene import Scene

    return Scene


def template() -> str:
    """The text of the scene that ``new`` writes, with the names that the registers offer."""
    from porescale.coupling.solid.choose import SOLID_OPERATORS
    from porescale.coupling.weighting.choose import WEIGHTINGS
    from porescale.dem.contact.choose import LAWS
    from porescale.lbm.boundary.choose import boundaries
    from porescale.lbm.collision.choose import OPERATORS

    text = files("porescale.cli").joinpath("template.toml").read_text(encoding="utf-8")
    for place, names in (("sides", boundaries()), ("operators", OPERATORS), ("solid_operators", SOLID_OPERATORS),
                         ("weightings", WEIGHTINGS), ("contact_laws", LAWS)):  # fmt: skip
        text = text.replace(f"{{{place}}}", " | ".join(names))
    return text


def report(scene: Scene) -> Report:
    """Every derived number of a scene; raises InputError with all refusals."""
    from porescale.builders.report import report as scene_report

    return scene_report(scene)


def build(scene: Scene) -> Simulation:
    """The simulation of a scene."""
    from porescale.builders.build import build as build_scene

    return build_scene(scene)


def drive(model: Simulation, folder: Path, scene: Scene, *, card: dict[str, Any], **options: Any) -> Outcome:
    """Run the model to the scene's end, write the run folder, and note how fast this machine is."""
    from porescale.analysis.bed_permeability import write_permeability
    from porescale.builders.cost import remember
    from porescale.cli.show import show
    from porescale.common.cli.run import drive_scene
    from porescale.common.record.open_run import open_run

    def after(finished: Path) -> None:
        """Leave the pictures, and the permeability of the bed if there is one."""
        show(finished)
        write_permeability(open_run(finished), finished)

    packing = scene.grains.packing if scene.grains else None
    card = {**card, "seeds": {"grains.packing.seed": packing.seed} if packing else {}}
    outcome = drive_scene(model, folder, scene, card=card, after=after, **options)
    remember(model.derived, outcome.steps_per_second)
    return outcome


def features() -> Mapping[str, Callable[[Path, float | None], AnyArray]]:
    """What a trade study may read of a run besides its tables."""
    from porescale.analysis.features import FEATURES

    return FEATURES
