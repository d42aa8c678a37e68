"""The rows of the lattice that bodies lie in, and what they cover of each.

A body, whatever its shape, has filled a patch of solid fractions around itself.  The lattice is done in bands of a few
rows.  A list of the bodies in every band, in index order so that sums do not depend on threads, lets its rows be
rasterized (``rasterize_band``) when they are needed: what holds for a whole body is then found once for several rows,
which is most of the work where these are a few cells long.
Patches and the scratch of a row are worked through in blocks of ``BLOCK`` cells, a number fixed when kernels are
compiled: a loop of a dozen cells would run cell by cell otherwise.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from porescale.common.compiled.jit import inline, parallel_kernel, prange, prefetch, thread, unchecked_view
from porescale.common.compiled.simd import EIGHT, fma, load_eight, ramp_eight, store_eight
from porescale.common.core.aligned import aligned_zeros

BLOCK = EIGHT
"""Cells done at once."""
AHEAD = 4
"""Entries of a band ahead of which patches are fetched: bodies lie apart in memory, and waiting for each would cost
more than all that is done with it."""
LINE = 16
"""Numbers from one fetch to the next: a line of the cache in single precision, a pair of lines in double."""
ROOM = 1
"""Rows that a body may go before all are listed anew: 70 to 220 steps of the main job."""
UNLISTED = -(1 << 62)
LISTING = 4
"""Parts of the lattice whose bands are listed side by side; any number gives the same lists."""
SERIAL_BELOW = 8192
"""Blocks of all patches: fewer are listed by one thread; and rows that loads have room for, that are added so.  To
have two threads begin and end a loop takes 0.1 to 0.5 ms beside six other busy processes (measured)."""


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


class Bands(NamedTuple):
    """Which bodies lie in which band of the lattice: entries start[b] to start[b + 1] - 1 are those of band b.

    height: rows of a band, the last of which may have less;  rows: of the lattice;  start (bands + 1,);  body, image
    (entries,): the body, and what has to be added to the row of its corner, see ``row_of``;  listed (n,): rows of the
    corners when they were listed.  Bodies may go ``ROOM`` rows from there before they are listed anew; an entry may
    have no row in its band.  A body is not negative by its type: an index that might be is tested at each use, a tenth
    of a sweep of discs of four cells.
    """

    height: int
    rows: int
    start: NDArray[np.int64]
    body: NDArray[np.uint32]
    image: NDArray[np.int64]
    listed: NDArray[np.int64]


def whole_blocks(cells: NDArray[np.int64]) -> NDArray[np.int64]:
    """The least multiples of ``BLOCK`` that hold so many cells."""
    return -(-cells // BLOCK) * BLOCK


def make_patches(width: NDArray[np.int64], height: NDArray[np.int64], dtype: np.dtype[np.floating]) -> Patches:
    """Empty patches of width (n,) by height (n,) cells."""
    stride = whole_blocks(width)
    size = stride * height
    start = np.cumsum(size) - size
    return Patches(np.zeros((len(width), 2), np.int64), height, stride, start, aligned_zeros(int(np.sum(size)), dtype))


def make_bands(patches: Patches, ny: int, height: int) -> Bands:
    """Lists that hold the patches in bands of ``height`` rows: each entry stands for a row or more of its body, or of
    its room.  Nothing is listed yet."""
    entries = int(np.sum(patches.height + 2 * ROOM))
    start = np.zeros(-(-ny // height) + 1, np.int64)
    listed = np.full(len(patches.height), UNLISTED)
    return Bands(height, ny, start, np.zeros(entries, np.uint32), np.zeros(entries, np.int64), listed)


@inline
def is_few(patches):
    """Whether one thread lists all patches: ``SERIAL_BELOW``."""
    return patches.fraction.shape[0] < SERIAL_BELOW * BLOCK


@inline
def row_of(k, bands, patches):
    """The row of the lattice in which the patch of entry ``k`` begins, beyond a periodic side, too."""
    return patches.corner[bands.body[k], 1] + bands.image[k]


@inline
def bands_about(low, height, bands):
    """First and one past the last band of a patch of ``height`` rows from ``low`` on, and of its room; none of rows
    beyond the lattice."""
    low, high = max(low - ROOM, 0), min(low + height + ROOM, bands.rows)
    if low >= high:
        return 0, 0
    return low // bands.height, (high - 1) // bands.height + 1


@inline
def has_room(corner, listed):
    """Whether no corner (n, 2) is more than ``ROOM`` rows from where it was ``listed`` (n,)."""
    near = True
    for n in range(listed.shape[0]):
        near = near and abs(corner[n, 1] - listed[n]) <= ROOM
    return near


@inline
def first_image(low, periodic_y, rows):
    """The highest row at which a patch that begins in row ``low`` may reach into the lattice with its room."""
    return low % rows + rows if periodic_y else low


@parallel_kernel
def list_bands(patches, periodic_y, bands):
    """Which bodies lie in which band of the lattice, in index order: a counting sort.

    Overwrites bands, unless all bodies are in the room that they were listed for: to write the lists, which other
    threads have read, takes ten times as long as to see that.  A body is higher than a periodic box by two rows at
    most.
    """
    if has_room(patches.corner, bands.listed):
        return
    start = bands.start
    count = start.shape[0] - 1
    start[:] = 0
    # How many begin less how many have ended in each band; then their sums, the number in each; then their sums.
    for n in range(patches.height.shape[0]):
        low, height = first_image(patches.corner[n, 1], periodic_y, bands.rows), patches.height[n]
        while True:  # once, or again for what lies beyond a periodic side
            first, last = bands_about(low, height, bands)
            start[first] += 1
            start[last] -= 1
            low -= bands.rows
            if not periodic_y or low + height + ROOM <= 0:
                break
    here = 0
    total = 0
    for b in range(count + 1):
        here += start[b]
        start[b] = total
        total += here
    if is_few(patches):
        list_part(patches, periodic_y, bands, np.int64(0), count)
    else:
        for piece in prange(LISTING):
            list_part(patches, periodic_y, bands, piece * count // LISTING, (piece + 1) * count // LISTING)
    for b in range(count, 0, -1):
        start[b] = start[b - 1]
    start[0] = 0
    for n in range(bands.listed.shape[0]):
        bands.listed[n] = patches.corner[n, 1]


@inline
def list_part(patches, periodic_y, bands, begin, end):
    """List bands ``begin`` to ``end`` - 1 of the lattice; moves bands.start of each to where its entries end."""
    for n in range(patches.height.shape[0]):
        corner, height = patches.corner[n, 1], patches.height[n]
        low = first_image(corner, periodic_y, bands.rows)
        while True:  # once, or again for what lies beyond a periodic side
            first, last = bands_about(low, height, bands)
            for b in range(max(first, begin), min(last, end)):
                at = bands.start[b]
                bands.body[at] = n
                bands.image[at] = low - corner
                bands.start[b] = at + 1
            low -= bands.rows
            if not periodic_y or low + height + ROOM <= 0:
                break


@inline
def lines_inside(k, band, bands, patches):
    """Rows of the patch of entry ``k`` that lie in ``band``: first, one past the last."""
    low, bottom = row_of(k, bands, patches), band * bands.height
    top = min(bottom + bands.height, bands.rows)
    return max(bottom - low, 0), min(top - low, patches.height[bands.body[k]])


@inline
def blocks_inside(base, stride, nx):
    """The whole blocks of a patch row that reach into the box, when its cell 0 lies in column ``base``: first, last.

    The first and the last one may stick out by less than a block.
    """
    return max(0, -base // BLOCK * BLOCK), min(stride, (nx - base + BLOCK - 1) // BLOCK * BLOCK)


@inline
def motion_of_body(n, patches, motion):
    """How body ``n`` moves, in double precision: what ``motion_of_row`` makes rows of.

    Along x and y: the cell at the lower left of its patch, the centre, velocity and its correction;  spin and twist
    (the spin's correction).
    """
    corner, centre, velocity, shift = patches.corner, motion.centre, motion.velocity, motion.shift
    return (
        (corner[n, 0], corner[n, 1]),
        (centre[n, 0], centre[n, 1]),
        (velocity[n, 0], velocity[n, 1]),
        (shift[n, 0], shift[n, 1]),
        motion.spin[n],
        shift[n, 2],
    )


@inline
def motion_of_row(j, body):
    """How the cells of row ``j`` of a patch move: what ``motion_of_block`` makes blocks of;  body: ``motion_of_body``.

    (x, y) from the centre to its first cell, spin and twist, vx and cx, the part that all its cells have and the
    correction of full ones, and vy, cy of its first cell.
    """
    corner, centre, velocity, shift, spin, twist = body
    ry = corner[1] + j + 0.5 - centre[1]
    rx = corner[0] + 0.5 - centre[0]
    return (
        rx,
        ry,
        spin,
        twist,
        velocity[0] - spin * ry,
        shift[0] - twist * ry,
        velocity[1] + spin * rx,
        shift[1] + twist * rx,
    )


@inline
def motion_of_block(b, row, fraction):
    """How the block that begins with cell ``b`` of a row moves, in the precision of ``fraction``;  row:
    ``motion_of_row``.

    (x, y) from the centre to its first cell, spin and twist, vx and cx, vy and cy of its first cell.
    """
    real = fraction.dtype.type
    rx, ry, spin, twist, vx, cx, vy, cy = row
    return (
        real(rx + b),
        real(ry),
        real(spin),
        real(twist),
        real(vx),
        real(cx),
        real(vy + spin * b),
        real(cy + twist * b),
    )


@inline
def solid_velocity(e, i, block):
    """Velocity of a body in cell ``i`` of a block of which it covers e;  block: ``motion_of_block``."""
    _, _, spin, twist, vx, cx, vy, cy = block
    return fma(e, cx, vx), fma(e, fma(twist, i, cy), fma(spin, i, vy))


@inline
def views_of(scratch, mine):
    """Four views (n,) of what thread ``mine`` has of scratch (threads, 3 or 4, n), the last one twice of three.

    They own nothing: to count references takes as long as a row of a few cells, longer where threads share the count.
    """
    n, last = scratch.shape[2], scratch.shape[1] - 1
    return (
        unchecked_view(scratch[mine, 0], 0, n),
        unchecked_view(scratch[mine, 1], 0, n),
        unchecked_view(scratch[mine, 2], 0, n),
        unchecked_view(scratch[mine, last], 0, n),
    )


@inline
def rasterize_band(band, bands, patches, motion, periodic_x, sums, extent, soft):
    """Add up the solid fractions of the rows of a band, and fractions times solid velocity at the cells' centres.

    The velocity in a cell that a body covers by e is its own and e times the half-step correction.

    motion: ``Motion``.  Adds to sums, four views (height of a band times (BLOCK + nx + BLOCK),), row by row, of which
    the fourth, where rims are ``soft``, gets fractions times theta, and is not touched elsewhere;  overwrites extent (2
    height,): the first column of each row that may be covered and one past the last.  All loops in one function, see
    ``views_of``: references to arrays that a loop passes on to another one are counted.
    """
    s, sx, sy, st = sums
    wide = s.shape[0] // bands.height
    nx = wide - 2 * BLOCK
    fraction = patches.fraction
    for i in range(bands.height):
        extent[2 * i] = nx
        extent[2 * i + 1] = 0
    for k in range(bands.start[band], bands.start[band + 1]):
        if k + AHEAD < bands.start[band + 1]:
            m = bands.body[k + AHEAD]
            j = max(band * bands.height - row_of(k + AHEAD, bands, patches), 0)
            soon = patches.start[m] + j * patches.stride[m]
            for b in range(0, 3 * LINE, LINE):  # those of a small body; what follows in memory comes by itself
                prefetch(fraction, soon + b)
        n = bands.body[k]
        base, stride = patches.corner[n, 0], patches.stride[n]
        body = motion_of_body(n, patches, motion)
        above = row_of(k, bands, patches) - band * bands.height
        if periodic_x:
            base %= nx
        begin, end = lines_inside(k, band, bands, patches)
        theta = s.dtype.type(motion.theta[n])
        while base + stride > 0:  # once, or again for what lies beyond a periodic side
            first, last = blocks_inside(base, stride, nx)
            at = patches.start[n] + begin * stride
            x0 = (above + begin) * wide + BLOCK + base
            for j in range(begin, end):
                row = motion_of_row(j, body)
                for b in range(first, last, BLOCK):
                    block = motion_of_block(b, row, s)
                    e, i, x = load_eight(fraction, at + b), ramp_eight(s), x0 + b
                    vx, vy = solid_velocity(e, i, block)
                    store_eight(s, x, load_eight(s, x) + e)
                    store_eight(sx, x, load_eight(sx, x) + e * vx)
                    store_eight(sy, x, load_eight(sy, x) + e * vy)
                    if soft:
                        store_eight(st, x, load_eight(st, x) + e * theta)
                at += stride
                x0 += wide
            if first < last:
                for i in range(above + begin, above + end):
                    extent[2 * i] = min(extent[2 * i], max(base + first, 0))
                    extent[2 * i + 1] = max(extent[2 * i + 1], min(base + last, nx))
            if not periodic_x:
                break
            base -= nx


@parallel_kernel
def rasterize(bands, patches, motion, periodic_x, scratch, extent, out):
    """All bands at once, for output: overwrites out (3, ny, nx) with the sums of ``rasterize_band``.

    scratch (threads, 3 or 4, height times (BLOCK + nx + BLOCK)): zero before and after;  extent (threads, 2 height):
    scratch.
    """
    nx = out.shape[2]
    wide = nx + 2 * BLOCK
    for number in prange(bands.start.shape[0] - 1):
        band, mine = np.int64(number), thread()
        reach = unchecked_view(extent[mine], 0, extent.shape[1])
        rasterize_band(band, bands, patches, motion, periodic_x, views_of(scratch, mine), reach, scratch.shape[1] > 3)
        first = band * bands.height
        for i in range(min(bands.height, bands.rows - first)):
            for k in range(3):  # element by element: assigned as slices it takes ten times as long to compile
                for x in range(nx):
                    out[k, first + i, x] = scratch[mine, k, i * wide + BLOCK + x]
            for k in range(scratch.shape[1]):
                for x in range(wide):
                    scratch[mine, k, i * wide + x] = 0
