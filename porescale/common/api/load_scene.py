"""Scenes by path or by the name of a case that comes with the packages."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from porescale.common.api.shipped import scene_path
from porescale.common.core.errors import Fault, InputError
from porescale.common.core.given_file import path_of
from porescale.common.schema import scene_file

if TYPE_CHECKING:
    from porescale.common.api.program import Program

Settings = Sequence[str] | Mapping[str, Any]
"""``section.key=value`` each, or key -> value."""


def load_scene(program: Program, scene: str | Path, quality: str | None, settings: Settings) -> Any:
    """The scene that ``scene`` names; arguments and errors as of the packages' ``load``."""
    from porescale.common.schema.sections import load

    path_of("scene", scene, "give the path of a scene, or the name of a case")
    file = scene_file.find(scene_path(scene, program.name))
    return load(file, program.scene(), quality=quality, overrides=setting_texts(settings))


def setting_texts(settings: Settings) -> tuple[str, ...]:
    """Settings as ``section.key=value``, which reads back to the bit; InputError where a key is none."""
    if isinstance(settings, str):
        return (settings,)
    if not isinstance(settings, Mapping):
        if not isinstance(settings, Iterable):
            repair = 'give {"fluid.spacing": "0.3 mm"}, or texts as fluid.spacing=0.0003'
            raise InputError(Fault("settings", str(settings), "are no settings", repair=repair))
        return tuple(settings)
    none = [Fault(key, None, "is None", repair="leave it out") for key, value in settings.items() if value is None]
    if none:
        raise InputError(none)
    return tuple(scene_file.setting_text(key, value) for key, value in settings.items())
