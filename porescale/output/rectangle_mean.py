"""Means over a rectangle of what cells hold."""

import numpy as np

from porescale.common.core.types import Floats, Reals
from porescale.output.sample import NOTHING

Corner = tuple[float, float]


class RectangleMean:
    """Means over the fluid in a rectangle from ``lower`` to ``upper`` (m) of a lattice of ``cells`` (nx, ny) with
    ``spacing`` (m): a cell counts with the part of it that is in the rectangle times the share of it that is fluid.

    x (columns,), y (rows,): middles of those parts, m.
    """

    def __init__(self, lower: Corner, upper: Corner, cells: tuple[int, int], spacing: float) -> None:
        parts = [_parts(low / spacing, high / spacing, count)
                 for low, high, count in zip(lower, upper, cells, strict=True)]  # fmt: skip
        (columns, wide, x), (rows, high, y) = parts
        self.where = rows, columns
        self.weight = high[:, None] * wide[None, :]
        self.x, self.y = x * spacing, y * spacing

    def of(self, solid: Reals, *fields: Reals) -> list[float]:
        """The share of the rectangle that is fluid, and the mean of each of the ``fields`` over it; nan without any.

        solid (ny, nx): share of each cell that is solid;  fields (ny, nx), or (rows, columns) of the rectangle.
        """
        free = self.weight * np.clip(1.0 - solid[self.where], 0.0, 1.0)
        total = float(free.sum())
        share = total / float(self.weight.sum())
        if share <= NOTHING:
            return [share, *(float("nan") for _ in fields)]
        own = [it if it.shape == free.shape else it[self.where] for it in fields]
        return [share, *(float((free * it).sum()) / total for it in own)]


def _parts(low: float, high: float, count: int) -> tuple[slice, Floats, Floats]:
    """Which of ``count`` cells lie between low and high (cells), how much of each, and the middles of those parts."""
    first, last = max(0, int(np.floor(low + 1e-9))), min(count, int(np.ceil(high - 1e-9)))
    edges = np.clip(np.arange(first, last + 1, dtype=float), low, high)
    return slice(first, last), np.diff(edges), 0.5 * (edges[:-1] + edges[1:])
