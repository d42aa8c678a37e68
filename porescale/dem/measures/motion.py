"""Mean velocity, strain rate and spin of the discs of a region: the affine motion that fits them best.

    v_i ~ V + G (x_i - X),  weighted least squares;  strain rate (G + G^T)/2, rotation (G_yx - G_xy)/2.

Exact for any affine motion, so that a rigid rotation has no strain rate, which the gradient of a coarse-grained
velocity does not give where discs lie unevenly.  Source: strain-rate tensor of measurement regions, Itasca PFC
manual; in two dimensions three discs, not in a line, are the fewest.
"""

from typing import NamedTuple

import numpy as np

from porescale.common.core.types import Floats

FLAT = 1e-9
"""Discs whose second moment has a smaller ratio of principal values lie in a line: the gradient across is unknown."""


class Motion(NamedTuple):
    """velocity (2,) m/s of the weighted mean;  gradient (2, 2) 1/s, G_ab = d v_a / d x_b;  nan where unknown."""

    velocity: Floats
    gradient: Floats

    @property
    def strain_rate(self) -> Floats:
        """Symmetric part, (2, 2) 1/s; extension positive."""
        return 0.5 * (self.gradient + self.gradient.T)

    @property
    def rotation(self) -> float:
        """Mean rate of rotation, rad/s, counter-clockwise."""
        return 0.5 * float(self.gradient[1, 0] - self.gradient[0, 1])


def motion(position: Floats, velocity: Floats, weight: Floats) -> Motion:
    """The affine motion of points with ``position`` (n, 2) m, ``velocity`` (n, 2) m/s and ``weight`` (n,) >= 0."""
    total = float(weight.sum())
    unknown = np.full((2, 2), np.nan)
    if not total > 0.0:
        return Motion(np.full(2, np.nan), unknown)
    share = weight[:, None] / total
    off = position - (share * position).sum(axis=0)
    mean = (share * velocity).sum(axis=0)
    second = off.T @ (share * off)
    low, high = np.linalg.eigvalsh(second)
    if not low > FLAT * high:
        return Motion(mean, unknown)
    return Motion(mean, np.linalg.solve(second, off.T @ (share * (velocity - mean))).T)
