"""Multiple relaxation times in the moments of Lallemand & Luo 2000, with body force (Guo, Zheng & Shi 2002).

Symmetric moments, in the order of Lallemand & Luo 2000: energy e, its square eps, the stresses p_xx and p_xy;
antisymmetric ones: momentum j and energy flux q.  The stresses relax with 1/tau, e and eps with their own rates: e
carries the bulk viscosity and damps sound.  The antisymmetric moments share the rate that holds the magic parameter
(trt.py; for 3/16 it is the 8(2 - s)/(8 - s) of Ginzburg & d'Humieres 2003), so walls stay where they are.  Equilibria
and sources of the force, per moment:

    e  -2 rho + 3 j²/rho,  6 u.F      eps  rho - 3 j²/rho,  -6 u.F      p_xx  (jx² - jy²)/rho,  2 (ux Fx - uy Fy)
    p_xy  jx jy/rho,  ux Fy + uy Fx   q  -j,  -F                         j  j,  F

each source times 1 - s/2 of its moment.  Weighted with 1 - B in partially saturated cells this is the PS-MRT of
Fukumoto & Ohtsuka 2016.
"""

from typing import NamedTuple

import numpy as np

from porescale.common.compiled.jit import inline
from porescale.lbm.collision.entry import Operator, Stability
from porescale.lbm.collision.law import (
    add_partial,
    collide,
    collide_partial,
    half_force,
    half_of_force,
    molecular_rate,
    numbers,
    shear_rate,
)
from porescale.lbm.collision.smagorinsky import eddy_version
from porescale.lbm.collision.trt import magic_rate, magic_rate_of

ENERGY_RATE = 1.64
"""Rate of e (Lallemand & Luo 2000, section V)."""
SQUARE_RATE = 1.54
"""Rate of eps (the same)."""
FASTEST = 1.9
"""Largest rate of both in cells that are partly solid: there all symmetric moments have the share that puts the wall in
its place, which stresses alone decide, and beyond 2 these would grow.  narrow-wall has shares up to 1.5 at a relaxation
time of 0.8 and 3 at 2, exact-wall 1.0002."""


class Mrt(NamedTuple):
    """rate : 1/tau;  fx, fy : body force density;  magic : L;  energy, square : rates of e and eps;  fastest : the
    largest of them in cells that are partly solid."""

    rate: np.floating
    fx: np.floating
    fy: np.floating
    magic: np.floating
    energy: np.floating
    square: np.floating
    fastest: np.floating


EddyMrt = eddy_version(Mrt)
half_force.of(Mrt, EddyMrt)(half_of_force)
shear_rate.of(Mrt)(molecular_rate)


@collide.of(Mrt, EddyMrt)
def _collide(f, m, rate, law):
    """MRT collision: each moment relaxes with its own rate."""
    return relax_moments(f, m, rate, magic_rate(rate, law), (law.energy, law.square), law)


@collide_partial.of(Mrt, EddyMrt)
def _collide_partial(f, m, rate, part, law):
    """A share of it, in which e and eps relax no faster than ``fastest``."""
    most = law.fastest / max(part.plus, numbers(rate).half)  # shares below 1 are bound by nothing
    own = min(law.energy, most), min(law.square, most)
    return add_partial(f, relax_moments(f, m, rate, magic_rate(rate, law), own, law), part)


@inline
def relax_moments(f, m, rate, minus, own, law):
    """The nine collided populations: changes of e, eps, p_xx and p_xy over their norms 36, 36, 4, 4, and of the
    antisymmetric half of each pair, which relaxes with the rate ``minus``;  own: rates of e and eps."""
    f0, f1, f2, f3, f4, f5, f6, f7, f8 = f
    d, jx, jy, ux, uy = m
    c, fx, fy = numbers(rate), law.fx, law.fy
    half, two, three = c.half, c.two, c.three
    energy, square = own
    a, b, p, q = f1 + f2, f3 + f4, f5 + f6, f7 + f8
    sides, corners = a + b, p + q
    rest = two * two * f0
    uf = two * three * (ux * fx + uy * fy)
    jj = three * (jx * ux + jy * uy)
    size = c.one / (two * two * c.nine)
    e = size * (energy * (rest + sides - two * corners - two * d + jj) + (c.one - half * energy) * uf)
    s = size * (square * (two * sides - rest - corners + d - jj) - (c.one - half * square) * uf)
    source = c.one - half * rate
    xx = c.quarter * (rate * (jx * ux - jy * uy - (a - b)) + source * two * (ux * fx - uy * fy))
    xy = c.quarter * (rate * (jx * uy - (p - q)) + source * (ux * fy + uy * fx))
    so = c.one - half * minus
    mx, my = minus * jx + so * fx, minus * jy + so * fy
    t1, t2 = three * c.w1, three * c.w2
    ho = half * minus
    side, corner = -e - two * s, two * e + s
    g0 = f0 + two * two * (s - e)
    plus, change = side + xx, t1 * mx - ho * (f1 - f2)
    g1 = f1 + plus + change
    g2 = f2 + plus - change
    plus, change = side - xx, t1 * my - ho * (f3 - f4)
    g3 = f3 + plus + change
    g4 = f4 + plus - change
    plus, change = corner + xy, t2 * (mx + my) - ho * (f5 - f6)
    g5 = f5 + plus + change
    g6 = f6 + plus - change
    plus, change = corner - xy, t2 * (my - mx) - ho * (f7 - f8)
    g7 = f7 + plus + change
    g8 = f8 + plus - change
    return g0, g1, g2, g3, g4, g5, g6, g7, g8


OPERATOR = Operator(
    name="mrt",
    purpose="multiple relaxation times: walls as with trt, and sound is damped faster",
    law=Mrt,
    eddy_law=EddyMrt,
    third_order_rate=magic_rate_of,
    constants={"energy": ENERGY_RATE, "square": SQUARE_RATE, "fastest": FASTEST},
    holds=Stability(10.0, 17.0, 31.0, 200000.0),
    order=1,
)
