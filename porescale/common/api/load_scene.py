"""Scenes by path or by the name of a case that comes with the packages."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from porescale.common.api.shipped import case_names, find_case
from porescale.common.core.errors import Fault, InputError
from porescale.common.schema import scene_file
from porescale.common.schema.messages import closest

if TYPE_CHECKING:
    from porescale.common.api.program import Program

Settings = Sequence[str] | Mapping[str, Any]
"""``section.key=value`` each, or key -> value."""


def load_scene(program: Program, scene: str | Path, quality: str | None, settings: Settings) -> Any:
    """The scene that ``scene`` names; arguments and errors as of the packages' ``load``."""
    from porescale.common.schema.sections import load

    overrides = setting_texts(settings)
    return load(find_scene(scene), program.scene(), quality=quality, overrides=overrides)


def find_scene(scene: str | Path) -> Path:
    """The file that ``scene`` names: a file, a folder with scene.toml, else the name of a shipped case; InputError."""
    path = Path(scene)
    try:
        return scene_file.find(path)
    except InputError as error:
        name = str(scene)
        if os.sep in name or path.suffix or os.path.lexists(path):
            raise
        if case := find_case(name):
            return scene_file.find(case)
        if name := closest(name, case_names()):
            raise InputError([replace(it, repair=f"did you mean the case {name!r}?") for it in error.faults]) from None
        raise


def setting_texts(settings: Settings) -> tuple[str, ...]:
    """Settings as ``section.key=value``, which reads back to the bit; InputError where a key is none."""
    if isinstance(settings, str):
        return (settings,)
    if not isinstance(settings, Mapping):
        return tuple(settings)
    none = [Fault(key, None, "is None", repair="leave it out") for key, value in settings.items() if value is None]
    if none:
        raise InputError(none)
    return tuple(scene_file.setting_text(key, value) for key, value in settings.items())
