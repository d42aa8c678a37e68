"""A partially saturated cell that holds a plane wall where it is, at every relaxation time.

Momentum, the other antisymmetric moments q and the symmetric part of the populations relax with rates of their own,
functions of the solid fraction e.  With t = 1 - e, k = tau - 1/2, 1/beta = 1/b - 1/2, lambda = 1/s_q - 1/2 and
k0 = 1/s_e - 1/2:

    j*  = j + F + b (rho v - j - F/2)          b: weight ``wall`` of weighting/wall.py
    q*  = (1 - s_q) q
    f+* = f+ + s_e tau (g+ - f+)

Solving one row of cells e between rigid cells and fluid (linear profile; steady, exactly) puts the wall at its place if
and only if  1/beta + 2 lambda = R = 3/4 t/(k - k0 t);  for a parabola too, at magic parameter 3/16, if also
2 lambda = e R.  These rates satisfy the first for every e and tau, the second nearly, and go over continuously into the
fluid's (e = 0) and a rigid cell's (e = 1: b = 1, s_q = 2, s_e = 0):

    lambda = t (lambda0 + (3/(8 k) - lambda0) (1 + E) e/(e + E)) + 1/2 e t/(t² + D²),     lambda0 that of the fluid
    R = 1/2 + 3/4 t²/(k e) + 2 lambda,     k0 = (k - 3/4 t/R)/t

A full cell that moves with v is a half-way bounce-back node on its own faces once its time-centred velocity is v: the
half-step correction of psm.py.  The body force acts in the whole cell, and the solid gets back that on e.

Derived here.  E and D are no more than widths of the two turns; the factor 1/2 of the second term, D, E and the radius
shift were chosen on square arrays of solid fraction 0.1 to 0.6, 10 to 20 cells a diameter, tau 0.52 to
1.5: drag within 1 % up to 0.3, 1.2 % at 0.4, 5 % at 0.6, converging at second order; no other case was examined.
"""

from typing import NamedTuple

import numpy as np

from porescale.common.compiled.jit import inline
from porescale.common.compiled.simd import fma
from porescale.coupling.coverage.soft_rim import SLIP_FACTOR
from porescale.coupling.solid.entry import Holds, SolidOperator
from porescale.coupling.solid.law import (
    blend,
    collide_with_solid,
    force_share,
    is_soft,
    momentum_to_solid,
    rates,
    sharp,
)
from porescale.lbm.collision.law import Partial, add_partial, collide_partial, numbers

ONSET = 0.05
"""E: solid fraction over which the rate of q turns from the fluid's to that of a wall."""
SMOOTHING = 0.3
"""D: fluid fraction over which it turns to that of a rigid cell."""
RADIUS_SHIFT = 1.5
"""Times the magic parameter, cells², over the radius: what exact walls lack to be those of a disc (0.28 at 3/16)."""


class ExactWall(NamedTuple):
    """k : tau - 1/2, molecular;  third_order : rate of q in the fluid;  onset : E;  smoothing : D²."""

    k: np.floating
    third_order: np.floating
    onset: np.floating
    smoothing: np.floating


class SoftWall(NamedTuple):
    """The same where bodies have soft rims (coverage/soft_rim.py);  slip_factor : of theta |v - u| in k."""

    k: np.floating
    third_order: np.floating
    onset: np.floating
    smoothing: np.floating
    slip_factor: np.floating


is_soft.of(ExactWall)(sharp)


@is_soft.of(SoftWall)
def _soft(solid):
    """``is_soft`` of a law with soft rims: True."""
    return True


@force_share.of(ExactWall, SoftWall)
def whole_cell(b, solid):
    """``force_share``: 1, the body force acts in the whole cell."""
    return numbers(b).one


@inline
def _rates(k, e, b, theta, solid):
    """Share s_e tau of the symmetric half, and kept: 1 - s_q less the share t of q after the fluid operator.

    k: tau - 1/2 of the cell.  With that share e = 0 is plain fluid.
    """
    c = numbers(b)
    t = c.one - e
    n = k * e
    lam0 = c.one / solid.third_order - c.half
    # Divisions cost more than all else here: lambda = dip/turns stays a quotient, and one division serves both rates.
    onset, smooth = e + solid.onset, t * t + solid.smoothing
    turns = onset * smooth
    dip = t * (lam0 * turns + e * ((c.c38 / k - lam0) * (c.one + solid.onset) * smooth + c.half * onset))
    q = (c.half * n + c.c34 * t * t) * turns + c.two * n * dip
    beneath, above = (c.half * t + k) * q - c.c34 * t * n * turns, c.half * turns + dip
    both = c.one / (beneath * above)
    plus, third = t * q * both * above, turns * both * beneath
    third += theta * ((c.one - b) * solid.third_order + c.two * b - third)
    return plus * (solid.k + c.half), c.one - third - t * (c.one - solid.third_order)


@rates.of(ExactWall)
def _rates_of_sharp_rims(e, b, theta, slip_x, slip_y, solid):
    """``rates`` at the relaxation time of the fluid: rims are sharp."""
    return _rates(solid.k, e, b, theta, solid)


@rates.of(SoftWall)
def _rates_of_soft_rims(e, b, theta, slip_x, slip_y, solid):
    """With a part of the slip in k where the rim is soft."""
    return _rates(solid.k + solid.slip_factor * theta * np.sqrt(slip_x * slip_x + slip_y * slip_y), e, b, theta, solid)


@inline
def _missing_momentum(cell, kept, rho, jx, jy):
    """Momentum that a cell lacks once its antisymmetric half has the shares: j + F + b (rho v - j - h) less theirs;
    j with h."""
    fx, fy = jx + cell.hx, jy + cell.hy
    return (
        fma(-kept, jx - cell.hx, fma(cell.e, fx, cell.b * fma(rho, cell.vx, -jx))),
        fma(-kept, jy - cell.hy, fma(cell.e, fy, cell.b * fma(rho, cell.vy, -jy))),
    )


@blend.of(ExactWall, SoftWall)
def blend_wall(f, g, cell, m, rate, solid):
    """Populations after collision, where each part relaxes with its own rate."""
    one = numbers(cell.e).one
    rho = one + m.d
    plus, kept = rates(cell.e, cell.b, cell.theta, m.ux - cell.vx, m.uy - cell.vy, solid)
    px, py = _missing_momentum(cell, kept, rho, rho * m.ux, rho * m.uy)
    return add_partial(f, g, Partial(plus, one - cell.e, kept, px, py))


@collide_with_solid.of(ExactWall, SoftWall)
def collide_with_wall(f, cell, shares, m, rate, law, solid):
    """The same in one with the fluid operator."""
    plus, kept = shares
    one = numbers(cell.e).one
    px, py = _missing_momentum(cell, kept, one + m.d, m.jx, m.jy)
    return collide_partial(f, m, rate, Partial(plus, one - cell.e, kept, px, py), law)


@momentum_to_solid.of(ExactWall, SoftWall)
def momentum_to_wall(cell, rho, jx, jy, rate, solid):
    """b (j + h - rho v), less the body force on the solid part."""
    b, hx, hy = cell.b, cell.hx, cell.hy
    two_e = numbers(cell.e).two * cell.e
    return b * rho, b * (jx + hx) - two_e * hx, b * (jy + hy) - two_e * hy


SOLID_OPERATOR = SolidOperator(
    name="exact-wall",
    purpose="holds walls where they are at every viscosity, the most accurate: the default; with weight wall",
    law=ExactWall,
    soft_law=SoftWall,
    constants={"onset": ONSET, "smoothing": SMOOTHING**2, "slip_factor": SLIP_FACTOR},
    weight="wall",
    radius_shift=RADIUS_SHIFT,
    half_step_correction=True,
    force_everywhere=True,
    films=True,
    gaps=((1.4, 0.28), (2.6, 0.05), (4.0, 0.01)),  # solid fraction 0.6, 0.5, 0.4 at 10 cells per diameter
    longest_relaxation_time=2.0,  # at 10 cells per diameter drag is within 1.5 % even at 3
    holds={"wall": Holds(lightest=((5.0, 0.1), (3.0, 0.2)), cells=3.0, bed=((0.4, 5.0), (0.6, 15.0)))},
    order=0,
)
