"""Two relaxation times (Ginzburg, Verhaeghe & d'Humieres 2008), with body force (Guo, Zheng & Shi 2002).

The even half of a pair, (f_i + f_-i)/2, relaxes with w+ = 1/tau and carries the viscosity; the odd half with w-, set by
the magic parameter  L = (1/w+ - 1/2)(1/w- - 1/2).  L = 3/16 puts a half-way wall exactly midway in a parabolic flow;
L = 1/4 is the most stable choice.  Where an eddy viscosity changes w+, L is held.
"""

from typing import NamedTuple

import numpy as np

from porescale.common.compiled.jit import inline
from porescale.lbm.collision.law import (
    collide,
    collide_in_shares,
    half_force,
    half_of_force,
    numbers,
    shear_rate,
)
from porescale.lbm.collision.smagorinsky import eddy_version

MAGIC_MIDWAY_WALL = 3 / 16


class Trt(NamedTuple):
    """rate : w+ = 1/tau;  magic : L;  fx, fy : body force density."""

    rate: np.floating
    fx: np.floating
    fy: np.floating
    magic: np.floating


class FreeTrt(NamedTuple):
    """The same without a body force: fx and fy are 0, and what they would add is not computed."""

    rate: np.floating
    fx: np.floating
    fy: np.floating
    magic: np.floating


EddyTrt = eddy_version(Trt)
half_force.of(Trt, EddyTrt)(half_of_force)


def odd_rate(relaxation_time: float, magic: float) -> float:
    """Rate w- of the odd half for a relaxation time and a magic parameter."""
    return 1 / (0.5 + magic / (relaxation_time - 0.5))


@half_force.of(FreeTrt)
def _no_force(law):
    """None: adding -0 changes nothing, which compilers know."""
    none = -numbers(law.rate).zero
    return none, none


@shear_rate.of(Trt, FreeTrt)
def _molecular(f0, f1, f2, f3, f4, f5, f6, f7, f8, d, jx, jy, ux, uy, law):
    """Rate of the molecular viscosity, the same everywhere."""
    return law.rate


@inline
def odd_rate_here(rate, law):
    """w- of a cell with w+ = ``rate``; one division, since with eddies every cell has its own."""
    c = numbers(rate)
    spread = c.one - c.half * rate  # (tau - 1/2)/tau
    return spread / (c.half * spread + law.magic * rate)


@collide.of(Trt, EddyTrt)
def _collide(f0, f1, f2, f3, f4, f5, f6, f7, f8, d, jx, jy, ux, uy, rate, law):
    """Each half relaxes with its own rate."""
    return relax_halves(f0, f1, f2, f3, f4, f5, f6, f7, f8, d, jx, jy, ux, uy, rate, odd_rate_here(rate, law), law)


@collide.of(FreeTrt)
def _collide_free(f0, f1, f2, f3, f4, f5, f6, f7, f8, d, jx, jy, ux, uy, rate, law):
    """The same of fluid that nothing drives."""
    odd = odd_rate_here(rate, law)
    q, xx, yy, xy = even_part(d, jx, jy, ux, uy, rate)
    return relax_by(f0, f1, f2, f3, f4, f5, f6, f7, f8, rate, odd, q, xx, yy, xy, odd * jx, odd * jy)


@collide_in_shares.of(Trt, EddyTrt)
def _collide_in_shares(
    f0, f1, f2, f3, f4, f5, f6, f7, f8, d, jx, jy, ux, uy, rate, even, odd, kept, px, py, law,
):  # fmt: skip
    """Each half at its own rate."""
    return relax_shares(
        f0, f1, f2, f3, f4, f5, f6, f7, f8, d, jx, jy, ux, uy, rate, odd_rate_here(rate, law), even, odd, kept, px, py,
        law,
    )  # fmt: skip


@collide_in_shares.of(FreeTrt)
def _collide_free_in_shares(
    f0, f1, f2, f3, f4, f5, f6, f7, f8, d, jx, jy, ux, uy, rate, even, odd, kept, px, py, law,
):  # fmt: skip
    """The same of fluid that nothing drives."""
    c, own = numbers(rate), odd_rate_here(rate, law)
    q, xx, yy, xy = even_part(d, jx, jy, ux, uy, even * rate)
    lost = c.one - kept - odd * (c.one - own)
    return relax_by(
        f0, f1, f2, f3, f4, f5, f6, f7, f8, even * rate, lost, q, xx, yy, xy, odd * (own * jx) + px,
        odd * (own * jy) + py,
    )  # fmt: skip


@inline
def relax_halves(f0, f1, f2, f3, f4, f5, f6, f7, f8, d, jx, jy, ux, uy, even, odd, law):
    """The nine collided populations for rates ``even`` and ``odd`` of the two halves of each pair.

    Equilibrium with the rate, the forcing with (1 - rate/2).
    """
    c = numbers(even)
    se, so = c.one - c.half * even, c.one - c.half * odd
    return relax_to(
        f0, f1, f2, f3, f4, f5, f6, f7, f8, d, jx, jy, ux, uy, even, se, odd, odd * jx + so * law.fx,
        odd * jy + so * law.fy, law,
    )  # fmt: skip


@inline
def relax_shares(
    f0, f1, f2, f3, f4, f5, f6, f7, f8, d, jx, jy, ux, uy, even, odd, even_share, odd_share, kept, px, py, law,
):  # fmt: skip
    """``collide_in_shares`` for rates ``even`` and ``odd``: each half relaxes at a rate that has its share in it."""
    c = numbers(even)
    se, so = even_share * (c.one - c.half * even), c.one - c.half * odd
    mx = odd_share * (odd * jx + so * law.fx) + px
    my = odd_share * (odd * jy + so * law.fy) + py
    lost = c.one - kept - odd_share * (c.one - odd)
    return relax_to(
        f0, f1, f2, f3, f4, f5, f6, f7, f8, d, jx, jy, ux, uy, even_share * even, se, lost, mx, my, law
    )  # fmt: skip


@inline
def relax_to(f0, f1, f2, f3, f4, f5, f6, f7, f8, d, jx, jy, ux, uy, even, se, odd, mx, my, law):
    """``relax_by`` with ``even`` times equilibrium and ``se`` times the forcing as the even half's gain."""
    c, fx, fy = numbers(even), law.fx, law.fy
    jxx = jx * ux
    jyy = jy * uy
    q = even * (d - c.c15 * (jxx + jyy)) - c.three * se * (ux * fx + uy * fy)
    xx = c.c45 * even * jxx + c.nine * se * ux * fx
    yy = c.c45 * even * jyy + c.nine * se * uy * fy
    xy = c.nine * (even * jx * uy + se * (ux * fy + uy * fx))
    return relax_by(f0, f1, f2, f3, f4, f5, f6, f7, f8, even, odd, q, xx, yy, xy, mx, my)


@inline
def even_part(d, jx, jy, ux, uy, even):
    """q, xx, yy, xy of ``even`` times equilibrium."""
    c = numbers(even)
    jxx = jx * ux
    jyy = jy * uy
    q = even * (d - c.c15 * (jxx + jyy))
    return q, c.c45 * even * jxx, c.c45 * even * jyy, c.nine * (even * jx * uy)


@inline
def relax_by(f0, f1, f2, f3, f4, f5, f6, f7, f8, even, odd, q, xx, yy, xy, mx, my):
    """Populations that lose shares ``even`` and ``odd`` of their halves.

    The even half of direction c gains w (q + cx² xx + cy² yy + cx cy xy), the odd one 3 w (cx mx + cy my).
    """
    c = numbers(even)
    half = c.half
    w1, w2 = c.w1, c.w2
    t1, t2 = c.three * w1, c.three * w2
    he = half * even
    ho = half * odd
    g0 = f0 - even * f0 + c.w0 * q
    s = w1 * (q + xx) - he * (f1 + f2)
    m = t1 * mx - ho * (f1 - f2)
    g1 = f1 + s + m
    g2 = f2 + s - m
    s = w1 * (q + yy) - he * (f3 + f4)
    m = t1 * my - ho * (f3 - f4)
    g3 = f3 + s + m
    g4 = f4 + s - m
    diagonal = q + xx + yy
    s = w2 * (diagonal + xy) - he * (f5 + f6)
    m = t2 * (mx + my) - ho * (f5 - f6)
    g5 = f5 + s + m
    g6 = f6 + s - m
    s = w2 * (diagonal - xy) - he * (f7 + f8)
    m = t2 * (my - mx) - ho * (f7 - f8)
    g7 = f7 + s + m
    g8 = f8 + s - m
    return g0, g1, g2, g3, g4, g5, g6, g7, g8
