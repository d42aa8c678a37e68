"""Whether a pair list must be rebuilt: from the displacement of points, or from that relative to their neighbours.

A list made with a skin holds as long as no two points have come nearer to each other by more than the skin.  None have
where no point was displaced by half the skin.  That is quick to compute, and too strict where many points move
together, as in a jet: displacements of neighbouring points are then alike, however large.  So the box is cut into
blocks, and the displacements of all points of a block are bounded by a rectangle: two points came nearer by at most the
diagonal of the rectangle that bounds both blocks.  Blocks that do not touch are a whole block apart, so the rectangle
of all may be larger.  The remaining skin is computed again only when some point has moved half of it further.
"""

import numpy as np

from porescale.common.compiled.jit import inline, kernel
from porescale.common.neighbors.cells import cell_at, minimum_image

LEFT, RIGHT, DOWN, UP, GROWTH = range(5)
"""Columns of bounds, m: least and largest component of the ways of a block's points, largest growth of their reach."""
BOUNDS = 5
BESIDE = np.array([[0, 0], [1, 0], [-1, 1], [0, 1], [1, 1]])
"""Columns and rows from a block to those that it is compared with; the others are compared with it."""


@kernel
def needs_rebuild(x, list_position, reach, list_reach, half_skin, period_x, period_y):
    """True if some point left its ``list_position`` (n, 2) m by more than ``half_skin`` less the growth of its reach.

    Positions that are no numbers count as strayed.  No early exit, so that the loop vectorises.
    """
    far = 0
    for i in range(x.shape[0]):
        dx = minimum_image(x[i, 0] - list_position[i, 0], period_x)
        dy = minimum_image(x[i, 1] - list_position[i, 1], period_y)
        margin = half_skin - max(0.0, reach[i] - list_reach[i])
        # not <= instead of >: true for nan
        far += (not (dx * dx + dy * dy <= margin * margin)) | (not (margin >= 0.0))
    return far > 0


@kernel
def sort_into_blocks(position, grid, block):
    """Overwrites ``block`` (n,): the cell of ``grid`` that each ``position`` (n, 2) m lies in or nearest to."""
    for i in range(position.shape[0]):
        block[i] = cell_at(position[i, 0], position[i, 1], grid)


@inline
def approach(bounds, a, b):
    """By how much (m) a point of block a and one of block b may have come nearer, growth of both reaches included."""
    across = max(bounds[a, RIGHT], bounds[b, RIGHT]) - min(bounds[a, LEFT], bounds[b, LEFT])
    along = max(bounds[a, UP], bounds[b, UP]) - min(bounds[a, DOWN], bounds[b, DOWN])
    return np.sqrt(across * across + along * along) + bounds[a, GROWTH] + bounds[b, GROWTH]


@kernel
def remaining_skin(x, list_position, reach, list_reach, block, bounds, columns, rows, skin, gap, period_x, period_y):
    """Way (m) by which any two points may still come nearer: those of blocks that touch may by ``skin`` (m), all others
    by ``gap`` (m), since the list was made.  Below 0 where some may have already.

    x, list_position (n, 2) m, reach, list_reach (n,) m: now and when the list was made;  block: see `sort_into_blocks`;
    bounds (columns rows + 1, 5): overwritten, the last row by that of all.  Positions that are no numbers give -inf.
    """
    whole = columns * rows
    for b in range(whole + 1):
        bounds[b, LEFT] = np.inf
        bounds[b, DOWN] = np.inf
        bounds[b, RIGHT] = -np.inf
        bounds[b, UP] = -np.inf
        bounds[b, GROWTH] = 0.0
    nowhere = 0
    for i in range(x.shape[0]):
        dx = minimum_image(x[i, 0] - list_position[i, 0], period_x)
        dy = minimum_image(x[i, 1] - list_position[i, 1], period_y)
        growth = reach[i] - list_reach[i]
        nowhere += not (dx * dx + dy * dy + growth * growth < np.inf)
        b = block[i]
        if dx < bounds[b, LEFT]:
            bounds[b, LEFT] = dx
        if dx > bounds[b, RIGHT]:
            bounds[b, RIGHT] = dx
        if dy < bounds[b, DOWN]:
            bounds[b, DOWN] = dy
        if dy > bounds[b, UP]:
            bounds[b, UP] = dy
        if growth > bounds[b, GROWTH]:
            bounds[b, GROWTH] = growth
    if nowhere > 0:
        return -np.inf
    most = 0.0
    for row in range(rows):
        for column in range(columns):
            a = row * columns + column
            if bounds[a, LEFT] > bounds[a, RIGHT]:  # no point in this cell
                continue
            for side in range(BESIDE.shape[0]):
                c = column + BESIDE[side, 0]
                r = row + BESIDE[side, 1]
                if period_x > 0.0:
                    c %= columns
                if period_y > 0.0:
                    r %= rows
                if 0 <= c < columns and r < rows:
                    most = max(most, approach(bounds, a, r * columns + c))
            bounds[whole, LEFT] = min(bounds[whole, LEFT], bounds[a, LEFT])
            bounds[whole, DOWN] = min(bounds[whole, DOWN], bounds[a, DOWN])
            bounds[whole, RIGHT] = max(bounds[whole, RIGHT], bounds[a, RIGHT])
            bounds[whole, UP] = max(bounds[whole, UP], bounds[a, UP])
            bounds[whole, GROWTH] = max(bounds[whole, GROWTH], bounds[a, GROWTH])
    if x.shape[0] == 0:
        return skin
    return min(skin - most, gap - approach(bounds, whole, whole))
