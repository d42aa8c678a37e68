"""SC3 (Holdych 2003): the populations turned back as at a wall of velocity v.

Omega^s_i = f_-i - f_i + f^eq_i(rho, v) - f^eq_-i(rho, v);  the even halves of the equilibria cancel,

    Omega^s_i = f_-i - f_i + 6 w_i rho c.v

The momentum of f + Omega^s is  -sum f c + 2 rho v:  the solid gains  2 B (sum f c - rho v), twice SC1's share, and the
half force h has no part in it, since u has none.
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


class Sc3(NamedTuple):
    """one : the number 1, for its precision."""

    one: np.floating


collide_beside.of(Sc3)(collide_then_mix)
rates.of(Sc3)(no_rates)


@force_share.of(Sc3)
def _free(b, solid):
    """1 - B."""
    return numbers(b).one - b


@is_soft.of(Sc3)
def _sharp(solid):
    """No."""
    return False


@mix.of(Sc3)
def _mix(
    f0, f1, f2, f3, f4, f5, f6, f7, f8, g0, g1, g2, g3, g4, g5, g6, g7, g8, e, b, theta, rho, ux, uy, vx, vy, hx,
    hy, rate, solid,
):  # fmt: skip
    """Bounce-back from the moving solid."""
    c = numbers(b)
    free = c.one - b
    p = c.two * c.three * rho * b
    px, py = p * vx, p * vy
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


@taken.of(Sc3)
def _taken(e, b, rho, jx, jy, hx, hy, rate, solid):
    """2 B (j - rho v)."""
    twice = b + b
    return twice * rho, twice * jx, twice * jy
