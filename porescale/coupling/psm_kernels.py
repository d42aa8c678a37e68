"""Collision of rows in which grains lie, and the sweeps over the lattice that do it.

Where no grain lies this is the plain operator.  Grains that share a cell act with the mean velocity of the solid in it,
v = sum e v_n / sum e; their loads use each one's own velocity and add up to the same total (load.py).
"""

import numpy as np

from porescale.common.compiled.jit import inline, parallel_kernel, part, prange, thread
from porescale.coupling.coverage.rows import BLOCK, lay_row
from porescale.coupling.load import take_row
from porescale.coupling.solid.law import collide_beside, force_share, is_soft, rates, taken
from porescale.coupling.weighting import weight
from porescale.lbm.collision.law import collide_row, half_force, moments, numbers, shear_rate
from porescale.lbm.stream import slots

AT_ONCE = 512
"""Cells of a row whose weights are worked out, then used: they stay in the nearest cache."""
STRETCH = 64
"""Cells of a row that are saturated or plain together."""


@inline
def weigh_row(s, sx, sy, inverse, b, even, kept, weighting, solid):
    """What saturated cells need that follows from the bodies alone.

    s, sx, sy (nx,) as in collide_saturated_row: sx, sy become the mean solid velocity.  Overwrites inverse, 1 over the
    sum of the solid fractions, or 1 where there is none to speak of, whose square is 0 (1 over it may be infinite);
    b, weight;  even, kept: ``rates``.  A loop of its own, since in one with the collision divisions would wait for
    each other.
    """
    c = numbers(weighting[0])
    for x in range(s.shape[0]):
        e = s[x]
        share = c.one / (e if e * e > c.zero else c.one)
        e = min(c.one, e)
        inverse[x] = share
        sx[x] *= share
        sy[x] *= share
        b[x] = weight(e, c.zero, c.zero, c.zero, weighting)
        even[x], kept[x] = rates(e, b[x], c.zero, c.zero, c.zero, solid)


@inline
def collide_saturated_row(
    a0, a1, a2, a3, a4, a5, a6, a7, a8, s, sx, sy, st, weights, first, last, weighting, solid, law,
):  # fmt: skip
    """Collide cells ``first`` to ``last`` - 1 of a row in which grains lie.

    a_i (nx,): slots, as in collide_row;  weighting, solid, law: laws of weight, solid and fluid operator.  s, sx, sy
    (nx,): sum of the solid fractions e and of e times solid velocity; overwritten with what loads are made of, the
    three numbers of ``taken`` over sum e.  st (nx,): sum of e times theta where rims are soft, overwritten with
    |u - v|; not touched elsewhere.  weights (4 or more, as many cells): scratch.
    """
    # Cut to the range first: an index that might be negative keeps the loop from being vectorised.
    n = last - first
    a0, a1, a2 = part(a0, first, n), part(a1, first, n), part(a2, first, n)
    a3, a4, a5 = part(a3, first, n), part(a4, first, n), part(a5, first, n)
    a6, a7, a8 = part(a6, first, n), part(a7, first, n), part(a8, first, n)
    s, sx, sy, st = part(s, first, n), part(sx, first, n), part(sy, first, n), part(st, first, n)
    inverse, b = part(weights[0], 0, n), part(weights[1], 0, n)
    even, kept = part(weights[2], 0, n), part(weights[3], 0, n)
    weigh_row(s, sx, sy, inverse, b, even, kept, weighting, solid)
    c = numbers(law.rate)
    one = c.one
    half_x, half_y = half_force(law)
    soft = is_soft(solid)
    for x in range(s.shape[0]):
        f0, f1, f2, f3, f4 = a0[x], a1[x], a2[x], a3[x], a4[x]
        f5, f6, f7, f8 = a5[x], a6[x], a7[x], a8[x]
        d, jx, jy = moments(f0, f1, f2, f3, f4, f5, f6, f7, f8)
        rho = one + d
        lightness = one / rho
        share, held, evenly, remaining = inverse[x], b[x], even[x], kept[x]
        e, vx, vy = min(one, s[x]), sx[x], sy[x]
        if soft:
            theta = st[x] * share
            slip_x = (jx + half_x) * lightness - vx
            slip_y = (jy + half_y) * lightness - vy
            held = weight(e, theta, slip_x, slip_y, weighting)
            evenly, remaining = rates(e, held, theta, slip_x, slip_y, solid)
            st[x] = np.sqrt(slip_x * slip_x + slip_y * slip_y)
        acting = force_share(held, solid)
        hx, hy = acting * half_x, acting * half_y
        kx, ky = jx + hx, jy + hy
        ux, uy = kx * lightness, ky * lightness
        rate = shear_rate(f0, f1, f2, f3, f4, f5, f6, f7, f8, d, kx, ky, ux, uy, law)
        g0, g1, g2, g3, g4, g5, g6, g7, g8 = collide_beside(
            f0, f1, f2, f3, f4, f5, f6, f7, f8, e, held, evenly, remaining, rho, d, kx, ky, ux, uy, vx, vy, hx, hy,
            rate, law, solid,
        )  # fmt: skip
        a0[x], a2[x], a1[x], a4[x], a3[x] = g0, g1, g2, g3, g4
        a6[x], a5[x], a8[x], a7[x] = g5, g6, g7, g8
        ta, tx, ty = taken(e, held, rho, jx, jy, hx, hy, rate, solid)
        s[x] = share * ta
        sx[x] = share * tx
        sy[x] = share * ty


@inline
def saturated_row(
    a0, a1, a2, a3, a4, a5, a6, a7, a8, begin, end, rows, patches, centre, velocity, spin, shift, theta,
    periodic_x, ramp, row_load, scratch, weights, weighting, solid, law,
):  # fmt: skip
    """One row of the lattice: lay out its bodies, collide, take their loads.

    Plain fluid outside of what the bodies cover.  scratch (3 or 4, BLOCK + nx + BLOCK): zero before and after;
    weights (5, AT_ONCE): scratch, its last row the ``partial`` of take_row; other arguments as in coverage_rows.py and
    load.py.
    """
    n = a0.shape[0]
    left = n
    right = n
    if begin < end:
        left, right = lay_row(
            begin, end, rows, patches, centre, velocity, spin, shift, theta, periodic_x, ramp, scratch
        )  # fmt: skip
    if left >= right:
        left = n
        right = n
    # Short loops run cell by cell: the plain ends of the row are whole stretches, or nothing.
    left, right = left // STRETCH * STRETCH, min((right + STRETCH - 1) // STRETCH * STRETCH, n)
    for end_of_row in range(2):  # one loop for both ends: compiled once
        first, last = (right, n) if end_of_row else (0, left)
        collide_row(a0, a1, a2, a3, a4, a5, a6, a7, a8, first, last, law)
    if left < right:
        s, sx, sy = part(scratch[0], BLOCK, n), part(scratch[1], BLOCK, n), part(scratch[2], BLOCK, n)
        softness = part(scratch[scratch.shape[0] - 1], BLOCK, n)
        for first in range(left, right, AT_ONCE):
            collide_saturated_row(
                a0, a1, a2, a3, a4, a5, a6, a7, a8, s, sx, sy, softness, weights, first, min(first + AT_ONCE, right),
                weighting, solid, law,
            )  # fmt: skip
        for k in range(scratch.shape[0]):
            scratch[k, :BLOCK] = 0
            scratch[k, BLOCK + n :] = 0
        take_row(
            begin, end, rows, patches, centre, velocity, spin, shift, periodic_x, ramp, scratch, weights[4], row_load
        )  # fmt: skip
        for k in range(scratch.shape[0]):
            scratch[k, BLOCK + left : BLOCK + right] = 0


@parallel_kernel
def sweep(
    f, parity, band_order, height, rows, patches, centre, velocity, spin, shift, theta, periodic_x, ramp, row_load,
    scratch, weights, weighting, solid, law,
):  # fmt: skip
    """Step of ``parity`` with bodies; overwrites populations f and row_load.  The halo is filled before an odd one.

    For each thread scratch (threads, 3 or 4, BLOCK + nx + BLOCK), zero before and after;  weights (threads, 5,
    AT_ONCE): scratch.  Bands of ``height`` rows are spread over the threads in ``band_order``;
    other arguments as in ``saturated_row``.
    """
    for turn in prange(band_order.shape[0]):
        band = band_order[turn]
        mine = thread()
        for y in range(band * height, min((band + 1) * height, f.shape[1] - 2)):
            a0, a1, a2, a3, a4, a5, a6, a7, a8 = slots(f, y + 1, parity)
            saturated_row(
                a0, a1, a2, a3, a4, a5, a6, a7, a8, rows.start[y], rows.start[y + 1], rows, patches, centre, velocity,
                spin, shift, theta, periodic_x, ramp, row_load, scratch[mine], weights[mine], weighting, solid, law,
            )  # fmt: skip
