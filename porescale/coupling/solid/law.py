"""What every solid operator of a partially saturated cell provides, and what they share.

A solid operator is one file of this folder.  It holds its law, a flat NamedTuple of numbers in the dtype of the
populations; bodies for that law of the functions of ``SolidLaw``, ``@blend.of(MyLaw)``; and its row in the register,
``SOLID_OPERATOR = SolidOperator(...)``, which choose.py finds (entry.py).

Every operator conserves mass in each cell, and what the fluid loses of momentum the solid gains.  The body force acts
in a share of the cell, ``force_share``, or a spurious force would act on a resting disc; rho u = sum f c + h
with half the force that acts, h.  Those of the literature (Noble & Torczynski 1998) are of the form

    f_i* = (1 - B) g_i + B (f_i + Omega^s_i),     g = f + Omega + S, the collided populations of the fluid operator

with the share 1 - B.  A fluid operator relaxes the antisymmetric moments that are not momentum with the rate
``third_order``.
"""

from typing import Any, NamedTuple, Protocol

import numpy as np

from porescale.common.compiled.jit import inline, law_function
from porescale.lbm.collision.law import collide, numbers


class SolidCell(NamedTuple):
    """Of a cell: e solid fraction, b weight, theta softness of the rim (coverage/soft_rim.py), v velocity of the solid,
    h half the body force that acts in it."""

    e: np.floating
    b: np.floating
    theta: np.floating
    vx: np.floating
    vy: np.floating
    hx: np.floating
    hy: np.floating


class SolidLaw(Protocol):
    """The contract of a law of solid cells: functions of one cell, compiled into the sweeps of psm_kernels.py.

    f: the nine shifted populations before, g after the fluid operator, tuples;  cell: ``SolidCell``;  m: the fluid's
    ``Macroscopic``, with h;  rate: 1/tau of the cell.
    """

    @staticmethod
    def force_share(b: Any, solid: Any) -> Any:
        """Share of a cell with weight b in which the body force acts; ``free_share`` is 1 - B."""

    @staticmethod
    def is_soft(solid: Any) -> Any:
        """Whether rims are soft (coverage/soft_rim.py): a constant, so that what depends on it costs nothing where they
        are not; ``sharp`` is no."""

    @staticmethod
    def rates(e: Any, b: Any, theta: Any, slip_x: Any, slip_y: Any, solid: Any) -> Any:
        """Two numbers of a cell that follow from the solid fraction alone where rims are sharp, for all cells of a row
        at once;  slip: u - v.  ``no_rates`` serves a law that needs none."""

    @staticmethod
    def blend(f: Any, g: Any, cell: Any, m: Any, rate: Any, solid: Any) -> Any:
        """The nine populations after solid and fluid operator."""

    @staticmethod
    def collide_with_solid(f: Any, cell: Any, shares: Any, m: Any, rate: Any, law: Any, solid: Any) -> Any:
        """``blend`` with what ``collide`` of the fluid's ``law`` makes of f;  shares: ``rates``.

        ``collide_then_blend`` serves any law with sharp rims.
        """

    @staticmethod
    def momentum_to_solid(cell: Any, rho: Any, jx: Any, jy: Any, rate: Any, solid: Any) -> Any:
        """What a cell's load is made of: (a, x, y) such that the solid of velocity v gains (x - a vx, y - a vy).

        j: first moment sum f c, without h.
        """


force_share = law_function(SolidLaw.force_share)
is_soft = law_function(SolidLaw.is_soft)
rates = law_function(SolidLaw.rates)
blend = law_function(SolidLaw.blend)
collide_with_solid = law_function(SolidLaw.collide_with_solid)
momentum_to_solid = law_function(SolidLaw.momentum_to_solid)


@inline
def free_share(b, solid):
    """``force_share`` 1 - B."""
    return numbers(b).one - b


@inline
def sharp(solid):
    """``is_soft`` of a law with sharp rims: False."""
    return False


@inline
def no_rates(e, b, theta, slip_x, slip_y, solid):
    """``rates`` of an operator that needs none."""
    return numbers(e).zero, numbers(e).zero


@inline
def collide_then_blend(f, cell, shares, m, rate, law, solid):
    """``collide_with_solid`` of any operator that has sharp rims."""
    return blend(f, collide(f, m, rate, law), cell, m, rate, solid)


@inline
def bounce(f, g, b, px, py):
    """Populations (1 - B) g_i + B f_-i + w_i c_i.p of a cell: those of the fluid bounced back, and a momentum p/3."""
    f0, f1, f2, f3, f4, f5, f6, f7, f8 = f
    g0, g1, g2, g3, g4, g5, g6, g7, g8 = g
    c = numbers(b)
    free = c.one - b
    sx, sy = c.w1 * px, c.w1 * py
    up, down = c.w2 * (px + py), c.w2 * (py - px)
    return (
        free * g0 + b * f0,
        free * g1 + (b * f2 + sx),
        free * g2 + (b * f1 - sx),
        free * g3 + (b * f4 + sy),
        free * g4 + (b * f3 - sy),
        free * g5 + (b * f6 + up),
        free * g6 + (b * f5 - up),
        free * g7 + (b * f8 + down),
        free * g8 + (b * f7 - down),
    )


def with_sharp_rims(law: type) -> type:
    """Give a law, as a decorator of its class, bodies for the share 1 - B and sharp rims; returns it."""
    force_share.of(law)(free_share)
    is_soft.of(law)(sharp)
    rates.of(law)(no_rates)
    collide_with_solid.of(law)(collide_then_blend)
    return law
