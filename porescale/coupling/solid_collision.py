"""Collision of rows in which grains lie, and the sweeps over the lattice that do it.

Where no grain lies this is the plain operator.  Grains that share a cell act with the mean velocity of the solid in it,
v = sum e v_n / sum e; their loads use each one's own velocity and add up to the same total (load.py).
"""

import numpy as np

from porescale.coupling.coverage_rows import BLOCK, lay_row
from porescale.coupling.load import take_row
from porescale.coupling.solid.law import force_share, is_soft, mix, taken
from porescale.coupling.weighting import weight
from porescale.ground.jit import inline, parallel_kernel, prange
from porescale.lbm.collision.law import collide, collide_row, moments, numbers, shear_rate
from porescale.lbm.stream import even_slots, odd_slots

STRETCH = 64
"""Cells of a row that are saturated or plain together."""


@inline
def collide_saturated_row(a0, a1, a2, a3, a4, a5, a6, a7, a8, s, sx, sy, st, first, last, weighting, solid, law):
    """Collide cells ``first`` to ``last`` - 1 of a row in which grains lie.

    a_i (nx,): slots, as in collide_row;  weighting, solid, law: laws of weight, solid and fluid operator.  s, sx, sy
    (nx,): sum of the solid fractions e and of e times solid velocity; overwritten with what loads are made of, the
    three numbers of ``taken`` over sum e.  st (nx,): sum of e times theta where rims are soft, overwritten with
    |u - v|; not touched elsewhere.
    """
    c = numbers(law.rate)
    one, half = c.one, c.half
    # Cut to the range first: an index that might be negative keeps the loop from being vectorised.
    a0, a1, a2, a3, a4 = a0[first:last], a1[first:last], a2[first:last], a3[first:last], a4[first:last]
    a5, a6, a7, a8 = a5[first:last], a6[first:last], a7[first:last], a8[first:last]
    s, sx, sy, st = s[first:last], sx[first:last], sy[first:last], st[first:last]
    soft = is_soft(solid)
    for x in range(s.shape[0]):
        f0, f1, f2, f3, f4 = a0[x], a1[x], a2[x], a3[x], a4[x]
        f5, f6, f7, f8 = a5[x], a6[x], a7[x], a8[x]
        e = s[x]
        d, jx, jy = moments(f0, f1, f2, f3, f4, f5, f6, f7, f8)
        rho = one + d
        share = e if e > c.zero else one
        both = one / (rho * share)  # one division for two: they cost more than all else here
        part, lightness = both * rho, both * share
        e = min(one, e)
        vx, vy = sx[x] * part, sy[x] * part
        theta = c.zero
        if soft:
            theta = st[x] * part
        slip_x = (jx + half * law.fx) * lightness - vx
        slip_y = (jy + half * law.fy) * lightness - vy
        b = weight(e, theta, slip_x, slip_y, weighting)
        if soft:
            st[x] = np.sqrt(slip_x * slip_x + slip_y * slip_y)
        acting = half * force_share(b, solid)
        hx = acting * law.fx
        hy = acting * law.fy
        kx, ky = jx + hx, jy + hy
        ux, uy = kx * lightness, ky * lightness
        rate = shear_rate(f0, f1, f2, f3, f4, f5, f6, f7, f8, d, kx, ky, ux, uy, law)
        g0, g1, g2, g3, g4, g5, g6, g7, g8 = collide(f0, f1, f2, f3, f4, f5, f6, f7, f8, d, kx, ky, ux, uy, rate, law)
        g0, g1, g2, g3, g4, g5, g6, g7, g8 = mix(
            f0, f1, f2, f3, f4, f5, f6, f7, f8, g0, g1, g2, g3, g4, g5, g6, g7, g8, e, b, theta, rho, ux, uy, vx, vy,
            hx, hy, rate, solid,
        )  # fmt: skip
        a0[x], a2[x], a1[x], a4[x], a3[x] = g0, g1, g2, g3, g4
        a6[x], a5[x], a8[x], a7[x] = g5, g6, g7, g8
        ta, tx, ty = taken(e, b, rho, jx, jy, hx, hy, rate, solid)
        s[x] = part * ta
        sx[x] = part * tx
        sy[x] = part * ty


@inline
def saturated_row(
    a0, a1, a2, a3, a4, a5, a6, a7, a8, begin, end, rows, patches, centre, velocity, spin, shift, theta,
    periodic_x, ramp, row_load, scratch, partial, weighting, solid, law,
):  # fmt: skip
    """One row of the lattice: lay out its bodies, collide, take their loads.

    Plain fluid outside of what the bodies cover.  scratch (3, BLOCK + nx + BLOCK): zero before and after;  partial:
    scratch too; other arguments as in coverage_rows.py and load.py.
    """
    n = a0.shape[0]
    s, sx, sy = scratch[0], scratch[1], scratch[2]
    left = n
    right = n
    if begin < end:
        left, right = lay_row(
            begin, end, rows, patches, centre, velocity, spin, shift, theta, periodic_x, ramp, scratch
        )  # fmt: skip
    if left >= right:
        collide_row(a0, a1, a2, a3, a4, a5, a6, a7, a8, 0, n, law)
        left = right
    else:
        # Short loops run cell by cell: the plain ends of the row are whole stretches, or nothing.
        left, right = left // STRETCH * STRETCH, min((right + STRETCH - 1) // STRETCH * STRETCH, n)
        cells, cells_x, cells_y = s[BLOCK : BLOCK + n], sx[BLOCK : BLOCK + n], sy[BLOCK : BLOCK + n]
        softness = scratch[scratch.shape[0] - 1, BLOCK : BLOCK + n]
        collide_row(a0, a1, a2, a3, a4, a5, a6, a7, a8, 0, left, law)
        collide_saturated_row(
            a0, a1, a2, a3, a4, a5, a6, a7, a8, cells, cells_x, cells_y, softness, left, right, weighting, solid,
            law,
        )  # fmt: skip
        collide_row(a0, a1, a2, a3, a4, a5, a6, a7, a8, right, n, law)
        for beyond in (s, sx, sy):
            beyond[:BLOCK] = 0
            beyond[BLOCK + n :] = 0
        if scratch.shape[0] > 3:
            scratch[3, :BLOCK] = 0
            scratch[3, BLOCK + n :] = 0
    take_row(begin, end, rows, patches, centre, velocity, spin, shift, periodic_x, ramp, scratch, partial, row_load)
    for used in (s, sx, sy):
        used[BLOCK + left : BLOCK + right] = 0
    if scratch.shape[0] > 3:
        scratch[3, BLOCK + left : BLOCK + right] = 0


@parallel_kernel
def sweep_even(
    f, band_order, height, rows, patches, centre, velocity, spin, shift, theta, periodic_x, ramp, row_load,
    scratch, partial, weighting, solid, law,
):  # fmt: skip
    """Even step with bodies; overwrites populations f and row_load.

    scratch (bands, 3, BLOCK + nx + BLOCK): zero before and after;  partial (bands, 3 * BLOCK): scratch.  Bands of
    ``height`` rows are spread over the threads in ``band_order``; other arguments as in ``saturated_row``.
    """
    for turn in prange(band_order.shape[0]):
        band = band_order[turn]
        for y in range(band * height, min((band + 1) * height, f.shape[1] - 2)):
            a0, a1, a2, a3, a4, a5, a6, a7, a8 = even_slots(f, y + 1)
            saturated_row(
                a0, a1, a2, a3, a4, a5, a6, a7, a8, rows.start[y], rows.start[y + 1], rows, patches, centre, velocity,
                spin, shift, theta, periodic_x, ramp, row_load, scratch[band], partial[band], weighting, solid, law,
            )  # fmt: skip


@parallel_kernel
def sweep_odd(
    f, band_order, height, rows, patches, centre, velocity, spin, shift, theta, periodic_x, ramp, row_load,
    scratch, partial, weighting, solid, law,
):  # fmt: skip
    """Odd step with bodies; the halo must have been filled."""
    for turn in prange(band_order.shape[0]):
        band = band_order[turn]
        for y in range(band * height, min((band + 1) * height, f.shape[1] - 2)):
            a0, a1, a2, a3, a4, a5, a6, a7, a8 = odd_slots(f, y + 1)
            saturated_row(
                a0, a1, a2, a3, a4, a5, a6, a7, a8, rows.start[y], rows.start[y + 1], rows, patches, centre, velocity,
                spin, shift, theta, periodic_x, ramp, row_load, scratch[band], partial[band], weighting, solid, law,
            )  # fmt: skip
