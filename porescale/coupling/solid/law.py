"""What every solid operator of a partially saturated cell provides, chosen by the type of its law.

Every operator conserves mass in each cell, and what the fluid loses of momentum the solid gains.  The body force acts
in a share of the cell, ``force_share``, or a resting disc would feel a force that is not there; rho u = sum f c + h
with half the force that acts, h.  Those of the literature are of the form

    f_i* = (1 - B) g_i + B (f_i + Omega^s_i),     g = f + Omega + S, the collided populations of the fluid operator

with the share 1 - B.  A fluid operator relaxes the odd moments that are not momentum with the rate ``third_order``.
"""

from porescale.common.compiled.jit import by_law, inline
from porescale.lbm.collision.law import collide, numbers


@by_law
def force_share(b, solid):
    """Share of a cell with weight b in which the body force acts."""


@by_law
def is_soft(solid):
    """Whether rims are soft (rim.py): a constant, so that what depends on it costs nothing where they are not."""


@by_law
def mix(
    f0, f1, f2, f3, f4, f5, f6, f7, f8, g0, g1, g2, g3, g4, g5, g6, g7, g8, e, b, theta, rho, ux, uy, vx, vy, hx,
    hy, rate, solid,
):  # fmt: skip
    """The nine populations after solid and fluid operator.

    f before, g after the fluid operator (shifted);  e solid fraction, b weight, theta softness of the rim (rim.py);
    u velocity with h;  v of the solid;  rate 1/tau.
    """


@by_law
def rates(e, b, theta, slip_x, slip_y, solid):
    """Two numbers of a cell that its law makes of the solid fraction alone where rims are sharp; slip: u - v."""


@by_law
def collide_beside(
    f0, f1, f2, f3, f4, f5, f6, f7, f8, e, b, even, kept, rho, d, jx, jy, ux, uy, vx, vy, hx, hy, rate, law, solid,
):  # fmt: skip
    """``mix`` with what ``collide`` of the fluid's law makes of f: the nine populations after the step.

    even, kept: ``rates``;  d density excess, j first moment with h;  law: of the fluid operator.
    """


@inline
def no_rates(e, b, theta, slip_x, slip_y, solid):
    """``rates`` of an operator that needs none."""
    return numbers(e).zero, numbers(e).zero


@inline
def collide_then_mix(
    f0, f1, f2, f3, f4, f5, f6, f7, f8, e, b, even, kept, rho, d, jx, jy, ux, uy, vx, vy, hx, hy, rate, law, solid,
):  # fmt: skip
    """``collide_beside`` of any operator that has sharp rims."""
    g0, g1, g2, g3, g4, g5, g6, g7, g8 = collide(f0, f1, f2, f3, f4, f5, f6, f7, f8, d, jx, jy, ux, uy, rate, law)
    return mix(
        f0, f1, f2, f3, f4, f5, f6, f7, f8, g0, g1, g2, g3, g4, g5, g6, g7, g8, e, b, numbers(e).zero, rho, ux, uy, vx,
        vy, hx, hy, rate, solid,
    )  # fmt: skip


@by_law
def taken(e, b, rho, jx, jy, hx, hy, rate, solid):
    """What a cell's load is made of: (a, x, y) such that the solid of velocity v gains (x - a vx, y - a vy).

    j: first moment sum f c.
    """
