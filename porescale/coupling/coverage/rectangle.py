"""A rectangle along the grid: a gate of finite thickness, a piston, a step.

What it covers of a cell is the product of two lengths, exactly.  A straight wall needs no radius shift; corners that
stand free would need the tips of polygon.py, which would stick out of a wall that several rectangles make.
"""

import numpy as np
from numpy.typing import ArrayLike, NDArray

from porescale.common.compiled.jit import kernel
from porescale.common.core.types import Integers, Reals
from porescale.coupling.coverage.shape import Shape
from porescale.lbm.fluid import Fluid


class Rectangle(Shape):
    """From ``lower`` to ``upper`` (2,), cells, of a size that stays; ``lower`` is written, ``upper`` follows.

    It may reach out of the box, or lie outside.
    """

    def __init__(self, lower: ArrayLike, upper: ArrayLike, velocity: ArrayLike = (0.0, 0.0)) -> None:
        super().__init__(velocity)
        self.lower = np.array(lower, float)
        self.extent = np.array(upper, float) - self.lower
        if self.extent.shape != (2,) or not np.all(self.extent > 0):
            raise ValueError(f"the upper corner {upper!r} does not lie right of and above the lower one, {lower!r}")

    @property
    def upper(self) -> Reals:
        """Upper right corner, (2,) cells."""
        return np.asarray(self.lower + self.extent)

    @property
    def centre(self) -> Reals:
        """Centre of the rectangle, (2,) cells."""
        return np.asarray(self.lower + 0.5 * self.extent)

    @property
    def place(self) -> Reals:
        """Lower left corner, (2,) cells: the array that motion overwrites."""
        return self.lower

    def size(self, fluid: Fluid, shift: float) -> tuple[int, int]:
        """Two cells more than it is long, and no more than the box between walls."""
        cells = []
        for length, whole, joined in zip(self.extent, (fluid.nx, fluid.ny), fluid.sides.periodic, strict=True):
            if joined and length > whole:
                raise ValueError("a rectangle is longer than the periodic box")
            wanted = int(np.floor(length)) + 2
            cells.append(wanted if joined else min(wanted, whole))
        return cells[0], cells[1]

    def fill(self, fluid: Fluid, corner: Integers, fraction: NDArray[np.floating]) -> None:
        """The part of it in the box."""
        columns, rows = self.size(fluid, 0.0)
        corner[:] = np.floor(self.lower)
        for a, (count, whole, joined) in enumerate(
            zip((columns, rows), (fluid.nx, fluid.ny), fluid.sides.periodic, strict=True)
        ):
            if not joined:
                corner[a] = min(max(corner[a], 0), whole - count)
        x, y = self.lower
        fill_rectangle(x, y, x + self.extent[0], y + self.extent[1], corner[0], corner[1], columns, fraction)


@kernel
def fill_rectangle(left, bottom, right, top, x0, y0, columns, fraction):
    """Overlaps of the cells from (x0, y0) on with a rectangle, cells; overwrites fraction (height, stride), with 0 from
    column ``columns`` on."""
    for j in range(fraction.shape[0]):
        y = y0 + j
        high = max(0.0, min(top, y + 1.0) - max(bottom, y))
        for i in range(fraction.shape[1]):
            x = x0 + i
            wide = max(0.0, min(right, x + 1.0) - max(left, x))
            fraction[j, i] = wide * high if i < columns else 0.0
