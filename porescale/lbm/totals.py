"""Sums over all cells and extremes of them: what a row of a series and a check of a state read of a fluid.

Every block of ``ROWS`` rows is gone through row by row, each column by itself, in float64, so that neighbouring cells
are neighbouring lanes of a vector here and threads side by side on a graphics device (device/readings.py).  What
the blocks give is added by numpy.  The order is the same on every machine and at any number of threads.
"""

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from porescale.common.compiled.jit import inline, parallel_kernel, prange
from porescale.common.core.types import Floats
from porescale.lbm.collision.law import moments, numbers
from porescale.lbm.stream import slots

ROWS = 256
"""Rows of a block.  What the blocks leave, seven float64 of a column, is 56 bytes for so many cells."""
SUMS = 4
"""The first entries of `Totals` are sums; then come the largest, the smallest, the largest."""
START = np.array([0.0, 0.0, 0.0, 0.0, 0.0, np.inf, -np.inf])


class Totals(NamedTuple):
    """Of all cells, lattice units; a number that is none anywhere makes the entries that depend on it nan.

    mass : sum of density - 1;  jx, jy : sums of the first moments, without the body force;  energy : sum of
    rho |u|²/2, half the body force in u;  square : largest |u|²;  thinnest, densest : density - 1, smallest, largest.
    """

    mass: float
    jx: float
    jy: float
    energy: float
    square: float
    thinnest: float
    densest: float

    @property
    def fastest(self) -> float:
        """Largest speed, cells per step."""
        return float(np.sqrt(self.square))

    @property
    def density_change(self) -> float:
        """Largest |density - 1|."""
        return float(np.maximum(-self.thinnest, self.densest))


@inline
def cell_of(planes, x):
    """The nine populations of cell x of a row, the slots (nx,) of which are ``planes``."""
    a0, a1, a2, a3, a4, a5, a6, a7, a8 = planes
    return a0[x], a1[x], a2[x], a3[x], a4[x], a5[x], a6[x], a7[x], a8[x]


@inline
def _larger(one, other):
    """The larger of two numbers, and the one that is none."""
    return other if other > one or other != other else one


@inline
def with_cell(t, f, fx, fy):
    """The seven numbers of ``Totals`` t, float64, with a cell more: populations f, body force density fx, fy."""
    t0, t1, t2, t3, t4, t5, t6 = t
    d, jx, jy = moments(f)
    c = numbers(d)
    rho = c.one + d
    ux, uy = (jx + c.half * fx) / rho, (jy + c.half * fy) / rho
    square = ux * ux + uy * uy
    return (
        t0 + d,
        t1 + jx,
        t2 + jy,
        t3 + c.half * rho * square,
        _larger(t4, square),
        -_larger(-t5, -d),
        _larger(t6, d),
    )


@inline
def _add_row(planes, fx, fy, out):
    """Add the cells of a row to ``out`` (7, nx)."""
    o0, o1, o2, o3, o4, o5, o6 = out[0], out[1], out[2], out[3], out[4], out[5], out[6]
    for x in range(o0.shape[0]):
        t = o0[x], o1[x], o2[x], o3[x], o4[x], o5[x], o6[x]
        o0[x], o1[x], o2[x], o3[x], o4[x], o5[x], o6[x] = with_cell(t, cell_of(planes, x), fx[x], fy[x])


@parallel_kernel
def add_blocks(f, n, parity, force, start, out):
    """``Totals`` of every column of every block before a step of ``parity``; overwrites out (blocks, 7, n), float64.

    f: padded populations of n cells a row, the halo filled before an odd step;  force (2, rows, n): body force
    density, one row for all or all rows;  start (7,): START.
    """
    for block in prange(out.shape[0]):
        for k in range(out.shape[1]):
            out[block, k] = start[k]
        for y in range(block * ROWS, min((block + 1) * ROWS, f.shape[1] - 2)):
            row = min(y, force.shape[1] - 1)
            _add_row(slots(f, n, y + 1, parity), force[0, row], force[1, row], out[block])


def blocks_of(nx: int, ny: int) -> Floats:
    """Room for what ``add_blocks`` gives of nx by ny cells, (blocks, 7, nx)."""
    return np.empty((-(-ny // ROWS), len(START), nx))


def totals_of(blocks: Floats) -> Totals:
    """What the blocks (blocks, 7, nx) make together."""
    each = blocks.transpose(1, 0, 2).reshape(len(START), -1)
    mass, jx, jy, energy = (float(row.sum()) for row in each[:SUMS])
    square, thinnest, densest = float(each[SUMS].max()), float(each[SUMS + 1].min()), float(each[SUMS + 2].max())
    return Totals(mass, jx, jy, energy, square, thinnest, densest)


def force_rows(force: tuple[float, float], field: Any, nx: int, dtype: Any) -> NDArray[np.floating]:
    """Body force density as ``add_blocks`` takes it: that of every cell, ``field``, or a row of the uniform one."""
    if field is not None:
        return np.asarray(field)
    rows = np.empty((2, 1, nx), dtype)
    rows[0], rows[1] = force
    return rows
