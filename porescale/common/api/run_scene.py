"""A run as its scene requests it: what its card holds, how long it takes, and whether it can be gone on with."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from contextlib import AbstractContextManager, nullcontext
from pathlib import Path
from types import MappingProxyType
from typing import TYPE_CHECKING, Any, TypeVar

from porescale.common.core.errors import InputError
from porescale.common.record.read_card import scene_folder

if TYPE_CHECKING:
    from porescale.common.api.program import Program
    from porescale.common.api.simulation import BaseSimulation
    from porescale.common.duration.expected import Work
    from porescale.common.record.drive import Outcome
    from porescale.common.schema.scene import SceneBase
    from porescale.common.schema.sections import Section

S = TypeVar("S", bound="Section")
NOTHING: Mapping[str, Any] = MappingProxyType({})


def drive_scene(
    model: BaseSimulation,
    folder: Path,
    scene: Any,
    *,
    card: dict[str, Any],
    after: Callable[[Path], object],
    work: Work,
    formerly: Mapping[str, Any] = NOTHING,
    **options: Any,
) -> Outcome:
    """`drive` the model for as long as its scene says, with rows, snapshots and checkpoints when it says.

    after, options : of `drive`;  work : what the run has to do; what that takes is noted where all of it was done in
    one go;  formerly : of `Program`.
    """
    from porescale.common.duration.expected import BUILDING, FINISHING, expected, remember
    from porescale.common.duration.quiet import quiet_seconds
    from porescale.common.record.drive import drive

    outcome = drive(
        model,
        folder,
        scene.time.end,
        snapshot_interval=scene.output.snapshot_interval,
        series_interval=scene.output.series_interval,
        checkpoint_seconds=scene.output.checkpoint_seconds,
        card=card,
        after=after,
        today=completing(type(scene), card, formerly),
        finish=expected(work).seconds[FINISHING],
        **options,
    )
    if outcome.phases and model.building and not options.get("resume"):
        remember(work, {BUILDING: quiet_seconds(*model.building), **outcome.phases}, model.building[0])
    return outcome


def rehearsed(module: str, scene: Any, fits: Callable[[], bool]) -> AbstractContextManager[None]:
    """Within this, ``python -m module`` compiles kernels of ``scene``, too (`ahead`), if there are cores for it.

    fits : whether it comes to them sooner, and the scene may be held twice; asked where a kernel is not on disk.  A
    scene that names a user's own functions is left alone.
    """
    from porescale.common.compiled.ahead import ahead
    from porescale.common.compiled.jit import threads
    from porescale.common.schema.own import on_card
    from porescale.common.schema.sections import scene_as_dict

    def given() -> dict[str, Any] | None:
        """What the second process reads; None where it is not to be started."""
        if on_card(scene) or not fits():
            return None
        return {"scene": scene_as_dict(scene), "folder": str(scene.source.folder or ""), "threads": threads()}

    return ahead(module, given) if threads() > 1 else nullcontext()


def scene_given(given: Mapping[str, Any], scene_type: type[S]) -> S:
    """The scene that the second process of `rehearsed` was given, with as many threads as the run has."""
    from porescale.common.compiled.jit import set_threads
    from porescale.common.schema.sections import validate

    set_threads(given["threads"])
    return validate(scene_type, given["scene"], folder=Path(given["folder"]) if given["folder"] else None)


def check_scene_resume(program: Program, folder: Path, card: dict[str, Any]) -> None:
    """InputError where the run in ``folder`` cannot be gone on with as ``card`` requests."""
    from porescale.common.record.drive import check_resume

    check_resume(folder, card, today=completing(program.scene(), card, program.formerly))


def check_same_scene(program: Program, folder: Path, card: dict[str, Any]) -> None:
    """InputError naming every key of a scene in which the run in ``folder`` differs from that of ``card``."""
    from porescale.common.record.record import check_changes

    check_changes(folder, card, completing(program.scene(), card, program.formerly))


def completing(
    scene_type: type[Section], card: Mapping[str, Any] = NOTHING, formerly: Mapping[str, Any] = NOTHING
) -> Callable[[Mapping[str, Any]], Mapping[str, Any]]:
    """What completes the full scene of an older record with the keys that came after it, at what they were before.

    That is their default, or what ``formerly``, tables like those of a scene, says where the default does something
    else.  Files that it names are looked for where the scene of ``card`` lies, with which the run is resumed.  A
    scene that is none today stays as it is.
    """

    from porescale.common.schema import scene_file
    from porescale.common.schema.sections import scene_as_dict, validate

    def completed(scene: Mapping[str, Any]) -> Mapping[str, Any]:
        """The scene of a card with the keys that came later."""
        try:
            return scene_as_dict(validate(scene_type, scene_file.merge(formerly, scene), folder=scene_folder(card)))
        except InputError:
            return scene

    return completed


def card_of(program: Program, scene: SceneBase) -> dict[str, Any]:
    """The entries of a run card that describe the request: a scene, and where it comes from."""
    from porescale.common.schema.own import on_card
    from porescale.common.schema.sections import scene_as_dict

    source = scene.source
    return {
        "package": program.name,
        "name": source.name,
        "scene": scene_as_dict(scene),
        "scene_file": str(source.file.resolve()) if source.file else None,
        "quality": source.quality,
        "settings": list(source.settings),
        **on_card(scene),
    }
