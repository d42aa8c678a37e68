"""Equilibrium populations to second order in velocity (Qian, d'Humieres & Lallemand 1992), shifted by the weights."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from porescale.lbm.lattice import CX, CY, WEIGHTS


def equilibrium(density: Any, ux: Any, uy: Any, shape: tuple[int, ...]) -> NDArray[np.float64]:
    """h_i = w_i (rho - 1 + rho (3 c.u + 9/2 (c.u)² - 3/2 u²)), (9, *shape); arguments broadcast to ``shape``."""
    rho, ux, uy = (np.broadcast_to(np.asarray(a, float), shape) for a in (density, ux, uy))
    out = np.empty((9, *shape))
    for i in range(9):
        cu = CX[i] * ux + CY[i] * uy
        out[i] = WEIGHTS[i] * (rho - 1 + rho * (3 * cu + 4.5 * cu**2 - 1.5 * (ux**2 + uy**2)))
    return out
