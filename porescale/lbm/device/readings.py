"""Moments and totals of populations on a device, worked out there: what rows, checks and snapshots read.

A thread takes a column of a block of rows, as a lane of the CPU's loop does (totals.py), in the same order: there is
no atomic operation.  Moments are fetched a band of rows at a time, so that three fields need no room on the device.
"""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from porescale.common.compiled.cuda import device_kernel, grid, launch, to_device
from porescale.lbm.collision.law import moments
from porescale.lbm.stream import slots
from porescale.lbm.totals import ROWS, START, Totals, blocks_of, cell_of, force_rows, totals_of, with_cell

Moments = tuple[NDArray[np.floating], NDArray[np.floating], NDArray[np.floating]]
BAND = 32
"""Rows whose moments are fetched at a time."""
THREADS = 128
"""Threads of a block; not tuned."""


def add_blocks_there(f: Any, n: Any, parity: Any, force: Any, start: Any, out: Any) -> None:
    """``add_blocks`` of totals.py: overwrites out (blocks, 7, n);  threads: one a column of a block or more."""
    k = grid()
    if k < n * out.shape[0]:
        block, x = k // n, k % n
        t = start[0], start[1], start[2], start[3], start[4], start[5], start[6]
        for y in range(block * ROWS, min((block + 1) * ROWS, f.shape[1] - 2)):
            row = min(y, force.shape[1] - 1)
            t = with_cell(t, cell_of(slots(f, n, y + 1, parity), x), force[0, row, x], force[1, row, x])
        out[block, 0, x], out[block, 1, x], out[block, 2, x], out[block, 3, x] = t[0], t[1], t[2], t[3]
        out[block, 4, x], out[block, 5, x], out[block, 6, x] = t[4], t[5], t[6]


def moments_of_rows(f: Any, n: Any, parity: Any, first: Any, out: Any) -> None:
    """``moment_fields`` of moments.py, of rows from ``first`` on: overwrites out (3, rows, n);  threads: one a cell."""
    k = grid()
    y, x = k // n, k % n
    if y < out.shape[1] and first + y < f.shape[1] - 2:
        out[0, y, x], out[1, y, x], out[2, y, x] = moments(cell_of(slots(f, n, first + y + 1, parity), x))


def keep_slots(flat: Any, at: Any, kept: Any) -> None:
    """Copy flat populations at slots ``at`` into ``kept``;  threads: a slot each."""
    k = grid()
    if k < at.shape[0]:
        kept[k] = flat[at[k]]


def put_slots(flat: Any, at: Any, kept: Any) -> None:
    """The reverse: overwrites flat populations at slots ``at``."""
    k = grid()
    if k < at.shape[0]:
        flat[at[k]] = kept[k]


class Readings:
    """Readings of a box of nx by ny cells of a type, in a uniform body force; its arrays on the device are made here.

    Both readings take the padded populations there, before a step of ``parity``, the halo filled before an odd one.
    """

    def __init__(self, nx: int, ny: int, force: tuple[float, float], dtype: Any) -> None:
        self.nx, self.ny, self.dtype = nx, ny, np.dtype(dtype)
        self._blocks, self._band = blocks_of(nx, ny), np.empty((3, min(BAND, ny), nx), dtype)
        there = (force_rows(force, None, nx, dtype), START, self._blocks, self._band)
        self._force, self._start, self._blocks_there, self._band_there = (to_device(it) for it in there)
        self._add, self._read, self.keep, self.put = (
            device_kernel(it, object, self.dtype.type)
            for it in (add_blocks_there, moments_of_rows, keep_slots, put_slots)
        )

    def totals(self, there: Any, parity: int) -> Totals:
        """``Fluid.totals``: fetches the sums of the blocks."""
        count = self.nx * len(self._blocks)
        launch(self._add, count, THREADS, there, self.nx, parity, self._force, self._start, self._blocks_there)
        self._blocks_there.copy_to_host(self._blocks)
        return totals_of(self._blocks)

    def moments(self, there: Any, parity: int) -> Moments:
        """``Fluid.moments``: fetches three numbers a cell."""
        d, jx, jy = (np.empty((self.ny, self.nx), self.dtype) for _ in range(3))
        for first in range(0, self.ny, BAND):
            launch(self._read, self.nx * self._band.shape[1], THREADS, there, self.nx, parity, first, self._band_there)
            self._band_there.copy_to_host(self._band)
            for field, band in zip((d, jx, jy), self._band, strict=True):
                field[first : first + BAND] = band[: self.ny - first]
        return d, jx, jy


def bytes_of_readings(nx: int, ny: int, real_bytes: int) -> int:
    """Device memory that the readings take."""
    return 8 * len(START) * nx * -(-ny // ROWS) + (3 * min(BAND, ny) + 2) * nx * real_bytes
