"""The parts there are, in the order of their columns, tables, arrays and state; each made where its sections are.

A part is imported where it is made, so that nothing of an absent section is.
"""

from collections.abc import Callable
from typing import NamedTuple, TypeVar

from porescale.builders.initial.frames import disc_count, free_rows
from porescale.builders.initial.rock import has_plates
from porescale.builders.stepper import Stepper
from porescale.builders.system import System
from porescale.common.record.part import Part
from porescale.scene.scene import Scene

P = TypeVar("P", bound=Part)
Parts = list[Part]


class Kind(NamedTuple):
    """sections : that it is built from;  wanted : whether a system has it;  make : of the system and the parts before
    it."""

    sections: tuple[str, ...]
    wanted: Callable[[System], bool]
    make: Callable[[System, Parts], Part]


def _one(kind: type[P], parts: Parts) -> P:
    """The part of a class that another one needs."""
    return next(part for part in parts if isinstance(part, kind))


def stepper_of(system: System) -> Stepper:
    """The part that advances a system: fluid, dry grains, or both."""
    if system.coupled:
        from porescale.builders.parts.coupled import CoupledPart

        return CoupledPart.build(system)
    if system.fluid:
        from porescale.builders.parts.fluid import FluidPart

        return FluidPart.build(system)
    from porescale.builders.parts.grains import GrainsPart

    return GrainsPart.build(system)


def _grain_series(system: System, parts: Parts) -> Part:
    from porescale.builders.parts.grain_series import GrainSeries

    return GrainSeries.build(system)


def _sleep(system: System, parts: Parts) -> Part:
    from porescale.builders.parts.sleep import SleepPart

    return SleepPart.build(system)


def _flow_series(system: System, parts: Parts) -> Part:
    from porescale.builders.parts.flow_series import FlowSeries
    from porescale.builders.parts.fluid import FluidPart

    return FlowSeries.build(system, _one(FluidPart, parts))


def _gate(system: System, parts: Parts) -> Part:
    from porescale.builders.parts.gate import GatePart

    return GatePart.build(system)


def _rectangles(system: System, parts: Parts) -> Part:
    from porescale.builders.parts.rectangles import RectanglesPart

    return RectanglesPart.build(system)


def _cell(system: System, parts: Parts) -> Part:
    from porescale.builders.parts.cell import CellPart

    return CellPart.build(system)


def _grain_cloud(system: System, parts: Parts) -> Part:
    from porescale.builders.parts.clouds import GrainCloud

    if system.scene.cell is None:
        return GrainCloud.build(system)
    from porescale.builders.parts.cell import CellPart

    return GrainCloud.build(system, _one(CellPart, parts).seen)


def _frame_cloud(system: System, parts: Parts) -> Part:
    from porescale.builders.parts.clouds import FrameCloud

    return FrameCloud.build(system)


def _bonds(system: System, parts: Parts) -> Part:
    from porescale.builders.parts.bonds import BondsPart

    return BondsPart.build(system)


def _energy(system: System, parts: Parts) -> Part:
    from porescale.builders.parts.energy import EnergyPart

    return EnergyPart.build(system)


def _grain_instruments(system: System, parts: Parts) -> Part:
    from porescale.builders.parts.grain_instruments import GrainInstruments

    return GrainInstruments.build(system)


def _flow_instruments(system: System, parts: Parts) -> Part:
    from porescale.builders.parts.flow_instruments import FlowInstruments
    from porescale.builders.parts.fluid import FluidPart

    return FlowInstruments.build(system, _one(FluidPart, parts))


def _control(system: System, parts: Parts) -> Part:
    from porescale.builders.parts.control import ControlPart

    return ControlPart.build(system)


def _rock(system: System, parts: Parts) -> Part:
    from porescale.builders.parts.bonds import BondsPart
    from porescale.builders.parts.rock import RockPart

    return RockPart.build(system, _one(BondsPart, parts))


def _free(system: System) -> bool:
    """Whether a scene with [grains] has any that forces move."""
    return bool(system.grains and system.scene.grains and free_rows(system.grains, system.frames, system.held).size > 0)


def _measures_grains(system: System) -> bool:
    """Whether a scene measures its grains beyond series.csv."""
    it = system.scene
    asked = it.region or it.coarse_graining or it.output.forces or it.output.contacts
    return bool(system.grains and it.grains and asked)


KINDS = (
    Kind(("grains",), _free, _grain_series),
    Kind(("sleep",), lambda it: bool(it.grains and it.scene.sleep), _sleep),
    Kind(("fluid",), lambda it: it.fluid is not None, _flow_series),
    Kind(("gate",), lambda it: it.scene.gate is not None, _gate),
    Kind(("rectangle",), lambda it: bool(it.scene.rectangle), _rectangles),
    Kind(("cell",), lambda it: bool(it.grains and it.scene.cell), _cell),
    Kind(("grains", "disc", "clump"), lambda it: bool(it.grains and disc_count(it.grains)), _grain_cloud),
    Kind(("segment", "polygon", "container"), lambda it: bool(it.frames), _frame_cloud),
    Kind(("bonds", "rock"), lambda it: bool(it.grains and (it.scene.bonds or it.scene.rock)), _bonds),
    Kind(("grains",), lambda it: bool(it.grains and it.scene.output.energy), _energy),
    Kind(("region", "coarse_graining"), _measures_grains, _grain_instruments),
    Kind(
        ("probe", "flux", "loads"),
        lambda it: bool(it.fluid and (it.scene.probe or it.scene.flux or it.scene.loads)),
        _flow_instruments,
    ),
    Kind(("control",), lambda it: len(it.recorded) > (2 if has_plates(it.scene) else 0), _control),
    Kind(("rock",), lambda it: bool(it.grains and has_plates(it.scene)), _rock),
)

OF_THE_START = ("contact", "material", "wall", "lubrication")
"""Sections of which fluid and grains are made, with no part of their own."""
OF_THE_RECORD = ("line", "permeability")
"""Sections that are measured in what a run has recorded."""
SECTIONS = tuple(
    name
    for name in Scene.model_fields
    if name in {*OF_THE_START, *OF_THE_RECORD, *(section for kind in KINDS for section in kind.sections)}
)
"""Sections that build something, in the order of a scene."""


def parts_of(system: System) -> tuple[Stepper, Parts]:
    """What carries the physics, and the other parts of a system."""
    stepper = stepper_of(system)
    parts: Parts = [stepper]
    for kind in KINDS:
        if kind.wanted(system):
            parts.append(kind.make(system, parts))
    return stepper, parts[1:]
