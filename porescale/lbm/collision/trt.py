"""Two relaxation times (Ginzburg, Verhaeghe & d'Humieres 2008), with body force (Guo, Zheng & Shi 2002).

The even half of a pair, (f_i + f_-i)/2, relaxes with w+ = 1/tau and carries the viscosity; the odd half with w-, set by
the magic parameter  L = (1/w+ - 1/2)(1/w- - 1/2).  L = 3/16 puts a half-way wall exactly midway in a parabolic flow.

The operator is split in two so that a partially saturated cell can share its second part: ``moments`` and ``targets``
give what the halves relax to, ``relax`` applies rates and targets.  Numbers arrive in one parameter row in the dtype
of the populations (see ``parameters``), since a float64 literal would promote a float32 kernel.
"""

import numpy as np
from numpy.typing import DTypeLike, NDArray

from porescale.ground.jit import inline

MAGIC_MIDWAY_WALL = 3 / 16


def odd_rate(relaxation_time: float, magic: float) -> float:
    """Rate w- of the odd half for a relaxation time and a magic parameter."""
    return 1 / (0.5 + magic / (relaxation_time - 0.5))


def parameters(
    relaxation_time: float, magic: float, force: tuple[float, float], dtype: DTypeLike
) -> NDArray[np.floating]:
    """Everything a row kernel needs, as one array (16,) of ``dtype``; lattice units.

    0 even rate, 1 odd rate, 2-3 force density, 4-5 forcing factors of even and odd half, 6-8 the weights,
    9-11 three times the weights of sides and diagonals and the number 3, 12 one, 13 half, 14 3/2, 15 9/2.
    """
    even, odd = 1 / relaxation_time, odd_rate(relaxation_time, magic)
    return np.array(
        [
            even,
            odd,
            force[0],
            force[1],
            1 - even / 2,
            1 - odd / 2,
            4 / 9,
            1 / 9,
            1 / 36,
            1 / 3,
            1 / 12,
            3,
            1,
            0.5,
            1.5,
            4.5,
        ],
        dtype=dtype,
    )


@inline
def moments(f0, f1, f2, f3, f4, f5, f6, f7, f8):
    """Density excess and first moment of nine shifted populations: (d, jx, jy)."""
    d = f0 + ((f1 + f2) + (f3 + f4)) + ((f5 + f6) + (f7 + f8))
    d5 = f5 - f6
    d7 = f7 - f8
    return d, (f1 - f2) + (d5 - d7), (f3 - f4) + (d5 + d7)


@inline
def targets(d, jx, jy, ux, uy, p):
    """Rate times equilibrium plus forcing, free of weights: even part q, xx, yy, xy and odd part mx, my.

    d density excess, j momentum density including half the force, u = j/(1 + d), p ``parameters``.
    The even half of direction c relaxes to w (q + cx² xx + cy² yy + cx cy xy), the odd one to 3 w (cx mx + cy my).
    """
    even, odd, fx, fy, se, so = p[0], p[1], p[2], p[3], p[4], p[5]
    three, c15, c45 = p[11], p[14], p[15]
    jxx = jx * ux
    jyy = jy * uy
    q = even * (d - c15 * (jxx + jyy)) - three * se * (ux * fx + uy * fy)
    nine = c45 + c45
    xx = c45 * even * jxx + nine * se * ux * fx
    yy = c45 * even * jyy + nine * se * uy * fy
    xy = nine * (even * jx * uy + se * (ux * fy + uy * fx))
    return q, xx, yy, xy, odd * jx + so * fx, odd * jy + so * fy


@inline
def relax(f0, f1, f2, f3, f4, f5, f6, f7, f8, even, odd, q, xx, yy, xy, mx, my, p):
    """The nine collided populations for rates ``even``, ``odd`` and targets as ``targets`` defines them."""
    w0, w1, w2, t1, t2, half = p[6], p[7], p[8], p[9], p[10], p[13]
    he = half * even
    ho = half * odd
    g0 = f0 - even * f0 + w0 * q
    s = w1 * (q + xx) - he * (f1 + f2)
    m = t1 * mx - ho * (f1 - f2)
    g1 = f1 + s + m
    g2 = f2 + s - m
    s = w1 * (q + yy) - he * (f3 + f4)
    m = t1 * my - ho * (f3 - f4)
    g3 = f3 + s + m
    g4 = f4 + s - m
    diagonal = q + xx + yy
    s = w2 * (diagonal + xy) - he * (f5 + f6)
    m = t2 * (mx + my) - ho * (f5 - f6)
    g5 = f5 + s + m
    g6 = f6 + s - m
    s = w2 * (diagonal - xy) - he * (f7 + f8)
    m = t2 * (my - mx) - ho * (f7 - f8)
    g7 = f7 + s + m
    g8 = f8 + s - m
    return g0, g1, g2, g3, g4, g5, g6, g7, g8


@inline
def collide_row(a0, a1, a2, a3, a4, a5, a6, a7, a8, first, last, p):
    """Collide cells ``first`` to ``last`` - 1 of one row; overwrites its nine slots.

    a_i (nx,): the slots where the row's h_i are read; the collided h_i goes to the slot of the opposite direction.
    p: ``parameters``.  Not checked: that density stays positive.
    """
    one, half, fx, fy = p[12], p[13], p[2], p[3]
    # Cut to the range first: an index that might be negative keeps the loop from being vectorised.
    a0, a1, a2, a3, a4 = a0[first:last], a1[first:last], a2[first:last], a3[first:last], a4[first:last]
    a5, a6, a7, a8 = a5[first:last], a6[first:last], a7[first:last], a8[first:last]
    for x in range(a0.shape[0]):
        f0, f1, f2, f3, f4 = a0[x], a1[x], a2[x], a3[x], a4[x]
        f5, f6, f7, f8 = a5[x], a6[x], a7[x], a8[x]
        d, jx, jy = moments(f0, f1, f2, f3, f4, f5, f6, f7, f8)
        jx += half * fx
        jy += half * fy
        lightness = one / (one + d)
        q, xx, yy, xy, mx, my = targets(d, jx, jy, jx * lightness, jy * lightness, p)
        g0, g1, g2, g3, g4, g5, g6, g7, g8 = relax(
            f0, f1, f2, f3, f4, f5, f6, f7, f8, p[0], p[1], q, xx, yy, xy, mx, my, p
        )
        a0[x], a2[x], a1[x], a4[x], a3[x] = g0, g1, g2, g3, g4
        a6[x], a5[x], a8[x], a7[x] = g5, g6, g7, g8
