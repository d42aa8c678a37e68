"""Loads on the device: a thread takes a row of a body, then one takes a body, in the order of load.py.

Plain functions: ``device_kernel`` of common/compiled/cuda.py compiles them for laws and a precision.
"""

from typing import Any

import numpy as np

from porescale.common.compiled.cuda import grid
from porescale.common.compiled.jit import inline
from porescale.coupling.coverage.rows import BLOCK, blocks_inside
from porescale.coupling.device.sweeps import block_at
from porescale.coupling.load import add_rows_of, load_of_cell, rim_of_cell, sum_rim_slip_of


@inline
def add_loads(a, b):
    """Sum of two loads of ``load_of_cell``."""
    return a[0] + b[0], a[1] + b[1], a[2] + b[2], a[3] + b[3], a[4] + b[4]


@inline
def load_at(i, block, line, gained, patches):
    """``load_of_cell`` of cell ``i`` of a block;  line: where the block begins in ``fraction``, its column and row."""
    at, x, y = line[0] + i, line[1] + i, line[2]
    real = patches.fraction.dtype.type
    rho, jx, jy = real(0), real(0), real(0)
    if 0 <= x < gained.shape[2]:
        rho, jx, jy = gained[0, y, x], gained[1, y, x], gained[2, y, x]
    return load_of_cell(patches.fraction[at], (rho, jx, jy), real(i), block)


@inline
def two_loads(i, block, line, gained, patches):
    """Cells i and i + 4: halves of a block are added until one is left, as ``reduce_add`` does."""
    return add_loads(load_at(i, block, line, gained, patches), load_at(i + 4, block, line, gained, patches))


@inline
def four_loads(i, block, line, gained, patches):
    """Every second cell from i on."""
    return add_loads(two_loads(i, block, line, gained, patches), two_loads(i + 2, block, line, gained, patches))


@inline
def block_load(block, line, gained, patches):
    """Sum of the loads of all eight cells of a block."""
    return add_loads(four_loads(0, block, line, gained, patches), four_loads(1, block, line, gained, patches))


@inline
def rim_at(i, line, gained, patches):
    """``rim_of_cell`` of cell ``i`` of a block, rounded as the CPU stores it."""
    at, x, y = line[0] + i, line[1] + i, line[2]
    real = patches.fraction.dtype.type
    rho, slip = real(0), real(0)
    if 0 <= x < gained.shape[2]:
        rho, slip = gained[0, y, x], gained[3, y, x]
    slipped, edge = rim_of_cell(patches.fraction[at], rho, slip)
    return real(slipped), real(edge)


@inline
def block_rim(line, gained, patches):
    """``rim_at`` of a block, added as ``block_load`` does."""
    whole, edges = patches.fraction.dtype.type(0), patches.fraction.dtype.type(0)
    for i in range(2):
        a, ea = rim_at(i, line, gained, patches)
        b, eb = rim_at(i + 4, line, gained, patches)
        c, ec = rim_at(i + 2, line, gained, patches)
        d, ed = rim_at(i + 6, line, gained, patches)
        half, half_edges = (a + b) + (c + d), (ea + eb) + (ec + ed)
        whole = half if i == 0 else whole + half
        edges = half_edges if i == 0 else edges + half_edges
    return whole, edges


@inline
def row_of(k, box, patches, owners):
    """Body, row of its patch and row of the lattice of the entry ``k`` of all rows; -1 where that is not in the box."""
    n = owners.row[k]
    j = k - owners.first_row[n]
    y = patches.corner[n, 1] + j
    if box.periodic_y:
        y %= box.ny
    return n, j, y if j < patches.height[n] and 0 <= y < box.ny else -1


def load_rows(box: Any, tiles: Any, patches: Any, owners: Any, row_load: Any) -> None:
    """``accumulate_load_band`` of every row of every body: overwrites row_load (n, largest height, 5 or more);
    threads: rows."""
    k = grid()
    if k < owners.row.shape[0]:
        n, j, y = row_of(k, box, patches, owners)
        if y >= 0:
            fx, fy, tz, mass, inertia = 0.0, 0.0, 0.0, 0.0, 0.0
            stride = patches.stride[n]
            at = patches.start[n] + j * stride
            base = patches.corner[n, 0]
            if box.periodic_x:
                base %= box.nx
            while base + stride > 0:  # once, or again for what lies beyond a periodic side
                first, last = blocks_inside(base, stride, box.nx)
                for b in range(first, last, BLOCK):
                    block = block_at((at + b) // BLOCK, patches)
                    found = block_load(block, (at + b, base + b, y), tiles.gained, patches)
                    fx += np.float64(found[0])
                    fy += np.float64(found[1])
                    tz += np.float64(found[2])
                    mass += np.float64(found[3])
                    inertia += np.float64(found[4])
                if not box.periodic_x:
                    break
                base -= box.nx
            row_load[n, j, 0], row_load[n, j, 1], row_load[n, j, 2] = fx, fy, tz
            row_load[n, j, 3], row_load[n, j, 4] = mass, inertia


def rim_rows(box: Any, tiles: Any, patches: Any, owners: Any, row_load: Any) -> None:
    """The two sums of ``accumulate_load_band`` where rims are soft: overwrites the last two of row_load;  threads:
    rows."""
    k = grid()
    if k < owners.row.shape[0]:
        n, j, y = row_of(k, box, patches, owners)
        if y >= 0:
            slipping, rim = 0.0, 0.0
            stride = patches.stride[n]
            at = patches.start[n] + j * stride
            base = patches.corner[n, 0]
            if box.periodic_x:
                base %= box.nx
            while base + stride > 0:
                first, last = blocks_inside(base, stride, box.nx)
                for b in range(first, last, BLOCK):
                    slipped, edge = block_rim((at + b, base + b, y), tiles.gained, patches)
                    slipping += np.float64(slipped)
                    rim += np.float64(edge)
                if not box.periodic_x:
                    break
                base -= box.nx
            row_load[n, j, 5], row_load[n, j, 6] = slipping, rim


def add_bodies(box: Any, patches: Any, row_load: Any, load: Any, inside: Any) -> None:
    """``add_rows`` of load.py: overwrites load (n, 3) and inside (n, 2);  threads: n."""
    n = grid()
    if n < load.shape[0]:
        add_rows_of(n, patches.corner, patches.height, (box.ny, box.periodic_y), row_load, load, inside)


def add_rims(box: Any, patches: Any, row_load: Any, rim: Any) -> None:
    """``sum_rim_slip`` of load.py: overwrites rim (n, 2);  threads: n."""
    n = grid()
    if n < rim.shape[0]:
        sum_rim_slip_of(n, patches.corner, patches.height, (box.ny, box.periodic_y), row_load, rim)
