"""The Python interface of porescale: scenes, simulations and runs, with the names that continuum_sph has too."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from porescale.common.api.shipped import cases as cases
from porescale.program import PROGRAM

if TYPE_CHECKING:
    from porescale.builders.scene import Scene
    from porescale.builders.simulation import Simulation
    from porescale.common.api.open_run import Run

__all__ = ["build", "cases", "load", "open_run"]


def load(scene: str | Path, *, quality: str | None = None, settings: Sequence[str] = ()) -> Scene:
    """The scene at a path: a TOML file or a folder with scene.toml.

    quality : level "draft", "standard" or "fine"; None: the file's own default;  settings : ``section.key=value``.
    Raises InputError with every fault of the file.
    """
    from porescale.builders.build import load_scene

    return load_scene(scene, quality=quality, settings=settings)


def build(scene: Scene) -> Simulation:
    """The simulation of ``scene`` at time 0; raises InputError for what the scene must not request.

    A packing is settled first, or read from the cache; that can take seconds.
    """
    made: Simulation = PROGRAM.build(scene)
    return made


def open_run(folder: str | Path) -> Run:
    """Open the folder of a run, finished, running or killed; InputError where it holds none, or a damaged one."""
    from porescale.common.api.open_run import open_run

    return open_run(folder, PROGRAM)
