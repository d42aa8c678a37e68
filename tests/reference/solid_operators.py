"""Solid operators of partially saturated cells, one cell at a time, as printed (Noble & Torczynski 1998; Holdych 2003;
review: Owen, Leonardi & Feng 2010, eqs 28-33), on whole populations f (9,).

u carries half the force that acts in the cell:  rho u = sum f c + h.
"""

from __future__ import annotations

import numpy as np

from tests.reference.lbm import BACK, C, W

DIRECTIONS, WEIGHTS, BACK = np.array(C, float), np.array(W), np.array(BACK)


def equilibrium(rho, u):
    cu = DIRECTIONS @ u
    return WEIGHTS * rho * (1 + 3 * cu + 4.5 * cu**2 - 1.5 * u @ u)


def sc1(f, rho, u, v, tau):
    return f[BACK] - f + equilibrium(rho, v) - equilibrium(rho, u)[BACK]


def odd_sc1(f, rho, u, v, tau):
    return f[BACK] - f + 3 * WEIGHTS * rho * (DIRECTIONS @ (v + u))


def sc2(f, rho, u, v, tau):
    return equilibrium(rho, v) - f + (1 - 1 / tau) * (f - equilibrium(rho, u))


def sc3(f, rho, u, v, tau):
    return f[BACK] - f + equilibrium(rho, v) - equilibrium(rho, v)[BACK]


OPERATORS = {"odd-SC1": odd_sc1, "SC1": sc1, "SC2": sc2, "SC3": sc3}
