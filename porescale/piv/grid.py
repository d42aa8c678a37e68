"""The grid of vectors of a picture, and a smooth displacement at every pixel from values on it."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import make_interp_spline

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Grid:
    """Centres of windows: start + k step, px, whole numbers, along both axes.

    size : rows, columns of the picture;  window : px, even;  step : px.
    """

    size: tuple[int, int]
    window: int
    step: int

    @property
    def start(self) -> int:
        """The first centre; the first window begins at the picture's edge."""
        return self.window // 2

    @property
    def shape(self) -> tuple[int, int]:
        """Rows and columns of vectors."""
        ny, nx = ((side - self.window) // self.step + 1 for side in self.size)
        return ny, nx

    @property
    def y(self) -> Array:
        """Rows of centres, px."""
        return self.start + self.step * np.arange(self.shape[0], dtype=float)

    @property
    def x(self) -> Array:
        """Columns of centres, px."""
        return self.start + self.step * np.arange(self.shape[1], dtype=float)

    def at_pixels(self, values: Array) -> NDArray[np.float32]:
        """``values`` (ny, nx) at every pixel, float32: natural cubic splines, straight beyond the outer centres."""
        down, across = (_at_pixels(self.start, self.step, n, side) for n, side in zip(self.shape, self.size, strict=True))
        return (down @ values.astype(np.float32)) @ across.T

    def at(self, other: Grid, values: Array) -> Array:
        """``values`` (ny, nx) at the centres of ``other``."""
        down, across = spline_matrix(self.y, other.y), spline_matrix(self.x, other.x)
        return np.asarray(down @ values @ across.T)

    def slopes(self, values: Array) -> tuple[Array, Array]:
        """Derivatives along x and y of the spline through ``values`` at the centres, per px."""
        h = 0.25
        across = (spline_matrix(self.x, self.x + h) - spline_matrix(self.x, self.x - h)) / (2 * h)
        down = (spline_matrix(self.y, self.y + h) - spline_matrix(self.y, self.y - h)) / (2 * h)
        return np.asarray(values @ across.T), np.asarray(down @ values)


@lru_cache(maxsize=64)
def _at_pixels(start: int, step: int, count: int, side: int) -> NDArray[np.float32]:
    """(side, count) matrix from values on a line of centres to pixels."""
    return spline_matrix(start + step * np.arange(count, dtype=float), np.arange(side, dtype=float)).astype(np.float32)


def spline_matrix(nodes: Array, points: Array) -> Array:
    """(points, nodes) matrix of interpolation: natural cubic spline, straight outside; lower order for few nodes."""
    if len(nodes) == 1:
        return np.ones((len(points), 1))
    order = 3 if len(nodes) > 3 else 1
    spline = make_interp_spline(nodes, np.eye(len(nodes)), order, bc_type="natural" if order == 3 else None)
    inside = np.clip(points, nodes[0], nodes[-1])
    found = spline(inside)
    beyond = points != inside
    if beyond.any():
        found[beyond] += (points - inside)[beyond, None] * spline(inside[beyond], 1)
    return np.asarray(found)
