"""Solid operators of partially saturated cells, one cell at a time, on whole populations f (9,).

Those of the literature as printed (Noble & Torczynski 1998; Holdych 2003; review: Owen, Leonardi & Feng 2010, eqs
28-33); the exact wall from the formulas in the docstring of porescale/coupling/solid/exact_wall.py.

u carries half the force that acts in the cell:  rho u = sum f c + h.
"""

import numpy as np

from tests.reference.lbm.lbm import BACK, C, W

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


def wall_weight(e, tau):
    """b of the exact wall: 1/b - 1/2 = 1/2 + 3/4 (1 - e)²/(k e)."""
    k = tau - 0.5
    return 4 * k * e / (4 * k * e + 3 * (1 - e) ** 2)


def wall_rates(e, tau, third_order):
    """Rates s_q of the odd moments but momentum, and s_e of the even part; e a number or an array."""
    e = np.asarray(e, float)
    k, t = tau - 0.5, 1 - e
    fluid = 1 / third_order - 0.5
    lam = t * (fluid + (3 / (8 * k) - fluid) * 1.05 * e / (e + 0.05)) + 0.5 * e * t / (t**2 + 0.3**2)
    with np.errstate(divide="ignore", invalid="ignore"):
        r = 0.5 + 0.75 * t**2 / (k * e) + 2 * lam
        k0 = (k - 0.75 * t / r) / t
        even = 1 / (0.5 + k0)
    return 1 / (0.5 + lam), np.where(e == 1, 0.0, even)


def narrow_parts(e, k, magic=3 / 16):
    """y and X of a narrow wall, and g, from the docstring of porescale/coupling/solid/narrow_wall.py; 0 < e < 1."""
    t, s, onset = 1 - e, 0.2, 0.05
    g = 8 / 3 * magic * (1 + s) / (1 + 3 * s) * onset / (e * (e + onset))
    return t**3 * (1 + s) / (t**2 + s), 0.75 * t / k * (1 + g), g


def narrow_weight(e, tau):
    """b of the narrow wall: 1/b - 1/2 = y X."""
    if e in (0.0, 1.0):
        return 2 * e
    y, x, _ = narrow_parts(e, tau - 0.5)
    return 1 / (0.5 + y * x)


def narrow_rates(e, tau, third_order):
    """Rates s_q and s_e of the narrow wall at magic parameter 3/16; e a number."""
    if e in (0.0, 1.0):
        return (2.0, 0.0) if e else (third_order, 1 / tau)
    k, t = tau - 0.5, 1 - e
    y, x, g = narrow_parts(e, k)
    return 1 / (0.5 + (1 - y) * x / 2), 1 / (0.5 + k / t * g / (1 + g))


WALLS = {"exact-wall": (wall_weight, wall_rates), "narrow-wall": (narrow_weight, narrow_rates)}
"""Weight and rates of the operators of which each part relaxes with a rate of its own."""


def halves(f):
    """Even half, momentum's share of the odd one, and the rest of it, of populations (9, ...)."""
    even, odd = (f + f[BACK]) / 2, (f - f[BACK]) / 2
    momentum = np.tensordot(DIRECTIONS, odd, ((0,), (0,)))
    carried = 3 * np.tensordot(WEIGHTS[:, None] * DIRECTIONS, momentum, 1)
    return even, carried, odd - carried


def exact_wall(f, g, rho, force, v, e, tau, third_order, name="exact-wall"):
    """Populations after the step; g: collided fluid;  v, force (2, ...), in the whole cell;  e and rho (...)."""
    j = np.tensordot(DIRECTIONS, f, ((0,), (0,)))
    weight, rates = WALLS[name]
    third, even_rate = rates(e, tau, third_order)
    even, _, rest = halves(f)
    after = j + force + weight(e, tau) * (rho * v - j - force / 2)
    return (
        even
        + even_rate * tau * (halves(g)[0] - even)
        + 3 * np.tensordot(WEIGHTS[:, None] * DIRECTIONS, after, 1)
        + (1 - third) * rest
    )
