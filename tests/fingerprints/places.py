"""Where the fingerprints reach into the packages.  Who moves or renames a module edits this file and nothing else here.

All else goes by what stays: ``porescale.load`` and ``build``, the keys of scenes, ``state()`` with the keys of
checkpoints, commands and the files that they write.  A place is "module:name" or "module:Class.method".
"""

from collections.abc import Callable, Sequence
from importlib import import_module
from pathlib import Path
from typing import Any

KERNELS = "porescale.common.compiled.jit"
"""Its import chooses the folder of compiled kernels."""
MACHINE = "porescale.common.core.machine:machine"
"""() -> {"processor": …}."""
SET_THREADS = "porescale.common.compiled.jit:set_threads"
"""Called by scripts that choose their threads themselves."""
CONCLUDE = "porescale.output.case:conclude"
"""(folder, numbers, figure, out): the end of a script."""
MEASURE = "porescale.piv.estimate.measure:measure"
"""(first, second, mask, settings) -> displacements of a pair of pictures."""
READ_SCENE = "porescale.common.schema.sections:load"
"""(path, type of the scene, quality=, overrides=) with the attribute ``scene``."""
LOAD, BUILD = "porescale.api:load", "porescale.builders.build:build"
"""(path, quality=, settings=) -> scene -> model."""
CONTINUUM_TYPE = "continuum_sph.program:scene_type"
"""() -> type of a continuum scene."""
CONTINUUM_BUILD = "continuum_sph.program:build"
"""(scene) -> model."""


def plain_state(model: Any) -> Any:
    """The state that a checkpoint of ``model`` would hold."""
    return model.state()


def seepage_state(both: Any) -> Any:
    """The same of water and soil together, which scripts step without a scene."""
    parts = {"water": both.water, "soil": both.ground, "supply": both.supply}
    return {name: it.state() for name, it in parts.items() if hasattr(it, "state")} | {"next_step": both.next_step}


STEPPERS: dict[str, Callable[[Any], Any]] = {
    "porescale.dem.grains:Grains.step": plain_state,
    "porescale.coupling.step:Coupled.advance": plain_state,
    "porescale.lbm.fluid:Fluid.advance": plain_state,
    "continuum_sph.water.step:Flow.advance": plain_state,
    "continuum_sph.soil.flow:SoilFlow.advance": plain_state,
    "continuum_sph.seepage.step:Seepage.advance": seepage_state,
}
"""Methods that do a step, or ``count`` of them where they have such an argument, and the state of their object."""


def fetch(place: str) -> Any:
    """What lies at a place."""
    holder, name = owner(place)
    return getattr(holder, name)


def owner(place: str) -> tuple[Any, str]:
    """The module or class that holds a place, and its name there."""
    module, _, names = place.partition(":")
    holder: Any = import_module(module)
    *classes, name = names.split(".")
    for it in classes:
        holder = getattr(holder, it)
    return holder, name


def grains_and_fluid(path: Path, quality: str | None, settings: Sequence[str]) -> Any:
    """The model of a scene of porescale."""
    return fetch(BUILD)(fetch(LOAD)(path, quality=quality, settings=settings))


def continuum(path: Path, quality: str | None, settings: Sequence[str]) -> Any:
    """The model of a scene of continuum_sph."""
    scene = fetch(READ_SCENE)(path, fetch(CONTINUUM_TYPE)(), quality=quality, overrides=settings)
    return fetch(CONTINUUM_BUILD)(scene)


def look(model: Any) -> dict[str, Any]:
    """What a run would record of a model now: rows of its tables, and its snapshot."""
    shot = model.snapshot()
    grids = {
        name: {"origin": list(it.origin), "spacing": list(it.spacing), "cells": it.cells}
        for name, it in shot.grids.items()
    }
    clouds = {
        name: {"position": it.position, "data": it.data, "lines": it.lines, "polygons": it.polygons}
        for name, it in shot.clouds.items()
    }
    tables = getattr(model, "tables", dict)()
    return {"series": model.series(), "tables": tables, "grids": grids, "clouds": clouds}
