"""Two relaxation times (Ginzburg, Verhaeghe & d'Humieres 2008), with body force (Guo, Zheng & Shi 2002).

The symmetric half of a pair, (f_i + f_-i)/2, relaxes with w+ = 1/tau and carries the viscosity; the antisymmetric half
with w-, set by the magic parameter  L = (1/w+ - 1/2)(1/w- - 1/2).  L = 3/16 puts a half-way wall exactly midway in a
parabolic flow; L = 1/4 is the most stable choice.  Where an eddy viscosity changes w+, L is held.
"""

from typing import Any, NamedTuple

import numpy as np

from porescale.common.compiled.jit import inline
from porescale.common.compiled.simd import fma
from porescale.lbm.collision.entry import Operator, Stability
from porescale.lbm.collision.law import (
    collide,
    collide_partial,
    half_force,
    half_of_force,
    molecular_rate,
    numbers,
    shear_rate,
)
from porescale.lbm.collision.smagorinsky import eddy_version


class Trt(NamedTuple):
    """rate : w+ = 1/tau;  magic : L;  fx, fy : body force density."""

    rate: np.floating
    fx: np.floating
    fy: np.floating
    magic: np.floating


class TrtWithoutForce(NamedTuple):
    """The same without a body force: fx and fy are 0, and what they would add is not computed."""

    rate: np.floating
    fx: np.floating
    fy: np.floating
    magic: np.floating


EddyTrt = eddy_version(Trt)
half_force.of(Trt, EddyTrt)(half_of_force)
shear_rate.of(Trt, TrtWithoutForce)(molecular_rate)


def antisymmetric_rate(relaxation_time: float, magic: float) -> float:
    """Rate w- of the antisymmetric half for a relaxation time and a magic parameter."""
    return 1 / (0.5 + magic / (relaxation_time - 0.5))


def magic_rate_of(law: Any) -> float:
    """w- of a law with ``rate`` and ``magic``, at the molecular viscosity."""
    return antisymmetric_rate(1 / float(law.rate), float(law.magic))


@half_force.of(TrtWithoutForce)
def _no_force(law):
    """Source of a fluid without body force: -0, since adding it changes nothing and compilers remove it."""
    none = -numbers(law.rate).zero
    return none, none


@inline
def magic_rate(rate, law):
    """Rate w- of a cell with w+ = ``rate``; one division, since with eddies every cell has its own."""
    c = numbers(rate)
    spread = c.one - c.half * rate  # (tau - 1/2)/tau
    return spread / (c.half * spread + law.magic * rate)


@collide.of(Trt, EddyTrt)
def _collide(f, m, rate, law):
    """TRT collision: each half of the populations relaxes with its own rate."""
    return relax_halves(f, m, rate, magic_rate(rate, law), law)


@collide.of(TrtWithoutForce)
def _collide_without_force(f, m, rate, law):
    """TRT collision of fluid without body force."""
    minus = magic_rate(rate, law)
    return relax_by(f, rate, minus, symmetric_equilibrium(m, rate), (minus * m.jx, minus * m.jy))


@collide_partial.of(Trt, EddyTrt)
def _collide_partial(f, m, rate, part, law):
    """Partial TRT collision: each half of the populations relaxes with its own rate."""
    return relax_partial(f, m, rate, magic_rate(rate, law), part, law)


@collide_partial.of(TrtWithoutForce)
def _collide_partial_without_force(f, m, rate, part, law):
    """Partial TRT collision of fluid without body force."""
    c, own, minus = numbers(rate), magic_rate(rate, law), part.minus
    gain = symmetric_equilibrium(m, part.plus * rate)
    lost = c.one - part.kept - minus * (c.one - own)
    added = (fma(minus, own * m.jx, part.px), fma(minus, own * m.jy, part.py))
    return relax_by(f, part.plus * rate, lost, gain, added)


@inline
def relax_halves(f, m, plus, minus, law):
    """The nine collided populations for rates ``plus`` and ``minus`` of the two halves of each pair.

    Equilibrium with the rate, the forcing with (1 - rate/2).
    """
    c = numbers(plus)
    sp, sm = c.one - c.half * plus, c.one - c.half * minus
    added = (fma(minus, m.jx, sm * law.fx), fma(minus, m.jy, sm * law.fy))
    return relax_by(f, plus, minus, symmetric_gain(m, plus, sp, law), added)


@inline
def relax_partial(f, m, plus, minus, part, law):
    """``collide_partial`` for rates ``plus`` and ``minus``: each half relaxes at a rate that has its share in it."""
    c = numbers(plus)
    sp, sm = part.plus * (c.one - c.half * plus), c.one - c.half * minus
    added = (
        fma(part.minus, fma(minus, m.jx, sm * law.fx), part.px),
        fma(part.minus, fma(minus, m.jy, sm * law.fy), part.py),
    )
    lost = c.one - part.kept - part.minus * (c.one - minus)
    rate = part.plus * plus
    return relax_by(f, rate, lost, symmetric_gain(m, rate, sp, law), added)


@inline
def symmetric_gain(m, share, forcing, law):
    """(q, xx, yy, xy) of ``relax_by``: ``share`` times equilibrium and ``forcing`` times the body force's part."""
    c, fx, fy = numbers(share), law.fx, law.fy
    d, jx, jy, ux, uy = m
    jxx = jx * ux
    jyy = jy * uy
    return (
        fma(share, fma(-c.c15, jxx + jyy, d), -c.three * forcing * (ux * fx + uy * fy)),
        fma(c.c45 * share, jxx, c.nine * forcing * (ux * fx)),
        fma(c.c45 * share, jyy, c.nine * forcing * (uy * fy)),
        c.nine * fma(share * jx, uy, forcing * (ux * fy + uy * fx)),
    )


@inline
def symmetric_equilibrium(m, share):
    """(q, xx, yy, xy) of ``relax_by``: ``share`` times equilibrium."""
    c = numbers(share)
    d, jx, jy, ux, uy = m
    jxx = jx * ux
    jyy = jy * uy
    q = share * fma(-c.c15, jxx + jyy, d)
    return q, c.c45 * share * jxx, c.c45 * share * jyy, c.nine * (share * jx * uy)


@inline
def relax_by(f, plus, minus, gain, added):
    """Populations that lose shares ``plus`` and ``minus`` of their symmetric and antisymmetric halves.

    The symmetric half of direction c gains w (q + cx² xx + cy² yy + cx cy xy), gain: (q, xx, yy, xy); the antisymmetric
    one 3 w (cx mx + cy my), added: (mx, my).
    """
    f0, f1, f2, f3, f4, f5, f6, f7, f8 = f
    q, xx, yy, xy = gain
    mx, my = added
    c = numbers(plus)
    half = c.half
    w1, w2 = c.w1, c.w2
    t1, t2 = c.three * w1, c.three * w2
    hp = half * plus
    hm = half * minus
    g0 = fma(c.w0, q, fma(-plus, f0, f0))
    s = fma(-hp, f1 + f2, w1 * (q + xx))
    a = fma(-hm, f1 - f2, t1 * mx)
    g1 = f1 + s + a
    g2 = f2 + s - a
    s = fma(-hp, f3 + f4, w1 * (q + yy))
    a = fma(-hm, f3 - f4, t1 * my)
    g3 = f3 + s + a
    g4 = f4 + s - a
    diagonal = q + xx + yy
    s = fma(-hp, f5 + f6, w2 * (diagonal + xy))
    a = fma(-hm, f5 - f6, t2 * (mx + my))
    g5 = f5 + s + a
    g6 = f6 + s - a
    s = fma(-hp, f7 + f8, w2 * (diagonal - xy))
    a = fma(-hm, f7 - f8, t2 * (my - mx))
    g7 = f7 + s + a
    g8 = f8 + s - a
    return g0, g1, g2, g3, g4, g5, g6, g7, g8


OPERATOR = Operator(
    name="trt",
    purpose="two relaxation times: walls stay where they are at every viscosity",
    law=Trt,
    eddy_law=EddyTrt,
    law_without_force=TrtWithoutForce,
    third_order_rate=magic_rate_of,
    holds=Stability(51.0, 5100.0, 20.0, 41.0),  # with magic 3/16
    order=0,
)
