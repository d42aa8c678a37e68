"""The sections of a continuum scene.  SI numbers or texts with units; an absent section builds nothing."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, ClassVar, Literal

import pydantic

from continuum_sph.build.instruments import Level, Probe
from continuum_sph.scene.air_sections import Air
from continuum_sph.scene.material_file import with_material
from continuum_sph.scene.pile_sections import Sheet
from continuum_sph.scene.reservoir_sections import Pool
from continuum_sph.scene.soil_sections import Ground
from porescale.common.core.constants import GRAVITY
from porescale.common.core.errors import Fault
from porescale.common.schema.sections import Refused, Section, quantity

# Sound speed over the speed of free fall from the highest water: Mach number 0.1, so that density changes by 1 %.
CALM_MACH = 10.0

# Bounds of sections: no flow of water that anyone computes lies outside, and inside every product stays a number.
SMALLEST, LARGEST = 1e-6, 1e5  # m
WEAKEST = 1e-6  # m/s², other than none
MOST = 100_000_000  # particles: 60 GB
WHOLE = 1e-6  # share of a spacing by which a length may miss a whole number of them


def spacings(length: float, spacing: float) -> int:
    """The whole number (1 at least) of spacings nearest to a length, both in m."""
    return max(1, round(length / spacing))


class Tank(Section):
    """A rectangular tank, lower left inner corner at the origin.

    "slip" walls carry pressure only, "stick" walls hold the water as well, or floor and lid alone do.  wall_particles:
    "pressure" take the pressure of the water before them (Adami, Hu & Adams 2012), "images" are those of the paper
    (eqs 50, 51).
    """

    width: float = quantity("m", ge=SMALLEST, le=LARGEST, help="inner width of the tank")
    height: float = quantity("m", ge=SMALLEST, le=LARGEST, help="inner height of the tank")
    walls: Literal["slip", "stick", "floor and lid stick"] = "slip"
    wall_particles: Literal["pressure", "images"] = "pressure"
    lid: bool = pydantic.Field(True, description="close the tank, so that no splash is lost")


class Column(Section):
    """A rectangle of water at the start."""

    left: float = quantity("m", 0.0, ge=0, le=LARGEST, help="left edge of the water")
    bottom: float = quantity("m", 0.0, ge=0, le=LARGEST, help="lower edge of the water")
    width: float = quantity("m", ge=SMALLEST, le=LARGEST, help="width of the water")
    height: float = quantity("m", ge=SMALLEST, le=LARGEST, help="height of the water")


class Water(Section):
    """A weakly compressible liquid.

    pressure : at the start, "hydrostatic", that of fluids just let go ("released"), or "none"
    (density ρ0 everywhere, as in the paper);  push : "face" gives the particles of the right face √(2g(H-y)) to
    the right, as in figs 6 and 7 of the paper.
    """

    density: float = quantity("kg/m^3", 1000.0, ge=1e-2, le=1e5, help="density under the pressure of the air")
    viscosity: float = quantity("Pa s", 1.002e-3, ge=0, le=1e9, help="viscosity")
    sound_speed: float | None = quantity("m/s", None, ge=1e-3, le=1e6, help="speed of sound, at least 10 sqrt(2 g H)")
    exponent: float = quantity("", 7.0, ge=1.5, le=20, help="exponent of the equation of state")
    pressure: Literal["hydrostatic", "released", "none"] = "hydrostatic"
    push: Literal["none", "face"] = "none"
    column: tuple[Column, ...] = pydantic.Field(default=(), description="rectangles of water")


class Disc(Section):
    """A disc."""

    x: float = quantity("m", ge=0, le=LARGEST, help="centre")
    y: float = quantity("m", ge=0, le=LARGEST, help="centre, above the floor")
    radius: float = quantity("m", ge=SMALLEST, le=LARGEST, help="radius")


class Inclusion(Section):
    """A second fluid, in discs within the water: bubbles or drops.

    law : "liquid" (eq. 41), as stiff as the water unless sound_speed says otherwise; gas under the pressure of the air,
    "adiabatic", or "printed" (eqs 39, 40);  surface_tension : σ against the water;  cohesion : a of eq. 54 within it.
    """

    density: float = quantity("kg/m^3", 1.207, ge=1e-2, le=1e5, help="density under the pressure of the air")
    viscosity: float = quantity("Pa s", 1.810e-5, ge=0, le=1e9, help="viscosity")
    law: Literal["liquid", "adiabatic", "printed"] = "adiabatic"
    sound_speed: float | None = quantity("m/s", None, ge=1e-3, le=1e6, help="speed of sound of a liquid")
    pressure: float = quantity("Pa", 1e5, ge=1e-3, le=1e9, help="pressure of the air, of a gas")
    exponent: float | None = quantity("", None, ge=1.01, le=20, help="exponent: 7 of a liquid, 1.403 of a gas")
    surface_tension: float = quantity("N/m", 0.0, ge=0, le=1e6, help="surface tension against the water")
    cohesion: float = quantity("Pa m^4", 0.0, ge=0, le=1e6, help="a of eq. 54")
    disc: tuple[Disc, ...] = pydantic.Field(min_length=1, description="discs of the second fluid")


class Numerics(Section):
    """Particles and what corrects them.  The paper: kernel cubic, smoothing_ratio 1, smoothing_length evolved (eq. 52),
    density_filter (eq. 27), xsph, and neither density diffusion nor shifting nor corrected gradients.

    diffusion_of : what the density diffusion takes for noise, the departure from "hydrostatic" density, from a "linear"
    field, or every difference ("plain");  noise_floor : over the pressure under the deepest water; noise below it
    diffuses the more slowly the weaker it is, with 0 all of it at the pace of sound, and water at rest creeps;
    density_filter : steps between filters, 0 never.
    xsph moves particles with the smoothed velocity but continuity with their own: volume is lost where they differ.
    """

    spacing: float = quantity("m", ge=1e-6, le=1e3, help="spacing of the particles at the start")
    kernel: Literal["wendland", "cubic"] = "wendland"
    smoothing_ratio: float = quantity("", 1.3, ge=1, le=3, help="smoothing length over spacing")
    artificial_viscosity: float = quantity("", 0.05, ge=0, le=10, help="alpha of eq. 36")
    artificial_viscosity_2: float = quantity("", 0.0, ge=0, le=10, help="beta of eq. 36")
    softening: float = quantity("", 0.1, ge=1e-6, le=10, help="epsilon of eq. 36")
    density_diffusion: float = quantity("", 0.1, ge=0, le=0.2, help="delta of the density diffusion")
    diffusion_of: Literal["hydrostatic", "linear", "plain"] = "hydrostatic"
    noise_floor: float = quantity("", 1e-3, ge=0, le=1, help="noise over the water's weight; below it diffuses slowly")
    density_filter: int = pydantic.Field(0, ge=0, le=1_000_000, description="steps between density filters (eq. 27)")
    gradient: Literal["plain", "corrected"] = "plain"
    shifting: float = quantity("", 0.0, ge=0, le=4, help="strength of particle shifting, about 1")
    smoothing_length: Literal["fixed", "evolved"] = "fixed"
    xsph: float = quantity("", 0.0, ge=0, le=1, help="epsilon of eq. 53")
    tension: Literal["cut", "kept"] = "kept"
    courant: float = quantity("", 0.25, ge=1e-3, le=0.5, help="share of the acoustic step of eq. 49")
    skin: float = quantity("", 0.25, ge=1e-3, le=2, help="largest skin of the pair lists over h; less where it pays")


class Time(Section):
    """How long a run lasts."""

    end: float = quantity("s", ge=1e-9, le=1e9, help="physical time to simulate")


class Output(Section):
    """What is recorded when; recording never changes the physics."""

    snapshot_interval: float = quantity("s", ge=1e-9, le=1e9, help="time between snapshots (frames of the film)")
    series_interval: float = quantity("s", ge=1e-9, le=1e9, help="time between rows of series.csv")
    checkpoint_seconds: float = quantity("s", 30.0, ge=1e-3, le=1e9, help="wall-clock time between checkpoints")
    energy: bool = pydantic.Field(False, description="energy book of the water, as columns of series.csv")


class Scene(Section):
    """A tank with water, soil, or both."""

    elsewhere: ClassVar[Mapping[str, str]] = {"domain": "porescale"}

    title: str = ""
    gravity: float = quantity("m/s^2", GRAVITY, ge=0, le=1e6, help="acceleration of free fall, downwards")
    tank: Tank
    water: Water = Water()
    soil: Ground | None = None
    air: Air | None = None
    inclusion: Inclusion | None = None
    pile: Sheet | None = None
    reservoir: tuple[Pool, ...] = ()
    probe: tuple[Probe, ...] = ()
    level: tuple[Level, ...] = ()
    numerics: Numerics
    time: Time
    output: Output

    @pydantic.model_validator(mode="before")
    @classmethod
    def _measured(cls, table: Any, info: pydantic.ValidationInfo) -> Any:
        return with_material(table, (info.context or {}).get("folder"))

    @property
    def head(self) -> float:
        """Height of the highest water above the floor, m."""
        tops = [column.bottom + column.height for column in self.water.column]
        return max([*tops, *(pool.highest for pool in self.reservoir)], default=0.0)

    @property
    def fall_speed(self) -> float:
        """Speed of free fall from there, m/s."""
        return float((2.0 * self.gravity * self.head) ** 0.5)

    @property
    def sound_speed(self) -> float:
        """c0, m/s: as given, or ten times the fall speed."""
        given = self.water.sound_speed
        return given if given is not None else CALM_MACH * self.fall_speed

    @property
    def calm(self) -> float:
        """Speed of sound waves whose pressure is the noise floor, m/s."""
        pressure = 0.5 * self.numerics.noise_floor * self.fall_speed**2  # over the density of the water
        return pressure / self.sound_speed if pressure > 0.0 else 0.0

    @property
    def inner(self) -> tuple[float, float]:
        """Inner width and height of the tank, m, in whole spacings, from which those given may differ by round-off."""
        spacing = self.numerics.spacing
        return spacings(self.tank.width, spacing) * spacing, spacings(self.tank.height, spacing) * spacing

    @pydantic.model_validator(mode="after")
    def _fits(self) -> Scene:
        tank, spacing = self.tank, self.numerics.spacing
        faults = self._unresolved()
        if self.soil is not None:
            faults += self.soil.faults(tank.width, tank.height, WHOLE * spacing)
        elif not self.water.column:
            faults.append(Fault("water.column", None, "is missing", repair="give at least one rectangle of water"))
        for index, pool in enumerate(self.reservoir):
            faults += pool.faults(f"reservoir[{index}]", *self.inner, spacing)
        if self.pile is not None:
            faults += self.pile.faults(*self.inner, spacing)
            if self.soil is None:
                faults.append(Fault("pile", "given", "needs soil beside it", repair="add [soil]"))
        if self.output.energy and not (self.water.column or self.reservoir):
            faults.append(Fault("output.energy", True, "is of water, of which there is none", repair="leave it out"))
        if self.reservoir and self.soil is None:
            faults.append(Fault("reservoir", "given", "needs soil beside it", repair="add [soil]"))
        if self.air is not None and (self.soil is None or not (self.water.column or self.reservoir)):
            faults.append(Fault("air", "given", "needs soil and water", repair="add [soil] and [[water.column]]"))
        if self.air is not None and self.soil is not None and self.soil.saturated:
            faults.append(Fault("air", "given", "has no room in full pores", repair="take out soil.saturated"))
        for index, column in enumerate(self.water.column):
            key = f"water.column[{index}]"
            slack = WHOLE * spacing
            if column.left + column.width > tank.width + slack:
                faults.append(
                    Fault(f"{key}.width", column.width, "reaches beyond the tank", "m",
                          f"<= {tank.width - column.left:g}")
                )  # fmt: skip
            if column.bottom + column.height > tank.height + slack:
                faults.append(
                    Fault(f"{key}.height", column.height, "reaches beyond the tank", "m",
                          f"<= {tank.height - column.bottom:g}")
                )  # fmt: skip
            if min(column.width, column.height) < 4.0 * spacing:
                finest = min(column.width, column.height) / 4.0
                faults.append(
                    Fault("numerics.spacing", spacing, f"leaves {key} fewer than 4 particles across", "m",
                          f"<= {finest:g}")
                )  # fmt: skip
        columns = self.water.column
        alone = len(columns) == 1 and columns[0].left == columns[0].bottom == 0.0
        if self.water.pressure == "released" and columns and not alone:
            faults.append(
                Fault("water.pressure", "released", "is known for one column in the left corner only",
                      repair='use "hydrostatic", or one column with left = bottom = 0')
            )  # fmt: skip
        faults += self._misplaced()
        if 0.0 < self.gravity < WEAKEST:
            faults.append(Fault("gravity", self.gravity, "is too weak to move water", "m/s^2", f"0 or >= {WEAKEST:g}"))
        if self.gravity == 0.0 and (columns or self.reservoir) and self.water.sound_speed is None:
            faults.append(Fault("water.sound_speed", None, "is needed when there is no gravity to take it from"))
        if faults:
            raise Refused(*faults)
        return self

    def _misplaced(self) -> list[Fault]:
        """Discs of the second fluid not within water or not resolved, and choices that have no room for one."""
        if self.inclusion is None:
            return []
        faults = []
        for index, disc in enumerate(self.inclusion.disc):
            key, r = f"inclusion.disc[{index}]", disc.radius
            held = any(
                c.left <= disc.x - r and disc.x + r <= c.left + c.width
                and c.bottom <= disc.y - r and disc.y + r <= c.bottom + c.height
                for c in self.water.column
            )  # fmt: skip
            if not held:
                faults.append(Fault(key, (disc.x, disc.y), "does not lie within a column of water", "m"))
            if r < 3.0 * self.numerics.spacing:
                faults.append(
                    Fault("numerics.spacing", self.numerics.spacing, f"leaves {key} fewer than 6 particles across", "m",
                          f"<= {r / 3.0:g}")
                )  # fmt: skip
        if self.tank.wall_particles == "images":
            faults.append(Fault("tank.wall_particles", "images", "have the pressure of one fluid only",
                                repair='use "pressure" with an inclusion'))  # fmt: skip
        return faults

    def _unresolved(self) -> list[Fault]:
        """Lengths of tank and water that are not whole spacings, and a spacing that makes too many particles."""
        spacing, tank, faults = self.numerics.spacing, self.tank, []
        count = tank.width * tank.height / spacing**2
        if count > MOST:
            finest = (tank.width * tank.height / MOST) ** 0.5
            faults.append(
                Fault(
                    "numerics.spacing",
                    spacing,
                    f"makes room for {count:.2g} particles in the tank",
                    "m",
                    f">= {finest:.3g}",
                )
            )
        held: list[tuple[str, Tank | Column]] = [("tank", tank)]
        held += [(f"water.column[{index}]", column) for index, column in enumerate(self.water.column)]
        for key, body in held:
            for name in ("left", "bottom", "width", "height") if isinstance(body, Column) else ("width", "height"):
                length = getattr(body, name)
                share, whole = length / spacing, spacings(length, spacing)
                if length > 0.0 and abs(share - whole) > WHOLE * max(1.0, share):
                    problem = f"is {share:.6g} spacings of {spacing:.6g} m, not whole ones"
                    faults.append(
                        Fault(f"{key}.{name}", length, problem, "m",
                              repair=f"{whole * spacing:.9g} m or a spacing of {length / whole:.9g} m would be")
                    )  # fmt: skip
        return faults
