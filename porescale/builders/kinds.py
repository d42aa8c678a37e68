"""The parts there are, in the order of their columns, tables, arrays and state; each made where its sections are.

A part is imported where it is made, so that nothing of an absent section is.
"""

from collections.abc import Callable
from importlib import import_module
from typing import Any, NamedTuple

from porescale.builders.initial.frames import disc_count, free_rows
from porescale.builders.initial.rock import has_plates
from porescale.builders.stepper import Stepper
from porescale.builders.system import System
from porescale.common.compiled.own import OwnLaw
from porescale.scene.scene import Scene


class Kind(NamedTuple):
    """sections : that it is built from;  wanted : whether a system has it;  name : of its file and class."""

    sections: tuple[str, ...]
    wanted: Callable[[System], bool]
    name: str


def _made(name: str, system: System) -> Any:
    """The part of that name; it may use those of the system that were made before."""
    file, _, kind = name.partition(".")
    return getattr(import_module(f"porescale.builders.parts.{file}"), kind)(system)


def _free(system: System) -> bool:
    """Whether a scene with [grains] has any that forces move."""
    return bool(system.grains and system.scene.grains and free_rows(system.grains, system.frames, system.held).size > 0)


def _measures_grains(system: System) -> bool:
    """Whether a scene measures its grains beyond series.csv."""
    it = system.scene
    requested = it.region or it.coarse_graining or it.output.forces or it.output.contacts
    return bool(system.grains and it.grains and requested)


KINDS = (
    Kind((), lambda it: bool(it.scene.fluid and isinstance(it.scene.fluid.body_force, OwnLaw)), "user_forces.OwnForce"),
    Kind(
        (),
        lambda it: any(isinstance(side.velocity, OwnLaw) for side in it.scene.domain.sides.values()),
        "user_forces.OwnInflow",
    ),
    Kind(("grains",), _free, "grain_series.GrainSeries"),
    Kind(("sleep",), lambda it: bool(it.grains and it.scene.sleep), "sleep.SleepPart"),
    Kind(("fluid",), lambda it: it.fluid is not None, "flow_series.FlowSeries"),
    Kind(("gate",), lambda it: it.scene.gate is not None, "gate.GatePart"),
    Kind(("rectangle",), lambda it: bool(it.scene.rectangle), "rectangles.RectanglesPart"),
    Kind(("disc",), lambda it: bool(it.grains and any(disc.timed for disc in it.scene.disc)), "discs.DiscsPart"),
    Kind(("cell",), lambda it: bool(it.grains and it.scene.cell), "cell.CellPart"),
    Kind(("grains", "disc", "clump"), lambda it: bool(it.grains and disc_count(it.grains)), "clouds.GrainCloud"),
    Kind(("segment", "polygon", "container"), lambda it: bool(it.frames), "clouds.FrameCloud"),
    Kind(("bonds", "rock"), lambda it: bool(it.grains and (it.scene.bonds or it.scene.rock)), "bonds.BondsPart"),
    Kind(("grains",), lambda it: bool(it.grains and it.scene.output.energy), "energy.EnergyPart"),
    Kind(("region", "coarse_graining"), _measures_grains, "grain_instruments.GrainInstruments"),
    Kind(
        ("probe", "flux", "loads"),
        lambda it: bool(it.fluid and (it.scene.probe or it.scene.flux or it.scene.loads)),
        "flow_instruments.FlowInstruments",
    ),
    Kind(("control",), lambda it: len(it.recorded) > (2 if has_plates(it.scene.rock) else 0), "control.ControlPart"),
    Kind(("rock",), lambda it: bool(it.grains and has_plates(it.scene.rock)), "rock.RockPart"),
)

OF_THE_START = ("contact", "material", "wall", "ring", "lubrication")
"""Sections of which fluid and grains are made, with no part of their own."""
OF_THE_RECORD = ("line", "permeability", "homogenise")
"""Sections that are measured in what a run has recorded, or by a command of its own."""
SECTIONS = tuple(
    name
    for name in Scene.model_fields
    if name in {*OF_THE_START, *OF_THE_RECORD, *(section for kind in KINDS for section in kind.sections)}
)
"""Sections that build something, in the order of a scene."""


def add_parts(system: System) -> Stepper:
    """Make all parts of a system, in their order; returns the first, which carries the physics."""
    name = "coupled.CoupledPart" if system.coupled else "fluid.FluidPart" if system.fluid else "grains.GrainsPart"
    stepper: Stepper = _made(name, system)
    system.parts.append(stepper)
    for kind in KINDS:
        if kind.wanted(system):
            system.parts.append(_made(kind.name, system))
    return stepper
