"""The longest stable step: of one contact, and of a lattice of discs from its dynamical matrix.  SI."""

import math
from functools import partial

import numpy as np

from porescale.common.evidence.validations import Measured, Validations
from porescale.dem.contact.linear import Linear
from porescale.validation.dem.bodies import lattice
from porescale.validation.dem.setups import MASS, RADIUS, STIFFNESS, grows, law_at, on_floor, stability_limit

VALIDATIONS = Validations()


def critical_step(damping_ratio: float) -> float:
    """Measured stability limit of a disc pressed on a floor, over sqrt(m/k), by bisection."""
    unit = math.sqrt(MASS / STIFFNESS)
    load = np.array([[0.0, -1e-3 * RADIUS * STIFFNESS]])
    pressed = partial(on_floor, law_at(damping_ratio), -1e-3 * RADIUS)
    return stability_limit(0.1, 3.0, 2e-3, lambda step: grows(pressed(), load, step * unit, 2000))


@VALIDATIONS.row(
    "dem.critical_step_of_a_contact",
    source="dt = 2 sqrt(m/k)(sqrt(1+h^2) - h), leap-frog with lagged damping (tutorial I-6, sign corrected)",
    because="1 %: growth within 2000 steps shows 1e-3 beyond the limit, bisection stops at 2e-3",
    tolerance=0.01,
)
def contact_row() -> Measured:
    """Longest stable step of a disc pressed on a floor, in sqrt(m/k), h = 0, 0.1, 0.5, 1."""
    ratios = (0.0, 0.1, 0.5, 1.0)
    return Measured.relative([2.0 * (math.hypot(1.0, h) - h) for h in ratios], [critical_step(h) for h in ratios])


def lattice_frequency(shear: float, waves: int = 48) -> float:
    """Largest m w^2/k_n of the infinite triangular lattice of equal discs with k_t = ``shear`` k_n, exact.

    Dynamical matrix of (u, r q): each contact, direction n, tangent t, phase p = exp(i q.n): normal part n.(1 - p)u,
    tangential part t.(1 - p)u + (1 + p) r q; mass 1 for u and 1/2 for r q.  Maximum over a grid of wave
    vectors that holds the corners and edge centres of the zone.
    """
    highest = 0.0
    scale = np.array([1.0, 1.0, math.sqrt(2.0)])
    ends = np.array([(1.0, 0.0), (0.5, math.sqrt(0.75))])
    back = 2.0 * math.pi * np.linalg.inv(ends).T
    for a in range(waves):
        for b in range(waves):
            q = back[0] * a / waves + back[1] * b / waves
            matrix = np.zeros((3, 3), complex)
            for angle in (0.0, math.pi / 3.0, 2.0 * math.pi / 3.0):
                n = np.array([math.cos(angle), math.sin(angle)])
                p = np.exp(1j * float(q @ n))
                normal = np.array([n[0] * (1 - p), n[1] * (1 - p), 0.0])
                tangent = np.array([-n[1] * (1 - p), n[0] * (1 - p), 1 + p])
                matrix += np.outer(normal.conj(), normal) + shear * np.outer(tangent.conj(), tangent)
            highest = max(highest, float(np.linalg.eigvalsh(scale[:, None] * matrix * scale)[-1]))
    return highest


def lattice_critical_step(shear: float) -> float:
    """Measured stability limit of a periodic triangular lattice of 6 x 6 discs, over sqrt(m/k_n)."""
    cells, unit = 6, math.sqrt(MASS / STIFFNESS)
    law = Linear(STIFFNESS, 0.0, shear * STIFFNESS, friction=1e6)
    pressed, loads = partial(lattice, law, cells, skin=0.05 * RADIUS), np.zeros((cells**2, 2))
    return stability_limit(0.1, 3.0, 3e-3, lambda step: grows(pressed(), loads, step * unit, 2000))


@VALIDATIONS.row(
    "dem.critical_step_of_a_lattice",
    source="largest eigenvalue of the dynamical matrix of the triangular lattice, translation and rotation",
    because="1 %: bisection stops at 3e-3, the lattice is pressed by 1e-4 (geometric stiffness of that order)",
    tolerance=0.01,
)
def lattice_row() -> Measured:
    """Longest stable step of a periodic lattice of discs in contact, in sqrt(m/k_n), k_t/k_n = 0.25 and 0.8."""
    shears = (0.25, 0.8)
    exact = [2.0 / math.sqrt(lattice_frequency(shear)) for shear in shears]
    return Measured.relative(exact, [lattice_critical_step(shear) for shear in shears])
