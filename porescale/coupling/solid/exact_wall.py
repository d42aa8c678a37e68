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

from porescale.coupling.solid.law import force_share, is_soft, mix, taken
from porescale.ground.jit import by_law
from porescale.lbm.collision.law import numbers

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


@mix.of(ExactWall, SoftWall)
def _mix(
    f0, f1, f2, f3, f4, f5, f6, f7, f8, g0, g1, g2, g3, g4, g5, g6, g7, g8, e, b, theta, rho, ux, uy, vx, vy, hx,
    hy, rate, solid,
):  # fmt: skip
    """Each part at its own rate; q after the fluid operator has a share t, so that e = 0 is plain fluid."""
    c = numbers(b)
    k = _stiffness(theta, ux - vx, uy - vy, solid)
    t = c.one - e
    tt = c.c34 * t * t
    n = k * e
    lam0 = c.one / solid.third_order - c.half
    # Divisions cost more than all else here: quotients share them, s_e = 1/(1/2 + k0) and s_q = 1/(1/2 + lambda) too.
    onset, smooth = e + solid.onset, t * t + solid.smoothing
    lam = t * (lam0 + e * ((c.c38 / k - lam0) * (c.one + solid.onset) * smooth + c.half * onset) / (onset * smooth))
    q = c.half * n + tt + c.two * lam * n
    beneath, above = (c.half * t + k) * q - c.c34 * t * n, c.half + lam
    both = c.one / (beneath * above)
    even, third = t * q * both * above, both * beneath
    third += theta * ((c.one - b) * solid.third_order + c.two * b - third)
    share = even * (solid.k + c.half)
    free = c.one - share
    psi = c.one - third - t * (c.one - solid.third_order)
    jx, jy = rho * ux - hx, rho * uy - hy
    fx, fy = c.two * hx, c.two * hy
    px = c.three * (jx + fx + b * (rho * (vx - ux)) - t * (jx + fx) - psi * jx)
    py = c.three * (jy + fy + b * (rho * (vy - uy)) - t * (jy + fy) - psi * jy)
    half = c.half
    ea, eb, oa, ob = half * free, half * share, half * psi, half * t
    q1, m1 = ea * (f1 + f2) + eb * (g1 + g2), oa * (f1 - f2) + ob * (g1 - g2) + c.w1 * px
    q3, m3 = ea * (f3 + f4) + eb * (g3 + g4), oa * (f3 - f4) + ob * (g3 - g4) + c.w1 * py
    q5, m5 = ea * (f5 + f6) + eb * (g5 + g6), oa * (f5 - f6) + ob * (g5 - g6) + c.w2 * (px + py)
    q7, m7 = ea * (f7 + f8) + eb * (g7 + g8), oa * (f7 - f8) + ob * (g7 - g8) + c.w2 * (py - px)
    return (
        free * f0 + share * g0,
        q1 + m1,
        q1 - m1,
        q3 + m3,
        q3 - m3,
        q5 + m5,
        q5 - m5,
        q7 + m7,
        q7 - m7,
    )


@taken.of(ExactWall, SoftWall)
def _taken(e, b, rho, jx, jy, hx, hy, rate, solid):
    """b (j + h - rho v), less the body force on the solid part."""
    two_e = numbers(e).two * e
    return b * rho, b * (jx + hx) - two_e * hx, b * (jy + hy) - two_e * hy
