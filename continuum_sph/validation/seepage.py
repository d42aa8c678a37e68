"""Validations of soil and water as two layers; each measuring function takes what its failing twin changes."""

from __future__ import annotations

import functools
from collections.abc import Callable
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from continuum_sph.seepage import Seepage
from continuum_sph.soil import SoilFlow
from continuum_sph.soil.state import YY
from continuum_sph.validation.levels import Infiltration
from continuum_sph.validation.seepage_trials import (
    WATER,
    Consolidation,
    Permeameter,
    energies,
    isochrones,
    momentum,
    realised_modulus,
    saturated_box,
    upward,
)
from porescale.common.core.constants import GRAVITY
from porescale.common.evidence.validations import Measured, Validations

Floats = NDArray[np.float64]

VALIDATIONS = Validations()

FACTORS = (0.01, 0.05, 0.1, 0.2, 0.3)
TERZAGHI = (0.9060, 0.6105, 0.3727, 0.1389, 0.0518)
LAYER = Consolidation(rows=20, permeability=1e-3, ratio=100.0)


@functools.cache
def consolidation(given: Consolidation = LAYER, factors: tuple[float, ...] = FACTORS) -> tuple[list[float], float]:
    """(u/u0 in the middle, at the ``factors`` by the exact rate of decay; largest error over all isochrones)."""
    middle, worst = [], 0.0
    for factor, (reached, z, u) in zip(factors, isochrones(given, factors), strict=True):
        near = np.abs(z / given.height - 0.5) < 0.6 / given.rows
        middle.append(float(u[near].mean() * np.exp(np.pi**2 * (reached - factor))))
        worst = max(worst, float(np.abs(u - given.excess(z, reached)).max()))
    return middle, worst


@VALIDATIONS.row(
    "continuum.consolidation",
    source="Terzaghi 1923: u = u0 sin(πz/H) exp(-π² T_v); figure 10 of Maeda & Sakai 2004, M in place of its B",
    because="water 1/100 as compressible as soil, π² T_v e^(-π² T_v)/100 <= 0.0037; inertia, 2π³ (ρ/ρ_w) k² M/(ρ_w g² "
    "H²) = 0.013 at first; stress in the half spacing before the base, 1/40 of the height, lacks π/40 of u0 before "
    "drag is there and starts a wave, of which a fourth, 0.02, is left at T_v = 0.01",
    tolerance=0.02,
    slow=True,
)
def consolidation_row() -> Measured:
    """u/u0 in the middle; the error is the largest over the isochrones, 20 particles over the height."""
    middle, worst = consolidation()
    return Measured(list(TERZAGHI), middle, worst)


@VALIDATIONS.row(
    "continuum.consolidation_modulus",
    source="plane strain: M = E (1 - ν)/{(1 + ν)(1 - 2ν)}, by loading the soil alone",
    because="the surface lies half a spacing of 1/20 above its particles' centres, uncertain to half of that again",
    tolerance=0.25 / 20,
    slow=True,
)
def modulus_row() -> Measured:
    """Load over mean settlement per height of a column that swings under it, over M."""
    found = realised_modulus(LAYER) / LAYER.modulus
    return Measured(1.0, found, abs(found - 1.0))


SOFT = (1.0, 4.0)


@functools.cache
def soft_decay(ratio: float) -> float:
    """u/u0 in the middle at T_v = 0.1 where water is ``ratio`` times as stiff as soil, K_w/(n M)."""
    (middle,), _ = consolidation(replace(LAYER, ratio=ratio), (0.1,))
    return middle


@VALIDATIONS.row(
    "continuum.consolidation_with_compressible_water",
    source="storage 1/M + n/K_w: c_v falls to c_v/(1 + n M/K_w)",
    because="errors of the layer with stiff water but for the first, 0.016, most of it the wave at the start",
    tolerance=0.016,
    slow=True,
)
def soft_row() -> Measured:
    """u/u0 in the middle at T_v = 0.1 for K_w/(n M) = 1 and 4."""
    exact = [float(np.exp(-(np.pi**2) * 0.1 / (1.0 + 1.0 / ratio))) for ratio in SOFT]
    found = [soft_decay(ratio) for ratio in SOFT]
    return Measured(exact, found, max(abs(a - b) for a, b in zip(exact, found, strict=True)))


def momentum_drift(spoil: Callable[[Seepage], None] | None = None) -> float:
    """Change of momentum of a stirred, saturated box in 20 steps, over the momentum that moves.

    spoil : called after each step.
    """
    both = saturated_box(16, 1, permeability=1e-3)
    before, layer = momentum(both), both.water.layer
    scale = float((layer.mass[: layer.fluid, None] * np.abs(layer.v[: layer.fluid])).sum())
    for _ in range(20):
        both.advance()
        if spoil is not None:
            spoil(both)
    return float(np.abs(momentum(both) - before).max()) / scale


@VALIDATIONS.row(
    "continuum.momentum_of_layers",
    source="Newton's third law: pressure and drag between soil and water",
    because="20 steps, each the sums of 25 partners of 256 particles in four passes: √(20 · 25 · 256 · 4) round-offs "
    "of 2.3e-16 of changes no larger than the momentum that moves",
    tolerance=2.3e-16 * (20 * 25 * 256 * 4) ** 0.5,
    slow=True,
)
def momentum_row() -> Measured:
    """Change of the momentum of both layers, over that which moves, in a periodic box stirred at random."""
    drift = momentum_drift()
    return Measured(0.0, drift, drift)


PERMEABILITIES = (1e-2, 1e-3, 1e-4, 1e-5)
"""k, m/s: four decades, with water of 30 m/s and up, as much faster as the soil is tighter: the same steps for all."""


@functools.cache
def darcy(permeability: float, gradient: float = 0.5, steps: int = 1600) -> float:
    """Flux through held soil over k i, water at rest at the start."""
    column = Permeameter(permeability=permeability, sound_speed=0.6 / permeability)
    both = column.build(gradient)
    for _ in range(steps):
        both.advance()
    return upward(both, 0.2 * column.height, 0.8 * column.height) / (permeability * gradient)


@VALIDATIONS.row(
    "continuum.permeameter",
    source="Darcy 1856: q = k i, upwards through 20 rows of soil under water, between faces of given pressure",
    because="held to 1 %; grains and drag are summed over a lattice that is 1 to 0.0011; rows that come in through "
    "the base or out of the soil have moved by 0.05 spacings with k 1e-2 and are pushed back by as much head at each "
    "end, 2 · 0.05/(20 · 0.5)",
    tolerance=0.01,
    slow=True,
)
def permeameter_row() -> Measured:
    """q/(k i) for k of 1e-2 to 1e-5 m/s, i 0.5."""
    found = [darcy(k) for k in PERMEABILITIES]
    return Measured(1.0, found, max(abs(value - 1.0) for value in found))


BOILING = Permeameter(held=False)
RAMP = (0.85, 1.1, 0.18)  # of i_c from, to, in s


@functools.cache
def ramp(column: Permeameter = BOILING) -> tuple[Floats, Floats, Floats]:
    """(gradient over i_c, mean upright stress in the soil over that without flow, mean speed of the soil m/s) while the
    gradient rises steadily."""
    low, high, seconds = RAMP
    both = column.build(low * column.critical, low * column.critical)
    ground = both.ground
    assert isinstance(ground, SoilFlow)
    soil, n = ground.soil, ground.soil.soil
    weight = column.critical * WATER * GRAVITY * column.height  # submerged, at the base
    rows = []
    while both.time < seconds:
        part = low + (high - low) * both.time / seconds
        both.water.drains[0].pressure[:] = column.base(part * column.critical)
        both.advance()
        volume = soil.mass[:n] / soil.density
        upright = float((volume * soil.stress[:n, YY]).sum() / volume.sum()) / (0.5 * weight)
        rows.append((part, upright, float(np.abs(soil.v[:n, 1]).mean())))
    part, upright, speed = np.array(rows).T
    return part, upright, speed


def boiling(column: Permeameter = BOILING) -> tuple[float, float, float]:
    """(gradient over i_c at which the mean upright stress in the soil would vanish, from its fall between 0.9 and 0.97;
    speed of the soil at 0.97 and at the end, m/s)."""
    part, upright, speed = ramp(column)
    chosen = (part > 0.9) & (part < 0.97)
    slope, start = np.polyfit(part[chosen], upright[chosen], 1)
    return float(-start / slope), float(speed[chosen][-1]), float(speed[-1])


@VALIDATIONS.row(
    "continuum.boiling_gradient",
    source="Terzaghi 1922: i_c = (G_s - 1)(1 - n)",
    because="held to 5 %; pore pressure follows the rise of 1.4 i_c a second H²/2c_v = 0.01 s late, and the base "
    "loses some 1 % of its head to the 0.2 spacings that water has come in by",
    tolerance=0.05,
    slow=True,
)
def boiling_row() -> Measured:
    """Gradient over i_c at which upward flow takes the soil's weight."""
    found, _, _ = boiling()
    return Measured(1.0, found, abs(found - 1.0))


SINKING = Infiltration()
WATCHED = (0.3, 0.8)  # s


def way_of_the_front(given: Infiltration = SINKING) -> float:
    """Way of the wetting front between two times over what it is exactly."""
    both, places = given.build(), []
    for time in WATCHED:
        while both.time < time:
            both.advance()
        places.append(given.reached(both))
    return (places[1] - places[0]) / (given.front(WATCHED[1]) - given.front(WATCHED[0]))


@VALIDATIONS.row(
    "continuum.infiltration",
    source="Green & Ampt 1911 without capillarity, level sinking: t = (n/k) {z/a - (h0/a²) ln(1 + a z/h0)}, a = 1 - n",
    because="held to 3 %; a front is a row of particles, 2.5 spacings apart in pores, whose place is known to a "
    "tenth of that, 0.25 of a way of 6.8 spacings, at two times: 0.25/6.8/√2",
    tolerance=0.03,
    slow=True,
)
def infiltration_row() -> Measured:
    """Way of the wetting front from 0.3 to 0.8 s in dry soil under sinking water, over the exact one."""
    found = way_of_the_front()
    return Measured(1.0, found, abs(found - 1.0))


@functools.cache
def growth_of_energy(permeability: float) -> float:
    """Largest growth of kinetic, compressive and elastic energy of a stirred, saturated box over 500 steps."""
    both = saturated_box(16, 1, permeability=permeability, speed=0.05)
    ground = both.ground
    assert isinstance(ground, SoilFlow)
    start = least = energies(both, ground)["sum"]
    growth = 0.0
    for _ in range(20):
        for _ in range(25):
            both.advance()
        parts = energies(both, ground)
        free = parts["sum"] - parts["heat of drag"]
        growth, least = max(growth, free - least), min(least, free)
    return growth / start


@VALIDATIONS.row(
    "continuum.seepage_at_any_permeability",
    source="second law: drag and pressure between layers make no energy, k from 1e-1 to 1e-9 m/s",
    because="kick-drift-kick swings by (ω Δt)²/8 of what moves about its energy, ω Δt up to 0.7 in the finest waves",
    tolerance=0.7**2 / 8,
    slow=True,
)
def any_permeability_row() -> Measured:
    """Largest growth of free energy over that at the start, for five permeabilities, the step that of sound."""
    found = [growth_of_energy(k) for k in (1e-1, 1e-3, 1e-5, 1e-7, 1e-9)]
    return Measured(0.0, found, max(found))
