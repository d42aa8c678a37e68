"""SC1, bounce-back of the non-equilibrium part (Noble & Torczynski 1998), and its odd half, the default.

SC1:  Omega^s_i = f_-i - f_i + f^eq_i(rho, v) - f^eq_-i(rho, u).  Its even half, f^eq+(v) - f^eq+(u), has no moment of
mass or momentum, is quadratic in velocity, and nothing relaxes it where B = 1: density and stress inside a grain drift
without end (a disc spun for 20 000 steps: density 0.75, torque 4 % down; grains at rest in a collapsing column: 0.85).
The odd half leaves it out, which changes drag by less than 1e-4 and stops the drift:

    Omega^s_i = f_-i - f_i + 3 w_i rho c.(v + u)

The solid gains  B (sum f c - h - rho v)  of momentum.
"""

from typing import NamedTuple

import numpy as np

from porescale.coupling.solid.law import (
    collide_beside,
    collide_then_mix,
    force_share,
    is_soft,
    mix,
    no_rates,
    rates,
    taken,
)
from porescale.lbm.collision.law import numbers


class OddSc1(NamedTuple):
    """one : the number 1, for its precision."""

    one: np.floating


class Sc1(NamedTuple):
    """one : the number 1, for its precision."""

    one: np.floating


collide_beside.of(OddSc1, Sc1)(collide_then_mix)
rates.of(OddSc1, Sc1)(no_rates)


@force_share.of(OddSc1, Sc1)
def _free(b, solid):
    """1 - B."""
    return numbers(b).one - b


@is_soft.of(OddSc1, Sc1)
def _sharp(solid):
    """No."""
    return False


@mix.of(OddSc1)
def _mix_odd(
    f0, f1, f2, f3, f4, f5, f6, f7, f8, g0, g1, g2, g3, g4, g5, g6, g7, g8, e, b, theta, rho, ux, uy, vx, vy, hx,
    hy, rate, solid,
):  # fmt: skip
    """Odd half of SC1."""
    c = numbers(b)
    free = c.one - b
    p = c.three * rho * b
    px = p * (vx + ux)
    py = p * (vy + uy)
    sx, sy = c.w1 * px, c.w1 * py
    up, down = c.w2 * (px + py), c.w2 * (py - px)
    return (
        free * g0 + b * f0,
        free * g1 + (b * f2 + sx),
        free * g2 + (b * f1 - sx),
        free * g3 + (b * f4 + sy),
        free * g4 + (b * f3 - sy),
        free * g5 + (b * f6 + up),
        free * g6 + (b * f5 - up),
        free * g7 + (b * f8 + down),
        free * g8 + (b * f7 - down),
    )


@mix.of(Sc1)
def _mix_whole(
    f0, f1, f2, f3, f4, f5, f6, f7, f8, g0, g1, g2, g3, g4, g5, g6, g7, g8, e, b, theta, rho, ux, uy, vx, vy, hx,
    hy, rate, solid,
):  # fmt: skip
    """SC1 as published: the odd half and  w (9/2 ((c.v)² - (c.u)²) - 3/2 (v² - u²)) rho."""
    c = numbers(b)
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


@taken.of(OddSc1, Sc1)
def _taken(e, b, rho, jx, jy, hx, hy, rate, solid):
    """B (j - h - rho v)."""
    return b * rho, b * (jx - hx), b * (jy - hy)
