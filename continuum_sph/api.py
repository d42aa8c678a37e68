"""The Python interface of continuum_sph: scenes, simulations and runs, with the names that porescale has too."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from continuum_sph.program import PROGRAM
from porescale.common.api.shipped import cases as cases

if TYPE_CHECKING:
    from continuum_sph.builders.simulation import Simulation
    from continuum_sph.scene.sections import Scene
    from porescale.common.api.open_run import Run

__all__ = ["build", "cases", "load", "open_run"]


def load(scene: str | Path, *, quality: str | None = None, settings: Sequence[str] = ()) -> Scene:
    """The scene at a path: a TOML file or a folder with scene.toml.

    quality : level "draft", "standard" or "fine"; None: the file's own default;  settings : ``section.key=value``.
    Raises InputError with every fault of the file.
    """
    from continuum_sph.scene.sections import load_scene

    return load_scene(scene, quality=quality, settings=settings)


def build(scene: Scene) -> Simulation:
    """The simulation of ``scene`` at time 0; raises InputError for what the scene must not request."""
    made: Simulation = PROGRAM.build(scene)
    return made


def open_run(folder: str | Path) -> Run:
    """Open the folder of a run, finished, running or killed; InputError where it holds none, or a damaged one."""
    from porescale.common.api.open_run import open_run

    return open_run(folder, PROGRAM)
