"""Everything outside a circle: the outer cylinder of a Couette cell, a rotating drum.

A cell is covered by what the disc inside leaves of it.  The fluid's side of the wall is hollow, so the radius shift of
exact walls is that of a disc with the curvature's sign turned: the hole is wider by it.
"""

import numpy as np
from numpy.typing import ArrayLike, NDArray

from porescale.common.compiled.jit import kernel
from porescale.common.core.types import Integers, Reals
from porescale.coupling.coverage.discs import CHUNKS, SCRATCH, cover
from porescale.coupling.coverage.rows import BLOCK, make_patches
from porescale.coupling.coverage.shape import Shape
from porescale.lbm.fluid import Fluid


class Ring(Shape):
    """All that is farther than ``radius`` (cells) from ``centre``; it may move and spin.

    The whole box is its patch, filled anew only when it has moved: spinning costs nothing.
    """

    def __init__(self, centre: ArrayLike, radius: float, spin: float = 0.0) -> None:
        super().__init__(spin=spin)
        self._centre = np.array(centre, float)
        self.radius = self.hole = float(radius)
        if self._centre.shape != (2,) or not radius > 1:
            raise ValueError(f"a ring needs a centre (x, y) and a radius above a cell, not {centre!r} and {radius}")

    @property
    def centre(self) -> Reals:
        """The centre, (2,) cells; write into it to move the ring."""
        return self._centre

    @property
    def place(self) -> Reals:
        """Centre of the ring, (2,) cells: the array that motion overwrites."""
        return self._centre

    def size(self, fluid: Fluid, shift: float) -> tuple[int, int]:
        """The box.  ValueError in a periodic one, where the rotating wall would overlap its own image."""
        if any(fluid.sides.periodic):
            raise ValueError("a ring stands in a box with sides that are not periodic")
        self.hole = self.radius + shift / self.radius
        return fluid.nx, fluid.ny

    def fill(self, fluid: Fluid, corner: Integers, fraction: NDArray[np.floating]) -> None:
        """One less what the disc covers; makes room for the disc's patch, since a ring seldom moves."""
        corner[:] = 0
        width = np.array([int(2 * self.hole) + 2])
        disc = make_patches(width + 1, width, fraction.dtype)
        lines = np.zeros((CHUNKS, SCRATCH, int(disc.stride[0]) + BLOCK))
        cover(self._centre[None], np.array([self.hole]), disc, lines)
        fill_ring(disc.corner[0], disc.fraction.reshape(width[0], -1), fluid.nx, fraction)


@kernel
def fill_ring(corner, disc, nx, fraction):
    """What a disc's patch (h, w), lower left cell at corner (2,), leaves of each cell; overwrites fraction (ny, >= nx),
    with 0 beyond the box."""
    for j in range(fraction.shape[0]):
        for i in range(fraction.shape[1]):
            fraction[j, i] = 1.0 if i < nx else 0.0
    for j in range(max(corner[1], 0), min(corner[1] + disc.shape[0], fraction.shape[0])):
        for i in range(max(corner[0], 0), min(corner[0] + disc.shape[1], nx)):
            fraction[j, i] = 1.0 - disc[j - corner[1], i - corner[0]]
