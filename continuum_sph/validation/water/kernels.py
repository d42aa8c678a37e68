"""Smoothing kernels: their integral and slope, and what sums over a lattice take off."""

from collections.abc import Callable

import numpy as np

from continuum_sph.water.smoothing import CUBIC, SUPPORT, WENDLAND, kernel_slope, kernel_value
from porescale.common.evidence.validations import Measured, Validations

VALIDATIONS = Validations()


LATTICE = 0.0130
"""1 - Σ V (-1/r dW/dr) y² over a square lattice, Wendland C2 at h = RATIO spacings (summed in the tests): what a
lattice takes off viscosity, and off gradient and divergence each and so off the speed of sound."""

SPREAD = 5 / 36
"""Half the variance ∫ x² W dA of Wendland C2, over h²: smoothing a field u adds SPREAD h² u'' to it."""


@VALIDATIONS.row(
    "continuum.kernel_integral",
    source="definition: eq. 2 of Maeda & Sakai 2004",
    because="midpoint rule on rings 1e-3 wide: (1e-3)²/24 times the slope 2π W(0) of 2π q W at q = 0, at most 3.5",
    tolerance=1.001 * 1e-6 / 24 * 3.5,
)
def kernel_integral() -> Measured:
    """∫ W dA of both kernels."""
    q = (np.arange(2000) + 0.5) * SUPPORT / 2000
    found = [
        float(sum(2.0 * np.pi * v * kernel_value(kind, v, 1.0) * SUPPORT / 2000 for v in q))
        for kind in (CUBIC, WENDLAND)
    ]
    return Measured.absolute(1.0, found)


def slope_error(slope: Callable[[int, float, float], float]) -> float:
    """Largest difference (1/m⁴) of a ``slope`` (kind, q, h) from differences of both kernels, h = 1 m."""
    worst = 0.0
    for kind in (CUBIC, WENDLAND):
        for q in np.linspace(0.1, 2.1, 57):
            differences = (kernel_value(kind, q + 1e-5, 1.0) - kernel_value(kind, q - 1e-5, 1.0)) / 2e-5 / q
            worst = max(worst, abs(differences - slope(kind, q, 1.0)))
    return worst


@VALIDATIONS.row(
    "continuum.kernel_slope",
    source="definition: (1/r) dW/dr against central differences of W",
    because="central differences over 2e-5 h, divided by q >= 0.1: third derivative, at most 8.4, times (1e-5)²/6, and "
    "round-off of values below 0.6, 1e-16 0.6/1e-5",
    tolerance=(8.4 * 1e-10 / 6 + 0.6e-11) / 0.1,
)
def slope_row() -> Measured:
    """Largest difference of the slope of both kernels, h = 1 m."""
    return Measured.absolute(0.0, slope_error(kernel_slope))
