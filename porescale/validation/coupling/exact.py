"""Exact answers that are known as Laplace transforms: a disc released or spun in unbounded, slow flow.

Time in units of a²/nu, a the radius, nu the viscosity of the fluid; s the density ratio.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray
from scipy.special import kve

TALBOT = 32
"""Nodes of the contour: errors of 1e-9 and less for transforms that are smooth off the negative axis."""


def inverse_laplace(
    transform: Callable[[NDArray[np.complexfloating]], NDArray[np.complexfloating]], time: float
) -> float:
    """f(time) from F(p), by Talbot's contour with a fixed number of nodes (Abate & Valko 2004)."""
    r = 2 * TALBOT / (5 * time)
    theta = np.arange(1, TALBOT) * np.pi / TALBOT
    cot = 1 / np.tan(theta)
    p = r * theta * (cot + 1j)
    turn = 1 + 1j * theta * (1 + cot**2) - 1j * cot
    terms = np.exp(p * time) * transform(p) * turn
    first = 0.5 * np.exp(r * time) * transform(np.array([r + 0j]))[0]
    return float(r / TALBOT * (first + terms.sum()).real)


def start_up(ratio: float, time: float) -> float:
    """v/((s - 1) g a²/nu) of a disc released from rest:  V(p) = 1/(p²(s + 1 + 4 K1(z)/(z K0(z)))), z = sqrt(p).

    Linear and unbounded; the bracket is the disc's mass, the displaced fluid's once (added mass) and the viscous
    history (Stokes 1851, oscillating cylinder).
    """

    def transform(p: NDArray[np.complexfloating]) -> NDArray[np.complexfloating]:
        """V(p)."""
        z = np.sqrt(p)
        return np.asarray(1 / (p**2 * (ratio + 1 + 4 * kve(1, z) / (z * kve(0, z)))))

    return inverse_laplace(transform, time)


def spin_down(ratio: float, time: float) -> float:
    """Spin over its first value of a disc set spinning in fluid at rest:  W(p) = s/(s p + 8 + 4 z K0(z)/K1(z)).

    From I (p W - 1) = -2 pi mu a² (2 + z K0/K1) W, I = s rho pi a⁴/2: the flow K1(z r/a) around a turning cylinder.
    """

    def transform(p: NDArray[np.complexfloating]) -> NDArray[np.complexfloating]:
        """W(p)."""
        z = np.sqrt(p)
        return np.asarray(ratio / (ratio * p + 8 + 4 * z * kve(0, z) / kve(1, z)))

    return inverse_laplace(transform, time)
