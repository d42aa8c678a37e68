"""The D2Q9 lattice: directions, weights, and where a population is stored between steps.

Directions come in opposite pairs, (1, 2), (3, 4), (5, 6), (7, 8), because every operator here works on the even and
the odd half of a pair.  Populations are stored shifted, h_i = f_i - w_i, so that a fluid at rest is all zeros and
round-off is that of the disturbance (Skordos 1993).  Speed of sound squared: 1/3.

Storage is one array ``populations`` (9, ny + 2, nx + 2) with a rim of halo cells, streamed in place by the AA pattern
(Bailey, Myre, Walsh, Lilja & Saar 2009).  In memory its rows are padded so that the first cell of each begins a line of
the cache (``padded_populations``): vectors that straddle two lines cost twice.  Two kinds of step alternate:

    even   reads h_i at slot [i, x], writes the collided h_i to slot [opposite(i), x]
    odd    reads h_i at slot [opposite(i), x - c_i], writes it to slot [i, x + c_i]

so each cell always reads and writes the same nine slots, and no order of cells and no number of threads can matter.
``even_slots`` and ``odd_slots`` of stream.py pass the nine slots of a row to one row kernel, the same for both.
"""

import numpy as np
from numpy.typing import DTypeLike, NDArray

from porescale.common.core.aligned import aligned_zeros

CX = np.array([0, 1, -1, 0, 0, 1, -1, -1, 1])
CY = np.array([0, 0, 0, 1, -1, 1, -1, 1, -1])
OPPOSITE = np.array([0, 2, 1, 4, 3, 6, 5, 8, 7])
WEIGHTS = np.array([4 / 9, 1 / 9, 1 / 9, 1 / 9, 1 / 9, 1 / 36, 1 / 36, 1 / 36, 1 / 36])

ROW_MULTIPLE = 16
"""Cells of a padded row are a multiple of this: a line of the cache in float32, two in float64."""


def row_length(nx: int) -> int:
    """Cells of a padded row of nx cells and two of halo."""
    return -(-(nx + 2) // ROW_MULTIPLE) * ROW_MULTIPLE


def padded_populations(nx: int, ny: int, dtype: DTypeLike) -> NDArray[np.floating]:
    """Zeros (9, ny + 2, row_length(nx)), contiguous, whose column 1, the first that is no halo, begins cache lines.

    The columns from nx + 2 on are never used.
    """
    return aligned_zeros((9, ny + 2, row_length(nx)), dtype, first=1)


def relaxation_time(viscosity: float) -> float:
    """Relaxation time of a lattice viscosity, tau = 3 nu + 1/2."""
    return 3 * viscosity + 0.5


def viscosity(relaxation_time: float) -> float:
    """Lattice viscosity of a relaxation time, nu = (tau - 1/2) / 3."""
    return (relaxation_time - 0.5) / 3


def direction(cx: int, cy: int) -> int:
    """Number of the direction with components cx, cy."""
    return int(np.flatnonzero((cx == CX) & (cy == CY))[0])
