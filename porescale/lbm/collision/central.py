"""Relaxation of central moments, those about the moving fluid (Geier, Greiner & Korvink 2006; De Rosis 2017).

k_mn = sum_i f_i (c_x - u_x)^m (c_y - u_y)^n.  The shear stresses k_20 - k_02 and k_11 relax with 1/tau; k_20 + k_02,
k_21, k_12 and k_22 take their equilibria 2 rho/3, 0, 0 and rho/9 at once (rate 1), which is what keeps the operator
stable as tau goes to 1/2.  These equilibria are those of Maxwell's distribution, so what the fluid does depends on
the speed of the frame only through k_30 and k_03, which this lattice cannot hold.  Walls move with the viscosity:
the magic parameter is (tau - 1/2)/2.

Force (Fei & Luo 2017): its central moments F in k_10 and k_01, F_x/3 in k_12, F_y/3 in k_21, zero in all others, each
times 1 - half its rate; up to second moments the forcing of Guo, Zheng & Shi 2002.
"""

from typing import NamedTuple

import numpy as np

from porescale.lbm.collision.entry import Operator, Stability
from porescale.lbm.collision.law import (
    collide,
    collide_partial,
    collide_then_add,
    half_force,
    half_of_force,
    molecular_rate,
    numbers,
    shear_rate,
)
from porescale.lbm.collision.smagorinsky import eddy_version


class Central(NamedTuple):
    """rate : 1/tau;  fx, fy : body force density."""

    rate: np.floating
    fx: np.floating
    fy: np.floating


EddyCentral = eddy_version(Central)
half_force.of(Central, EddyCentral)(half_of_force)
shear_rate.of(Central)(molecular_rate)
collide_partial.of(Central, EddyCentral)(collide_then_add)


@collide.of(Central, EddyCentral)
def _collide(f, m, rate, law):
    """Collided central moments, turned back into moments at rest and these into populations.

    k_20 = p + a, k_02 = p - a and k_11 = b after collision; m: moments at rest, less those of the weights.
    """
    _, f1, f2, f3, f4, f5, f6, f7, f8 = f
    d, jx, jy, ux, uy = m
    c, fx, fy = numbers(rate), law.fx, law.fy
    half, two, quarter = c.half, c.two, c.quarter
    third = c.one / c.three
    keep = c.one - rate
    uxx, uyy, uxy = ux * ux, uy * uy, ux * uy
    xfx, yfy = ux * fx, uy * fy
    cross = half * (ux * fy + uy * fx)
    jxx, jyy, jxy = jx * ux, jy * uy, jx * uy
    a = half * keep * (((f1 + f2) - (f3 + f4)) - (jxx - jyy) + (xfx - yfy))
    b = keep * (((f5 + f6) - (f7 + f8)) - jxy + cross)
    p = third * d + third
    pp, pm = p + a, p - a
    hx, hy = half * fx, half * fy
    m20 = third * d + (jxx + xfx) + a
    m02 = third * d + (jyy + yfy) - a
    m11 = jxy + cross + b
    m21 = third * hy + uxx * hy + uxy * fx + uy * (pp + jxx) + two * ux * b
    m12 = third * hx + uyy * hx + uxy * fy + ux * (pm + jyy) + two * uy * b
    m22 = third * (third * d + (xfx + yfy)) + (uxx * pm + uyy * pp) + uxy * (two * two * b + jxy + (ux * fy + uy * fx))
    ox, oy = jx + hx - m12, jy + hy - m21
    ex, ey = m20 - m22, m02 - m22
    up, down = m22 + m11, m22 - m11
    op, om = m12 + m21, m12 - m21
    return (
        d - (m20 + m02) + m22,
        half * (ex + ox),
        half * (ex - ox),
        half * (ey + oy),
        half * (ey - oy),
        quarter * (up + op),
        quarter * (up - op),
        quarter * (down - om),
        quarter * (down + om),
    )


OPERATOR = Operator(
    name="central",
    purpose="central moments: stable as the viscosity goes to zero, and the same in every moving frame",
    law=Central,
    eddy_law=EddyCentral,
    third_order_rate=lambda law: 1.0,
    convective_delay=lambda law: 1 / float(law.rate) - 0.5,
    holds=Stability(5100.0, 5100.0, 62.0, 200000.0),  # in the open it held in all of the map
    soft_rim=True,
    order=2,
)
