"""A user's functions of place and time on the lattice: the body force of every cell, the velocity along a side.

Functions take and give SI; arrays are in lattice units.  Filling them allocates nothing.
"""

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import DTypeLike, NDArray

from porescale.common.compiled.jit import Kernel, kernel, parallel_kernel, prange
from porescale.common.core.types import Floats
from porescale.lbm.scales import Scales

Fill = Callable[[float], Any]
"""Fills its array for a time (s), and returns it."""


def side_filler(law: Kernel, scales: Scales, count: int) -> Fill:
    """Velocities (count, 2) along a side of so many cells, of a function (s, t) in m and s that gives m/s."""

    @kernel
    def fill(time, spacing, unit, out):
        """Overwrite ``out`` (n, 2) with the function at the middle of each cell."""
        for k in range(out.shape[0]):
            u, v = law((k + 0.5) * spacing, time)
            out[k, 0] = u / unit
            out[k, 1] = v / unit

    found: Floats = np.zeros((count, 2))

    def filled(time: float) -> Floats:
        """The velocities at ``time`` (s)."""
        fill(time, scales.spacing, scales.velocity, found)
        return found

    return filled


def force_filler(law: Kernel, scales: Scales, shape: tuple[int, int], dtype: DTypeLike, *, steady: bool) -> Fill:
    """Force densities (2, ny, nx) of one in N/m³, a function (x, y, t) in m and s, or (x, y) if steady."""

    @parallel_kernel
    def fill(time, spacing, unit, out):
        """Overwrite ``out`` (2, ny, nx) with the function at the middle of each cell."""
        for y in prange(out.shape[1]):
            for x in range(out.shape[2]):
                fx, fy = law((x + 0.5) * spacing, (y + 0.5) * spacing, time)
                out[0, y, x] = fx / unit
                out[1, y, x] = fy / unit

    @parallel_kernel
    def fill_once(time, spacing, unit, out):
        """The same, of a function of the place alone."""
        for y in prange(out.shape[1]):
            for x in range(out.shape[2]):
                fx, fy = law((x + 0.5) * spacing, (y + 0.5) * spacing)
                out[0, y, x] = fx / unit
                out[1, y, x] = fy / unit

    found: NDArray[np.floating] = np.zeros((2, *shape), dtype)
    unit = scales.body_force

    def filled(time: float) -> NDArray[np.floating]:
        """The force densities at ``time`` (s)."""
        (fill_once if steady else fill)(time, scales.spacing, unit, found)
        return found

    return filled
