"""Members of a clump that overlap: cells on the rims of both hold their union, not their sum.

A cell that one of them fills counts as full whatever the other has of it.  Where both have a part, what they have in
common is taken off, half of each: the mean over sub-rows of a cell of the exact length that lies in both.
"""

import numpy as np
from numpy.typing import NDArray

from porescale.common.compiled.jit import inline, kernel
from porescale.dem.bodies.rigid import clumps_of
from porescale.dem.grains import Grains

SUB_ROWS = 16
"""Sub-rows of a cell: an area is within 1/16 of a rim's slope of exact where an outline ends between two of them."""


def overlapping(grains: Grains, radius: NDArray[np.float64]) -> NDArray[np.int64]:
    """Pairs (p, 2) of discs of one clump that overlap with ``radius`` (n,) m, by rising second disc."""
    clumps, found = clumps_of(grains), []
    for c in range(clumps.count if clumps else 0):
        assert clumps
        own, at = clumps.discs_of(c), clumps.offset[clumps.start[c] : clumps.start[c + 1]]
        for m in range(len(own)):
            apart = np.hypot(*(at[:m] - at[m]).T)
            found += [(own[n], own[m]) for n in np.flatnonzero(apart < radius[own[:m]] + radius[own[m]])]
    return np.array(found, np.int64).reshape(-1, 2)


@inline
def common(x, y, x1, y1, r1, x2, y2, r2):
    """Area of the cell with its lower left corner at (x, y) that lies in both discs; centres and radii in cells."""
    total = 0.0
    for k in range(SUB_ROWS):
        height = y + (k + 0.5) / SUB_ROWS
        one = r1 * r1 - (height - y1) * (height - y1)
        other = r2 * r2 - (height - y2) * (height - y2)
        if one > 0.0 and other > 0.0:
            one, other = np.sqrt(one), np.sqrt(other)
            left = max(x, max(x1 - one, x2 - other))
            total += max(0.0, min(x + 1.0, min(x1 + one, x2 + other)) - left)
    return total / SUB_ROWS


@inline
def subtract_in_row(y, n, m, centre, radius, patches):
    """``subtract_overlap`` of discs n and m in row ``y``, where both have one."""
    corner, height, stride, start = patches.corner, patches.height, patches.stride, patches.start
    fraction = patches.fraction
    if not (0 <= y - corner[n, 1] < height[n] and 0 <= y - corner[m, 1] < height[m]):
        return
    left = max(corner[n, 0], corner[m, 0])
    right = min(corner[n, 0] + stride[n], corner[m, 0] + stride[m])
    one = start[n] + (y - corner[n, 1]) * stride[n] - corner[n, 0]
    other = start[m] + (y - corner[m, 1]) * stride[m] - corner[m, 0]
    for x in range(left, right):
        if 0.0 < fraction[one + x] < 1.0 and 0.0 < fraction[other + x] < 1.0:
            both = common(
                float(x), float(y), centre[n, 0], centre[n, 1], radius[n], centre[m, 0], centre[m, 1], radius[m]
            )
            fraction[one + x] = max(0.0, np.float64(fraction[one + x]) - 0.5 * both)
            fraction[other + x] = max(0.0, np.float64(fraction[other + x]) - 0.5 * both)


@kernel
def subtract_overlap(centre, radius, pairs, patches):
    """Take what two discs of a pair have in common off them, in cells that neither fills.

    centre (n, 2), radius (n,) cells;  pairs (p, 2).  Overwrites ``patches.fraction``, which ``cover`` has filled.
    """
    corner, height = patches.corner, patches.height
    for p in range(pairs.shape[0]):
        n, m = pairs[p, 0], pairs[p, 1]
        for y in range(max(corner[n, 1], corner[m, 1]), min(corner[n, 1] + height[n], corner[m, 1] + height[m])):
            subtract_in_row(y, n, m, centre, radius, patches)
