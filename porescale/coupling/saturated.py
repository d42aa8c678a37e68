"""The partially saturated cells of a lattice: what discs cover of it, and one fluid step with them in it."""

import numpy as np
from numpy.typing import NDArray

from porescale.coupling.coverage import cover, lay_out, list_rows
from porescale.coupling.load import add_rows
from porescale.coupling.solid.choose import choose_solid
from porescale.coupling.solid_collision import sweep_even, sweep_odd
from porescale.coupling.weighting import choose_weight, weights_of
from porescale.lbm.fluid import Fluid

BAND_HEIGHT = 8
"""Rows that one thread does at a time; any value gives the same bits."""
SPREAD = 0.6180339887498949
"""Golden section: bands in the order of the multiples of it, modulo 1, are spread evenly over any number of threads,
though the grains lie at the bottom."""

Array = NDArray[np.floating]


class Saturated:
    """Discs of given radii (cells) as the fluid sees them.

    force (n, 2), torque (n,): loads of the last step, lattice units;  solid, solid_x, solid_y (ny, nx): sum of the
    solid fractions, and of fraction times velocity, right after ``cover``.  A step allocates no array.
    """

    def __init__(self, fluid: Fluid, radius: Array, *, solid_operator: str = "odd-SC1", weighting: str = "B2") -> None:
        count, ny, nx = len(radius), fluid.ny, fluid.nx
        dtype = fluid.populations.dtype
        self.radius = np.ascontiguousarray(radius, float)
        self.periodic_x = fluid.sides.left == "periodic"
        self.periodic_y = fluid.sides.bottom == "periodic"
        across = 2 * self.radius.max(initial=0)
        if (self.periodic_x and across > nx) or (self.periodic_y and across > ny):
            raise ValueError("a disc is wider than the periodic box")
        width = (np.floor(2 * self.radius) + 2).astype(np.int64)
        widest = int(width.max(initial=0))
        start = np.concatenate(([0], np.cumsum(width**2)[:-1])).astype(np.int64)[:count]
        self._lines = np.zeros((count, 4, widest + 1))
        corner, reach = np.zeros((count, 2), np.int64), np.zeros((count, widest, 2), np.int64)
        self._patches = (start, width, np.zeros(int(np.sum(width**2))), corner, reach)
        entries = int(np.sum(width))
        self._rows = (np.zeros(ny + 1, np.int64), np.zeros(entries, np.int64), np.zeros(entries, np.int64))
        self._row_load = np.zeros((count, widest, 3))
        bands = -(-ny // BAND_HEIGHT)
        self._band_order = np.argsort(np.arange(bands) * SPREAD % 1).astype(np.int64)
        self._scratch = np.zeros((bands, 3, nx), dtype)
        self.solid, self.solid_x, self.solid_y = (np.zeros((ny, nx), dtype) for _ in range(3))
        self._laws = (
            choose_weight(weighting, fluid.relaxation_time, dtype), choose_solid(solid_operator, dtype)
        )  # fmt: skip
        self.force, self.torque = np.zeros((count, 2)), np.zeros(count)

    def _place(self, centre: Array) -> None:
        """Fill the discs' patches, and list what lies in which row."""
        _, width, _, corner, reach = self._patches
        cover(centre, self.radius, *self._patches, self._lines)
        list_rows(corner, width, reach, self.solid.shape[0], self.periodic_y, *self._rows)

    def cover(self, centre: Array, velocity: Array, spin: Array) -> None:
        """Fill the solid fields for discs at centre (n, 2), cells, with velocity and spin in lattice units."""
        self._place(centre)
        fields = self.solid, self.solid_x, self.solid_y
        lay_out(*self._rows, centre, velocity, spin, *self._patches, self.periodic_x, *fields)

    def weights(self) -> Array:
        """Weight B of every cell (ny, nx), right after ``cover``."""
        zero = type(self._laws[0].k)(0)
        return weights_of(self.solid, zero, zero, self._laws[0])

    def advance(self, fluid: Fluid, centre: Array, velocity: Array, spin: Array) -> None:
        """One fluid step with the discs where they are; fills ``force`` and ``torque``."""
        self._place(centre)
        fluid.advance(
            sweep_even, sweep_odd, self._band_order, BAND_HEIGHT, *self._rows, centre, velocity, spin, *self._patches,
            self.periodic_x, self._row_load, self._scratch, *self._laws,
        )  # fmt: skip
        _, width, _, corner, reach = self._patches
        add_rows(corner, width, reach, fluid.ny, self.periodic_y, self._row_load, self.force, self.torque)
