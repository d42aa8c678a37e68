"""Kernels of the pair list: search through windows of cells, rows in ascending order, data carried over."""

from typing import NamedTuple

import numpy as np

from porescale.common.compiled.jit import inline, kernel, parallel_kernel, prange, thread, unchecked_view
from porescale.common.compiled.simd import WORDS, store_sorted
from porescale.common.neighbors.cells import FIRST, REACH, cell_of, grid_of, tilted_image, untilted, wrapped


class Criterion(NamedTuple):
    """Which pairs are listed: skin, m, and whether every pair is listed from both ends."""

    skin: float
    full: bool


@kernel
def first_unusable(x, reach):
    """First i whose ``x`` (n, 2) is not finite, or whose ``reach`` (n,) is not finite or negative; else -1."""
    for i in range(x.shape[0]):
        if not (np.isfinite(x[i, 0]) and np.isfinite(x[i, 1]) and np.isfinite(reach[i]) and reach[i] >= 0.0):
            return i
    return -1


@kernel
def gather_sorted(x, reach, order, out):
    """x, y and reach of the points in cell order, for reading in sequence: overwrites ``out`` (3, n)."""
    for k in range(order.shape[0]):
        i = order[k]
        out[0, k] = x[i, 0]
        out[1, k] = x[i, 1]
        out[2, k] = reach[i]


@inline
def window(at, range_, lower, inverse_size, number, period):
    """First cell and number of cells along one axis that hold everything within ``range_`` of ``at``.

    On a periodic side the first may be negative: cells then continue round the end, each named once.
    """
    # Padding against rounding: cell indices of points exactly at the range's end, far from the origin too.
    range_ += 1e-9 * range_ + 1e-15 * abs(at)
    if period > 0.0:
        first = int(np.floor((at - range_ - lower) * inverse_size))
        last = int(np.floor((at + range_ - lower) * inverse_size))
        return first, min(last - first + 1, number)
    first = cell_of(at - range_, lower, inverse_size, number)
    return first, cell_of(at + range_, lower, inverse_size, number) - first + 1


@inline
def count_stretch(i, k0, k1, xi, yi, reach_i, ordered, order, grid, criterion):
    """Number of partners of point i among slots k0 … k1-1 of the cell order.  Without writing, so it vectorises."""
    found = 0
    skin, full = criterion.skin, criterion.full
    if grid.period_x > 0.0 or grid.period_y > 0.0:
        for k in range(np.uint64(k0), np.uint64(k1)):  # unsigned: no wraparound of negative indices
            dx, dy = tilted_image(xi - ordered[0, k], yi - ordered[1, k], grid.period_x, grid.period_y, grid.tilt)
            reached = reach_i + ordered[2, k] + skin
            j = order[k]
            found += (dx * dx + dy * dy < reached * reached) & ((j > i) | (full & (j != i)))
        return found
    for k in range(np.uint64(k0), np.uint64(k1)):
        dx = xi - ordered[0, k]
        dy = yi - ordered[1, k]
        reached = reach_i + ordered[2, k] + skin
        j = order[k]
        found += (dx * dx + dy * dy < reached * reached) & ((j > i) | (full & (j != i)))
    return found


@inline
def note_stretch(i, k0, k1, xi, yi, reach_i, ordered, order, grid, criterion, row, slot):
    """As count_stretch, writing partners to ``row[slot]`` and on, which must have room for all of k0 … k1.

    Every candidate is written and only a partner moves on to the next slot: half the candidates are partners,
    and a branch on that would be guessed wrong every other time.
    """
    at = np.uint64(slot)
    skin, full = criterion.skin, criterion.full
    if grid.period_x > 0.0 or grid.period_y > 0.0:
        for k in range(np.uint64(k0), np.uint64(k1)):
            dx, dy = tilted_image(xi - ordered[0, k], yi - ordered[1, k], grid.period_x, grid.period_y, grid.tilt)
            reached = reach_i + ordered[2, k] + skin
            j = order[k]
            row[at] = j
            at += np.uint64((dx * dx + dy * dy < reached * reached) & ((j > i) | (full & (j != i))))
        return np.int64(at) - slot
    for k in range(np.uint64(k0), np.uint64(k1)):
        dx = xi - ordered[0, k]
        dy = yi - ordered[1, k]
        reached = reach_i + ordered[2, k] + skin
        j = order[k]
        row[at] = j
        at += np.uint64((dx * dx + dy * dy < reached * reached) & ((j > i) | (full & (j != i))))
    return np.int64(at) - slot


@inline
def search_row(write, i, x, reach, ordered, order, cell_start, levels, criterion, row):
    """Number of partners of point i, and how long ``row`` must be to note them (WORDS entries spare).

    If ``write``, they are noted in ``row``, cell by cell; where that is too short the number is right but partners are
    missing.  x (m, 2) m, reach (m,) m: of the points whose rows are searched;  ordered (3, n) m, order (n,): x, y,
    reach and number of all candidates in cell order;  cell_start, levels: see `sort_into_cells`.  A pair counts when
    its squared distance is below (reach_i + reach_j + skin)².  Each level is looked through as far as its own largest
    reach asks, so that a small point has few candidates (Ogarko & Luding, Comput. Phys. Commun. 183 (2012) 931).

    Numbers come in tuples, arrays do not: an array taken out of a tuple is counted as a reference, here for every
    point, which cost 7 to 15 % of a search.
    """
    xi = x[i, 0]
    yi = x[i, 1]
    reach_i = reach[i]
    found = np.int64(0)  # not 0 alone, for which note_stretch is compiled once more
    needed = 0
    for level in range(levels.shape[0]):
        found, needed = search_level(
            write, i, (xi, yi, reach_i), ordered, order, cell_start, levels, level, criterion, row, (found, needed)
        )
    return found, needed


@inline
def search_level(write, i, point, ordered, order, cell_start, levels, level, criterion, row, so_far):
    """What `search_row` finds in one ``level``.  point : x, y, reach of i, m;  so_far : (found, needed) before it."""
    xi, yi, reach_i = point
    found, needed = so_far
    grid, first_cell = grid_of(levels, level), int(levels[level, FIRST])
    columns, rows, tilt = grid.columns, grid.rows, grid.tilt
    range_ = reach_i + levels[level, REACH] + criterion.skin
    at_x = untilted(xi, yi, grid.lower_y, grid.period_y, tilt)
    inside_x = wrapped(at_x, grid.lower_x, grid.period_x)
    inside_y = wrapped(yi, grid.lower_y, grid.period_y)
    first_column, width = window(inside_x, range_, grid.lower_x, grid.inverse_x, columns, grid.period_x)
    first_row, height = window(inside_y, range_, grid.lower_y, grid.inverse_y, rows, grid.period_y)
    if first_column < 0:
        first_column += columns
    elif first_column >= columns:
        first_column -= columns
    # Cells of one row follow each other in the sorted order, so a row of the window is one stretch, or two
    # where it runs over a periodic end.
    inside = min(width, columns - first_column)
    if tilt != 0.0 and height == rows:  # a row may hold both images of a point: all of it
        first_column, width = 0, columns
        inside = width
    for step in range(height):
        place = first_row + step
        if place < 0:
            place += rows
        elif place >= rows:
            place -= rows
        base = first_cell + place * columns
        if tilt != 0.0 and height < rows:  # a row beyond the end is that of an image, seen from ``tilt`` aside
            turns = np.floor((first_row + step) / rows)
            seen_x = wrapped(at_x - turns * tilt, grid.lower_x, grid.period_x)
            first_column, width = window(seen_x, range_, grid.lower_x, grid.inverse_x, columns, grid.period_x)
            first_column %= columns
            inside = min(width, columns - first_column)
        for piece in range(1 + (width > inside)):
            k0 = cell_start[base + first_column] if piece == 0 else cell_start[base]
            k1 = cell_start[base + first_column + inside] if piece == 0 else cell_start[base + width - inside]
            needed = max(needed, found + k1 - k0 + WORDS)
            if write and found + k1 - k0 + WORDS <= row.shape[0]:
                found += note_stretch(i, k0, k1, xi, yi, reach_i, ordered, order, grid, criterion, row, found)
            else:
                found += count_stretch(i, k0, k1, xi, yi, reach_i, ordered, order, grid, criterion)
    return found, needed


@kernel
def fill_serial(start, partner, row, x, reach, ordered, order, cell_start, levels, criterion):
    """All rows in one thread: overwrites ``start`` (n + 1,), ``partner`` and the scratch ``row``; returns the number of
    pairs and how long ``row`` must be.

    If one exceeds its array's length rows are missing: give more room and call again.
    """
    start[0] = 0
    longest = 0
    for i in range(x.shape[0]):
        begin = start[i]
        found, needed = search_row(True, i, x, reach, ordered, order, cell_start, levels, criterion, row)
        longest = max(longest, needed)
        if needed <= row.shape[0] and begin + found <= partner.shape[0]:
            store_sorted(row, found, partner, begin)
        start[i + 1] = begin + found
    return start[x.shape[0]], longest


@parallel_kernel
def count_parallel(start, row, x, reach, ordered, order, cell_start, levels, criterion):
    """Row lengths over threads, summed in order: overwrites ``start`` (n + 1,); returns what `fill_serial` does."""
    n = x.shape[0]
    longest = 0
    for number in prange(n):
        i = np.int64(number)
        found, needed = search_row(False, i, x, reach, ordered, order, cell_start, levels, criterion, row)
        longest = max(longest, needed)
        start[i + 1] = found
    start[0] = 0
    for k in range(n):
        start[k + 1] += start[k]
    return start[n], longest


@parallel_kernel
def fill_parallel(start, partner, scratch, length, x, reach, ordered, order, cell_start, levels, criterion):
    """Rows over threads into the places that ``start`` (n + 1,) names: overwrites ``partner`` and ``scratch``, of which
    each thread has ``length`` entries, as many as `count_parallel` says."""
    for number in prange(x.shape[0]):
        i = np.int64(number)
        row = unchecked_view(scratch, thread() * length, length)
        found, _ = search_row(True, i, x, reach, ordered, order, cell_start, levels, criterion, row)
        store_sorted(row, found, partner, start[i])


@kernel
def mirror(first, start, partner):
    """Rows of the points from ``first`` on, from those of the points before, whose partners they are: overwrites the
    rest of ``start`` (n + 1,) and ``partner``, which has room for as much again; returns the number of pairs, twice
    what there was.  Points before come in order, so rows ascend.
    """
    count = start.shape[0] - 1
    half = start[first]
    for j in range(first + 1, count + 1):
        start[j] = 0
    for k in range(half):
        if partner[k] + 1 < count:  # number of partners of j, two on from its own place
            start[partner[k] + 2] += 1
    if first + 1 <= count:
        start[first + 1] = half
    for j in range(first + 2, count + 1):
        start[j] += start[j - 1]
    k = 0
    for i in range(first):  # start[j + 1] walks from the first entry of j's row to its end
        while k < start[i + 1]:
            slot = start[partner[k] + 1]
            partner[slot] = i
            start[partner[k] + 1] = slot + 1
            k += 1
    return 2 * half


@kernel
def leave_out(group, start, partner):
    """Take pairs of one ``group`` (n,) >= 0, and all of groups below -1, out of the rows: overwrites both; returns the
    number that are left.
    """
    kept, first = 0, start[0]
    for i in range(start.shape[0] - 1):
        last = start[i + 1]
        for k in range(first, last):
            j = partner[k]
            if min(group[i], group[j]) >= -1 and (group[i] < 0 or group[i] != group[j]):
                partner[kept] = j
                kept += 1
        first = last
        start[i + 1] = kept
    return kept


@kernel
def carry(old_start, old_partner, old_carried, start, partner, carried):
    """Data of pairs listed before and now: overwrites ``carried`` (m, k), 0 for new pairs.

    Both lists ascend within a row, so each row is one walk along both.
    """
    for i in range(start.shape[0] - 1):
        old = old_start[i]
        end = old_start[i + 1]
        for k in range(start[i], start[i + 1]):
            while old < end and old_partner[old] < partner[k]:
                old += 1
            known = old < end and old_partner[old] == partner[k]
            for c in range(
                carried.shape[1]
            ):  # rows assigned whole take three seconds to compile: their shapes are tested
                carried[k, c] = old_carried[old, c] if known else 0.0
