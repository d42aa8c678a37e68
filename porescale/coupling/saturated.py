"""The partially saturated cells of a lattice: what discs cover of it, and one fluid step with them in it."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from porescale.coupling.coverage import CHUNKS, SCRATCH, cover
from porescale.coupling.coverage_rows import BLOCK, lay_out, list_rows, make_patches, make_rows
from porescale.coupling.load import add_rows, half_step_correction
from porescale.coupling.solid.choose import choose_solid
from porescale.coupling.solid_collision import sweep_even, sweep_odd
from porescale.coupling.weighting import choose_weight, fitting_weight, weights_of
from porescale.lbm.collision.choose import third_order_rate
from porescale.lbm.fluid import Fluid

RADIUS_SHIFT = 0.28
"""Cells², over the radius: what exact walls lack to be those of a disc.  See solid/exact_wall.py."""
LOW_PASS = 0.1
"""Share of a step's load in the one that the half-step correction is made from; 1 lets light discs run away."""
BAND_HEIGHT = 8
"""Rows that one thread does at a time; any value gives the same bits."""
SPREAD = 0.6180339887498949
"""Golden section: bands in the order of the multiples of it, modulo 1, are spread evenly over any number of threads,
though the grains lie at the bottom."""

Array = NDArray[np.floating]


class Saturated:
    """Discs of given radii (cells) as the fluid sees them.

    force (n, 2), torque (n,): loads of the last step, lattice units.  The fluid sees a radius of
    ``covering_radius`` cells.  A step allocates no array.
    """

    def __init__(
        self, fluid: Fluid, radius: Array, *, solid_operator: str = "exact-wall", weighting: str | None = None
    ) -> None:
        count, ny, nx = len(radius), fluid.ny, fluid.nx
        dtype = fluid.populations.dtype
        self.radius = np.ascontiguousarray(radius, float)
        self.periodic_x = fluid.sides.left == "periodic"
        self.periodic_y = fluid.sides.bottom == "periodic"
        exact = solid_operator == "exact-wall"
        self.covering_radius = self.radius + RADIUS_SHIFT / np.maximum(self.radius, 1.0) * exact
        across = 2 * self.covering_radius.max(initial=0)
        if (self.periodic_x and across > nx) or (self.periodic_y and across > ny):
            raise ValueError("a disc is wider than the periodic box")
        width = (np.floor(2 * self.covering_radius) + 2).astype(np.int64)
        self._patches = make_patches(width + 1, width, dtype)
        self._rows = make_rows(self._patches, ny)
        widest, highest = int(self._patches.stride.max(initial=BLOCK)), int(width.max(initial=0))
        self._lines = np.zeros((CHUNKS, SCRATCH, widest + BLOCK))
        self._row_load = np.zeros((count, highest, 5))
        bands = -(-ny // BAND_HEIGHT)
        self._band_order = np.argsort(np.arange(bands) * SPREAD % 1).astype(np.int64)
        self._ramp = np.arange(BLOCK).astype(dtype)
        self._scratch = np.zeros((bands, 3, BLOCK + nx + BLOCK), dtype)
        self._partial = np.zeros((bands, 5 * BLOCK), dtype)
        self._laws = (
            choose_weight(fitting_weight(solid_operator, weighting), fluid.relaxation_time, dtype),
            choose_solid(solid_operator, fluid.relaxation_time, third_order_rate(fluid.law), dtype),
        )  # fmt: skip
        self._covered: Array | None = None
        self._shape = ny, nx
        self._load, self._inside = np.zeros((count, 3)), np.zeros((count, 2))
        self.force, self.torque = self._load[:, :2], self._load[:, 2]
        self._corrected, self._slow_load, self._shift = exact, np.zeros((count, 3)), np.zeros((count, 3))
        self._direct = -np.pi * self.covering_radius[:, None] ** 2 * np.asarray(fluid.force)

    @property
    def covered(self) -> Array:
        """Sum of the solid fractions, and of fraction times velocity (x, y), (3, ny, nx); made when asked for."""
        if self._covered is None:
            self._covered = np.zeros((3, *self._shape), self._scratch.dtype)
        return self._covered

    @property
    def solid(self) -> Array:
        """Sum of the solid fractions right after ``cover``, (ny, nx)."""
        return np.asarray(self.covered[0])

    @property
    def solid_x(self) -> Array:
        """Sum of fraction times velocity along x right after ``cover``, (ny, nx)."""
        return np.asarray(self.covered[1])

    @property
    def solid_y(self) -> Array:
        """Sum of fraction times velocity along y right after ``cover``, (ny, nx)."""
        return np.asarray(self.covered[2])

    def _place(self, centre: Array) -> None:
        """Fill the discs' patches, and list what lies in which row."""
        cover(centre, self.covering_radius, self._patches, self._lines)
        list_rows(self._patches, self.periodic_y, self._rows)

    def cover(self, centre: Array, velocity: Array, spin: Array) -> None:
        """Fill the solid fields for discs at centre (n, 2), cells, with velocity and spin in lattice units."""
        self._place(centre)
        motion = centre, velocity, spin, self._shift
        lay_out(self._rows, self._patches, *motion, self.periodic_x, self._ramp, self._scratch, self.covered)

    def weights(self) -> Array:
        """Weight B of every cell (ny, nx), right after ``cover``."""
        zero = type(self._laws[0].k)(0)
        return weights_of(self.solid, zero, zero, self._laws[0])

    def advance(self, fluid: Fluid, centre: Array, velocity: Array, spin: Array) -> None:
        """One fluid step with the discs where they are; fills ``force`` and ``torque``."""
        self._place(centre)
        fluid.advance(
            sweep_even, sweep_odd, self._band_order, BAND_HEIGHT, self._rows, self._patches, centre, velocity, spin,
            self._shift, self.periodic_x, self._ramp, self._row_load, self._scratch, self._partial, *self._laws,
        )  # fmt: skip
        patches = self._patches
        add_rows(
            patches.corner, patches.height, fluid.ny, self.periodic_y, self._row_load, self._load, self._inside
        )  # fmt: skip
        if self._corrected:
            half_step_correction(self._load, self._inside, self._direct, LOW_PASS, self._slow_load, self._shift)

    def state(self) -> dict[str, Any]:
        """What the next step takes from those before."""
        return {"slow_load": self._slow_load, "shift": self._shift}

    def restore(self, state: dict[str, Any]) -> None:
        """Take up a state of the same discs."""
        self._slow_load[...], self._shift[...] = state["slow_load"], state["shift"]
