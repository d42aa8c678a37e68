"""Scenes on the cards of older runs, read as scenes of today."""

from collections.abc import Callable, Mapping
from pathlib import Path
from types import MappingProxyType
from typing import Any

from porescale.common.core.errors import InputError
from porescale.common.schema import scene_file
from porescale.common.schema.sections import Section, scene_as_dict, validate


def completing(
    scene_type: type[Section], card: Mapping[str, Any], formerly: Mapping[str, Any] = MappingProxyType({})
) -> Callable[[Mapping[str, Any]], Mapping[str, Any]]:
    """What completes the full scene on an older run's card with the keys that came after it, at what they were before.

    That is their default, or what ``formerly``, tables like those of a scene, says where the default does something
    else.  Files that it names are looked for where the scene of ``card`` lies, with which the run is resumed.  A
    scene that is none today stays as it is.
    """

    def completed(scene: Mapping[str, Any]) -> Mapping[str, Any]:
        """The scene of a card with the keys that came later."""
        folder = Path(card["scene_file"]).parent if "scene_file" in card else None
        try:
            return scene_as_dict(validate(scene_type, scene_file.merge(formerly, scene), folder=folder))
        except InputError:
            return scene

    return completed
