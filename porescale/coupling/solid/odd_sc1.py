"""The antisymmetric half of SC1 (sc1.py), which leaves out what drifts in it.

The symmetric half of SC1, f^eq+(v) - f^eq+(u), has no moment of mass or momentum, is quadratic in velocity, and nothing
relaxes it where B = 1.  Without it drag changes by less than 1e-4:

    Omega^s_i = f_-i - f_i + 3 w_i rho c.(v + u)

The solid gains  B (sum f c - h - rho v)  of momentum, as with SC1.  Derived here.
"""

from typing import NamedTuple

import numpy as np

from porescale.coupling.solid.entry import Holds, SolidOperator
from porescale.coupling.solid.law import blend, bounce, momentum_to_solid, with_sharp_rims
from porescale.lbm.collision.law import numbers


@with_sharp_rims
class OddSc1(NamedTuple):
    """one : the number 1, for its precision."""

    one: np.floating


@blend.of(OddSc1)
def _blend(f, g, cell, m, rate, solid):
    """Antisymmetric half of SC1."""
    c = numbers(cell.b)
    p = c.three * (c.one + m.d) * cell.b
    return bounce(f, g, cell.b, p * (cell.vx + m.ux), p * (cell.vy + m.uy))


@momentum_to_solid.of(OddSc1)
def momentum_to_solid_sc1(cell, rho, jx, jy, rate, solid):
    """B (j - h - rho v)."""
    b = cell.b
    return b * rho, b * (jx - cell.hx), b * (jy - cell.hy)


SOLID_OPERATOR = SolidOperator(
    name="odd-SC1",
    purpose="the odd half of SC1: as accurate, and nothing drifts inside grains",
    law=OddSc1,
    constants={"one": 1.0},
    holds={
        "B2": Holds(((16.0, 0.1), (10.0, 0.2), (5.0, 0.3), (3.0, 0.5)), 10.0, ((0.2, 10.0), (0.4, 15.0))),
        "B1": Holds(((10.0, 0.1), (5.0, 0.2), (3.0, 0.5)), 10.0, ((0.1, 10.0),)),
    },
    order=1,
)
