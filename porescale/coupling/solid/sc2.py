"""SC2, superposition (Noble & Torczynski 1998): the solid's equilibrium, and the fluid's own relaxed departure from it.

Omega^s_i = f^eq_i(rho, v) - f_i + (1 - 1/tau)(f_i - f^eq_i(rho, u)).

The momentum of f + Omega^s is  rho v + (1 - 1/tau)(sum f c - rho u) = rho v - (1 - 1/tau) h, so the solid gains
B (sum f c + (1 - 1/tau) h - rho v):  the half force inside u has a part in it, whatever the weight.
"""

from typing import NamedTuple

import numpy as np

from porescale.coupling.solid.entry import SolidOperator
from porescale.coupling.solid.law import blend, momentum_to_solid, with_sharp_rims
from porescale.lbm.collision.law import numbers


@with_sharp_rims
class Sc2(NamedTuple):
    """one : the number 1, for its precision."""

    one: np.floating


@blend.of(Sc2)
def _blend(f, g, cell, m, rate, solid):
    """Superposition; the equilibria of v and u differ by what is of first and second order in velocity."""
    f0, f1, f2, f3, f4, f5, f6, f7, f8 = f
    g0, g1, g2, g3, g4, g5, g6, g7, g8 = g
    b, vx, vy, ux, uy = cell.b, cell.vx, cell.vy, m.ux, m.uy
    c = numbers(b)
    rho = c.one + m.d
    free, kept = c.one - b, c.one - rate
    a = b * kept
    p = c.three * rho * b
    px, py = p * (vx - kept * ux), p * (vy - kept * uy)
    sx, sy = c.w1 * px, c.w1 * py
    up, down = c.w2 * (px + py), c.w2 * (py - px)
    n = c.c45 * rho * b
    xx, yy = n * (vx * vx - kept * ux * ux), n * (vy * vy - kept * uy * uy)
    xy = c.two * n * (vx * vy - kept * ux * uy)
    q = b * rate * m.d - (xx + yy) / c.three
    ex, ey = c.w1 * (q + xx), c.w1 * (q + yy)
    e5, e7 = c.w2 * (q + xx + yy + xy), c.w2 * (q + xx + yy - xy)
    return (
        free * g0 + a * f0 + c.w0 * q,
        free * g1 + a * f1 + (ex + sx),
        free * g2 + a * f2 + (ex - sx),
        free * g3 + a * f3 + (ey + sy),
        free * g4 + a * f4 + (ey - sy),
        free * g5 + a * f5 + (e5 + up),
        free * g6 + a * f6 + (e5 - up),
        free * g7 + a * f7 + (e7 + down),
        free * g8 + a * f8 + (e7 - down),
    )


@momentum_to_solid.of(Sc2)
def _momentum_to_solid(cell, rho, jx, jy, rate, solid):
    """B (j + (1 - 1/tau) h - rho v)."""
    kept = numbers(rate).one - rate
    b = cell.b
    return b * rho, b * (jx + kept * cell.hx), b * (jy + kept * cell.hy)


SOLID_OPERATOR = SolidOperator(
    name="SC2",
    purpose="superposition: smooth inside grains, but converges at first order only; for comparison",
    law=Sc2,
    constants={"one": 1.0},
    order=3,
)
