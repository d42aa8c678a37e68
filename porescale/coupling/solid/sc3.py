"""SC3 (Holdych 2003): the populations turned back as at a wall of velocity v.

Omega^s_i = f_-i - f_i + f^eq_i(rho, v) - f^eq_-i(rho, v);  the even halves of the equilibria cancel,

    Omega^s_i = f_-i - f_i + 6 w_i rho c.v

The momentum of f + Omega^s is  -sum f c + 2 rho v:  the solid gains  2 B (sum f c - rho v), twice SC1's share, and the
half force h has no part in it, since u has none.  A full cell turns its populations back: bodies have the load of two
steps (immersed.py).
"""

from typing import NamedTuple

import numpy as np

from porescale.coupling.solid.entry import SolidOperator
from porescale.coupling.solid.law import blend, bounce, momentum_to_solid, with_sharp_rims
from porescale.lbm.collision.law import numbers


@with_sharp_rims
class Sc3(NamedTuple):
    """one : the number 1, for its precision."""

    one: np.floating


@blend.of(Sc3)
def _blend(f, g, cell, m, rate, solid):
    """Bounce-back from the moving solid."""
    c = numbers(cell.b)
    p = c.two * c.three * (c.one + m.d) * cell.b
    return bounce(f, g, cell.b, p * cell.vx, p * cell.vy)


@momentum_to_solid.of(Sc3)
def _momentum_to_solid(cell, rho, jx, jy, rate, solid):
    """2 B (j - rho v)."""
    twice = cell.b + cell.b
    return twice * rho, twice * jx, twice * jy


SOLID_OPERATOR = SolidOperator(
    name="SC3",
    purpose="bounce-back from the grain; what moves is noisy",
    law=Sc3,
    constants={"one": 1.0},
    turns_back=True,
    order=4,
)
