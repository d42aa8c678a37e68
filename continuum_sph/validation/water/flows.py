"""Flows that shifting, corrected gradients and the energy budget are for: vortices, spinning square, impact.  SI."""

import numpy as np

from continuum_sph.builders.parts.water import water_flow
from continuum_sph.validation.water.kernels import LATTICE, SPREAD
from continuum_sph.validation.water.setups import column_scene, kinetic_energy, run_until
from continuum_sph.water.energy_budget import budget
from continuum_sph.water.eos.liquid import Tait
from continuum_sph.water.fluids import Fluid
from continuum_sph.water.parameters import Law
from continuum_sph.water.smoothing import RATIO, Smoothing
from continuum_sph.water.state import Layer
from continuum_sph.water.step import Flow
from porescale.common.core.types import Floats
from porescale.common.evidence.validations import Measured, Validations
from porescale.common.neighbors import PairList, square_lattice

VALIDATIONS = Validations()


def taylor_green_vortices(x: Floats) -> tuple[Floats, Floats]:
    """Velocity (n, 2) m/s and pressure (n,) Pa at ``x`` (n, 2) m of four vortices in a box of 1 m, 1 m/s, 1 kg/m³.

    Taylor & Green, Proc. R. Soc. A 158 (1937) 499: the field keeps its form and decays as exp(-8π² ν t).
    """
    angle = 2.0 * np.pi * x
    v = np.column_stack((-np.cos(angle[:, 0]) * np.sin(angle[:, 1]), np.sin(angle[:, 0]) * np.cos(angle[:, 1])))
    p = -0.25 * (np.cos(2.0 * angle[:, 0]) + np.cos(2.0 * angle[:, 1]))
    return v, p


def taylor_green(across: int, reynolds: float, *, shifting: float = 2.0, corrected: bool = True) -> Flow:
    """Four vortices in a periodic box of 1 m, fastest at 1 m/s, density 1 kg/m³, ν = 1/``reynolds``, Mach 0.1."""
    spacing = 1.0 / across
    x = square_lattice((0.0, 0.0), (1.0, 1.0), spacing)
    v, p = taylor_green_vortices(x)
    state = Tait(1.0, 10.0)
    smoothing = Smoothing("wendland", RATIO * spacing)
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
    smoothing = Smoothing("wendland", RATIO * spacing)
    law = Law(smoothing, spacing, (Fluid(state),), (0.0, 0.0), alpha=0.02, shifting=shifting, cut=cut)
    rho = state.density_at(pressure)
    v = np.column_stack((-x[:, 1], x[:, 0]))
    layer = Layer(len(x), x, v, rho * spacing**2, rho)
    pairs = PairList(len(x), 0.25 * smoothing.length, (-1.0, -1.0), (1.0, 1.0), full=True)
    flow = Flow(layer, law, pairs)
    flow.start()
    return flow


REYNOLDS = 100.0
DECAY = 8.0 * np.pi**2 / REYNOLDS  # 1/s, of the vortices' speed


def vortex_error(across: int, shifting: float = 2.0, corrected: bool = True, end: float = 0.5) -> float:
    """Largest relative error of the vortices' speed, at four times up to ``end`` (s)."""
    flow = taylor_green(across, REYNOLDS, shifting=shifting, corrected=corrected)
    start, worst = kinetic_energy(flow), 0.0
    for time in np.linspace(0.25 * end, end, 4):
        run_until(flow, time)
        speed = (kinetic_energy(flow) / start) ** 0.5
        worst = max(worst, abs(speed / np.exp(-DECAY * flow.time) - 1.0))
    return worst


@VALIDATIONS.row(
    "continuum.taylor_green_decay",
    source="Taylor & Green 1937: exp(-8π² ν t), Reynolds number 100",
    because="pressure has twice the wave number of the vortices, 4π; gradient and divergence smooth it by "
    "SPREAD (4π h)² each, h = RATIO/50",
    tolerance=2.0 * SPREAD * (4.0 * np.pi * RATIO / 50) ** 2,
    slow=True,
)
def taylor_green_row() -> Measured:
    """Largest error of the vortices' speed until 0.67 of it is left, 50 particles in a period."""
    return Measured.absolute(0.0, vortex_error(50))


@VALIDATIONS.row(
    "continuum.taylor_green_converges",
    source="Taylor & Green 1937, Reynolds number 100; 25 and 100 particles in a period",
    because="an error of second order falls to 1/16; of first order, which shifting leaves, to 1/4",
    tolerance=0.25,
    slow=True,
)
def convergence_row() -> Measured:
    """Error at 100 particles over that at 25."""
    coarse, fine = vortex_error(25), vortex_error(100)
    return Measured.absolute(0.0, fine / coarse)


def sunk(seconds: float, rows: int = 20) -> float:
    """How far the middle of a shifted column of 1 m at rest sinks in ``seconds``, m."""
    scene = column_scene(1.0 / rows, tank=(0.5, 1.2), column=(0.5, 1.0), gradient="corrected", shifting=2.0)
    flow = water_flow(scene)
    height = flow.layer.x[: flow.layer.fluid, 1]
    before = float(height.mean())
    run_until(flow, seconds)
    return before - float(height.mean())


@VALIDATIONS.row(
    "continuum.shifted_water_keeps_its_volume",
    source="exact: water at rest at its hydrostatic density stays where it is; 10 s",
    because="the lattice settles by what it takes off the gradient of pressure, 1.3 % of a spacing",
    tolerance=LATTICE / 20,
    slow=True,
)
def volume_row() -> Measured:
    """Sinking of the middle of a column of 1 m in 10 s, m, with corrected gradients and shifting, 20 rows."""
    return Measured.absolute(0.0, sunk(10.0))


def energy_growth(seconds: float, heat_kept: bool = False) -> tuple[float, float]:
    """(largest growth of the energy of a collapsing column of 1 m by 2 m from any moment on, drift of its balance),
    both over the energy it starts with.

    heat_kept : count the heat of viscosity as energy of flow, and so what viscosity took as growth.
    """
    scene = column_scene(0.05, tank=(4.0, 3.0), column=(1.0, 2.0), pressure="released")
    flow = water_flow(scene)
    flow.layer.keep_budget()
    first = budget(flow)
    scale, least, growth, drift = first["total energy"], np.inf, 0.0, 0.0
    while flow.time < seconds:
        flow.advance()
        if flow.step % 20:
            continue
        now = budget(flow)
        energy = now["total energy"] + (2.0 * now["heat of viscosity"] if heat_kept else 0.0)
        least = min(least, energy)
        growth = max(growth, energy - least)
        drift = max(drift, abs(now["energy balance"] - first["energy balance"]))
    return growth / scale, drift / scale


@VALIDATIONS.row(
    "continuum.energy_never_grows",
    source="exact: walls at rest do no work",
    because="walls carry pressure but no store of its work: what water in their place would store, p²/2ρc² with "
    "p = ρ g H = ρ c²/200 in layers 0.15 m deep along 3 m, goes and comes back; the start has ρ g H times 1 m²",
    tolerance=0.15 * 3.0 / 400.0,
    slow=True,
)
def energy_row() -> Measured:
    """Largest growth of kinetic, potential and compressive energy of a collapsing column, over its start, 0.6 s."""
    return Measured.absolute(0.0, energy_growth(0.6)[0])


@VALIDATIONS.row(
    "continuum.energy_balance",
    source="exact: energy, heat, what diffusion took and what walls gave add up to what was there",
    because="steps of Δt = 0.25 h/c miss (Δt c/h)²/2 = 3 % of what is turned over, below 3 % of all until the impact",
    tolerance=0.03 * 0.03,
    slow=True,
)
def balance_row() -> Measured:
    """Largest change of the sum over the first 0.6 s, over the energy at the start."""
    return Measured.absolute(0.0, energy_growth(0.6)[1])


@VALIDATIONS.row(
    "continuum.energy_balance_over_an_impact",
    source="exact: energy, heat, what diffusion took and what walls gave add up to what was there",
    because="steps miss (Δt c/h)²/2 = 3 % of what viscosity (9 % of the start), diffusion (6 %) and walls (5 %) turn "
    "over until the water has struck the far wall and stands at it",
    tolerance=0.03 * 0.2,
    slow=True,
)
def impact_row() -> Measured:
    """Largest change of the sum over the first 1.2 s, over the energy at the start."""
    return Measured.absolute(0.0, energy_growth(1.2)[1])
