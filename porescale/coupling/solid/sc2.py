"""SC2, superposition (Noble & Torczynski 1998): the solid's equilibrium, and the fluid's own relaxed departure from it.

Omega^s_i = f^eq_i(rho, v) - f_i + (1 - 1/tau)(f_i - f^eq_i(rho, u)).

The momentum of f + Omega^s is  rho v + (1 - 1/tau)(sum f c - rho u) = rho v - (1 - 1/tau) h, so the solid gains
B (sum f c + (1 - 1/tau) h - rho v):  the half force inside u has a part in it, whatever the weight.
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
from porescale.lbm.collision.law import moments, numbers


class Sc2(NamedTuple):
    """one : the number 1, for its precision."""

    one: np.floating


collide_beside.of(Sc2)(collide_then_mix)
rates.of(Sc2)(no_rates)


@force_share.of(Sc2)
def _free(b, solid):
    """1 - B."""
    return numbers(b).one - b


@is_soft.of(Sc2)
def _sharp(solid):
    """No."""
    return False


@mix.of(Sc2)
def _mix(
    f0, f1, f2, f3, f4, f5, f6, f7, f8, g0, g1, g2, g3, g4, g5, g6, g7, g8, e, b, theta, rho, ux, uy, vx, vy, hx,
    hy, rate, solid,
):  # fmt: skip
    """Superposition; the equilibria of v and u differ by what is of first and second order in velocity."""
    c = numbers(b)
    free, kept = c.one - b, c.one - rate
    a = b * kept
    d, _, _ = moments(f0, f1, f2, f3, f4, f5, f6, f7, f8)
    p = c.three * rho * b
    px, py = p * (vx - kept * ux), p * (vy - kept * uy)
    sx, sy = c.w1 * px, c.w1 * py
    up, down = c.w2 * (px + py), c.w2 * (py - px)
    n = c.c45 * rho * b
    xx, yy = n * (vx * vx - kept * ux * ux), n * (vy * vy - kept * uy * uy)
    xy = c.two * n * (vx * vy - kept * ux * uy)
    q = b * rate * d - (xx + yy) / c.three
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


@taken.of(Sc2)
def _taken(e, b, rho, jx, jy, hx, hy, rate, solid):
    """B (j + (1 - 1/tau) h - rho v)."""
    kept = numbers(rate).one - rate
    return b * rho, b * (jx + kept * hx), b * (jy + kept * hy)
