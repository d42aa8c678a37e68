"""Values of the fluid at points between the centres of cells."""

import numpy as np
from numpy.typing import ArrayLike

from porescale.common.core.types import AnyArray

NOTHING = 1e-6
"""Share of fluid below which a point counts as solid: solid fractions are written in single precision."""


class Sampler:
    """Bilinear interpolation at fixed ``points`` (n, 2) m of a lattice of ``cells`` (nx, ny) with ``spacing``, m.

    Across a periodic side it goes on with the cells of the other; at any other side the centre next to it counts.
    """

    def __init__(
        self, points: ArrayLike, cells: tuple[int, int], spacing: float, periodic: tuple[bool, bool] = (False, False)
    ) -> None:
        self.points = np.asarray(points, float).reshape(-1, 2)
        places = self.points / spacing - 0.5  # in cells, from the first centre
        low, share = [], []
        for axis in range(2):
            at, last = places[:, axis], cells[axis] - 1
            at = at if periodic[axis] else np.clip(at, 0, last)
            below = np.floor(at)
            if not periodic[axis]:
                below = np.minimum(below, max(last - 1, 0))
            low.append(below.astype(np.int64))
            share.append(at - below)
        (x, y), (sx, sy) = low, share
        nx, ny = cells
        self._index = np.stack([((y + j) % ny) * nx + (x + i) % nx for j in (0, 1) for i in (0, 1)])  # (4, n)
        self._weight = np.stack([(sy if j else 1 - sy) * (sx if i else 1 - sx) for j in (0, 1) for i in (0, 1)])

    def of(self, values: AnyArray) -> AnyArray:
        """Interpolated ``values`` (ny, nx), (n,)."""
        return np.asarray((values.reshape(-1)[self._index] * self._weight).sum(axis=0))

    def in_fluid(self, values: AnyArray, solid: AnyArray) -> AnyArray:
        """Interpolated ``values`` (ny, nx), (n,), weighted by the fluid share 1 - ``solid`` (ny, nx) of cells.

        Not a number where all four cells are solid: inside grains there is none.
        """
        weight = self._weight * np.clip(1 - solid.reshape(-1)[self._index], 0, 1)
        total = weight.sum(axis=0)
        value = (values.reshape(-1)[self._index] * weight).sum(axis=0)
        return np.asarray(np.divide(value, total, out=np.full_like(value, np.nan, float), where=total > NOTHING))


def along(start: tuple[float, float], end: tuple[float, float], count: int) -> AnyArray:
    """``count`` points from start to end, both included, (count, 2) m."""
    share = np.linspace(0, 1, count)[:, None]
    return np.asarray((1 - share) * np.asarray(start) + share * np.asarray(end))


def midpoints(start: tuple[float, float], end: tuple[float, float], count: int) -> AnyArray:
    """Centres of ``count`` equal pieces between start and end, (count, 2) m."""
    share = (np.arange(count)[:, None] + 0.5) / count
    return np.asarray((1 - share) * np.asarray(start) + share * np.asarray(end))
