"""Water in a tank: particles, their flow equations, what is recorded of them, and checks of their state."""

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from continuum_sph.builders.assembly import Assembly
from continuum_sph.builders.initial_pressure import released_pressure
from continuum_sph.builders.parts.inclusion import InclusionPart, fill_inclusion, inclusion_fluid
from continuum_sph.builders.parts.instruments import WaterInstruments
from continuum_sph.builders.parts.stiffness import noise_speed, sound_speed
from continuum_sph.builders.sanity import (
    JumpCheck,
    Now,
    Range,
    require_distinct,
    require_finite,
    require_step,
    require_within,
)
from continuum_sph.builders.sanity_fluids import bounds, sound_speeds
from continuum_sph.scene.sections import Scene
from continuum_sph.water.density import NAMES
from continuum_sph.water.energy_budget import budget, held
from continuum_sph.water.eos.liquid import Tait
from continuum_sph.water.fluids import Fluid
from continuum_sph.water.parameters import RULES, Law
from continuum_sph.water.pressure_walls import tank_walls
from continuum_sph.water.smoothing import SUPPORT, Smoothing
from continuum_sph.water.state import Layer
from continuum_sph.water.step import Flow
from porescale.common.core.types import Floats
from porescale.common.neighbors import PairList, square_lattice
from porescale.common.record.model import Cloud, Snapshot
from porescale.common.record.part import Part

REPAIR = "lower numerics.courant, or raise numerics.artificial_viscosity or water.sound_speed"


class WaterPart(Part):
    """The fluids of a tank."""

    def __init__(self, scene: Scene, flow: Flow) -> None:
        self.scene, self.flow = scene, flow
        self.jumps = JumpCheck(scene.numerics.spacing)

    def after(self) -> None:
        """Take the time for the next check."""
        self.jumps.add_time(self.flow.time, self.flow.max_speed)

    @property
    def now(self) -> Now:
        """Step, time (s) and repair that error messages give."""
        return Now(self.flow.step, self.flow.time, REPAIR)

    def inside(self) -> NDArray[np.bool_]:
        """Which water particles are in the tank, (fluid,)."""
        (width, height), x = self.scene.inner, self.flow.layer.x[: self.flow.layer.fluid]
        low = (x >= 0.0).all(axis=1)
        inside: NDArray[np.bool_] = low & (x[:, 0] <= width) & (x[:, 1] <= height)
        return inside

    def check(self) -> None:
        """Raise Unstable when a particle is nowhere, where none could have come to or where another is, when a fluid in
        the tank is faster than sound or of a density that means nothing, or the next step is longer than it may be.
        """
        flow, layer, law, now = self.flow, self.flow.layer, self.flow.law, self.now
        n = layer.fluid
        recorded = {
            "position": ("m", layer.x[:n]), "velocity": ("m/s", layer.v[:n]), "density": ("kg/m³", layer.density),
            "mass": ("kg/m", layer.mass[:n]), "pressure": ("Pa", layer.pressure[:n]), "energy": ("J/m", layer.energy),
            "acceleration": ("m/s²", layer.acceleration), "smoothing length": ("m", layer.length[:n]),
        }  # fmt: skip
        require_finite(recorded, now)
        self.jumps.check(layer.x[:n], layer.mass[:n], now, layer.renewed)
        require_within(layer.mass[:n], Range("mass", "kg/m", 0.0, np.inf), np.arange(n), layer.x, now)
        inside = np.flatnonzero(self.inside())
        require_distinct(layer.x, inside, now)
        speed = np.hypot(layer.v[inside, 0], layer.v[inside, 1])
        thin, dense, swift = (values[layer.material[inside]] for values in bounds(law.fluids))
        require_within(speed, Range("speed", "m/s", 0.0, swift), inside, layer.x, now)
        require_within(layer.density[inside], Range("density", "kg/m³", thin, dense), inside, layer.x, now)
        for rate in (layer.rate, layer.rate_before):  # a step on it is within bounds still
            most = (dense - thin) / flow.next_step if flow.next_step > 0.0 else np.inf
            require_within(np.abs(rate[inside]), Range("density rate", "kg/(m³ s)", 0.0, most), inside, layer.x, now)
        acceleration = float(np.hypot(*layer.acceleration.T).max(initial=0.0))
        sound = sound_speeds(law.fluids, layer.material[:n], layer.density)
        limits = law.limits(acceleration, float((sound / layer.length[:n]).max(initial=0.0)))
        require_step(flow.next_step, limits, RULES, layer.x, layer.acceleration, layer.density, now)

    def row(self) -> dict[str, float]:
        """Columns of all fluid, a second one and air included: position and energies.

        front (m) : right edge of the foremost particle
        highest water (m) : upper edge of the highest particle
        mean height (m) : of the centre of mass
        NAME (J/m) : kinetic, potential, compressive energy; with output.energy the budget of water/energy_budget.py
        momentum x (kg/s) : of the fluid, per metre of depth
        fastest (m/s) : largest speed of a particle
        densest (kg/m3) : largest density of a particle
        mass (kg/m) : of the fluid, per metre of depth
        particles outside () : particles that have left the tank
        stops at walls () : how often a particle was stopped at a wall, since the start
        """
        layer, tait = self.flow.layer, water_state(self.scene)
        n, half = layer.fluid, 0.5 * self.scene.numerics.spacing
        x, v, mass = layer.x[:n], layer.v[:n], layer.mass[:n]
        inside = self.inside()
        at = x[inside] if inside.any() else np.zeros((1, 2))
        speed2 = (v * v).sum(axis=1)
        energy = budget(self.flow) if layer.has_budget else held(self.flow)
        return {
            "front (m)": float(at[:, 0].max()) + half,
            "highest water (m)": float(at[:, 1].max()) + half,
            "mean height (m)": float((mass * x[:, 1]).sum()) / (float(mass.sum()) or 1.0),
            **{f"{name} (J/m)": value for name, value in energy.items()},
            "momentum x (kg/s)": float((mass * v[:, 0]).sum()),
            "fastest (m/s)": float(np.sqrt(speed2[inside].max())) if inside.any() else 0.0,
            "densest (kg/m3)": float(layer.density.max()) if n else tait.density,
            "mass (kg/m)": float(mass.sum()),
            "particles outside ()": float(int((mass > 0.0).sum()) - int(inside.sum())),
            "stops at walls ()": float(self.flow.stopped),
        }

    def motion(self) -> tuple[Floats, Floats]:
        """Positions (n, 2) m and velocities (n, 2) m/s of the water; views."""
        layer = self.flow.layer
        return layer.x[: layer.fluid], layer.v[: layer.fluid]

    def masses(self) -> Floats:
        """Masses of the water, (n,) kg/m; a view."""
        return self.flow.layer.mass[: self.flow.layer.fluid]

    def cloud(self) -> Cloud:
        """The water: velocity, pressure, density."""
        layer = self.flow.layer
        n = layer.fluid
        velocity = np.zeros((n, 3))
        velocity[:, :2] = layer.v[:n]
        data: dict[str, NDArray[Any]] = {
            "velocity": velocity,
            "pressure": layer.pressure[:n].copy(),
            "density": layer.density.copy(),
        }
        if self.scene.inclusion:
            data["fluid"] = layer.material[:n].copy()
        units = {"velocity": "m/s", "pressure": "Pa", "density": "kg/m3"}
        return Cloud(layer.x[:n].copy(), data, units)

    def show(self, snapshot: Snapshot) -> None:
        """Add all particles, water and walls, to the snapshot."""
        snapshot.clouds["particles"] = self.cloud()

    def state(self) -> dict[str, Any]:
        """Everything that later steps depend on."""
        return {"flow": self.flow.state()}

    def restore(self, state: dict[str, Any]) -> None:
        """Go on bit for bit from a state of a part of the same scene."""
        self.flow.restore(state["flow"])
        self.jumps.reset()


class WaterSteps(Part):
    """How the steps of water were chosen."""

    def __init__(self, flow: Flow) -> None:
        self.flow = flow

    def row(self) -> dict[str, float]:
        """Number of steps that each stability criterion has limited.

        steps limited by RULE () : number of steps whose length sound, acceleration, viscosity or capillarity decided
        """
        return {f"steps limited by {rule} ()": float(k) for rule, k in zip(RULES, self.flow.limited, strict=True)}


def assemble(scene: Scene) -> Assembly:
    """Water in a tank, with what is measured in it."""
    flow = water_flow(scene)
    water = WaterPart(scene, flow)
    parts: list[Part] = [water]
    if scene.inclusion:
        parts.append(InclusionPart(flow))
    parts.append(WaterSteps(flow))
    if scene.probe or scene.level:
        parts.append(WaterInstruments(scene.probe, scene.level, flow, scene.inner[0]))
    return Assembly(flow, parts, water, REPAIR)


def water_state(scene: Scene) -> Tait:
    """The equation of state of a scene's water."""
    return Tait(scene.water.density, sound_speed(scene), scene.water.exponent)


def water_law(scene: Scene) -> Law:
    """Parameters of the fluid particles of a scene."""
    numerics, water, state, second = scene.numerics, scene.water, water_state(scene), scene.inclusion
    return Law(
        smoothing=Smoothing(numerics.kernel, numerics.smoothing_ratio * numerics.spacing),
        spacing=numerics.spacing,
        fluids=(Fluid(state, water.viscosity), *([inclusion_fluid(second, state)] if second else [])),
        gravity=(0.0, -scene.gravity),
        alpha=numerics.artificial_viscosity,
        beta=numerics.artificial_viscosity_2,
        softening=numerics.softening,
        diffusion=numerics.density_diffusion,
        noise=NAMES.index(numerics.diffusion_of),
        noise_speed=noise_speed(scene),
        xsph=numerics.xsph,
        shifting=numerics.shifting,
        corrected=numerics.gradient == "corrected",
        varied=numerics.smoothing_length == "evolved",
        filter_every=numerics.density_filter,
        sticky=scene.tank.walls != "slip",
        images=scene.tank.wall_particles == "images",
        tension=second.surface_tension if second else 0.0,
        cut=numerics.tension == "cut",
        courant=numerics.courant,
    )


def wall_layers(law: Law, spacing: float) -> int:
    """Layers of wall particles that fill the support of a fluid particle at the wall."""
    return math.ceil(SUPPORT * law.smoothing.length / spacing - 0.5 - 1e-9)


def water_particles(scene: Scene, law: Law) -> tuple[Floats, Floats, Floats]:
    """Positions (n, 2) m, velocities (n, 2) m/s and densities (n,) kg/m³ of the water at the start."""
    water, spacing, tait = scene.water, scene.numerics.spacing, water_state(scene)
    positions, velocities, densities = [np.zeros((0, 2))], [np.zeros((0, 2))], [np.zeros(0)]
    for column in water.column:
        corner = (column.left, column.bottom)
        x = square_lattice(corner, (column.left + column.width, column.bottom + column.height), spacing)
        top = column.bottom + column.height
        depth = water.surface_over(x, np.full(len(x), top), 0.5 * spacing) - x[:, 1]
        free = column.left + column.width < scene.inner[0] - 0.5 * spacing  # its right face, that of a wall is not
        if water.pressure == "hydrostatic" or (water.pressure == "released" and (scene.inclusion or not free)):
            rho = tait.settled_density(depth, scene.gravity)
        elif water.pressure == "released":
            p = released_pressure(x[:, 0], x[:, 1], column.width, column.height, water.density, scene.gravity)
            rho = tait.density * (1.0 + p / tait.stiffness) ** (1.0 / tait.exponent)
        else:
            rho = np.full(len(x), tait.density)
        v = np.zeros_like(x)
        if water.push == "face":
            face = (x[:, 0] > x[:, 0].max() - 0.5 * spacing) & scene.open_at(x + np.array((spacing, 0.0)))
            v[face, 0] = np.sqrt(2.0 * scene.gravity * depth[face])
        positions.append(x)
        velocities.append(v)
        densities.append(rho)
    return np.concatenate(positions), np.concatenate(velocities), np.concatenate(densities)


def water_flow(scene: Scene) -> Flow:
    """The particles of a scene, ready for their first step."""
    law, spacing, tank = water_law(scene), scene.numerics.spacing, scene.tank
    x, v, rho = water_particles(scene, law)
    layers = wall_layers(law, spacing)
    width, height = scene.inner
    walls = tank_walls(width, height, spacing, layers, lid=tank.lid)
    area = spacing * spacing
    material = np.zeros(len(x) + len(walls), np.int64)
    if tank.walls == "floor and lid stick":
        material[len(x) :] = (walls[:, 1] > 0.0) & (walls[:, 1] < height)
    if scene.inclusion is not None:
        fill_inclusion(scene, law, x, rho, material)
    layer = Layer(
        fluid=len(x),
        x=np.concatenate((x, walls)),
        v=np.concatenate((v, np.zeros_like(walls))),
        mass=np.concatenate((rho * area, np.full(len(walls), law.state.density * area))),
        density=rho,
        material=material,
    )
    if scene.output.energy:
        layer.keep_budget()
    margin = layers * spacing
    pairs = PairList(
        layer.count,
        scene.numerics.skin * law.smoothing.length,
        (-margin, -margin),
        (width + margin, height + margin),
        full=True,
    )
    flow = Flow(layer, law, pairs)
    flow.lower[:] = 0.0
    flow.upper[:] = width, height if tank.lid else np.inf
    flow.start()
    return flow
