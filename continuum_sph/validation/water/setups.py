"""What experiments with water share: a column in a tank, a box of disordered liquid, and their momentum.  SI."""

import numpy as np

from continuum_sph.scene.sections import Scene
from continuum_sph.validation.tanks import tank_scene
from continuum_sph.water.eos.liquid import Tait
from continuum_sph.water.fluids import Fluid
from continuum_sph.water.parameters import Law
from continuum_sph.water.smoothing import RATIO, Smoothing
from continuum_sph.water.state import Layer
from continuum_sph.water.step import Flow
from porescale.common.core.constants import GRAVITY
from porescale.common.core.types import Floats
from porescale.common.neighbors import PairList, square_lattice


def column_scene(
    spacing: float,
    *,
    tank: tuple[float, float],
    column: tuple[float, float],
    end: float = 1.0,
    pressure: str = "hydrostatic",
    viscosity: float = 1.002e-3,
    gravity: float = GRAVITY,
    **numerics: float | str,
) -> Scene:
    """A tank (width, height) with one column (width, height) of water in its left corner; lengths in m."""
    water = {
        "viscosity": viscosity,
        "pressure": pressure,
        "column": [{"width": column[0], "height": column[1]}],
    }
    return tank_scene(*tank, spacing, end, gravity=gravity, water=water, numerics=numerics)


def run_until(flow: Flow, time: float) -> Flow:
    """Advance ``flow`` to ``time`` (s) or just beyond."""
    while flow.time < time:
        flow.advance()
    return flow


def open_box(across: int, seed: int) -> Flow:
    """A periodic box of 1 m of disordered liquid stirred at random, without walls or gravity."""
    spacing, density = 1.0 / across, 1000.0
    rng = np.random.default_rng(seed)
    x = square_lattice((0.0, 0.0), (1.0, 1.0), spacing)
    x += rng.uniform(-0.2, 0.2, x.shape) * spacing
    v = rng.normal(0.0, 0.5, x.shape)
    smoothing = Smoothing("wendland", RATIO * spacing)
    fluid = Fluid(Tait(density, 20.0), 1.0)
    law = Law(smoothing, spacing, (fluid,), (0.0, 0.0), alpha=0.05, beta=0.1, xsph=0.0, cut=False)
    layer = Layer(len(x), x, v, np.full(len(x), density * spacing**2), np.full(len(x), density))
    pairs = PairList(len(x), 0.25 * smoothing.length, (0.0, 0.0), (1.0, 1.0), (True, True), full=True)
    flow = Flow(layer, law, pairs)
    flow.start()
    return flow


def momentum(flow: Flow) -> Floats:
    """Total momentum of the liquid, (2,) kg/s."""
    layer = flow.layer
    total: Floats = (layer.mass[: layer.fluid, None] * layer.v[: layer.fluid]).sum(axis=0)
    return total


def kinetic_energy(flow: Flow) -> float:
    """Kinetic energy of the liquid, J/m."""
    layer = flow.layer
    return float(0.5 * (layer.mass[: layer.fluid, None] * layer.v[: layer.fluid] ** 2).sum())
