"""Patches of discs filled on the device: one thread for a grid line, a cell, a row or a column of a patch.

Each calls the functions of coverage/ that the CPU compiles.  Areas are differences of large terms: double precision,
whatever that of the populations is.

Plain functions: ``device_kernel`` of common/compiled/cuda.py compiles them for laws and a precision.
"""

from typing import Any

from porescale.common.compiled.cuda import grid
from porescale.coupling.coverage.discs import across, full_or_empty, least_part, lines_at, strip_area
from porescale.coupling.coverage.overlap import subtract_in_row
from porescale.coupling.coverage.rows import BLOCK
from porescale.coupling.coverage.shared import MOST, opened
from porescale.coupling.coverage.soft_rim import filter_cell, filter_row
from porescale.coupling.device.layout import first_place, next_place
from porescale.coupling.device.tiles import TILE_HEIGHT, TILE_WIDTH
from porescale.coupling.push import covered_area_of, held_area_of


def place_patches(places: Any, corner: Any, height: Any, stride: Any) -> None:
    """Integers of the patches from numbers (n, 4) that the CPU sends: overwrites the others;  threads: n."""
    n = grid()
    if n < places.shape[0]:
        corner[n, 0], corner[n, 1] = int(places[n, 0]), int(places[n, 1])
        height[n], stride[n] = int(places[n, 2]), int(places[n, 3])


def mark_discs(centre: Any, radius: Any, patches: Any, owners: Any, lines: Any) -> None:
    """``mark_lines`` of discs.py: overwrites lines (2, 3, lines of all discs), along y and along x;  threads: lines.

    Patches of discs with soft rims begin two cells further to the left and below: what the filters spread.
    """
    k = grid()
    if k < lines.shape[2]:
        n = owners.line[k // BLOCK]
        i = k - owners.first_line[n]
        b = i // BLOCK * BLOCK
        spread = 2 if patches.theta[n] > 0.0 else 0
        left = patches.corner[n, 0] + spread - centre[n, 0] + b
        bottom = patches.corner[n, 1] + spread - centre[n, 1] + b
        upright, level = lines_at(left + (i - b), bottom + (i - b), radius[n])
        lines[0, 0, k], lines[0, 1, k], lines[0, 2, k] = upright
        lines[1, 0, k], lines[1, 1, k], lines[1, 2, k] = level


def cover_discs(radius: Any, patches: Any, owners: Any, lines: Any, cells: Any) -> None:
    """``cover_disc`` of discs.py: overwrites the fractions of the discs, the first ``cells``;  threads: as many."""
    k = grid()
    if k < cells:
        n = owners.block[k // BLOCK]
        stride, r = patches.stride[n], radius[n]
        j = (k - patches.start[n]) // stride
        i = k - patches.start[n] - j * stride
        if j < patches.height[n]:
            x = owners.first_line[n] + i
            next_x = owners.first_line[n] + min(i + 1, stride - 1)  # the last line is repeated
            y = owners.first_line[n] + j
            left = (lines[0, 0, x], lines[0, 1, x], lines[0, 2, x])
            right = (lines[0, 0, next_x], lines[0, 1, next_x], lines[0, 2, next_x])
            below = across((lines[1, 0, y], lines[1, 1, y], lines[1, 2, y]), r)
            above = across((lines[1, 0, y + 1], lines[1, 1, y + 1], lines[1, 2, y + 1]), r)
            part = strip_area(left, right, above) - strip_area(left, right, below)
            patches.fraction[k] = full_or_empty(part, least_part(r))


def subtract_pairs(groups: Any, pairs: Any, motion: Any, radius: Any, patches: Any) -> None:
    """``subtract_overlap`` of overlap.py: overwrites fractions;  threads: groups by ``rows``.

    groups: (where the pairs of each group begin in ``pairs``, (g + 1,); rows that no group exceeds).  Discs of one
    group overlap none of another; a thread takes a row of a group, in whose cells pairs come in order.
    """
    begin, rows = groups
    k = grid()
    g = k // rows
    if g < begin.shape[0] - 1:
        low = patches.corner[pairs[begin[g], 0], 1]
        for p in range(begin[g], begin[g + 1]):
            low = min(low, patches.corner[pairs[p, 0], 1], patches.corner[pairs[p, 1], 1])
        for p in range(begin[g], begin[g + 1]):
            subtract_in_row(low + k % rows, pairs[p, 0], pairs[p, 1], motion.centre, radius, patches)


def filter_rows(softness: Any, patches: Any, owners: Any) -> None:
    """``filter_row`` of soft_rim.py: overwrites rows;  softness (n,): theta or theta2;  threads: rows."""
    k = grid()
    if k < owners.row.shape[0]:
        n = owners.row[k]
        j = k - owners.first_row[n]
        if j < patches.height[n] and patches.theta[n] > 0.0:
            at = patches.start[n] + j * patches.stride[n]
            filter_row(patches.fraction[at : at + patches.stride[n]], patches.stride[n], 0.25 * softness[n])


def filter_columns(softness: Any, patches: Any, owners: Any) -> None:
    """``filter_cell`` of soft_rim.py up the columns of discs, which are overwritten;  threads: lines of all discs."""
    k = grid()
    if k < owners.line.shape[0] * BLOCK:
        n = owners.line[k // BLOCK]
        if patches.theta[n] > 0.0:
            stride, height, start = patches.stride[n], patches.height[n], patches.start[n]
            patch = patches.fraction[start : start + height * stride]
            for j in range(height - 1, -1, -1):
                filter_cell(patch, k - owners.first_line[n], j, stride, 0.25 * softness[n])


def covered_areas(patches: Any, periodic: Any, shape: Any, area: Any) -> None:
    """``covered_area`` of push.py: overwrites area (n,);  threads: n."""
    n = grid()
    if n < area.shape[0]:
        area[n] = covered_area_of(n, patches, periodic, shape)


def held_areas(patches: Any, periodic: Any, shape: Any, half_rate: Any, weighting: Any, area: Any) -> None:
    """``held_area`` of push.py: overwrites area (n,);  threads: n."""
    n = grid()
    if n < area.shape[0]:
        area[n] = held_area_of(n, patches, periodic, shape, half_rate, weighting)


def keep_open(covered: Any, box: Any, tiles: Any, body: Any, patches: Any) -> None:
    """``keep_open`` of shared.py: overwrites fractions;  threads: cells of the ``covered`` tiles that hold bodies."""
    k = grid()
    tile = k // (TILE_WIDTH * TILE_HEIGHT)
    if tile < covered:
        t, c = tiles.order[tile], k % (TILE_WIDTH * TILE_HEIGHT)
        wide = (box.nx + TILE_WIDTH - 1) // TILE_WIDTH
        x, y = t % wide * TILE_WIDTH + c % TILE_WIDTH, t // wide * TILE_HEIGHT + c // TILE_WIDTH
        real = patches.fraction.dtype.type
        s, most, last, several = real(0), real(MOST), -1, False
        for turn in range(2 if x < box.nx and y < box.ny else 0):  # add up, share out
            for entry in range(tiles.start[t], tiles.start[t + 1]):
                n = tiles.body[entry]
                at = first_place(n, x, y, box, patches)
                while at >= 0:  # once, or again for what lies beyond a periodic side
                    e = patches.fraction[at]
                    if turn == 0 and e > 0:
                        s += e
                        several = several or (last >= 0 and (n == last or body[n] != body[last]))
                        last = n
                    elif turn == 1 and several and s > e > 0:
                        patches.fraction[at] = opened(e, s, most)
                    at = next_place(at, n, box, patches)
