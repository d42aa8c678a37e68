"""The rows of the lattice that bodies lie in, and what they cover of each.

A body, whatever its shape, has filled a patch of solid fractions around itself.  A list of the bodies in every row, in
index order so that sums do not depend on threads, lets a row be rasterized (``rasterize_row``) when it is needed.
Patches and the scratch of a row are worked through in blocks of ``BLOCK`` cells, a number fixed when kernels are
compiled: a loop of a dozen cells would run cell by cell otherwise.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from porescale.common.compiled.jit import inline, parallel_kernel, prange, prefetch
from porescale.common.compiled.simd import EIGHT, fma, load_eight, ramp_eight, store_eight
from porescale.common.core.aligned import aligned_zeros

BLOCK = EIGHT
"""Cells done at once."""
AHEAD = 12
"""Entries of a row ahead of which patches are fetched: bodies lie apart in memory, and waiting for each would cost more
than all that is done with it."""
LISTING = 4
"""Parts of the lattice whose rows are listed side by side; any number gives the same lists."""
SERIAL_BELOW = 8192
"""Blocks of all patches: fewer are covered and listed by one thread, in 0.4 ms at most; and rows that loads have room
for, that are added so.  To have two threads begin and end a loop takes 0.1 to 0.5 ms beside six other
busy processes (measured)."""


class Patches(NamedTuple):
    """Where bodies cover the lattice.

    corner (n, 2): cell (x, y) at a patch's lower left;  height (n,): its rows;  stride (n,): cells of a row, a multiple
    of ``BLOCK``;  start (n,): where in ``fraction`` its first row begins;  fraction: of all patches, row by row.
    """

    corner: NDArray[np.int64]
    height: NDArray[np.int64]
    stride: NDArray[np.int64]
    start: NDArray[np.int64]
    fraction: NDArray[np.floating]


class Motion(NamedTuple):
    """How bodies move, lattice units.

    centre (n, 2) cells;  velocity (n, 2);  spin (n,);  shift (n, 3): half-step correction, along x and y and of the
    spin (load.py);  theta (n,): softness of the rims (soft_rim.py).
    """

    centre: NDArray[np.floating]
    velocity: NDArray[np.floating]
    spin: NDArray[np.floating]
    shift: NDArray[np.floating]
    theta: NDArray[np.floating]


class Rows(NamedTuple):
    """Which bodies lie in which row of the lattice: entries start[y] to start[y + 1] - 1 are those of row y.

    start (ny + 1,);  body, line (as many as patches have rows): the body, and the row of its patch.  Not negative by
    their type: an index that might be is tested at each use, a tenth of a sweep of discs of four cells.
    """

    start: NDArray[np.int64]
    body: NDArray[np.uint32]
    line: NDArray[np.uint32]


def whole_blocks(cells: NDArray[np.int64]) -> NDArray[np.int64]:
    """The least multiples of ``BLOCK`` that hold so many cells."""
    return -(-cells // BLOCK) * BLOCK


def make_patches(width: NDArray[np.int64], height: NDArray[np.int64], dtype: np.dtype[np.floating]) -> Patches:
    """Empty patches of width (n,) by height (n,) cells."""
    stride = whole_blocks(width)
    size = stride * height
    start = np.cumsum(size) - size
    return Patches(np.zeros((len(width), 2), np.int64), height, stride, start, aligned_zeros(int(np.sum(size)), dtype))


def make_rows(patches: Patches, ny: int) -> Rows:
    """Lists that hold all rows of the patches."""
    entries = int(np.sum(patches.height))
    return Rows(np.zeros(ny + 1, np.int64), np.zeros(entries, np.uint32), np.zeros(entries, np.uint32))


@inline
def is_few(patches):
    """Whether one thread does all patches: ``SERIAL_BELOW``."""
    return patches.fraction.shape[0] < SERIAL_BELOW * BLOCK


@parallel_kernel
def list_rows(patches, periodic_y, rows):
    """Which bodies lie in which row of the lattice, and with which row of their patch, in index order: a counting sort.

    Overwrites rows.  A body is higher than a periodic box by two rows at most.
    """
    start = rows.start
    ny = start.shape[0] - 1
    start[:] = 0
    # How many begin less how many have ended in each row; then their sums, the number in each; then their sums.
    for n in range(patches.height.shape[0]):
        low = patches.corner[n, 1]
        high = low + patches.height[n]
        if periodic_y:
            low %= ny
            high = low + patches.height[n]
            while high > ny:
                start[low] += 1
                start[ny] -= 1
                low = 0
                high -= ny
        low = max(low, 0)
        high = min(high, ny)
        if low < high:
            start[low] += 1
            start[high] -= 1
    here = 0
    total = 0
    for y in range(ny + 1):
        here += start[y]
        start[y] = total
        total += here
    if is_few(patches):
        list_part(patches, periodic_y, rows, 0, ny)
    else:
        for piece in prange(LISTING):
            list_part(patches, periodic_y, rows, piece * ny // LISTING, (piece + 1) * ny // LISTING)
    for y in range(ny, 0, -1):
        start[y] = start[y - 1]
    start[0] = 0


@inline
def list_part(patches, periodic_y, rows, first, last):
    """List rows ``first`` to ``last`` - 1 of the lattice; moves rows.start of each to where its entries end."""
    ny = rows.start.shape[0] - 1
    for n in range(patches.height.shape[0]):
        low = patches.corner[n, 1]
        if periodic_y:
            low %= ny
        high = low + patches.height[n]
        while True:  # once, or again for what lies beyond a periodic side
            for y in range(max(low, first), min(high, last)):
                at = rows.start[y]
                rows.body[at] = n
                rows.line[at] = y - low
                rows.start[y] = at + 1
            low -= ny
            high -= ny
            if not periodic_y or high <= 0:
                break


@inline
def blocks_inside(base, stride, nx):
    """The whole blocks of a patch row that reach into the box, when its cell 0 lies in column ``base``: first, last.

    The first and the last one may stick out by less than a block.
    """
    return max(0, -base // BLOCK * BLOCK), min(stride, (nx - base + BLOCK - 1) // BLOCK * BLOCK)


@inline
def motion_of_row(n, j, patches, motion):
    """How the cells of row ``j`` of body n's patch move: what ``motion_of_block`` makes blocks of.

    (x, y) from the centre to its first cell, turning and twist (spin and its correction), vx and cx, the part that all
    its cells have and the correction of full ones, and vy, cy of its first cell.
    """
    real = patches.fraction.dtype.type
    velocity, spin, shift = motion.velocity, motion.spin, motion.shift
    ry = patches.corner[n, 1] + j + 0.5 - motion.centre[n, 1]
    rx = patches.corner[n, 0] + 0.5 - motion.centre[n, 0]
    return (
        rx,
        ry,
        real(spin[n]),
        real(shift[n, 2]),
        real(velocity[n, 0] - spin[n] * ry),
        real(shift[n, 0] - shift[n, 2] * ry),
        velocity[n, 1] + spin[n] * rx,
        shift[n, 1] + shift[n, 2] * rx,
    )


@inline
def motion_of_block(n, b, row, patches, motion):
    """How the block that begins with cell ``b`` of a row moves;  row: ``motion_of_row``.

    (x, y) from the centre to its first cell, turning and twist, vx and cx, vy and cy of its first cell.
    """
    real = patches.fraction.dtype.type
    rx, ry, turning, twist, vx, cx, vy, cy = row
    return (
        real(rx + b),
        real(ry),
        turning,
        twist,
        vx,
        cx,
        real(vy + motion.spin[n] * b),
        real(cy + motion.shift[n, 2] * b),
    )


@inline
def solid_velocity(e, i, block):
    """Velocity of a body in cell ``i`` of a block of which it covers e;  block: ``motion_of_block``."""
    _, _, turning, twist, vx, cx, vy, cy = block
    return fma(e, cx, vx), fma(e, fma(twist, i, cy), fma(turning, i, vy))


@inline
def rasterize_row(y, rows, patches, motion, periodic_x, scratch):
    """Add up the solid fractions of one row, and fractions times solid velocity at the cells' centres.

    The velocity in a cell that a body covers by e is its own and e times the half-step correction.

    y: row of the lattice;  motion: ``Motion``  Adds to scratch (3 or 4, BLOCK + nx +
    BLOCK), whose fourth row, where rims are soft, gets fractions times theta; returns the first column that may be
    covered and one past the last.
    """
    nx = scratch.shape[1] - 2 * BLOCK
    s, sx, sy = scratch[0], scratch[1], scratch[2]
    leftmost = nx
    rightmost = 0
    for k in range(rows.start[y], rows.start[y + 1]):
        if k + AHEAD < rows.body.shape[0]:
            m = rows.body[k + AHEAD]
            soon = patches.start[m] + rows.line[k + AHEAD] * patches.stride[m]
            prefetch(patches.fraction, soon)
            prefetch(patches.fraction, soon + BLOCK)
        n = rows.body[k]
        j = rows.line[k]
        stride = patches.stride[n]
        at = patches.start[n] + j * stride
        base = patches.corner[n, 0]
        row = motion_of_row(n, j, patches, motion)
        if periodic_x:
            base %= nx
        while base + stride > 0:  # once, or again for what lies beyond a periodic side
            first, last = blocks_inside(base, stride, nx)
            for b in range(first, last, BLOCK):
                block = motion_of_block(n, b, row, patches, motion)
                e, i, x = load_eight(patches.fraction, at + b), ramp_eight(s), base + b + BLOCK
                vx, vy = solid_velocity(e, i, block)
                store_eight(s, x, load_eight(s, x) + e)
                store_eight(sx, x, load_eight(sx, x) + e * vx)
                store_eight(sy, x, load_eight(sy, x) + e * vy)
                if scratch.shape[0] > 3:
                    st = scratch[3]
                    store_eight(st, x, load_eight(st, x) + e * s.dtype.type(motion.theta[n]))
            if first < last:
                leftmost = min(leftmost, base + first)
                rightmost = max(rightmost, base + last)
            if not periodic_x:
                break
            base -= nx
    return max(leftmost, 0), min(rightmost, nx)


@parallel_kernel
def rasterize(rows, patches, motion, periodic_x, scratch, out):
    """All rows at once, for output: overwrites out (3, ny, nx) with what ``rasterize_row`` gives.

    scratch (bands, 3 or 4, BLOCK + nx + BLOCK): zero before and after.
    """
    bands = scratch.shape[0]
    ny, nx = out.shape[1], out.shape[2]
    for band in prange(bands):
        for y in range(band * ny // bands, (band + 1) * ny // bands):
            rasterize_row(y, rows, patches, motion, periodic_x, scratch[band])
            for k in range(3):  # element by element: assigned as slices it takes ten times as long to compile
                for x in range(nx):
                    out[k, y, x] = scratch[band, k, BLOCK + x]
            for k in range(scratch.shape[1]):
                for x in range(scratch.shape[2]):
                    scratch[band, k, x] = 0
