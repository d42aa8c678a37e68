"""What every collision operator shares: numbers in the dtype of the populations, moments, the choice by type.

An operator is a NamedTuple of its rates (a law) and a body of ``collide`` for it.  Kernels take the law as their last
argument and are compiled once for each operator in use.  Every law begins with the fields ``rate`` (1/tau), ``fx`` and
``fy`` (body force density), lattice units, in the dtype of the populations.
"""

from typing import NamedTuple

import numpy as np

from porescale.common.compiled.jit import by_law, by_precision, inline


class Numbers(NamedTuple):
    """Weights of rest, sides and diagonals, and the numbers that kernels need, in one precision."""

    w0: np.floating
    w1: np.floating
    w2: np.floating
    zero: np.floating
    quarter: np.floating
    half: np.floating
    one: np.floating
    c15: np.floating
    two: np.floating
    three: np.floating
    c45: np.floating
    nine: np.floating
    c34: np.floating
    c38: np.floating


@by_precision
def numbers(real: type) -> Numbers:
    """``Numbers`` in the precision of a number."""
    return Numbers(*(real(v) for v in (4 / 9, 1 / 9, 1 / 36, 0, 0.25, 0.5, 1, 1.5, 2, 3, 4.5, 9, 0.75, 0.375)))


@inline
def moments(f0, f1, f2, f3, f4, f5, f6, f7, f8):
    """Density excess and first moment of nine shifted populations: (d, jx, jy)."""
    d = f0 + ((f1 + f2) + (f3 + f4)) + ((f5 + f6) + (f7 + f8))
    d5 = f5 - f6
    d7 = f7 - f8
    return d, (f1 - f2) + (d5 - d7), (f3 - f4) + (d5 + d7)


@inline
def stress(f1, f2, f3, f4, f5, f6, f7, f8, third, jx, jy, ux, uy):
    """Non-equilibrium part of the second moments: (xx, yy, xy); ``third`` is a third of the density excess."""
    diagonal = (f5 + f6) + (f7 + f8)
    return (
        f1 + f2 + diagonal - third - jx * ux,
        f3 + f4 + diagonal - third - jy * uy,
        (f5 + f6) - (f7 + f8) - jx * uy,
    )


@by_law
def half_force(law):
    """Half the body force density: (hx, hy)."""


@inline
def half_of_force(law):
    """``half_force`` of a law that may have one."""
    half = numbers(law.rate).half
    return half * law.fx, half * law.fy


@by_law
def shear_rate(f0, f1, f2, f3, f4, f5, f6, f7, f8, d, jx, jy, ux, uy, law):
    """Rate at which the shear stress of this cell relaxes: 1/tau, or less with an eddy viscosity."""


@by_law
def collide(f0, f1, f2, f3, f4, f5, f6, f7, f8, d, jx, jy, ux, uy, rate, law):
    """The nine collided populations of a cell, body force included.

    f: shifted populations;  d density excess, j first moment with half the force that acts here, u = j/(1 + d);
    rate: ``shear_rate``.
    """


@by_law
def collide_in_shares(
    f0, f1, f2, f3, f4, f5, f6, f7, f8, d, jx, jy, ux, uy, rate, even, odd, kept, px, py, law,
):  # fmt: skip
    """What is left of a collision in a cell that is partly solid: (1 - even) f+ + even g+,  kept f- + odd g- + 3 w c.p.

    f+, f-: even and odd half of the populations before, g+, g- after ``collide``, whose arguments the others are.
    """


@inline
def add_shares(
    f0, f1, f2, f3, f4, f5, f6, f7, f8, g0, g1, g2, g3, g4, g5, g6, g7, g8, even, odd, kept, px, py,
):  # fmt: skip
    """The same from the populations f before and g after any collision."""
    c = numbers(f0)
    half = c.half
    ea, eb, oa, ob = half * (c.one - even), half * even, half * kept, half * odd
    t1, t2 = c.three * c.w1, c.three * c.w2
    q1, m1 = ea * (f1 + f2) + eb * (g1 + g2), oa * (f1 - f2) + ob * (g1 - g2) + t1 * px
    q3, m3 = ea * (f3 + f4) + eb * (g3 + g4), oa * (f3 - f4) + ob * (g3 - g4) + t1 * py
    q5, m5 = ea * (f5 + f6) + eb * (g5 + g6), oa * (f5 - f6) + ob * (g5 - g6) + t2 * (px + py)
    q7, m7 = ea * (f7 + f8) + eb * (g7 + g8), oa * (f7 - f8) + ob * (g7 - g8) + t2 * (py - px)
    return (c.one - even) * f0 + even * g0, q1 + m1, q1 - m1, q3 + m3, q3 - m3, q5 + m5, q5 - m5, q7 + m7, q7 - m7


@inline
def collide_then_add(
    f0, f1, f2, f3, f4, f5, f6, f7, f8, d, jx, jy, ux, uy, rate, even, odd, kept, px, py, law,
):  # fmt: skip
    """``collide_in_shares`` for any operator."""
    g0, g1, g2, g3, g4, g5, g6, g7, g8 = collide(f0, f1, f2, f3, f4, f5, f6, f7, f8, d, jx, jy, ux, uy, rate, law)
    return add_shares(
        f0, f1, f2, f3, f4, f5, f6, f7, f8, g0, g1, g2, g3, g4, g5, g6, g7, g8, even, odd, kept, px, py
    )  # fmt: skip


@inline
def collide_row(a0, a1, a2, a3, a4, a5, a6, a7, a8, first, last, law):
    """Collide cells ``first`` to ``last`` - 1 of one row; overwrites its nine slots.

    a_i (nx,): the slots where the row's h_i are read; the collided h_i goes to the slot of the opposite direction.
    Not checked: that density stays positive.
    """
    c = numbers(law.rate)
    hx, hy = half_force(law)
    # Cut to the range first: an index that might be negative keeps the loop from being vectorised.
    a0, a1, a2, a3, a4 = a0[first:last], a1[first:last], a2[first:last], a3[first:last], a4[first:last]
    a5, a6, a7, a8 = a5[first:last], a6[first:last], a7[first:last], a8[first:last]
    for x in range(a0.shape[0]):
        f0, f1, f2, f3, f4 = a0[x], a1[x], a2[x], a3[x], a4[x]
        f5, f6, f7, f8 = a5[x], a6[x], a7[x], a8[x]
        d, jx, jy = moments(f0, f1, f2, f3, f4, f5, f6, f7, f8)
        jx += hx
        jy += hy
        lightness = c.one / (c.one + d)
        ux, uy = jx * lightness, jy * lightness
        rate = shear_rate(f0, f1, f2, f3, f4, f5, f6, f7, f8, d, jx, jy, ux, uy, law)
        g0, g1, g2, g3, g4, g5, g6, g7, g8 = collide(f0, f1, f2, f3, f4, f5, f6, f7, f8, d, jx, jy, ux, uy, rate, law)
        a0[x], a2[x], a1[x], a4[x], a3[x] = g0, g1, g2, g3, g4
        a6[x], a5[x], a8[x], a7[x] = g5, g6, g7, g8
