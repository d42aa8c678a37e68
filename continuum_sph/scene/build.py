"""From a scene to particles, law and pair list."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from continuum_sph.boundary import tank_walls
from continuum_sph.density import NAMES
from continuum_sph.eos import Tait
from continuum_sph.exact import released_pressure
from continuum_sph.fluids import Fluid
from continuum_sph.law import Law
from continuum_sph.layers import Layer
from continuum_sph.scene.sections import Scene
from continuum_sph.smoothing import SUPPORT, Smoothing
from continuum_sph.step import Flow
from porescale.particles import PairList, square_lattice

Floats = NDArray[np.float64]


def water_of(scene: Scene) -> Tait:
    """The equation of state of a scene's water."""
    return Tait(scene.water.density, scene.sound_speed, scene.water.exponent)


def law_of(scene: Scene) -> Law:
    """What the particles of a scene obey."""
    numerics, water = scene.numerics, scene.water
    return Law(
        smoothing=Smoothing(numerics.kernel, numerics.smoothing_ratio * numerics.spacing),
        spacing=numerics.spacing,
        fluids=(Fluid(water_of(scene), water.viscosity),),
        gravity=(0.0, -scene.gravity),
        alpha=numerics.artificial_viscosity,
        beta=numerics.artificial_viscosity_2,
        softening=numerics.softening,
        diffusion=numerics.density_diffusion,
        noise=NAMES.index(numerics.diffusion_of),
        xsph=numerics.xsph,
        shifting=numerics.shifting,
        corrected=numerics.gradient == "corrected",
        varied=numerics.smoothing_length == "evolved",
        filter_every=numerics.density_filter,
        sticky=scene.tank.walls == "stick",
        images=scene.tank.wall_particles == "images",
        cut=numerics.tension == "cut",
        courant=numerics.courant,
    )


def wall_layers(law: Law, spacing: float) -> int:
    """Layers of wall particles that fill the support of a fluid particle at the wall."""
    return math.ceil(SUPPORT * law.smoothing.length / spacing - 0.5 - 1e-9)


def fluid_of(scene: Scene, law: Law) -> tuple[Floats, Floats, Floats]:
    """Positions (n, 2) m, velocities (n, 2) m/s and densities (n,) kg/m³ of the water at the start."""
    water, spacing, tait = scene.water, scene.numerics.spacing, water_of(scene)
    positions, velocities, densities = [], [], []
    for column in water.column:
        corner = (column.left, column.bottom)
        x = square_lattice(corner, (column.left + column.width, column.bottom + column.height), spacing)
        top = column.bottom + column.height
        depth = top - x[:, 1]
        if water.pressure == "hydrostatic":
            rho = tait.settled_density(depth, scene.gravity)
        elif water.pressure == "released":
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


def flow_of(scene: Scene) -> Flow:
    """The particles of a scene, ready for their first step."""
    law, spacing, tank = law_of(scene), scene.numerics.spacing, scene.tank
    x, v, rho = fluid_of(scene, law)
    layers = wall_layers(law, spacing)
    width, height = scene.inner
    walls = tank_walls(width, height, spacing, layers, lid=tank.lid)
    area = spacing * spacing
    layer = Layer(
        fluid=len(x),
        x=np.concatenate((x, walls)),
        v=np.concatenate((v, np.zeros_like(walls))),
        mass=np.concatenate((rho * area, np.full(len(walls), law.state.density * area))),
        density=rho,
    )
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
