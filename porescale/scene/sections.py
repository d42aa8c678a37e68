"""The sections of a scene.  SI numbers or texts with units; an absent section builds nothing."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, ClassVar

import pydantic

from porescale.build.checks.frame_places import judge_sections
from porescale.build.lattice import disagreements
from porescale.common.core.constants import GRAVITY
from porescale.common.core.errors import Fault
from porescale.common.schema.sections import Refused, Section, quantity
from porescale.lbm.scales import NAMES
from porescale.scene.bodies_of_grains import Clump, Controlled, by_hand
from porescale.scene.bonds import Bonds, judge_bonds
from porescale.scene.cell import Cell, judge_cell
from porescale.scene.contact import Contact, Material, judge_contact
from porescale.scene.discs import Disc, Lubrication
from porescale.scene.fluid import Fluid
from porescale.scene.frames import Container, PolygonBody, SegmentBody
from porescale.scene.measures import FieldName, Flux, Homogenise, Line, Loads, Permeability, Probe
from porescale.scene.packing import Circles, judged_grading, with_circles, with_consequences
from porescale.scene.rectangles import Rectangle
from porescale.scene.regions import CoarseGraining, Region
from porescale.scene.rock import Rock, judge_rock
from porescale.scene.sides import Domain
from porescale.scene.sleep import Sleep, judge_sleep
from porescale.scene.walls import Wall, judge_walls

LENGTH: Any = {"ge": 1e-9, "le": 1e3}
TIME: Any = {"ge": 1e-12, "le": 1e9}
DENSITY: Any = {"ge": 1e-3, "le": 1e5}
FRICTION: Any = {"ge": 0, "le": 1e3}
"""Ranges, SI, far beyond what grains and water need: what lies outside is a slip of unit or exponent, and would
end in numbers that are none."""
EDGE = 1e-9
"""Relative slack of places at the edge of the box."""
PLACE = 1e3
SPEED = 1e4
SPIN = 1e7
FORCE = 1e12
MATERIAL = pydantic.Field("", description="name of its material (default: the first)")


class Time(Section):
    """How long a run lasts."""

    end: float = quantity("s", **TIME, help="physical time to simulate")


class Output(Section):
    """What is recorded when; recording never changes the physics."""

    snapshot_interval: float = quantity("s", **TIME, help="time between snapshots (frames of the film)")
    series_interval: float = quantity("s", **TIME, help="time between rows of series.csv")
    checkpoint_seconds: float = quantity("s", 30.0, gt=0, le=1e9, help="wall-clock time between checkpoints")
    fields: tuple[FieldName, ...] = pydantic.Field(
        (), description="fields of snapshots besides velocity and pressure, each with a picture"
    )
    contacts: bool = pydantic.Field(False, description="contacts of grains with their forces in snapshots")
    forces: bool = pydantic.Field(
        False, description="force and moment of grains on every wall, plate, rectangle and held disc: forces.csv"
    )
    energy: bool = pydantic.Field(False, description="energy book of the grains, as columns of series.csv")


class Packing(Section):
    """Grains placed at random without overlap, then settled dry under gravity until they fill a rectangle.

    Their number is packing_fraction * width * height over the mean grain area; how high they stand in the end, friction
    and seed decide.  With settle = false they stay where they were placed (packing_fraction at most 0.8); with compress
    = true they are grown and pressed together in the whole box until it has that fraction, or void ratio, to round-off.
    """

    left: float = quantity("m", ge=0, le=PLACE, help="left edge of the rectangle")
    bottom: float = quantity("m", 0.0, ge=0, le=PLACE, help="lower edge of the rectangle")
    width: float = quantity("m", **LENGTH, help="width of the rectangle")
    height: float = quantity("m", **LENGTH, help="height of the rectangle")
    diameter: float = quantity("m", **LENGTH, help="mean diameter of the grains")
    size_spread: float = quantity("", 0.1, ge=0, lt=1, help="half width of the diameters over their mean")
    packing_fraction: float = quantity("", 0.81, ge=1e-3, le=0.84, help="grain area over the rectangle's area")
    seed: int = pydantic.Field(1, ge=0, description="seed of the random placement")
    settle: bool = pydantic.Field(True, description="let the grains settle dry before the run")
    settling_friction: float = quantity("", 0.3, **FRICTION, help="friction while preparing: little packs densely")
    void_ratio: float | None = quantity("", None, gt=0, lt=1e3, help="pores over grains, instead of packing_fraction")
    grading: tuple[tuple[float, float], ...] = quantity(
        "m", (), help="grading curve, [diameter, percent finer by mass] from 0 to 100, instead of diameter"
    )
    log_spread: float | None = quantity(
        "", None, ge=0, le=0.46, help="deviation of the logarithm of lognormal diameters, instead of size_spread"
    )
    compress: bool = pydantic.Field(False, description="grow in place to packing_fraction, without gravity")
    pressure: float | None = quantity("Pa", None, gt=0, le=1e12, help="mean stress to compress to, without gravity")
    material: str = MATERIAL

    @pydantic.model_validator(mode="before")
    @classmethod
    def _consequences(cls, table: Any) -> Any:
        return with_consequences(table)

    @pydantic.field_validator("grading")
    @classmethod
    def _a_curve(cls, curve: tuple[tuple[float, float], ...]) -> tuple[tuple[float, float], ...]:
        return judged_grading(curve)


class Grain(Section):
    """One grain, placed by hand."""

    x: float = quantity("m", ge=-PLACE, le=PLACE, help="centre")
    y: float = quantity("m", ge=-PLACE, le=PLACE, help="centre")
    diameter: float = quantity("m", **LENGTH, help="diameter")
    velocity: tuple[float, float] = quantity("m/s", (0.0, 0.0), ge=-SPEED, le=SPEED, help="velocity at the start")
    spin: float = quantity("rad/s", 0.0, ge=-SPIN, le=SPIN, help="angular velocity at the start, counter-clockwise")
    material: str = MATERIAL


class Grains(Section):
    """The grains: a packing, grains placed by hand, or both."""

    density: float = quantity("kg/m^3", **DENSITY, help="density of the grains")
    hydraulic_radius_ratio: float | None = quantity(
        "", None, ge=0.01, le=1, help="radius that the fluid sees over the mechanical radius, 0.7 to 0.9 in dense beds"
    )
    packing: Packing | None = None
    overlap: float = quantity(
        "", 1e-3, ge=0, le=0.1, help="overlap over diameter up to which grains placed by hand may start (circles: 0.02)"
    )
    grain: tuple[Grain, ...] = ()
    circles: Circles | None = None

    @pydantic.model_validator(mode="before")
    @classmethod
    def _from_file(cls, table: Any, info: pydantic.ValidationInfo) -> Any:
        return with_circles(table, (info.context or {}).get("folder"))


class Gate(Section):
    """An upright plate without thickness, over the whole height, that holds grains and water until it opens."""

    x: float = quantity("m", **LENGTH, help="where the gate stands")
    opens_at: float = quantity("s", 0.0, ge=0, le=1e9, help="time at which it opens")
    lift_speed: float | None = quantity(
        "m/s", None, ge=1e-9, le=SPEED, help="speed at which it rises; left out, it vanishes at once"
    )
    friction: float = quantity("", 0.0, **FRICTION, help="friction coefficient between gate and grains")


class Scene(Section):
    """A scene: box, time, output, and the parts it needs."""

    elsewhere: ClassVar[Mapping[str, str]] = {"tank": "continuum-sph"}

    title: str = ""
    gravity: tuple[float, float] = quantity("m/s^2", (0.0, -GRAVITY), ge=-1e6, le=1e6, help="acceleration of free fall")
    domain: Domain
    time: Time
    output: Output
    fluid: Fluid | None = None
    grains: Grains | None = None
    contact: Contact | None = None
    material: tuple[Material, ...] = ()
    clump: tuple[Clump, ...] = ()
    segment: tuple[SegmentBody, ...] = ()
    polygon: tuple[PolygonBody, ...] = ()
    container: tuple[Container, ...] = ()
    bonds: tuple[Bonds, ...] = ()
    rock: Rock | None = None
    control: tuple[Controlled, ...] = ()
    wall: tuple[Wall, ...] = ()
    cell: Cell | None = None
    gate: Gate | None = None
    disc: tuple[Disc, ...] = ()
    rectangle: tuple[Rectangle, ...] = ()
    probe: tuple[Probe, ...] = ()
    line: tuple[Line, ...] = ()
    flux: tuple[Flux, ...] = ()
    loads: Loads | None = None
    permeability: Permeability | None = None
    region: tuple[Region, ...] = ()
    coarse_graining: CoarseGraining | None = None
    homogenise: Homogenise | None = None
    lubrication: Lubrication | None = None
    sleep: Sleep | None = None

    @pydantic.field_validator("bonds", mode="before")
    @classmethod
    def _one_or_more(cls, given: Any) -> Any:
        """[bonds] is the same as one [[bonds]]."""
        return [given] if isinstance(given, Mapping) else given

    @pydantic.field_validator("fluid")
    @classmethod
    def _agreed(cls, fluid: Fluid | None, info: pydantic.ValidationInfo) -> Fluid | None:
        """Four numbers of a lattice must agree; said here, since their repair depends on the box."""
        if fluid is None or any(getattr(fluid, name) is None for name in NAMES):
            return fluid
        domain = info.data.get("domain")  # absent where it is itself at fault
        width, height = (domain.width, domain.height) if domain else (0.0, 0.0)
        faults = disagreements({name: getattr(fluid, name) for name in NAMES}, width, height)
        if faults:
            raise Refused(*faults)
        return fluid

    @pydantic.model_validator(mode="after")
    def _complete(self) -> Scene:
        faults = [*self._needed(), *self._places()]
        if faults:
            raise Refused(*faults)
        return self

    def _needed(self) -> list[Fault]:
        """Sections that others need, or that need others."""
        faults = []
        if self.fluid is None and self.grains is None:
            faults.append(Fault("fluid, grains", None, "nothing to simulate", repair="add [fluid], [grains] or both"))
        if self.grains is not None and self.contact is None:
            repair = "add [contact] with stiffness and restitution"
            faults.append(Fault("contact", None, "grains need a contact law", repair=repair))
        if self.grains is None and self.contact is not None:
            faults.append(
                Fault("contact", None, "there are no grains to touch", repair="add [grains] or remove [contact]")
            )
        if self.fluid and self.grains and self.grains.hydraulic_radius_ratio is None:
            faults.append(
                Fault("grains.hydraulic_radius_ratio", None, "every scene with grains in fluid states it",
                      allowed=">= 0.01 and <= 1",
                      repair="0.8 opens the pores of a dense bed; 1 seals a bed at rest, since pores in two "
                             "dimensions do not connect; 1 is right for single grains")
            )  # fmt: skip
        if self.fluid is None:
            given = {"probe": self.probe, "line": self.line, "flux": self.flux, "loads": self.loads,
                     "permeability": self.permeability, "output.fields": self.output.fields}  # fmt: skip
            faults += [Fault(name, None, "there is no fluid to measure", repair="add [fluid] or leave it out")
                       for name, section in given.items() if section]  # fmt: skip
        if self.grains is None:
            asked = {"region": self.region, "coarse_graining": self.coarse_graining,
                     "output.contacts": self.output.contacts, "output.forces": self.output.forces,
                     "output.energy": self.output.energy}  # fmt: skip
            faults += [Fault(name, None, "there are no grains to measure", repair="add [grains] or leave it out")
                       for name, section in asked.items() if section]  # fmt: skip
        if self.grains and self.grains.packing is None and not (by_hand(self) or self.segment or self.polygon):
            faults.append(Fault("grains", None, "holds no grain", repair="add [grains.packing] or [[grains.grain]]"))
        of_grains = {"material": self.material, "clump": self.clump, "control": self.control}
        if self.grains is None:
            faults += [Fault(name, None, "there are no grains", repair="add [grains] or leave it out")
                       for name, section in of_grains.items() if section]  # fmt: skip
        if self.grains and self.contact:
            faults += judge_contact(self)
        faults += [*judge_walls(self), *judge_cell(self), *judge_sections(self), *judge_bonds(self), *judge_rock(self)]
        faults += judge_sleep(self)
        if self.lubrication and not (self.fluid and (self.grains or self.disc)):
            faults.append(Fault("lubrication", None, "there are no grains in fluid", repair="leave it out"))
        if self.permeability and self.fluid and self.grains is None:
            faults.append(Fault("permeability", None, "there is no bed", repair="add [grains] or leave it out"))
        packing = self.grains.packing if self.grains else None
        if self.permeability and self.grains and packing is None and self.permeability.window is None:
            repair = "add [permeability.window] with left, bottom, width, height"
            faults.append(Fault("permeability.window", None, "is needed where there is no packing", repair=repair))
        return faults

    def _places(self) -> list[Fault]:
        """What must lie in the box, and numbers of bodies that must exist."""
        box = self.domain.width, self.domain.height
        points = [(f"probe[{k}]", (it.x, it.y)) for k, it in enumerate(self.probe)]
        for name, sections in (("line", self.line), ("flux", self.flux)):
            points += [(f"{name}[{k}].{end}", getattr(it, end)) for k, it in enumerate(sections)
                       for end in ("start", "end")]  # fmt: skip
        for k, region in enumerate(self.region):
            corners = ("lower", region.lower), ("upper", region.upper)
            points += [(f"region[{k}].{end}", at) for end, at in corners if not any(self.domain.periodic)]
        if self.permeability and (window := self.permeability.window):
            points.append(("permeability.window", (window.left, window.bottom)))
            points.append(("permeability.window", (window.left + window.width, window.bottom + window.height)))
        faults = [
            Fault(key, f"({at[0]:g}, {at[1]:g})", "is outside the box", "m", repair="move it inside")
            for key, at in points
            if not all(-EDGE * size <= value <= (1 + EDGE) * size for value, size in zip(at, box, strict=True))
        ]
        if self.gate is not None and not self.gate.x < self.domain.width:
            faults.append(
                Fault("gate.x", self.gate.x, "is outside the box", "m", f"< {self.domain.width:g}", "move it inside")
            )
        for number in self.loads.discs if self.loads else ():
            if not 0 <= number < len(self.disc):
                allowed = f"0 to {len(self.disc) - 1}" if self.disc else "none: there is no [[disc]]"
                faults.append(Fault("loads.discs", number, "there is no such disc", "", allowed))
        for number in self.loads.rectangles if self.loads else ():
            if not 0 <= number < len(self.rectangle):
                allowed = f"0 to {len(self.rectangle) - 1}" if self.rectangle else "none: there is no [[rectangle]]"
                faults.append(Fault("loads.rectangles", number, "there is no such rectangle", "", allowed))
        return faults
