"""`run` from Python: a scene or a simulation through its time, with the run folder that the command writes."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from porescale.common.api.folders import IN_PYTHON, check_folder, named_folder
from porescale.common.api.run_scene import card_of, check_scene_resume
from porescale.common.core.errors import Fault, InputError, warn

if TYPE_CHECKING:
    from porescale.common.api.open_run import Run
    from porescale.common.api.program import Program
    from porescale.common.api.simulation import BaseSimulation


def run(
    program: Program,
    given: Any,
    out: str | Path | None,
    *,
    resume: bool = False,
    overwrite: bool = False,
    threads: int | None = None,
    progress: bool = True,
) -> Run:
    """Run a scene, or a simulation at time 0, to the scene's end and open its folder; see ``run`` of the packages."""
    from porescale.common.api.open_run import open_run
    from porescale.common.api.simulation import BaseSimulation

    model = given if isinstance(given, BaseSimulation) else None
    scene = program.required(given if model is None else model.scene)
    if model is not None:
        _require_start(model)
    card = card_of(program, scene)
    if model is not None and model.hooks:
        card["hooks"] = {name: hook.on_card() for name, hook in model.hooks.items()}
    folder = named_folder(out, card["name"] or "scene", IN_PYTHON)
    card["name"] = card["name"] or folder.resolve().name
    check_folder(folder, program.name, resume=resume, overwrite=overwrite, words=IN_PYTHON)
    report = program.report(scene)  # what contradicts itself is refused
    if resume:
        check_scene_resume(program, folder, card)
    if threads is not None:
        set_threads(threads)
    for text in report.warnings:
        warn(text)
    if model is None:
        model = program.build(scene)
    program.drive(model, folder, scene, card=card, resume=resume, quiet=not progress, overwrite=overwrite)
    return open_run(folder, program)


def _require_start(model: BaseSimulation) -> None:
    """InputError unless a simulation is at time 0: its folder would lack what came before."""
    if model.step:
        problem, repair = "the simulation is no longer at time 0", "build another, or go on with it by its run()"
        raise InputError(Fault("simulation", f"step {model.step}", problem, repair=repair))


def set_threads(count: int | None) -> int:
    """Use ``count`` threads in all that is computed from now on (None: all cores); returns it.

    InputError unless this machine has as many.  Results are the same in every bit on any number of them.
    """
    from porescale.common.compiled import jit

    try:
        return jit.set_threads(count)
    except InputError as error:
        raise InputError([replace(fault, key="threads") for fault in error.faults]) from None
