"""Which bodies lie in which tile of the lattice, in index order, so that a cell adds them up as the CPU's rows do.

Listed on the CPU: a counting sort of some ten thousand bodies takes a small part of the contact steps beside it, and
needs no atomic operation.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from porescale.common.compiled.jit import inline, kernel

TILE_WIDTH, TILE_HEIGHT = 32, 8
"""Cells of a tile: those of a block of threads, whose warps take rows of it; not tuned."""


class TileLists(NamedTuple):
    """Lists of tiles, of integers of 32 bits.

    start (tiles + 1,): the bodies of tile t are entries start[t] to start[t + 1] - 1 of ``body``;  order (tiles,):
    those with bodies first, each by rising number.
    """

    start: NDArray[np.int32]
    order: NDArray[np.int32]
    body: NDArray[np.int32]


def tiles_of(nx: int, ny: int) -> tuple[int, int]:
    """Tiles along x and along y of a box of nx by ny cells."""
    return -(-nx // TILE_WIDTH), -(-ny // TILE_HEIGHT)


def most_entries(height: NDArray[np.int64], stride: NDArray[np.int64], nx: int, ny: int) -> int:
    """No fewer entries than lists of bodies with patches of these cells can have, wherever they are."""
    wide, high = tiles_of(nx, ny)
    along = np.minimum(stride // TILE_WIDTH + 3, wide)
    return int((along * np.minimum(height // TILE_HEIGHT + 3, high)).sum())


@inline
def reach(low, count, whole, joined, side):
    """Tiles along an axis that a patch of ``count`` cells from ``low`` on reaches: first, one past the last, and the
    same for what lies beyond a periodic side.

    whole: cells of the box;  side: of a tile.
    """
    if joined:
        low %= whole
    first, last = max(low, 0), min(low + count, whole)
    again = min(low + count - whole, whole) if joined else 0
    return (
        first // side,
        (last + side - 1) // side if last > first else first // side,
        (again + side - 1) // side if again > 0 else 0,
    )


@kernel
def list_tiles(patches, box, start, order, body, seen):
    """List the bodies of every tile: overwrites start, order, body (``TileLists``) and seen (tiles,).

    box: (nx, ny, whether x is periodic, whether y is).  Returns the number of tiles that hold bodies.
    """
    nx, ny, joined_x, joined_y = box
    wide = (nx + TILE_WIDTH - 1) // TILE_WIDTH
    count = seen.shape[0]
    start[:] = 0
    for turn in range(2):  # counted, then listed
        seen[:] = -1
        for n in range(patches.height.shape[0]):
            left, right, beyond = reach(patches.corner[n, 0], patches.stride[n], nx, joined_x, TILE_WIDTH)
            low, high, above = reach(patches.corner[n, 1], patches.height[n], ny, joined_y, TILE_HEIGHT)
            for v in range(high - low + above):
                row = low + v if v < high - low else v - (high - low)
                for u in range(right - left + beyond):
                    t = row * wide + (left + u if u < right - left else u - (right - left))
                    if seen[t] != n:  # a body that goes round the box may reach a tile twice
                        seen[t] = n
                        if turn == 0:
                            start[t] += 1
                        else:
                            body[start[t]] = n
                            start[t] += 1
        if turn == 0:
            total = 0
            for t in range(count):
                here = start[t]
                start[t] = total
                total += here
    for t in range(count, 0, -1):
        start[t] = start[t - 1]
    start[0] = 0
    covered = 0
    for t in range(count):
        if start[t] < start[t + 1]:
            order[covered] = t
            covered += 1
    rest = covered
    for t in range(count):
        if start[t] == start[t + 1]:
            order[rest] = t
            rest += 1
    return covered
