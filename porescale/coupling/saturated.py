"""The partially saturated cells of a lattice: what discs cover of it, and one fluid step with them in it."""

import numpy as np
from numpy.typing import NDArray

from porescale.coupling.coverage import accumulate, cover, list_bands
from porescale.coupling.load import loads
from porescale.coupling.solid_collision import sweep_even, sweep_odd
from porescale.lbm.fluid import Fluid

BAND_HEIGHT = 8
"""Rows that one thread sums at a time; any value gives the same bits."""

Array = NDArray[np.floating]


class Saturated:
    """Discs of given radii (cells) as the fluid sees them.

    force (n, 2), torque (n,): loads of the last step, lattice units;  solid fields (ny, nx): see solid_collision.py.
    A step allocates nothing, unless discs crowd into a band as never before.
    """

    def __init__(self, fluid: Fluid, radius: Array) -> None:
        count, ny, nx = len(radius), fluid.ny, fluid.nx
        dtype = fluid.populations.dtype
        self.radius = np.ascontiguousarray(radius, float)
        self.periodic_x = fluid.sides.left == "periodic"
        self.periodic_y = fluid.sides.bottom == "periodic"
        self._width = (np.floor(2 * self.radius) + 2).astype(np.int64)
        across = 2 * self.radius.max(initial=0)
        if (self.periodic_x and across > nx) or (self.periodic_y and across > ny):
            raise ValueError("a disc is wider than the periodic box")
        self._start = np.concatenate(([0], np.cumsum(self._width**2)[:-1])).astype(np.int64)[:count]
        self._patch = np.zeros(int(np.sum(self._width**2)), float)
        widest = int(self._width.max(initial=0))
        self._lines = np.zeros((count, 4, widest + 1))
        self._reach = np.zeros((count, widest, 2), np.int64)
        self._corner = np.zeros((count, 2), np.int64)
        bands = -(-ny // BAND_HEIGHT)
        self._band_start = np.zeros(bands + 1, np.int64)
        self._band_disc = np.zeros(4 * count + 16, np.int64)
        self._last = np.zeros(bands, np.int64)
        self.solid, self.solid_x, self.solid_y = (np.zeros((ny, nx), dtype) for _ in range(3))
        self.span = np.zeros((ny, 2), np.int64)
        self._k = np.array([fluid.relaxation_time - 0.5], dtype)
        self.force, self.torque = np.zeros((count, 2)), np.zeros(count)

    def cover(self, centre: Array, velocity: Array, spin: Array) -> None:
        """Put the discs (centre (n, 2) in cells, velocity and spin in lattice units) on the lattice."""
        cover(centre, self.radius, self._start, self._width, self._patch, self._corner, self._reach, self._lines)
        bands = (self._corner, self._width, self.solid.shape[0], BAND_HEIGHT, self.periodic_y)
        needed = list_bands(*bands, self._band_start, self._band_disc, self._last)
        if needed > len(self._band_disc):
            self._band_disc = np.zeros(2 * needed, np.int64)
            list_bands(*bands, self._band_start, self._band_disc, self._last)
        accumulate(
            centre, velocity, spin, self._start, self._width, self._patch, self._corner, self._reach, self._band_start,
            self._band_disc, BAND_HEIGHT, self.periodic_x, self.periodic_y, self.solid, self.solid_x, self.solid_y,
            self.span,
        )  # fmt: skip

    def weights(self) -> Array:
        """Weight B of every cell (ny, nx), right after ``cover``."""
        e = np.minimum(self.solid, 1)
        k = self._k[0]
        return np.asarray(e * k / ((1 - e) + k))

    def advance(self, fluid: Fluid, centre: Array, velocity: Array, spin: Array) -> None:
        """One fluid step with the discs where they are; fills ``force`` and ``torque``."""
        self.cover(centre, velocity, spin)
        fluid.advance(sweep_even, sweep_odd, self.solid, self.solid_x, self.solid_y, self.span, self._k)
        loads(
            centre, velocity, spin, self._start, self._width, self._patch, self._corner, self._reach, self.periodic_x,
            self.periodic_y, self.solid, self.solid_x, self.solid_y, self.force, self.torque,
        )  # fmt: skip
