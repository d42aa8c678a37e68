"""Soil in a tank: particles, their material law, what is recorded of them, and checks of their state."""

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from continuum_sph.builders.assembly import Assembly
from continuum_sph.builders.parts.material import banded, material_of
from continuum_sph.builders.parts.sheet_pile import sheet_pile
from continuum_sph.builders.sanity import (
    JumpCheck,
    Now,
    Range,
    require_distinct,
    require_finite,
    require_step,
    require_within,
)
from continuum_sph.scene.numerics import NumericsSection
from continuum_sph.scene.sections import Scene
from continuum_sph.scene.soil import Outline, SoilSection
from continuum_sph.seepage.mixture import LEAST_POROSITY
from continuum_sph.seepage.sheet_pile import CutPairList, Pile
from continuum_sph.soil import Material, Soil, SoilFlow, SoilLaw, porosity
from continuum_sph.soil.parameters import RULES
from continuum_sph.soil.softening import averages_of, band_width
from continuum_sph.soil.steadying import WEIGHTLESS, steadied
from continuum_sph.soil.stress import XX, XY, YY, ZZ
from continuum_sph.soil.walls import HOLDING, SLIPPING
from continuum_sph.water.image_walls import facing
from continuum_sph.water.pressure_walls import tank_walls
from continuum_sph.water.smoothing import Smoothing
from porescale.common.core.constants import GRAVITY
from porescale.common.core.errors import Fault, InputError
from porescale.common.core.types import Floats
from porescale.common.neighbors import PairList, square_lattice
from porescale.common.record.model import Cloud, Snapshot
from porescale.common.record.part import Part

NO_PILE = np.zeros((0, 2)), np.zeros((0, 4)), np.zeros(0, np.int64)
REPAIR = "raise soil.stiffness or soil.numerics.damping, or lower numerics.courant"
LEAST = float(np.finfo(np.float64).tiny)  # of what is above zero
DEEPEST = 0.5  # of a porosity at the start, left when soil is compressed out of bounds


class SoilPart(Part):
    """Soil in a tank."""

    def __init__(self, scene: Scene, flow: SoilFlow) -> None:
        self.flow = flow
        self.first = flow.soil.x[: flow.soil.soil].copy()  # (soil, 2) m, where displacements count from
        self.counted = soil_section(scene).numerics.settle == 0.0
        self.jumps = JumpCheck(flow.law.spacing)

    def after(self) -> None:
        """Displacements count from now if the soil has just settled; take the time for the next check."""
        if not self.counted and self.flow.time >= self.flow.law.settle:
            self.first[:] = self.flow.soil.x[: len(self.first)]
            self.counted = True
        self.jumps.add_time(self.flow.time, self.flow.max_speed)

    def check(self) -> None:
        """Raise Unstable when soil is nowhere or where none could have come to, where another is, faster than its
        own sound, denser than its grains, under a stress that no blow makes, or when the next step is longer than it
        may be.
        """
        flow, soil, n = self.flow, self.flow.soil, self.flow.soil.soil
        now = Now(flow.step, flow.time, REPAIR)
        recorded = {
            "position": ("m", soil.x[:n]), "velocity": ("m/s", soil.v[:n]), "density": ("kg/m³", soil.density),
            "mass": ("kg/m", soil.mass[:n]), "stress": ("Pa", soil.stress[:n]),
            "plastic strain": ("", soil.plastic_shear), "opening": ("", soil.separation_strain),
            "acceleration": ("m/s²", soil.acceleration),
        }  # fmt: skip
        require_finite(recorded, now, "soil particle")
        self.jumps.check(soil.x[:n], soil.mass[:n], now)
        require_distinct(soil.x, np.arange(n), now)
        sound = flow.sound_rate * flow.law.smoothing.length
        for values, least, most, name, unit in (
            (soil.mass[:n], LEAST, np.inf, "mass", "kg/m"),
            (soil.density, LEAST, np.inf, "density", "kg/m³"),
            (porosity(soil.density, soil.material[:n], flow.table), -DEEPEST, 1.0, "porosity", ""),
            (np.hypot(soil.v[:n, 0], soil.v[:n, 1]), 0.0, sound, "speed", "m/s"),
            # A blow at the speed of sound is one of ρ c², the stress of a strain of one.
            (np.abs(soil.stress[:n]).max(axis=1), 0.0, soil.density * sound * sound, "stress", "Pa"),
            (soil.plastic_shear, 0.0, np.inf, "plastic strain", ""),
            (soil.separation_strain, 0.0, np.inf, "opening", ""),
        ):
            require_within(values, Range(name, unit, least, most), np.arange(n), soil.x, now)
        limits = flow.law.limits(float(np.hypot(*soil.acceleration.T).max(initial=0.0)), flow.sound_rate, flow.limit)
        require_step(flow.next_step, limits, RULES, soil.x, soil.acceleration, soil.density, now)

    def displacement(self) -> NDArray[np.float64]:
        """How far each particle has come since the start, or since it settled, (soil,) m."""
        moved: NDArray[np.float64] = np.hypot(*(self.flow.soil.x[: len(self.first)] - self.first).T)
        return moved

    def row(self) -> dict[str, float]:
        """Columns of the soil: position, motion, stress, and how the step was chosen.

        front (m) : right edge of the foremost particle of soil
        highest soil (m) : upper edge of the highest particle
        largest displacement (m) : of any particle since the start
        mean displacement (m) : of all particles since the start
        displacement of 95 % (m) : which 95 % of the particles do not exceed
        fastest (m/s) : largest speed of a particle
        kinetic energy (J/m) : per metre of depth
        potential energy (J/m) : per metre of depth, from the floor
        momentum x (kg/s) : per metre of depth
        stress upright over weight () : sum of V σ_yy over that of m g y; 1 at rest, free at the top
        stress across over upright () : ratio of the mean stresses, K0 at rest
        plastic strain () : mean plastic shear strain
        volume (m2) : of the soil, per metre of depth
        share come apart () : share of the volume that opened where the soil came apart
        mass (kg/m) : per metre of depth
        stops at walls () : how often a particle was stopped at a wall, since the start
        steps limited by RULE () : number of steps whose length sound, acceleration or the other layers decided
        """
        flow, soil, n = self.flow, self.flow.soil, self.flow.soil.soil
        half, gravity = 0.5 * flow.law.spacing, -flow.law.gravity[1]
        x, v, mass, stress = soil.x[:n], soil.v[:n], soil.mass[:n], soil.stress[:n]
        volume, moved = mass / soil.density, self.displacement()
        weight = gravity * float((mass * x[:, 1]).sum())
        upright, across = float((volume * stress[:, YY]).sum()), float((volume * stress[:, XX]).sum())
        return {
            "front (m)": float(x[:, 0].max()) + half,
            "highest soil (m)": float(x[:, 1].max()) + half,
            "largest displacement (m)": float(moved.max()),
            "mean displacement (m)": float(moved.mean()),
            "displacement of 95 % (m)": float(np.quantile(moved, 0.95)),
            "fastest (m/s)": float(np.hypot(v[:, 0], v[:, 1]).max()),
            "kinetic energy (J/m)": 0.5 * float((mass * (v * v).sum(axis=1)).sum()),
            "potential energy (J/m)": weight,
            "momentum x (kg/s)": float((mass * v[:, 0]).sum()),
            "stress upright over weight ()": upright / weight if weight > 0.0 else 0.0,
            "stress across over upright ()": across / upright if upright > 0.0 else 0.0,
            "plastic strain ()": float(soil.plastic_shear.mean()),
            "volume (m2)": float(volume.sum()),
            "share come apart ()": float(
                (soil.separation_strain * volume / (1.0 + soil.separation_strain)).sum() / volume.sum()
            ),
            "mass (kg/m)": float(mass.sum()),
            "stops at walls ()": float(flow.stopped),
            **{f"steps limited by {rule} ()": float(k) for rule, k in zip(RULES, flow.limited, strict=True)},
        }

    def motion(self) -> tuple[Floats, Floats]:
        """Positions (n, 2) m and velocities (n, 2) m/s of the soil; views."""
        soil = self.flow.soil
        return soil.x[: soil.soil], soil.v[: soil.soil]

    def masses(self) -> Floats:
        """Masses of the soil, (n,) kg/m; a view."""
        return self.flow.soil.mass[: self.flow.soil.soil]

    def cloud(self) -> Cloud:
        """The soil: velocity, displacement, stress, what yielded and what came apart."""
        soil, n = self.flow.soil, self.flow.soil.soil
        velocity = np.zeros((n, 3))
        velocity[:, :2] = soil.v[:n]
        stress = soil.stress[:n]
        data: dict[str, NDArray[Any]] = {
            "velocity": velocity,
            "displacement": self.displacement(),
            "mean_stress": 0.5 * (stress[:, XX] + stress[:, YY]),
            "stress_xx": stress[:, XX].copy(),
            "stress_yy": stress[:, YY].copy(),
            "stress_xy": stress[:, XY].copy(),
            "stress_zz": stress[:, ZZ].copy(),
            "plastic_strain": soil.plastic_shear.copy(),
            "opening": soil.separation_strain.copy(),
            "porosity": porosity(soil.density, soil.material[:n], self.flow.table),
        }
        units = {name: "Pa" for name in data if "stress" in name}
        units |= {"velocity": "m/s", "displacement": "m"}
        return Cloud(soil.x[:n].copy(), data, units)

    def show(self, snapshot: Snapshot) -> None:
        """Add all particles, soil and walls, to the snapshot."""
        snapshot.clouds["particles"] = self.cloud()

    def state(self) -> dict[str, Any]:
        """Everything that later steps depend on."""
        return {"flow": self.flow.state(), "first": self.first.copy(), "counted": self.counted}

    def restore(self, state: dict[str, Any]) -> None:
        """Go on bit for bit from a state of a part of the same scene."""
        self.flow.restore(state["flow"])
        self.first[:], self.counted = state["first"], bool(state["counted"])
        self.jumps.reset()


def assemble(scene: Scene) -> Assembly:
    """Build the flow and the parts of a scene of soil in a tank."""
    flow = soil_flow(scene)
    part = SoilPart(scene, flow)
    return Assembly(flow, [part], part, REPAIR)


def geostatic(depth: Floats, material: Material, gravity: float = GRAVITY, rest: float | None = None) -> Floats:
    """Stress (n, 4) Pa at a ``depth`` (n,) m below level ground, σ_xx = K0 σ_yy."""
    weight = material.density * gravity * np.maximum(depth, 0.0)
    k0 = material.rest if rest is None else rest
    across = material.poisson * (1.0 + k0) * weight
    return np.column_stack((k0 * weight, weight, np.zeros_like(weight), across))


def placed(
    x: Floats,
    stress: Floats,
    tank: tuple[float, float],
    law: SoilLaw,
    *,
    floor: str = "hold",
    sides: str = "slip",
    skin: float,
    pile: Pile | None = None,
    hasty: bool = False,
) -> SoilFlow:
    """Soil at ``x`` (n, 2) m with ``stress`` (n, 4) Pa in a tank (width, height), m, lower left corner at the origin.

    floor, sides : "hold" the soil or let it "slip", sides "none": endless soil, periodic across;  skin : of the pair
    list, over the smoothing length;  pile : in the soil of a closed tank;  hasty : rates of the initial state are not
    worked out yet, so that no kernel runs.
    """
    (width, height), spacing, material = tank, law.spacing, law.materials[0]
    layers = math.ceil(law.smoothing.support / spacing - 0.5 - 1e-9)
    closed = sides != "none"
    tank_sides = tank_walls(width, height, spacing, layers, sides=closed)
    piled, behind, side = pile.particles(layers, height) if pile else NO_PILE
    walls = np.concatenate((tank_sides, piled))
    n, count = len(x), len(x) + len(walls)
    number = np.zeros(count, np.int64)
    beside = (walls[:, 0] < 0.0) | (walls[:, 0] > width)
    below = walls[:, 1] < 0.0
    # In a corner both walls reverse the velocity, as a no-slip wall does.
    slips = {"hold": HOLDING, "slip": SLIPPING}
    kinds = np.where(beside, slips.get(sides, HOLDING), slips[floor])
    number[n:] = np.where(beside & below, HOLDING, kinds)
    if pile:
        number[count - len(piled) :] = HOLDING if pile.rough else SLIPPING
    soil = Soil(
        n,
        np.concatenate((x, walls)),
        np.zeros((count, 2)),
        np.full(count, material.density * spacing**2),
        np.full(n, material.density),
        np.concatenate((stress, np.zeros((len(walls), 4)))),
        number,
    )
    margin = layers * spacing
    lower, upper = (0.0, 0.0) if closed else (-math.inf, 0.0), (width, math.inf) if closed else (math.inf, math.inf)
    soil.facing[n:] = np.concatenate((facing(tank_sides, lower, upper), behind))
    box = ((-margin, -margin), (width + margin, height + margin)) if closed else ((0.0, -margin), (width, height))
    pairs = PairList(count, skin * law.smoothing.length, *box, (not closed, False), full=True)
    if pile:
        pairs = CutPairList(pairs, pile, n, side, soil.v)
    flow = SoilFlow(soil, law, pairs)
    flow.lower[:], flow.upper[:] = lower, upper
    if not hasty:
        flow.start()
    return flow


def soil_section(scene: Scene) -> SoilSection:
    """The soil of a scene that has some."""
    assert scene.soil is not None
    return scene.soil


def porous_section(scene: Scene) -> SoilSection:
    """The soil of a scene whose pores have room for water; InputError without."""
    section = soil_section(scene)
    if section.porosity < LEAST_POROSITY:
        least = f">= {LEAST_POROSITY:g} with water"
        raise InputError(Fault("soil.porosity", section.porosity, "leaves water no room", "", least, "raise it"))
    return section


def damping_of(section: SoilSection, numerics: NumericsSection, steady: float) -> float:
    """α of the damping: as given, or what makes α c h the given viscosity, c sound in a column at E0, or ``steady``."""
    choice = section.numerics
    if choice.damping_viscosity is not None:
        sound = math.sqrt(material_of(section).column_modulus / section.density)
        return choice.damping_viscosity / (sound * numerics.smoothing_ratio * numerics.spacing)
    if choice.damping is not None:
        return choice.damping
    return steady if choice.damping_of == "zig-zags" else WEIGHTLESS[0]


def side_friction(section: SoilSection) -> float:
    """2 tan δ/W of a section's side walls, 1/m; 0 without."""
    walls = section.side_walls
    return 2.0 * math.tan(walls.friction_angle) / walls.distance if walls else 0.0


def soil_law(scene: Scene) -> SoilLaw:
    """Parameters of the soil of a scene."""
    section, numerics = soil_section(scene), scene.numerics
    choice, material = section.numerics, material_of(section)
    # What stops the slowest swing of a column of this height, period 4 H/c, within one of its periods.
    softest = material.column_modulus * material.stiffness_at(material.least) / material.stiffness
    slowest = 0.5 * math.pi * math.sqrt(softest / material.density) / section.height
    smoothing = Smoothing(numerics.kernel, numerics.smoothing_ratio * numerics.spacing)
    damping, diffusion = steadied(material, scene.gravity, section.height, smoothing.length)
    averages = averages_of(smoothing, numerics.spacing, section.softening.band_width) if section.softening else 1
    return SoilLaw(
        smoothing,
        numerics.spacing,
        (banded(material, section, band_width(smoothing, numerics.spacing, averages)),),
        (0.0, -scene.gravity),
        damping=damping_of(section, numerics, damping),
        printed_damping=choice.damping_of == "approach",
        bounded=choice.damping_of == "bounded",
        corrected=choice.gradient == "corrected",
        diffusion=diffusion if choice.stress_diffusion is None else choice.stress_diffusion,
        sound_diffusion=choice.restless_diffusion,
        spacing_recovery=choice.parting,
        repulsion=choice.repulsion,
        drag=slowest,
        settle=choice.settle,
        courant=numerics.courant,
        averages=averages,
        level_from=choice.settle if section.loads_from_none else 0.0,
        side_friction=side_friction(section),
    )


def unfilled(key: str, body: Outline) -> Fault:
    """The fault of an outline, of a ``body`` at a ``key``, in which there is no particle of soil."""
    repair = "move or widen it, or lower numerics.spacing"
    return Fault(key, body.outline[0], "holds no particle of soil", "m", repair=repair)


def soil_particles(scene: Scene) -> tuple[Floats, Floats]:
    """Positions (n, 2) m and stresses (n, 4) Pa of a scene's soil at the start; InputError where a body holds none."""
    section, spacing = soil_section(scene), scene.numerics.spacing
    corners = [corner for body in section.body for corner in body.outline]
    right, above = (min(scene.inner[a], max(corner[a] for corner in corners) + spacing) for a in (0, 1))
    lattice = square_lattice((0.0, 0.0), (right, above), spacing)  # a tank may be far wider than its ground
    inside, empty = np.zeros(len(lattice), np.bool_), []
    free = ~sheet_pile(scene.pile, spacing).holds(lattice) if scene.pile else np.ones(len(lattice), np.bool_)
    for number, body in enumerate(section.body):
        own = body.holds(lattice) & free
        if not own.any():
            empty.append(unfilled(f"soil.body[{number}].outline", body))
        inside |= own
    if empty:
        raise InputError(empty)
    x = lattice[inside]
    if section.stress != "geostatic":
        return x, np.zeros((len(x), 4))
    depth = section.surface_over(x, 0.5 * spacing) - x[:, 1]
    return x, geostatic(depth, material_of(section), scene.gravity, section.rest)


def soil_flow(scene: Scene, *, hasty: bool = False) -> SoilFlow:
    """The soil of a scene, ready for its first step;  hasty : as of `placed`."""
    section, numerics = soil_section(scene), scene.numerics
    x, stress = soil_particles(scene)
    pile = sheet_pile(scene.pile, numerics.spacing) if scene.pile else None
    return placed(
        x, stress, scene.inner, soil_law(scene), floor=section.floor, sides=section.sides, skin=numerics.skin,
        pile=pile, hasty=hasty,
    )  # fmt: skip
