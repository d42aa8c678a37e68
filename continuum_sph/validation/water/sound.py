"""A standing sound wave: its period, and that it neither grows nor fades.  SI."""

import numpy as np

from continuum_sph.validation.water.kernels import SPREAD
from continuum_sph.water.eos.liquid import Tait
from continuum_sph.water.fluids import Fluid
from continuum_sph.water.parameters import Law
from continuum_sph.water.smoothing import RATIO, Smoothing
from continuum_sph.water.state import Layer
from continuum_sph.water.step import Flow
from porescale.common.evidence.validations import Measured, Validations
from porescale.common.neighbors import PairList, square_lattice

VALIDATIONS = Validations()


def sound_wave(across: int, amplitude: float) -> Flow:
    """A standing sound wave, density 1 + ``amplitude`` cos(2πx) of a period of 1 m, at 10 m/s; nothing damps it."""
    spacing, density = 1.0 / across, 1000.0
    x = square_lattice((0.0, 0.0), (1.0, 8 * spacing), spacing)
    rho = density * (1.0 + amplitude * np.cos(2.0 * np.pi * x[:, 0]))
    smoothing = Smoothing("wendland", RATIO * spacing)
    law = Law(smoothing, spacing, (Fluid(Tait(density, 10.0)),), (0.0, 0.0), diffusion=0.0, cut=False)
    layer = Layer(len(x), x, np.zeros_like(x), rho * spacing**2, rho)
    pairs = PairList(len(x), 0.2 * smoothing.length, (0.0, 0.0), (1.0, 8 * spacing), (True, True), full=True)
    flow = Flow(layer, law, pairs)
    flow.start()
    return flow


def wave_amplitude(flow: Flow) -> float:
    """Part of the density, over ρ0, that goes as cos(2πx)."""
    layer = flow.layer
    x, rho = layer.x[: layer.fluid, 0], layer.density
    return float(2.0 * np.mean((rho / flow.law.state.density - 1.0) * np.cos(2.0 * np.pi * x)))


def sound_period(across: int, extrapolated: bool = True) -> tuple[float, float]:
    """Period (s) of a standing wave of 1 m at 10 m/s, and largest amplitude in the fifth to tenth period.

    extrapolated : as `step` predicts density; else by the rate of the last step alone.
    """
    flow = sound_wave(across, 1e-4)
    times, sizes = [], []
    while flow.time < 1.0:
        if not extrapolated:
            flow.layer.rate_before[:] = flow.layer.rate
        flow.advance()
        times.append(flow.time)
        sizes.append(wave_amplitude(flow) / 1e-4)
    t, a = np.array(times), np.array(sizes)
    turn = np.flatnonzero(a[:-1] * a[1:] < 0.0)
    zeros = t[turn] - a[turn] * (t[turn + 1] - t[turn]) / (a[turn + 1] - a[turn])
    return 2.0 * float(zeros[-1] - zeros[0]) / (len(zeros) - 1), float(np.abs(a[len(a) // 2 :]).max())


WAVE = 2.0 * np.pi * RATIO / 32  # 2π h of the rows below
PHASE = 0.25 * WAVE  # ω Δt there: Δt = 0.25 h/c0, ω = 2π c0


@VALIDATIONS.row(
    "continuum.sound_period",
    source="exact: L/c0",
    because="gradient and divergence are exact on the lattice and smooth over h, SPREAD (2π h)² = 0.010 in both "
    "together; the scheme's steps do less than (ωΔt)² = 0.004",
    tolerance=1.0 / (1.0 - SPREAD * WAVE**2) - 1.0 + PHASE**2,
)
def sound_row() -> Measured:
    """Relative error of the period, 32 particles in a wave."""
    return Measured.relative(0.1, sound_period(32)[0])


@VALIDATIONS.row(
    "continuum.sound_neither_grows_nor_fades",
    source="exact: an ideal wave keeps its amplitude",
    because="the scheme damps by (ωΔt)⁴/2 a step, 0.4 % in the five periods before; steps miss a crest by up to "
    "half of one, (ωΔt)²/8",
    tolerance=0.5 * PHASE**4 * (5 * 2.0 * np.pi / PHASE) + PHASE**2 / 8.0,
)
def sound_amplitude_row() -> Measured:
    """Departure from 1 of the largest amplitude in the fifth to tenth period."""
    return Measured.absolute(1.0, sound_period(32)[1])
