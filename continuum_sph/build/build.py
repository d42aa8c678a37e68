"""From a scene to particles, law and pair list."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from continuum_sph.build.release import lattice_pressure
from continuum_sph.scene.sections import Scene
from continuum_sph.validation.exact import released_pressure
from continuum_sph.water.density import NAMES
from continuum_sph.water.eos import Gas, Tait
from continuum_sph.water.fluids import Fluid
from continuum_sph.water.parameters import Law
from continuum_sph.water.pressure_walls import tank_walls
from continuum_sph.water.smoothing import SUPPORT, Smoothing
from continuum_sph.water.state import Layer
from continuum_sph.water.step import Flow
from porescale.common.neighbors import PairList, square_lattice

Floats = NDArray[np.float64]


def water_of(scene: Scene) -> Tait:
    """The equation of state of a scene's water."""
    return Tait(scene.water.density, scene.sound_speed, scene.water.exponent)


def inclusion_of(scene: Scene) -> Fluid | None:
    """The second fluid of a scene."""
    given = scene.inclusion
    if given is None:
        return None
    if given.law == "liquid":
        water, exponent = water_of(scene), given.exponent or 7.0
        stiff = (water.stiffness * exponent / given.density) ** 0.5
        return Fluid(Tait(given.density, given.sound_speed or stiff, exponent), given.viscosity, given.cohesion)
    gas = Gas(given.density, given.pressure, given.exponent or 1.403, printed=given.law == "printed")
    return Fluid(gas, given.viscosity, given.cohesion)


def law_of(scene: Scene) -> Law:
    """What the particles of a scene obey."""
    numerics, water, second = scene.numerics, scene.water, inclusion_of(scene)
    return Law(
        smoothing=Smoothing(numerics.kernel, numerics.smoothing_ratio * numerics.spacing),
        spacing=numerics.spacing,
        fluids=(Fluid(water_of(scene), water.viscosity), *([second] if second else [])),
        gravity=(0.0, -scene.gravity),
        alpha=numerics.artificial_viscosity,
        beta=numerics.artificial_viscosity_2,
        softening=numerics.softening,
        diffusion=numerics.density_diffusion,
        noise=NAMES.index(numerics.diffusion_of),
        calm=scene.calm,
        xsph=numerics.xsph,
        shifting=numerics.shifting,
        corrected=numerics.gradient == "corrected",
        varied=numerics.smoothing_length == "evolved",
        filter_every=numerics.density_filter,
        sticky=scene.tank.walls != "slip",
        images=scene.tank.wall_particles == "images",
        tension=scene.inclusion.surface_tension if scene.inclusion else 0.0,
        cut=numerics.tension == "cut",
        courant=numerics.courant,
    )


def wall_layers(law: Law, spacing: float) -> int:
    """Layers of wall particles that fill the support of a fluid particle at the wall."""
    return math.ceil(SUPPORT * law.smoothing.length / spacing - 0.5 - 1e-9)


def fluid_of(scene: Scene, law: Law) -> tuple[Floats, Floats, Floats]:
    """Positions (n, 2) m, velocities (n, 2) m/s and densities (n,) kg/m³ of the water at the start."""
    water, spacing, tait = scene.water, scene.numerics.spacing, water_of(scene)
    positions, velocities, densities = [np.zeros((0, 2))], [np.zeros((0, 2))], [np.zeros(0)]
    for column in water.column:
        corner = (column.left, column.bottom)
        x = square_lattice(corner, (column.left + column.width, column.bottom + column.height), spacing)
        top = column.bottom + column.height
        depth = top - x[:, 1]
        if water.pressure == "hydrostatic" or (water.pressure == "released" and scene.inclusion):
            rho = tait.settled_density(depth, scene.gravity)
        elif water.pressure == "released" and scene.inclusion is None:
            p = released_pressure(x[:, 0], x[:, 1], column.width, column.height, water.density, scene.gravity)
            rho = tait.density * (1.0 + p / tait.stiffness) ** (1.0 / tait.exponent)
        else:
            rho = np.full(len(x), tait.density)
        v = np.zeros_like(x)
        if water.push == "face":
            face = x[:, 0] > x[:, 0].max() - 0.5 * spacing
            v[face, 0] = np.sqrt(2.0 * scene.gravity * depth[face])
        positions.append(x)
        velocities.append(v)
        densities.append(rho)
    return np.concatenate(positions), np.concatenate(velocities), np.concatenate(densities)


def fill(scene: Scene, law: Law, x: Floats, rho: Floats, material: NDArray[np.int64]) -> None:
    """Turn water at ``x`` (n, 2) m in the discs of the second fluid into it; overwrites there ``rho`` and ``material``.

    Its pressure is that of the water in its place, or that of both the instant they are released (`release`), which
    overwrites all of ``rho``; and of surface tension σ/R more.
    """
    assert scene.inclusion is not None
    states, numerics = [fluid.state for fluid in law.fluids], scene.numerics
    pressure, pull = states[0].pressure(rho), np.zeros(len(x))
    for disc in scene.inclusion.disc:
        inside = np.flatnonzero(np.hypot(x[:, 0] - disc.x, x[:, 1] - disc.y) < disc.radius)
        pull[inside] = scene.inclusion.surface_tension / disc.radius
        material[inside] = 1
    if scene.water.pressure == "released":
        heavy = np.array([state.density for state in states])[material[: len(x)]]
        pressure = lattice_pressure(x, heavy, numerics.spacing, scene.gravity, scene.inner, scene.tank.lid)
    for number, state in enumerate(states):
        own = material[: len(x)] == number
        rho[own] = state.density_at(pressure[own] + pull[own])


def flow_of(scene: Scene) -> Flow:
    """The particles of a scene, ready for their first step."""
    law, spacing, tank = law_of(scene), scene.numerics.spacing, scene.tank
    x, v, rho = fluid_of(scene, law)
    layers = wall_layers(law, spacing)
    width, height = scene.inner
    walls = tank_walls(width, height, spacing, layers, lid=tank.lid)
    area = spacing * spacing
    material = np.zeros(len(x) + len(walls), np.int64)
    if tank.walls == "floor and lid stick":
        material[len(x) :] = (walls[:, 1] > 0.0) & (walls[:, 1] < height)
    if scene.inclusion is not None:
        fill(scene, law, x, rho, material)
    layer = Layer(
        fluid=len(x),
        x=np.concatenate((x, walls)),
        v=np.concatenate((v, np.zeros_like(walls))),
        mass=np.concatenate((rho * area, np.full(len(walls), law.state.density * area))),
        density=rho,
        material=material,
    )
    if scene.output.energy:
        layer.keep_book()
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
