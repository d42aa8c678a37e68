"""SC1, bounce-back of the non-equilibrium part (Noble & Torczynski 1998).

    Omega^s_i = f_-i - f_i + f^eq_i(rho, v) - f^eq_-i(rho, u)

Its symmetric half, f^eq+(v) - f^eq+(u), has no moment of mass or momentum, is quadratic in velocity, and nothing
relaxes it where B = 1: density and stress inside a grain drift without end (a disc spun for 20 000 steps: density 0.75,
torque 4 % down; grains at rest in a collapsing column: 0.85).  odd_sc1.py leaves it out.

The solid gains  B (sum f c - h - rho v)  of momentum.
"""

from typing import NamedTuple

import numpy as np

from porescale.coupling.solid.entry import SolidOperator
from porescale.coupling.solid.law import blend, momentum_to_solid, with_sharp_rims
from porescale.coupling.solid.odd_sc1 import momentum_to_solid_sc1
from porescale.lbm.collision.law import numbers


@with_sharp_rims
class Sc1(NamedTuple):
    """one : the number 1, for its precision."""

    one: np.floating


momentum_to_solid.of(Sc1)(momentum_to_solid_sc1)


@blend.of(Sc1)
def _blend(f, g, cell, m, rate, solid):
    """SC1 as published: the antisymmetric half and  w (9/2 ((c.v)² - (c.u)²) - 3/2 (v² - u²)) rho."""
    f0, f1, f2, f3, f4, f5, f6, f7, f8 = f
    g0, g1, g2, g3, g4, g5, g6, g7, g8 = g
    b, vx, vy, ux, uy = cell.b, cell.vx, cell.vy, m.ux, m.uy
    c = numbers(b)
    rho = c.one + m.d
    free = c.one - b
    p = c.three * rho * b
    px = p * (vx + ux)
    py = p * (vy + uy)
    sx, sy = c.w1 * px, c.w1 * py
    up, down = c.w2 * (px + py), c.w2 * (py - px)
    n = c.c45 * rho * b
    xx, yy, xy = n * (vx * vx - ux * ux), n * (vy * vy - uy * uy), c.two * n * (vx * vy - ux * uy)
    q = -(xx + yy) / c.three
    ex, ey = c.w1 * (q + xx), c.w1 * (q + yy)
    e5, e7 = c.w2 * (q + xx + yy + xy), c.w2 * (q + xx + yy - xy)
    return (
        free * g0 + b * f0 + c.w0 * q,
        free * g1 + (b * f2 + sx) + ex,
        free * g2 + (b * f1 - sx) + ex,
        free * g3 + (b * f4 + sy) + ey,
        free * g4 + (b * f3 - sy) + ey,
        free * g5 + (b * f6 + up) + e5,
        free * g6 + (b * f5 - up) + e5,
        free * g7 + (b * f8 + down) + e7,
        free * g8 + (b * f7 - down) + e7,
    )


SOLID_OPERATOR = SolidOperator(
    name="SC1",
    purpose="bounce-back of the non-equilibrium part, as published: drifts where grains stay",
    law=Sc1,
    constants={"one": 1.0},
    order=2,
)
