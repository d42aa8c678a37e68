"""Convergence of displacements: the same vortices over more pixels, and over more tracers."""

from dataclasses import replace

from porescale.common.evidence.convergence import Ladders
from porescale.piv.images import flows
from porescale.validation.piv.pairs import CAMERA, SIZE, trial

LADDERS = Ladders()
SEEDS = range(2)
SHARE = 1 / 32
"""Largest displacement over the wavelength: the same strain in all pairs."""


@LADDERS.ladder(
    "piv.pixels_in_a_vortex",
    title="Root mean square error of a component over the largest displacement; Taylor-Green vortices, two seeds",
    along="pixels in a wave of vortices",
    levels=(48, 64, 96, 128, 192),
    because="no order is expected: tracers and noise stay as they are, and smoothing adapts to what the flow lets it",
)
def vortices(wave: float) -> float:
    """0.05 tracers a pixel, noise 3 grey levels, 5 % lost; largest displacement 1/32 of the wave."""
    peak = wave * SHARE
    return trial(flows.taylor_green(SIZE, peak, wave), CAMERA, SEEDS).rms / peak


@LADDERS.ladder(
    "piv.tracers_in_a_pixel",
    title="Root mean square error of a component of a Lamb-Oseen vortex, 6 px at 64 px from its centre, two seeds; px",
    along="tracers in a pixel",
    levels=(0.0125, 0.025, 0.05, 0.1),
    because="no order is expected: of n independent tracers it would be 1/2, and windows and splines share them",
)
def tracers(density: float) -> float:
    """As for the vortex of the accuracy table, other densities of tracers."""
    return trial(flows.lamb_oseen(SIZE, 6.0, 64.0), replace(CAMERA, density=density), SEEDS).rms
