"""An exact wall whose rates are chosen by what a narrow channel carries.

As in solid/exact_wall.py a row of cells of solid fraction e, t = 1 - e, has the rates b of momentum, s_q of the other
antisymmetric moments q and s_e of the symmetric half, with k = tau - 1/2, 1/beta = 1/b - 1/2, lambda = 1/s_q - 1/2 and
k0 = 1/s_e - 1/2.  The wall is at its place if  1/beta + 2 lambda = X = 3/4 t/(k - k0 t).  That leaves two functions of
e free: X, and the share y = 1/(beta X).

Under a body force F, with the force in all of the cell, the row holds (mean of before and after the collision)

    m = y t G/2 - 3 F y t (2 t - y)/(4 k) + 2 lambda y F,     G the slope of the velocity at the wall,

and fluid slips along the wall by  u_s = -(F/8k) (12 t (t - y) + 3 - 16 magic).  A cell of fluid holds F/8k more than
the mean of the parabola over it.  So a channel of w = n + t1 + t2 cells, n of them fluid, holds too much, in units of
F/8k, by

    n (16 magic - 2 - 12 mean(t (t - y))) + sum over both rows of (-6 w t (t - y) - 6 y t (2 t - y) + 16 k lambda y
    + 4 t³).

At magic parameter 3/16 fluid cells hold right where  mean(t (t - y)) = 1/24;  rows do the better the smaller X, whose
least is 3/4 t/k (k0 = 0).  No term has tau in it then.  So

    y = t³ (1 + s)/(t² + s),     X = 3/4 (t/k) (1 + g),     g = G E/(e (e + E)),
    1/beta = y X,     2 lambda = (1 - y) X,     k0 = (k/t) g/(1 + g),     G = 8/3 k lambda0 (1 + s)/(1 + 3 s),

which goes over continuously into fluid (e = 0: g infinite, lambda = lambda0, k0 = k) and into a cell that turns
populations back (e = 1: b = 2, s_q = 2, s_e = 0).  Such a cell is at rest with its body by itself; no half-step
correction is needed, and free bodies have the load of two steps (immersed.py).  t (t - y) has the mean 1/24 at
s = 0.16.

Derived here, but for s = 0.2, E = 0.05 and the radius shift 0.4 magic/r, which were chosen on square arrays of solid
fraction 0.3 to 0.6, 10 cells a diameter, tau 0.8: drag within 0.2, 0.5, 1.2 and 1.0 % as the mean over places, at any
tau alike.  Hexagonal arrays, solid fractions of 0.1 and 0.2, other sizes and relaxation times were looked at
afterwards.  It is made for magic parameter 3/16.
"""

from typing import NamedTuple

import numpy as np

from porescale.coupling.solid.entry import Holds, SolidOperator
from porescale.coupling.solid.exact_wall import blend_wall, collide_with_wall, momentum_to_wall, whole_cell
from porescale.coupling.solid.law import (
    blend,
    collide_with_solid,
    force_share,
    is_soft,
    momentum_to_solid,
    rates,
    sharp,
)
from porescale.coupling.weighting.narrow import BEND, GRADE, ONSET
from porescale.lbm.collision.entry import MAGIC_MIDWAY_WALL
from porescale.lbm.collision.law import numbers


class NarrowWall(NamedTuple):
    """k : tau - 1/2, molecular;  third_order : rate of q in the fluid;  bend : s;  onset : E;  start : G E of the
    weight."""

    k: np.floating
    third_order: np.floating
    bend: np.floating
    onset: np.floating
    start: np.floating


is_soft.of(NarrowWall)(sharp)
force_share.of(NarrowWall)(whole_cell)
blend.of(NarrowWall)(blend_wall)
collide_with_solid.of(NarrowWall)(collide_with_wall)
momentum_to_solid.of(NarrowWall)(momentum_to_wall)


@rates.of(NarrowWall)
def narrow_rates(e, b, theta, slip_x, slip_y, solid):
    """Share s_e tau of the symmetric half, and kept: 1 - s_q less the share t of q after the fluid operator.

    The same in products: with D = e (e + E), S = t² + s, y = t³ (1 + s)/S and 1 - y = e (t² + s (1 + t + t²))/S.  The
    weight has the G of magic parameter 3/16, lambda that of the fluid's, and k0 keeps the wall at its place with both.
    """
    c = numbers(e)
    k, s = solid.k, solid.bend
    t = c.one - e
    tt = t * t
    size = tt + s
    bent = tt + s * (c.one + t + tt)  # (1 - y) S/e
    straight = tt * t * (c.one + s)  # y S
    lam0 = c.one / solid.third_order - c.half
    start = (c.two + c.two / c.three) * k * lam0 * (c.one + s) / (c.one + c.three * s) * solid.onset
    d = e * (e + solid.onset)
    lam = c.c38 * t * (d + start) * bent / (k * (e + solid.onset) * size)
    beyond = solid.start * straight + start * e * bent  # S (Z - D), with Z = X 4 k D/(3 t)
    whole = t * (d * size + beyond)
    plus = c.two * whole / (whole + c.two * k * beyond)
    third = c.one / (lam + c.half)
    return plus * (k + c.half), c.one - third - t * (c.one - solid.third_order)


SOLID_OPERATOR = SolidOperator(
    name="narrow-wall",
    purpose="drag and permeability of dense beds with gaps of 1.4 cells and more; twice the noise of what moves",
    law=NarrowWall,
    constants={"bend": BEND, "onset": ONSET, "start": GRADE * ONSET},
    weight="narrow",
    radius_shift=0.4,
    force_everywhere=True,
    turns_back=True,
    longest_relaxation_time=2.0,
    magic=MAGIC_MIDWAY_WALL,
    narrow_gaps=True,
    holds={"narrow": Holds(lightest=((5.0, 0.1), (3.0, 0.2)), cells=5.0, bed=((0.6, 5.0), (0.7, 10.0)))},
    order=5,
)
