"""The soft rim: how a body that the fluid passes fast is laid on the lattice.

Near tau = 1/2 the viscous layer at a grain is thinner than a cell.  A weight that is right in slow flow then looks a
cell too big (drag 6 to 24 % too high), and shakes as cells are covered and set free: the noise is the content, at one
wave a cell, of a nonlinear function of a sharp mask.  What is needed depends on the cell Reynolds number R = |U| h/nu
of the body, estimated from the slip at its rim, w = sum e (1 - e)|v - u| / sum e (1 - e), low-passed:

    q = (3.3 w sqrt(2 r)/nu)^(4/3), about R²;      theta = q/(q + 4),   theta2 = q/(q + 36)
    radius      r_c = r - sqrt(r) (0.49 theta + 0.25 theta2) + (A/r)(1 - theta)
    fractions   filtered by (s, 1 - 2 s, s) along x, then y, with s = theta/4, and again with s = theta2/4
    cells       k = tau - 1/2 + 0.24 theta |v - u|, and the odd rate that of SC1 in theta (solid/exact_wall.py)

A disc that stands frees and covers no cells, so nothing shakes and nothing need be filtered: its cells are those of the
exact wall, and it is only drawn in, since fast flow stops in every cell that it touches, half a cell before its rim:

    radius      r_c = r - 0.4 theta - 0.3 theta2 + (A/r)(1 - theta)

theta = 0 is the exact wall to the bit; the filter keeps the sum of the fractions.  The numbers were chosen by the drag
of an impulsively towed cylinder, d = 10 and 15 cells, Re 50, 100 and 500, against a body-fitted solution; other sizes,
directions, Reynolds numbers and viscosities were not looked at.  Those of a disc that stands: by the drag of a cylinder
that fluid passes at once (d = 10 and 15, Re 50, 100, 500), with the street of vortices in sight (d = 20, Re 100), whose
lift is 14 % too small with filters.  Derived here.
"""

import math

import numpy as np
from numpy.typing import NDArray

from porescale.common.compiled.jit import inline, kernel, parallel_kernel, prange
from porescale.coupling.coverage.rows import Patches
from porescale.coupling.load import sum_rim_slip

SLIP_FACTOR = 0.24
"""Factor of theta |v - u| in the slip-dependent part of k."""
DRAWN_IN = 0.4, 0.3
"""Cells by which a disc that stands is drawn in at theta and theta2 of 1."""
SLIP_SHARE = 0.02
"""Share of a step's rim slip in the one that theta is made from."""
MARGIN = 4
"""Columns and rows that two filters add to a patch."""


@inline
def softness(slip, radius, viscosity):
    """theta and theta2 of a body of ``radius`` cells at a rim slip and viscosity in lattice units."""
    q = (3.3 * slip * math.sqrt(2.0 * radius) / viscosity) ** (4.0 / 3.0)
    return q / (q + 4.0), q / (q + 36.0)


@kernel
def soften(slip, radius, radius_shift, viscosity, stands, theta, theta2, covering_radius):
    """theta, theta2 and r_c of every disc from its low-passed rim slip (n,); overwrites the last three (n,).

    radius (n,): r, cells;  radius_shift: A, cells²;  stands (n,): discs whose theta and theta2 serve for r_c alone.
    """
    for n in range(radius.shape[0]):
        r = radius[n]
        first, second = softness(slip[n], r, viscosity)
        theta[n] = 0.0 if stands[n] else first
        theta2[n] = 0.0 if stands[n] else second
        inset = math.sqrt(r) * (0.49 * first + 0.25 * second)
        if stands[n]:
            inset = DRAWN_IN[0] * first + DRAWN_IN[1] * second
        covering_radius[n] = max(r - inset + radius_shift / max(r, 1.0) * (1.0 - first), 0.5 * r)


@kernel
def follow_slip(rim, share, slip):
    """Low-pass of the rim slip.  rim (n, 2): sums of e (1 - e) times slip, and of e (1 - e); overwrites slip (n,)."""
    for n in range(slip.shape[0]):
        now = rim[n, 0] / rim[n, 1] if rim[n, 1] > 0.0 else 0.0
        slip[n] += share * (now - slip[n])


@inline
def filtered(before, last, here, s):
    """(s, 1 - 2 s, s) of three cells side by side, those ``before``, ``last`` and ``here``."""
    return s * (np.float64(before) + here) + (1.0 - 2.0 * s) * np.float64(last)


@inline
def filter_row(row, stride, s):
    """Filter a row (stride,) of a patch, one cell to the right, in place."""
    for i in range(stride - 1, -1, -1):
        row[i] = filtered(row[i - 2] if i > 1 else 0.0, row[i - 1] if i > 0 else 0.0, row[i], s)


@inline
def filter_cell(patch, i, j, stride, s):
    """Filter cell ``i`` of row ``j`` of a patch along y, one cell up; the rows above must have been."""
    below = patch[(j - 2) * stride + i] if j > 1 else 0.0
    last = patch[(j - 1) * stride + i] if j > 0 else 0.0
    patch[j * stride + i] = filtered(below, last, patch[j * stride + i], s)


@inline
def filter_patch(patch, height, stride, s):
    """Filter a patch (height * stride,) by (s, 1 - 2 s, s) both ways, one cell up and to the right, in place.

    The last two columns and rows must be empty before.
    """
    for j in range(height):
        filter_row(patch[j * stride : (j + 1) * stride], stride, s)
    for j in range(height - 1, -1, -1):
        for i in range(stride):
            filter_cell(patch, i, j, stride, s)


@parallel_kernel
def filter_patches(theta, theta2, patches):
    """Filter the fractions of the first bodies, those of theta (n,), twice; overwrites patches and their corners."""
    # By name: what a loop over threads writes into a member of a tuple is lost.
    corner, height, stride, start, fraction = (
        patches.corner, patches.height, patches.stride, patches.start, patches.fraction,
    )  # fmt: skip
    for n in prange(theta.shape[0]):
        if theta[n] > 0.0:
            patch = fraction[start[n] : start[n] + height[n] * stride[n]]
            filter_patch(patch, height[n], stride[n], 0.25 * theta[n])
            filter_patch(patch, height[n], stride[n], 0.25 * theta2[n])
            corner[n, 0] -= 2
            corner[n, 1] -= 2


class SoftRim:
    """Soft rims of discs.  slip (n,): low-passed, lattice units, what goes on from step to step;  theta, theta2 (n,);
    sums (n, 2): see ``follow_slip``;  stands (n,): set by the owner for discs that never move, which get sharp ones."""

    def __init__(
        self, radius: NDArray[np.floating], radius_shift: float, relaxation_time: float, theta: NDArray[np.floating]
    ) -> None:
        self.radius, self.radius_shift, self.viscosity = radius, radius_shift, (relaxation_time - 0.5) / 3
        self.theta, self.theta2 = theta, np.zeros(len(radius))
        self.stands = np.zeros(len(radius), np.bool_)
        self.slip, self.sums = np.zeros(len(radius)), np.zeros((len(radius), 2))

    def soften(self, covering_radius: NDArray[np.floating]) -> None:
        """Softness of this step; overwrites covering_radius (n,), cells."""
        soften(
            self.slip, self.radius, self.radius_shift, self.viscosity, self.stands, self.theta, self.theta2,
            covering_radius,
        )  # fmt: skip

    def filter(self, patches: Patches) -> None:
        """Filter the discs' fractions; overwrites their patches and corners."""
        filter_patches(self.theta, self.theta2, patches)

    def follow(self, patches: Patches, ny: int, periodic_y: bool, row_load: NDArray[np.floating]) -> None:
        """Store the slip of the step done."""
        sum_rim_slip(patches.corner, patches.height, ny, periodic_y, row_load, self.sums)
        self.low_pass()

    def low_pass(self) -> None:
        """Store the slip of a step whose ``sums`` there are."""
        follow_slip(self.sums, SLIP_SHARE, self.slip)
