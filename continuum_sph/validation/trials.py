"""Small flows that validations and tests set up and watch.  SI."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from continuum_sph.scene.sections import Scene
from continuum_sph.validation.exact import taylor_green_vortices
from continuum_sph.water.eos.liquid import Tait
from continuum_sph.water.fluids import Fluid
from continuum_sph.water.parameters import Law
from continuum_sph.water.pressure_walls import tank_walls
from continuum_sph.water.smoothing import Smoothing
from continuum_sph.water.state import Layer
from continuum_sph.water.step import Flow
from porescale.common.core.constants import GRAVITY
from porescale.common.neighbors import PairList, square_lattice
from porescale.common.schema.sections import validate

Floats = NDArray[np.float64]


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
    return validate(
        Scene,
        {
            "gravity": gravity,
            "tank": {"width": tank[0], "height": tank[1]},
            "water": {
                "viscosity": viscosity,
                "pressure": pressure,
                "column": [{"width": column[0], "height": column[1]}],
            },
            "numerics": {"spacing": spacing, **numerics},
            "time": {"end": end},
            "output": {"snapshot_interval": end, "series_interval": end},
        },
    )


def run_until(flow: Flow, time: float) -> Flow:
    """Advance ``flow`` to ``time`` (s) or just beyond."""
    while flow.time < time:
        flow.advance()
    return flow


def channel(
    gap: float,
    across: int,
    viscosity: float,
    sound_speed: float,
    *,
    force: float = 0.0,
    lid_speed: float = 0.0,
    corrected: bool = True,
) -> Flow:
    """Liquid of density 1000 between two plates that hold it, periodic along them.

    gap : m;  across : particles;  viscosity : ν, m²/s;  force : along the plates, m/s²;  lid_speed : of the upper, m/s;
    corrected : gradients.
    """
    spacing, density, layers = gap / across, 1000.0, 3
    length = 8 * spacing  # two cutoffs of 2h + skin and a little
    x = square_lattice((0.0, 0.0), (length, gap), spacing)
    walls = tank_walls(length, gap, spacing, layers, sides=False, lid=True)
    smoothing = Smoothing("wendland", 1.3 * spacing)
    law = Law(
        smoothing, spacing, (Fluid(Tait(density, sound_speed), viscosity * density),), (force, 0.0),
        diffusion=0.0, sticky=True, cut=False, corrected=corrected,
    )  # fmt: skip
    v = np.zeros((len(x) + len(walls), 2))
    v[len(x) :, 0] = np.where(walls[:, 1] > gap, lid_speed, 0.0)
    count = len(v)
    layer = Layer(len(x), np.concatenate((x, walls)), v, np.full(count, density * spacing**2), np.full(len(x), density))
    margin = layers * spacing
    pairs = PairList(count, 0.2 * smoothing.length, (0.0, -margin), (length, gap + margin), (True, False), full=True)
    flow = Flow(layer, law, pairs)
    flow.start()
    return flow


def open_box(across: int, seed: int, *, alpha: float = 0.05, xsph: float = 0.0) -> Flow:
    """A periodic box of 1 m of disordered liquid stirred at random, without walls or gravity."""
    spacing, density = 1.0 / across, 1000.0
    rng = np.random.default_rng(seed)
    x = square_lattice((0.0, 0.0), (1.0, 1.0), spacing)
    x += rng.uniform(-0.2, 0.2, x.shape) * spacing
    v = rng.normal(0.0, 0.5, x.shape)
    smoothing = Smoothing("wendland", 1.3 * spacing)
    fluid = Fluid(Tait(density, 20.0), 1.0)
    law = Law(smoothing, spacing, (fluid,), (0.0, 0.0), alpha=alpha, beta=0.1, xsph=xsph, cut=False)
    layer = Layer(len(x), x, v, np.full(len(x), density * spacing**2), np.full(len(x), density))
    pairs = PairList(len(x), 0.25 * smoothing.length, (0.0, 0.0), (1.0, 1.0), (True, True), full=True)
    flow = Flow(layer, law, pairs)
    flow.start()
    return flow


def sound_wave(across: int, amplitude: float) -> Flow:
    """A standing sound wave, density 1 + ``amplitude`` cos(2πx) of a period of 1 m, at 10 m/s; nothing damps it."""
    spacing, density = 1.0 / across, 1000.0
    x = square_lattice((0.0, 0.0), (1.0, 8 * spacing), spacing)
    rho = density * (1.0 + amplitude * np.cos(2.0 * np.pi * x[:, 0]))
    smoothing = Smoothing("wendland", 1.3 * spacing)
    law = Law(smoothing, spacing, (Fluid(Tait(density, 10.0)),), (0.0, 0.0), diffusion=0.0, cut=False)
    layer = Layer(len(x), x, np.zeros_like(x), rho * spacing**2, rho)
    pairs = PairList(len(x), 0.2 * smoothing.length, (0.0, 0.0), (1.0, 8 * spacing), (True, True), full=True)
    flow = Flow(layer, law, pairs)
    flow.start()
    return flow


def taylor_green(across: int, reynolds: float, *, shifting: float = 2.0, corrected: bool = True) -> Flow:
    """Four vortices in a periodic box of 1 m, fastest at 1 m/s, density 1 kg/m³, ν = 1/``reynolds``, Mach 0.1."""
    spacing = 1.0 / across
    x = square_lattice((0.0, 0.0), (1.0, 1.0), spacing)
    v, p = taylor_green_vortices(x)
    state = Tait(1.0, 10.0)
    smoothing = Smoothing("wendland", 1.3 * spacing)
    law = Law(
        smoothing, spacing, (Fluid(state, 1.0 / reynolds),), (0.0, 0.0),
        shifting=shifting, corrected=corrected, cut=False,
    )  # fmt: skip
    rho = state.density_at(p)
    layer = Layer(len(x), x, v, rho * spacing**2, rho)
    pairs = PairList(len(x), 0.25 * smoothing.length, (0.0, 0.0), (1.0, 1.0), (True, True), full=True)
    flow = Flow(layer, law, pairs)
    flow.start()
    return flow


def spinning_square(across: int, *, cut: bool, shifting: float) -> Flow:
    """A square of water of 1 m that spins at 1 rad/s about its middle, (0, 0), in open space, Mach 0.1.

    It starts with the pressure that keeps it without divergence, ∇²p = 2 ρ ω², p = 0 on its sides: tension within.
    Source: Colagrossi, thesis, Rome 2005; Le Touzé et al., Int. J. Numer. Methods Fluids 73 (2013) 660.
    """
    spacing, density = 1.0 / across, 1000.0
    x = square_lattice((-0.5, -0.5), (0.5, 0.5), spacing)
    pressure = np.zeros(len(x))
    for m in range(1, 40, 2):
        for n in range(1, 40, 2):
            wave = np.sin(m * np.pi * (x[:, 0] + 0.5)) * np.sin(n * np.pi * (x[:, 1] + 0.5))
            pressure -= 32.0 * density / (m * n * np.pi**4 * (m * m + n * n)) * wave
    state = Tait(density, 10.0 * 0.5**0.5)
    smoothing = Smoothing("wendland", 1.3 * spacing)
    law = Law(smoothing, spacing, (Fluid(state),), (0.0, 0.0), alpha=0.02, shifting=shifting, cut=cut)
    rho = state.density_at(pressure)
    v = np.column_stack((-x[:, 1], x[:, 0]))
    layer = Layer(len(x), x, v, rho * spacing**2, rho)
    pairs = PairList(len(x), 0.25 * smoothing.length, (-1.0, -1.0), (1.0, 1.0), full=True)
    flow = Flow(layer, law, pairs)
    flow.start()
    return flow


def wave_amplitude(flow: Flow) -> float:
    """Part of the density, over ρ0, that goes as cos(2πx)."""
    layer = flow.layer
    x, rho = layer.x[: layer.fluid, 0], layer.density
    return float(2.0 * np.mean((rho / flow.law.state.density - 1.0) * np.cos(2.0 * np.pi * x)))


def speed_profile(flow: Flow) -> tuple[Floats, Floats]:
    """Height (m) and velocity along the plates (m/s) of the liquid of a channel."""
    layer = flow.layer
    return layer.x[: layer.fluid, 1], layer.v[: layer.fluid, 0]


def momentum(flow: Flow) -> Floats:
    """Total momentum of the liquid, (2,) kg/s."""
    layer = flow.layer
    total: Floats = (layer.mass[: layer.fluid, None] * layer.v[: layer.fluid]).sum(axis=0)
    return total


def kinetic_energy(flow: Flow) -> float:
    """Kinetic energy of the liquid, J/m."""
    layer = flow.layer
    return float(0.5 * (layer.mass[: layer.fluid, None] * layer.v[: layer.fluid] ** 2).sum())
