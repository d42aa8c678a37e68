"""Cells that two bodies share stay open where films are corrected: so much is solid in them at most.

The outlines of two discs in the lattice lie nearer to each other than the discs (lubrication.py).  At gaps of a tenth
of a cell they meet, and fill the cells between them.  What the discs displace then has no way out in some places, and
one in others, and the lattice bears several times too much there.  With ``MOST`` solid it bears the same at all places.
"""

from porescale.common.compiled.jit import inline, parallel_kernel, prange, thread, unchecked_view
from porescale.common.compiled.simd import choose, load_eight, store_eight
from porescale.coupling.coverage.rows import BLOCK, blocks_inside, is_few, lines_inside, row_of

MOST = 0.9
"""Solid fraction of a cell that two bodies share, at most.  Chosen by measurement: docs/theory/lubrication.md."""


@inline
def opened(e, s, most):
    """What a disc keeps of its fraction ``e`` of a cell of which all discs have ``s``: less where they are several and
    have more than ``most``.  Vectors or numbers of one precision; s > 0 of numbers."""
    return choose(s, e, choose(s, most, e * (most / s), e), e)


@inline
def of_several(cell, band, own, bands, patches, body, joined):
    """Whether a disc of another body than disc ``own`` has a part of a ``cell``, (column, row of the band), or disc
    ``own`` two, across a periodic side;  joined: columns of a box that is periodic along x, else 0."""
    x, y = cell
    parts = 0
    for k in range(bands.start[band], bands.start[band + 1]):
        n = bands.body[k]
        if n == own or (n < body.shape[0] and body[n] != body[own]):
            j = band * bands.height + y - row_of(k, bands, patches)
            i = (x - patches.corner[n, 0]) % joined if joined else x - patches.corner[n, 0]
            while 0 <= j < patches.height[n] and 0 <= i < patches.stride[n]:
                if patches.fraction[patches.start[n] + j * patches.stride[n] + i] > 0:
                    parts += 1
                    if n != own or parts > 1:
                        return True
                if not joined:
                    break
                i += joined
    return False


@inline
def open_band(band, bands, patches, body, clumps, periodic_x, s):
    """``keep_open`` of the rows of one band;  s (as ``keep_open``'s scratch): zero before and after."""
    fraction = patches.fraction
    wide = s.shape[0] // bands.height
    nx, most = wide - 2 * BLOCK, fraction.dtype.type(MOST)
    joined = nx if periodic_x else 0
    for turn in range(3):  # add up, share out, clear
        for k in range(bands.start[band], bands.start[band + 1]):
            n = bands.body[k]
            if n >= body.shape[0]:
                continue
            base, stride = patches.corner[n, 0], patches.stride[n]
            above = row_of(k, bands, patches) - band * bands.height
            if periodic_x:
                base %= nx
            begin, end = lines_inside(k, band, bands, patches)
            while base + stride > 0:  # once, or again for what lies beyond a periodic side
                first, last = blocks_inside(base, stride, nx)
                for j in range(begin, end):
                    at = patches.start[n] + j * stride
                    x0 = (above + j) * wide + BLOCK + base
                    if turn == 0:
                        for b in range(first, last, BLOCK):
                            store_eight(s, x0 + b, load_eight(s, x0 + b) + load_eight(fraction, at + b))
                    elif turn == 2:
                        for i in range(first, last):
                            s[x0 + i] = 0
                    else:
                        for b in range(first, last, BLOCK):
                            x = base + b
                            if not clumps and x >= 0 and x + BLOCK <= nx:
                                e, all_of_it = load_eight(fraction, at + b), load_eight(s, x0 + b)
                                store_eight(fraction, at + b, opened(e, all_of_it, most))
                                continue
                            for i in range(max(b, -base), min(b + BLOCK, nx - base)):
                                e, cell = fraction[at + i], (base + i, above + j)
                                shared = s[x0 + i] > e > 0 and s[x0 + i] > most
                                if shared and clumps:
                                    shared = of_several(cell, band, n, bands, patches, body, joined)
                                if shared:
                                    fraction[at + i] = opened(e, s[x0 + i], most)
                if not periodic_x:
                    break
                base -= nx


@parallel_kernel
def keep_open(bands, patches, body, periodic_x, scratch):
    """Leave 1 - ``MOST`` open of cells that discs of two bodies share, or a disc and its image across a periodic side,
    each keeping its part of what is solid.

    body (n,): of the first n patches, which are discs, the first disc of the rigid body that each is of.  Overwrites
    ``patches.fraction``, which is filled, and ``bands`` lists;  scratch (threads, 3 or 4, height times (BLOCK + nx +
    BLOCK)): zero before and after.
    """
    clumps = False
    for n in range(body.shape[0]):
        clumps = clumps or body[n] != n
    count = bands.start.shape[0] - 1
    if is_few(patches):
        for band in range(count):
            open_band(band, bands, patches, body, clumps, periodic_x, scratch[0, 0])
    else:
        for number in prange(count):
            s = unchecked_view(scratch[thread(), 0], 0, scratch.shape[2])
            open_band(number, bands, patches, body, clumps, periodic_x, s)
