"""Collision of rows in which grains lie, and the sweep over the lattice that does it.

Where no grain lies this is the plain operator.  Grains that share a cell act with the mean velocity of the solid in it,
v = sum e v_n / sum e; their loads use each one's own velocity and add up to the same total (load.py).
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from porescale.common.compiled.jit import disjoint, inline, parallel_kernel, prange, thread, unchecked_view
from porescale.coupling.coverage.rows import BLOCK, rasterize_band, views_of
from porescale.coupling.load import accumulate_load_band
from porescale.coupling.solid.law import (
    SolidCell,
    collide_with_solid,
    force_share,
    is_soft,
    momentum_to_solid,
    rates,
)
from porescale.coupling.weighting.law import weight
from porescale.lbm.collision.law import (
    Macroscopic,
    cell_law,
    collide_row,
    cut,
    half_force,
    moments,
    numbers,
    part_law,
    row_law,
    shear_rate,
)
from porescale.lbm.stream import slots

AT_ONCE = 512
"""Cells of a row whose weights are worked out, then used: they stay in the nearest cache."""
STRETCH = 64
"""Cells of a row that are saturated or plain together."""


class RowWork(NamedTuple):
    """What bands of rows are worked out with.

    row_load (n, largest height, 5 or 7): load.py;  for each thread scratch (threads, 3 or 4, height of a band times
    (BLOCK + nx + BLOCK)): zero before and after;  weights (threads, 4, AT_ONCE or less), extent (threads, twice the
    height of a band): scratch.
    """

    row_load: NDArray[np.float64]
    scratch: NDArray[np.floating]
    weights: NDArray[np.floating]
    extent: NDArray[np.int64]


@inline
def weights_of_cell(e, weighting, solid):
    """What a saturated cell needs that follows from the sum e of its solid fractions alone: 1/e, the weight b, and the
    two ``rates``.  1 where there is no e to speak of, whose square is 0 (1 over it may be infinite)."""
    c = numbers(e)
    share = c.one / (e if e * e > c.zero else c.one)
    e = min(c.one, e)
    b = weight(e, c.zero, c.zero, c.zero, weighting)
    return share, b, rates(e, b, c.zero, c.zero, c.zero, solid)


@inline
def collide_saturated_cell(f, body, weights, laws):
    """Collide a cell in which grains lie: its populations, what loads are made of, and |u - v| where rims are soft.

    body: sum e of the solid fractions and of e times theta, velocity of the solid (x, y);  weights: of
    ``weights_of_cell``;  laws: of weight, solid and fluid operator, that of the cell.
    """
    weighting, solid, law = laws
    e, theta, vx, vy = body
    share, held, shares = weights
    c = numbers(law.rate)
    one = c.one
    half_x, half_y = half_force(law)
    d, jx, jy = moments(f)
    rho = one + d
    specific_volume = one / rho
    e, slip = min(one, e), c.zero
    if is_soft(solid):
        theta = theta * share
        slip_x = (jx + half_x) * specific_volume - vx
        slip_y = (jy + half_y) * specific_volume - vy
        held = weight(e, theta, slip_x, slip_y, weighting)
        shares = rates(e, held, theta, slip_x, slip_y, solid)
        slip = np.sqrt(slip_x * slip_x + slip_y * slip_y)
    acting = force_share(held, solid)
    hx, hy = acting * half_x, acting * half_y
    kx, ky = jx + hx, jy + hy
    cell = SolidCell(e, held, theta, vx, vy, hx, hy)
    m = Macroscopic(d, kx, ky, kx * specific_volume, ky * specific_volume)
    rate = shear_rate(f, m, law)
    g = collide_with_solid(f, cell, shares, m, rate, law, solid)
    ta, tx, ty = momentum_to_solid(cell, rho, jx, jy, rate, solid)
    return g, (share * ta, share * tx, share * ty), slip


@disjoint
def weights_row(sums, weights, weighting, solid):
    """What saturated cells need that follows from the bodies alone.

    sums: s, sx, sy (cells,) as in collide_saturated_row: sx, sy become the mean solid velocity.  Overwrites four rows
    of weights:  1 over the sum of the solid fractions, or 1 where there is none to speak of, whose square is 0 (1 over
    it may be infinite);  the weight b;  the two ``rates``.  A loop of its own, since in one with the collision
    divisions would wait for each other.
    """
    s, sx, sy = sums
    inverse, b, first_rate, second_rate = weights
    for x in range(s.shape[0]):
        share, b[x], (first_rate[x], second_rate[x]) = weights_of_cell(s[x], weighting, solid)
        inverse[x] = share
        sx[x] *= share
        sy[x] *= share


@disjoint
def collide_saturated_cells(planes, sums, st, weights, weighting, solid, fluids):
    """Collide all cells of nine slots (n,);  arguments as in collide_saturated_row, weights: of ``weights_row``."""
    a0, a1, a2, a3, a4, a5, a6, a7, a8 = planes
    s, sx, sy = sums
    inverse, b, first_rate, second_rate = weights
    soft = is_soft(solid)
    for x in range(s.shape[0]):
        f = (a0[x], a1[x], a2[x], a3[x], a4[x], a5[x], a6[x], a7[x], a8[x])
        here, shares = (weighting, solid, cell_law(x, fluids)), (first_rate[x], second_rate[x])
        theta = st[x] if soft else numbers(s[x]).zero
        g, gained, slip = collide_saturated_cell(f, (s[x], theta, sx[x], sy[x]), (inverse[x], b[x], shares), here)
        a0[x], a2[x], a1[x], a4[x], a3[x] = g[0], g[1], g[2], g[3], g[4]
        a6[x], a5[x], a8[x], a7[x] = g[5], g[6], g[7], g[8]
        if soft:
            st[x] = slip
        s[x], sx[x], sy[x] = gained


@inline
def collide_saturated_row(planes, sums, st, weights, first, last, laws):
    """Collide cells ``first`` to ``last`` - 1 of a row in which grains lie.

    planes: nine slots (nx,), as in collide_row;  laws: of weight, solid and fluid operator.  sums: s, sx, sy (nx,), sum
    of the solid fractions e and of e times solid velocity; overwritten with what loads are made of, the three numbers
    of ``momentum_to_solid`` over sum e.  st (nx,): sum of e times theta where rims are soft, overwritten with |u - v|;
    not touched elsewhere.  weights (4 or more, as many cells): scratch.
    """
    weighting, solid, law = laws
    # Cut to the range first: an index that might be negative keeps the loop from being vectorised.
    n = last - first
    s, sx, sy = sums
    here = unchecked_view(s, first, n), unchecked_view(sx, first, n), unchecked_view(sy, first, n)
    found = (
        unchecked_view(weights[0], 0, n),
        unchecked_view(weights[1], 0, n),
        unchecked_view(weights[2], 0, n),
        unchecked_view(weights[3], 0, n),
    )
    weights_row(here, found, weighting, solid)
    fluids = part_law(first, last, law)
    softness = unchecked_view(st, first, n)
    collide_saturated_cells(cut(planes, first, n), here, softness, found, weighting, solid, fluids)


@inline
def stretches(left, right, n):
    """First and one past the last saturated cell of a row of n, where bodies may cover those from ``left`` to
    ``right`` - 1.

    Short loops run cell by cell: the plain ends of the row are whole stretches, or empty.
    """
    if left >= right:
        left = n
        right = n
    return left // STRETCH * STRETCH, min((right + STRETCH - 1) // STRETCH * STRETCH, n)


@inline
def collide_partly(planes, i, extent, sums, soft, weights, laws):
    """Collide row ``i`` of a band, of which bodies may cover columns extent[2 i] to extent[2 i + 1] - 1.  Plain fluid
    outside.

    planes: the row's nine slots;  sums: of ``rasterize_band``, overwritten in the row with what loads are made of, and
    with 0 beyond the box;  soft: whether rims are;  weights: four views, scratch;  laws: of weight, solid and fluid
    operator.  Overwrites the slots, and in extent the saturated columns.
    """
    law = laws[2]
    n = planes[0].shape[0]
    at = i * (n + 2 * BLOCK) + BLOCK
    left, right = stretches(extent[2 * i], extent[2 * i + 1], n)
    extent[2 * i] = left
    extent[2 * i + 1] = right
    for end_of_row in range(2):  # one loop for both ends: compiled once
        first, last = (right, n) if end_of_row else (0, left)
        collide_row(planes, first, last, law)
    if left < right:
        s, sx, sy = unchecked_view(sums[0], at, n), unchecked_view(sums[1], at, n), unchecked_view(sums[2], at, n)
        softness = unchecked_view(sums[3], at, n)
        for first in range(left, right, AT_ONCE):
            last = min(first + AT_ONCE, right)
            collide_saturated_row(planes, (s, sx, sy), softness, weights, first, last, laws)
        clear(sums, soft, at - BLOCK, at)
        clear(sums, soft, at + n, at + n + BLOCK)


@inline
def clear(sums, soft, first, last):
    """Set entries ``first`` to ``last`` - 1 of the sums to 0, of the fourth where rims are soft."""
    sums[0][first:last] = 0
    sums[1][first:last] = 0
    sums[2][first:last] = 0
    if soft:
        sums[3][first:last] = 0


@parallel_kernel
def sweep(f, parity, band_order, bands, patches, motion, periodic_x, work, weighting, solid, law):
    """Step of ``parity`` with bodies; overwrites padded populations f and work.row_load.  Before an odd one: fill
    the halo.

    Bands are spread over the threads in ``band_order``: bodies are rasterized, rows collided, loads taken;  motion:
    ``Motion`` of all bodies;  work: ``RowWork`` of all threads;  weighting, solid, law: of weight, solid and fluid
    operator.
    """
    # By name: what a loop over threads writes into a member of a tuple is lost.
    row_load, scratch, weights, extent = work.row_load, work.scratch, work.weights, work.extent
    n, soft = scratch.shape[2] // bands.height - 2 * BLOCK, scratch.shape[1] > 3
    for turn in prange(band_order.shape[0]):
        band, mine = band_order[turn], thread()
        bottom = band * bands.height
        sums, shares = views_of(scratch, mine), views_of(weights, mine)
        reach = unchecked_view(extent[mine], 0, extent.shape[1])
        rasterize_band(band, bands, patches, motion, periodic_x, sums, reach, soft)
        rows = min(bands.height, bands.rows - bottom)
        for i in range(rows):
            y = bottom + i
            here = weighting, solid, row_law(y, law)
            collide_partly(slots(f, n, y + 1, parity), i, reach, sums, soft, shares, here)
        accumulate_load_band(band, bands, patches, motion, periodic_x, sums, row_load, soft)
        for i in range(rows):
            at = i * (n + 2 * BLOCK) + BLOCK
            clear(sums, soft, at + reach[2 * i], at + reach[2 * i + 1])
