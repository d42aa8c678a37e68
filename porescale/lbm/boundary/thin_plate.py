"""A vertical plate of no thickness between two columns of cells: the gate.

Links that cross the plate bounce back half-way, where the plate is.  In the in-place pattern that is an exchange of the
two slots of a link before each odd step and again after it, so mass is conserved to the bit, no fluid is caught inside,
and the plate can rise or vanish between two steps.  A plate that rises with speed v adds 6 w_i c_i . (0, v) to what
leaves it (Ladd 1994); over the two links of a crossing that sums to zero.
"""

import math
from collections.abc import Mapping

import numpy as np
from numpy.typing import DTypeLike, NDArray

from porescale.common.compiled.jit import kernel
from porescale.lbm.boundary.law import Boundary
from porescale.lbm.boundary.sides import NAMES, Sides
from porescale.lbm.lattice import CY, OPPOSITE, WEIGHTS, direction, row_length

_CROSSING = (direction(1, 0), direction(1, 1), direction(1, -1))


def open_ends(kinds: Mapping[str, Boundary], nx: int, column: int) -> list[str]:
    """Sides that leave a plate left of ``column`` open: a bottom or top that does not turn the fluid back, a left or
    right one that settles what passes it less than two cells beside the plate;  kinds : by name of the side."""
    crossed = [side for side in ("bottom", "top") if kinds[side].periodic or kinds[side].settles]
    return crossed + [side for side, at in (("left", 1), ("right", nx - 1)) if column == at and kinds[side].settles]


class Plate:
    """The links that a plate over the whole height, left of cell ``column`` (1 to nx - 1, from 0), crosses.

    first, second (k,): flat slots exchanged, lowest link first;  pull (k,): 6 w c_y, what a unit of speed adds;
    row (k,): the lower of the two rows a link joins, so that a plate whose lower edge has risen cuts the links of rows
    at and above it.  lower_edge: cells above the bottom;  speed: upward, lattice units.

    Where the plate touches a free-slip side, a link that mirrors there would come down on the plate's other face; its
    two halo slots are exchanged as well.
    """

    def __init__(self, nx: int, ny: int, column: int, sides: Sides, dtype: DTypeLike) -> None:
        if not 0 < column < nx:
            raise ValueError(f"a plate stands between two columns: column {column} is not in 1 … {nx - 1}")
        kinds = {side: sides.boundary(side) for side in NAMES}
        bottom, top = kinds["bottom"], kinds["top"]
        if open_at := open_ends(kinds, nx, column):
            problem = "a plate needs sides that turn the fluid back at its ends, and two cells to any other"
            raise ValueError(f"{problem}: {kinds[open_at[0]].name} does not")
        first, second, pull, row = [], [], [], []
        long = row_length(nx)
        for y in range(1, ny + 1):
            for out in _CROSSING:
                to = y + int(CY[out])
                if 1 <= to <= ny:
                    first.append((int(OPPOSITE[out]) * (ny + 2) + y) * long + column)
                    second.append((out * (ny + 2) + to) * long + column + 1)
                    pull.append(6 * WEIGHTS[out] * CY[out])
                    row.append(min(y, to) - 1)
                elif (bottom if to < 1 else top).mirrors:
                    mirror = direction(-1, int(CY[out]))
                    first.append((mirror * (ny + 2) + to) * long + column)
                    second.append((out * (ny + 2) + to) * long + column + 1)
                    pull.append(0.0)
                    row.append(y - 1)
        order = np.argsort(row, kind="stable")
        self.first: NDArray[np.int64] = np.array(first, np.int64)[order]
        self.second: NDArray[np.int64] = np.array(second, np.int64)[order]
        self.pull: NDArray[np.floating] = np.array(pull, dtype)[order]
        self.row: NDArray[np.int64] = np.array(row, np.int64)[order]
        self.lower_edge = 0.0
        self.speed = 0.0

    def signed_speed(self, sign: float) -> np.floating:
        """Speed with a sign, in the dtype of the populations."""
        return self.pull.dtype.type(sign * self.speed)

    def links_from(self) -> int:
        """Number of the first link that the plate, at its present height, still cuts."""
        return int(np.searchsorted(self.row, math.ceil(self.lower_edge - 0.5)))


@kernel
def exchange(flat, first, second, pull, begin, speed):
    """Exchange the slots of links ``begin`` and up; overwrites flat populations.  ``speed`` changes sign after the
    odd step, when the slots hold what left instead of what arrives."""
    for k in range(begin, first.shape[0]):
        toward = flat[first[k]]
        plus = pull[k] * speed
        flat[first[k]] = flat[second[k]] + plus
        flat[second[k]] = toward - plus
