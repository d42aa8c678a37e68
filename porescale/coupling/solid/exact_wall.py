"""A partially saturated cell that holds a plane wall where it is, at every relaxation time.

Momentum, the other odd moments q and the even part of the populations relax with rates of their own, functions of the
solid fraction e.  With t = 1 - e, k = tau - 1/2, 1/beta = 1/b - 1/2, lambda = 1/s_q - 1/2, k0 = 1/s_e - 1/2:

    j*  = j + F + b (rho v - j - F/2)          b: weight ``wall`` of weighting.py
    q*  = (1 - s_q) q
    f+* = f+ + s_e tau (g+ - f+)

Solving one row of cells e between rigid cells and fluid (linear profile; steady, exactly) puts the wall at its place if
and only if  1/beta + 2 lambda = R = 3/4 t/(k - k0 t);  for a parabola too, at magic parameter 3/16, if also
2 lambda = e R.  These rates satisfy the first for every e and tau, the second nearly, and go over continuously into the
fluid's (e = 0) and a rigid cell's (e = 1: b = 1, s_q = 2, s_e = 0):

    lambda = t (lambda0 + (3/(8 k) - lambda0) (1 + E) e/(e + E)) + 1/2 e t/(t² + D²),     lambda0 that of the fluid
    R = 1/2 + 3/4 t²/(k e) + 2 lambda,     k0 = (k - 3/4 t/R)/t

A full cell that moves with v is a half-way bounce-back node on its own faces once its time-centred velocity is v: the
half-step correction of saturated.py.  The body force acts in the whole cell, and the solid gets back that on e.

Derived here.  E and D are no more than widths of the two turns; the factor 1/2 of the second term, D, E and the radius
shift of saturated.py were chosen on square arrays of solid fraction 0.1 to 0.6, 10 to 20 cells a diameter, tau 0.52 to
1.5: drag within 1 % up to 0.3, 1.2 % at 0.4, 5 % at 0.6, converging at second order; nothing else was looked at.
"""

from typing import NamedTuple

import numpy as np

from porescale.common.compiled.jit import by_law, inline
from porescale.coupling.solid.law import collide_beside, force_share, is_soft, mix, rates, taken
from porescale.lbm.collision.law import add_shares, collide_in_shares, numbers

ONSET = 0.05
"""E: solid fraction over which the rate of q turns from the fluid's to that of a wall."""
SMOOTHING = 0.3
"""D: fluid fraction over which it turns to that of a rigid cell."""


class ExactWall(NamedTuple):
    """k : tau - 1/2, molecular;  third_order : rate of q in the fluid;  onset : E;  smoothing : D²."""

    k: np.floating
    third_order: np.floating
    onset: np.floating
    smoothing: np.floating


class SoftWall(NamedTuple):
    """The same where bodies have soft rims (rim.py);  slip_factor : of theta |v - u| in k."""

    k: np.floating
    third_order: np.floating
    onset: np.floating
    smoothing: np.floating
    slip_factor: np.floating


@by_law
def _stiffness(theta, slip_x, slip_y, solid):
    """k of a cell in which the fluid slips past the solid."""


@_stiffness.of(ExactWall)
def _molecular(theta, slip_x, slip_y, solid):
    """tau - 1/2."""
    return solid.k


@_stiffness.of(SoftWall)
def _with_slip(theta, slip_x, slip_y, solid):
    """And a part of the slip where the rim is soft."""
    return solid.k + solid.slip_factor * theta * np.sqrt(slip_x * slip_x + slip_y * slip_y)


@is_soft.of(ExactWall)
def _sharp(solid):
    """No."""
    return False


@is_soft.of(SoftWall)
def _soft(solid):
    """Yes."""
    return True


@force_share.of(ExactWall, SoftWall)
def _whole(b, solid):
    """All of it."""
    return numbers(b).one


@rates.of(ExactWall, SoftWall)
def _rates(e, b, theta, slip_x, slip_y, solid):
    """Share s_e tau of the even half, and kept: 1 - s_q less the share t of q after the fluid operator.

    With that share e = 0 is plain fluid.
    """
    c = numbers(b)
    k = _stiffness(theta, slip_x, slip_y, solid)
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
    even, third = t * q * both * above, turns * both * beneath
    third += theta * ((c.one - b) * solid.third_order + c.two * b - third)
    return even * (solid.k + c.half), c.one - third - t * (c.one - solid.third_order)


@inline
def _momentum(e, b, kept, rho, jx, jy, vx, vy, hx, hy):
    """Momentum that a cell lacks once its odd half has the shares: j + F + b (rho v - j - h) less theirs; j with h."""
    fx, fy = jx + hx, jy + hy
    return (
        e * fx + b * (rho * vx - jx) - kept * (jx - hx),
        e * fy + b * (rho * vy - jy) - kept * (jy - hy),
    )


@mix.of(ExactWall, SoftWall)
def _mix(
    f0, f1, f2, f3, f4, f5, f6, f7, f8, g0, g1, g2, g3, g4, g5, g6, g7, g8, e, b, theta, rho, ux, uy, vx, vy, hx,
    hy, rate, solid,
):  # fmt: skip
    """Each part at its own rate."""
    even, kept = rates(e, b, theta, ux - vx, uy - vy, solid)
    px, py = _momentum(e, b, kept, rho, rho * ux, rho * uy, vx, vy, hx, hy)
    return add_shares(
        f0, f1, f2, f3, f4, f5, f6, f7, f8, g0, g1, g2, g3, g4, g5, g6, g7, g8, even, numbers(e).one - e, kept, px, py
    )  # fmt: skip


@collide_beside.of(ExactWall, SoftWall)
def _collide_beside(
    f0, f1, f2, f3, f4, f5, f6, f7, f8, e, b, even, kept, rho, d, jx, jy, ux, uy, vx, vy, hx, hy, rate, law, solid,
):  # fmt: skip
    """The same in one with the fluid operator."""
    px, py = _momentum(e, b, kept, rho, jx, jy, vx, vy, hx, hy)
    return collide_in_shares(
        f0, f1, f2, f3, f4, f5, f6, f7, f8, d, jx, jy, ux, uy, rate, even, numbers(e).one - e, kept, px, py, law
    )  # fmt: skip


@taken.of(ExactWall, SoftWall)
def _taken(e, b, rho, jx, jy, hx, hy, rate, solid):
    """b (j + h - rho v), less the body force on the solid part."""
    two_e = numbers(e).two * e
    return b * rho, b * (jx + hx) - two_e * hx, b * (jy + hy) - two_e * hy
