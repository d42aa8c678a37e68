"""A rectangle in which something is measured, and what of discs and of contacts lies within it, periodic images too.

A ``period`` is (width, height) m, 0 where not periodic, or (width, height, tilt) where the image one height up lies
``tilt`` to the right: see ``Grains.period``.
"""

import math
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from porescale.common.core.errors import Fault, InputError
from porescale.common.core.types import Floats

Period = tuple[float, float] | tuple[float, float, float]


def edges_of(period: Period) -> tuple[float, float, float]:
    """Width, height and tilt (m) of ``period``; the tilt is 0 where not given."""
    return (*period, 0.0) if len(period) == 2 else period


@dataclass(frozen=True)
class Region:
    """Corners, m: lower left and upper right."""

    lower: tuple[float, float]
    upper: tuple[float, float]

    def __post_init__(self) -> None:
        numbers = (*self.lower, *self.upper)
        if not all(math.isfinite(it) for it in numbers) or not all(
            a < b for a, b in zip(self.lower, self.upper, strict=True)
        ):
            problem = "must lie right of and above the lower corner"
            raise InputError(Fault("region.upper", str(self.upper), problem, "m", f"> {self.lower}"))

    @property
    def size(self) -> tuple[float, float]:
        """Width and height, m."""
        return self.upper[0] - self.lower[0], self.upper[1] - self.lower[1]

    @property
    def area(self) -> float:
        """Area of the region, m²."""
        width, height = self.size
        return width * height

    def near(self, points: Floats, period: Period) -> Floats:
        """The images (n, 2) m of ``points`` within a period of the lower corner; themselves where not periodic."""
        moved = np.array(points, dtype=np.float64)
        width, height, tilt = edges_of(period)
        for axis, length in ((1, height), (0, width)):
            if length > 0.0:
                turns = np.floor((moved[:, axis] - self.lower[axis]) / length)
                moved[:, axis] -= length * turns
                if axis == 1 and tilt != 0.0:
                    moved[:, 0] -= tilt * turns
                beyond = moved[:, axis] >= self.lower[axis] + length  # a tiny negative number less the floor of it
                moved[beyond, axis] = self.lower[axis]
        return moved

    def about(self, points: Floats, period: Period) -> Floats:
        """The images (n, 2) m of ``points`` nearest to the middle, so that what reaches in lies beside the region."""
        width, height, _ = edges_of(period)
        x, y = (0.5 * (a + b) for a, b in zip(self.lower, self.upper, strict=True))
        return Region((x - 0.5 * width, y - 0.5 * height), (x + width + 1.0, y + height + 1.0)).near(points, period)

    def shifts(self, low: Floats, high: Floats, period: Period) -> Iterator[Floats]:
        """Whole periods (2,) m by which something between corners ``low`` and ``high`` (n, 2) m may have to be moved
        to reach into the region: (0, 0) alone where nothing is periodic."""
        width, height, tilt = edges_of(period)
        for up in self._turns(1, low, high, height, 0.0):
            for along in self._turns(0, low, high, width, up * tilt):
                yield np.array([along * width + up * tilt, up * height])

    def _turns(self, axis: int, low: Floats, high: Floats, length: float, moved: float) -> range:
        """How many whole periods along ``axis`` something may have to be moved that was ``moved`` (m) before."""
        if length == 0.0 or len(low) == 0:
            return range(1)
        first = math.ceil((self.lower[axis] - moved - float(high[:, axis].max())) / length)
        return range(first, math.floor((self.upper[axis] - moved - float(low[:, axis].min())) / length) + 1)

    def holds(self, points: Floats, period: Period = (0.0, 0.0)) -> NDArray[np.bool_]:
        """Which points (n, 2) m, or images of them, lie inside or on the lower and left edges, (n,) bool."""
        at = self.near(points, period)
        return np.asarray(np.all((at >= self.lower) & (at < self.upper), axis=1))

    def share_of_branch(self, start: Floats, branch: Floats, period: Period = (0.0, 0.0)) -> Floats:
        """Share (n,) of the segments from ``start`` (n, 2) m along ``branch`` (n, 2) m that lies inside.

        Clipping after Liang & Barsky, ACM Trans. Graphics 3 (1984) 1; shares of all periodic images add up.
        """
        start = self.near(start, period)
        end = start + branch
        total = np.zeros(len(start))
        for shift in self.shifts(np.minimum(start, end), np.maximum(start, end), period):
            enters, leaves = np.zeros(len(start)), np.ones(len(start))
            for axis in range(2):
                along, at = branch[:, axis], start[:, axis] + shift[axis]
                level = along == 0.0
                step = np.where(level, 1.0, along)
                ends = ((self.lower[axis] - at) / step, (self.upper[axis] - at) / step)
                inside = (at >= self.lower[axis]) & (at < self.upper[axis])
                enters = np.maximum(enters, np.where(level, np.where(inside, 0.0, 2.0), np.minimum(*ends)))
                leaves = np.minimum(leaves, np.where(level, 1.0, np.maximum(*ends)))
            total += np.maximum(leaves - enters, 0.0)
        return total
