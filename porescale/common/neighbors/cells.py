"""Cells: which points lie near each other, by a counting sort into regular grids of cells, one for each level of size.

Stable (points keep their index order inside a cell), linear in points plus cells, no allocation.
Points outside the grid belong to the nearest border cell (or to their periodic image's cell), so a search
over a window of cells stays complete wherever points are.
"""

from typing import NamedTuple

import numpy as np

from porescale.common.compiled.jit import inline, kernel


class Grid(NamedTuple):
    """A regular grid of cells: lower corner, m; cells per metre; number of columns and rows; periods, m, 0 where a side
    is not periodic; and how far right (m) the image one period higher lies (see `tilted_image`)."""

    lower_x: float
    lower_y: float
    inverse_x: float
    inverse_y: float
    columns: int
    rows: int
    period_x: float = 0.0
    period_y: float = 0.0
    tilt: float = 0.0


REACH, FIRST, COLUMNS = 9, 10, 11
"""Columns of a table of levels behind the nine numbers of its grids, and how many there are."""


@inline
def minimum_image(dx, period):
    """Distance component between nearest periodic images, m; ``period`` 0: side is not periodic.

    ``dx - period * nearest integer(dx / period)``: in [-period/2, period/2] for any ``dx``.  The reciprocal does
    not depend on ``dx``: it leaves the loop that this is used in, where a division would cost most of a pair.
    """
    if period > 0.0:
        dx -= period * np.rint(dx * (1.0 / period))
    return dx


@inline
def tilted_image(dx, dy, period_x, period_y, tilt):
    """Components between nearest images, m, where the image one ``period_y`` higher lies ``tilt`` (m) to the right.

    Exact for pairs nearer than half of either period, whatever the tilt; tilt 0: ``minimum_image`` of both, to the bit.
    Source: Lees & Edwards, J. Phys. C 5 (1972) 1921.
    """
    if tilt != 0.0:
        dx -= tilt * np.rint(dy * (1.0 / period_y))
    return minimum_image(dx, period_x), minimum_image(dy, period_y)


@inline
def wrapped(x, lower, period):
    """Coordinate (m) of the image of ``x`` in [lower, lower + period]; ``period`` 0: ``x`` itself.

    Of an ``x`` so far that rounding leaves its image outside, as when a run blows up: the lower end, for what is looked
    up by this must lie in the box.
    """
    if period > 0.0:
        x -= period * np.floor((x - lower) / period)
        if not lower <= x <= lower + period:
            x = lower
    return x


@inline
def untilted(x, y, lower_y, period_y, tilt):
    """First coordinate (m) of the image of (x, y) that lies in the box along y: ``tilt`` further left per period."""
    if tilt != 0.0:
        x -= tilt * np.floor((y - lower_y) / period_y)
    return x


@inline
def cell_of(x, lower, inverse_size, number):
    """Index 0 … number-1 of the cell that holds coordinate ``x``, clamped to the grid.

    Monotone in ``x``, also where it clamps: points between two others lie in cells between theirs.
    """
    place = np.floor((x - lower) * inverse_size)
    if place < 0.0:  # clamped as float: a far point must not overflow the integer
        return 0
    if place > number - 1.0:
        return number - 1
    return int(place)


def grid_shape(lower: tuple[float, float], upper: tuple[float, float], size: float, limit: int) -> tuple[int, int]:
    """Columns and rows of cells at least ``size`` (m) wide that fill the box, at most about ``limit`` in all.

    A box far larger than its points need would otherwise cost more in empty cells than in points.
    """
    width, height = upper[0] - lower[0], upper[1] - lower[1]
    size = max(size, (width * height / limit) ** 0.5, width / limit, height / limit)
    if not size > 0.0:
        return 1, 1
    return max(1, int(width / size)), max(1, int(height / size))


@inline
def cell_at(x, y, grid):
    """Number of the cell of ``grid`` that holds the image of (x, y), m, in the box."""
    across = untilted(x, y, grid.lower_y, grid.period_y, grid.tilt)
    column = cell_of(wrapped(across, grid.lower_x, grid.period_x), grid.lower_x, grid.inverse_x, grid.columns)
    row = cell_of(wrapped(y, grid.lower_y, grid.period_y), grid.lower_y, grid.inverse_y, grid.rows)
    return row * grid.columns + column


@inline
def grid_of(levels, k):
    """The grid of row ``k`` of ``levels`` (l, COLUMNS), see `sort_into_cells`."""
    return Grid(
        levels[k, 0], levels[k, 1], levels[k, 2], levels[k, 3], int(levels[k, 4]), int(levels[k, 5]), levels[k, 6],
        levels[k, 7], levels[k, 8],
    )  # fmt: skip


@kernel
def largest_below(reach, bound):
    """(largest, number) of those of ``reach`` (n,) that are at most ``bound``; (-1, 0) where none is."""
    largest, number = -1.0, 0
    for i in range(reach.shape[0]):
        if reach[i] <= bound:
            largest = max(largest, reach[i])
            number += 1
    return largest, number


@kernel
def sort_into_cells(x, reach, levels, cell, start, order):
    """Counting sort of points ``x`` (n, 2) m into the cells of their level, level after level, row after row.

    reach (n,) m;  levels (l, COLUMNS): of each level the numbers of its Grid, the largest reach of its points, m, and
    its first cell; the largest first.  Overwrites ``cell`` (n,) cell of each point, ``start`` (cells + 1,) first slot
    of each cell and ``order`` (n,) points by cell, ascending inside a cell.  Not checked: positions must be finite.
    """
    n = x.shape[0]
    start[:] = 0
    grid, first, k = grid_of(levels, 0), 0, 0
    for i in range(n):
        if levels.shape[0] > 1:
            k = 0
            while k + 1 < levels.shape[0] and reach[i] <= levels[k + 1, REACH]:
                k += 1
            grid, first = grid_of(levels, k), int(levels[k, FIRST])
        cell[i] = first + cell_at(x[i, 0], x[i, 1], grid)
        start[cell[i] + 1] += 1
    for c in range(start.shape[0] - 1):
        start[c + 1] += start[c]
    for i in range(n):  # start[c] now walks to the first slot of cell c + 1 …
        order[start[cell[i]]] = i
        start[cell[i]] += 1
    for c in range(start.shape[0] - 1, 0, -1):  # … and is shifted back
        start[c] = start[c - 1]
    start[0] = 0
