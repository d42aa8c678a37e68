"""What every solid operator of a partially saturated cell provides, chosen by the type of its law.

    f_i* = (1 - B) g_i + B (f_i + Omega^s_i),     g = f + Omega + S, the collided populations of the fluid operator

so that the body force acts in (1 - B) of the cell, or a resting disc would feel a force that is not there; with
rho u = sum f c + h, h = (1 - B) F/2.  Every operator conserves mass in each cell.
"""

from porescale.ground.jit import by_law


@by_law
def mix(
    f0, f1, f2, f3, f4, f5, f6, f7, f8, g0, g1, g2, g3, g4, g5, g6, g7, g8, b, rho, ux, uy, vx, vy, rate, solid
):  # fmt: skip
    """The nine populations after solid and fluid operator.

    f before, g after the fluid operator (shifted);  b weight;  u velocity with h;  v of the solid;  rate 1/tau.
    """


@by_law
def taken(b, rho, jx, jy, hx, hy, rate, solid):
    """What a cell's load is made of: (a, x, y) such that the solid of velocity v gains (x - a vx, y - a vy).

    j: first moment sum f c;  h: half the force that acts, (1 - B) F/2.
    """
