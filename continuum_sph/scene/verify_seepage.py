"""Validations of soil and water as two layers; each measuring function takes what its failing twin changes."""

from __future__ import annotations

import functools
from collections.abc import Callable
from dataclasses import replace

import numpy as np

from continuum_sph.scene.trials_seepage import (
    Consolidation,
    isochrones,
    momentum,
    realised_modulus,
    saturated_box,
)
from continuum_sph.seepage import Seepage
from porescale.workbench.validations import Measured, Validations

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
