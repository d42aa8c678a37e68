"""The grid of vectors of a picture, and a smooth displacement at every pixel from values on it."""

from dataclasses import dataclass
from functools import lru_cache
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import make_interp_spline

from porescale.common.compiled.jit import parallel_kernel, prange
from porescale.common.core.types import Floats


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
    def y(self) -> Floats:
        """Rows of centres, px."""
        return self.start + self.step * np.arange(self.shape[0], dtype=float)

    @property
    def x(self) -> Floats:
        """Columns of centres, px."""
        return self.start + self.step * np.arange(self.shape[1], dtype=float)

    def axes(self, every: int = 1) -> "tuple[Axis, Axis]":
        """Interpolation from coefficients to centres of blocks of ``every`` px a side (1: pixels), down and across."""
        down, across = (
            _axis(self.start, self.step, n, side, every) for n, side in zip(self.shape, self.size, strict=True)
        )
        return down, across

    def coefficients(self, values: Floats) -> Floats:
        """Coefficients (m, n) of the natural cubic splines through ``values`` (ny, nx), straight beyond the outer
        centres.
        """
        down, across = self.axes()
        return np.asarray(down.coefficients @ values @ across.coefficients.T)

    def both(self, u: Floats, v: Floats) -> NDArray[np.float32]:
        """``coefficients`` of u and v, (2, m, n) float32."""
        return np.stack([self.coefficients(u), self.coefficients(v)]).astype(np.float32)

    def through(self, other: "Grid", values: Floats) -> Floats:
        """The splines through ``values`` (ny, nx) at the centres of ``other``, straight beyond the outer ones."""
        (down, across), c = self.axes(), self.coefficients(values)
        rows = _matrix(down, other.y, c.shape[0])
        return np.asarray(rows @ c @ _matrix(across, other.x, c.shape[1]).T)

    def values(self, coefficients: Floats) -> Floats:
        """The splines with ``coefficients`` (m, n) at the centres: the inverse of ``coefficients`` on its image."""
        (top, left), (ny, nx) = (_before(self.start, self.step),) * 2, self.shape
        mean = np.array([1.0, 4.0, 1.0]) / 6
        rows = sum(w * coefficients[top - 1 + k : top - 1 + k + ny] for k, w in enumerate(mean))
        return np.asarray(sum(w * rows[:, left - 1 + k : left - 1 + k + nx] for k, w in enumerate(mean)))

    def at(self, other: "Grid", values: Floats) -> Floats:
        """``values`` (ny, nx) at the centres of ``other``; those of the rim beyond it, where no window has been."""
        down, across = spline_matrix(self.y, other.y), spline_matrix(self.x, other.x)
        return np.asarray(down @ values @ across.T)

    def slopes(self, values: Floats) -> tuple[Floats, Floats]:
        """Derivatives along x and y of the spline through ``values`` at the centres, per px."""
        down, across = (_slopes(self.step, n) for n in self.shape)
        return values @ across.T, down @ values


@lru_cache(maxsize=64)
def _slopes(step: int, count: int) -> Floats:
    """(count, count) matrix from values on a line of centres to the slopes of their spline there."""
    at = step * np.arange(count, dtype=float)
    return np.asarray(make_interp_spline(at, np.eye(count), 3, bc_type="natural")(at, 1))


class Axis(NamedTuple):
    """Interpolation from a line of centres to pixels: coefficients (m, n) of cubic B-splines one step apart, straight
    beyond the ends; at pixel p those from first[p] on count with weights[:, p].  at (m,) : where the B-splines are, px.
    """

    coefficients: Floats
    at: Floats
    first: NDArray[np.int64]
    weights: NDArray[np.float32]


def _matrix(axis: Axis, at: Floats, count: int) -> Floats:
    """(places, coefficients) matrix of an axis of pixels at whole pixels ``at``."""
    which = np.asarray(at).astype(int)
    found = np.zeros((len(which), count))
    for j in range(4):
        found[np.arange(len(which)), axis.first[which] + j] = axis.weights[j, which]
    return found


def nearest(own: Floats, other: Floats) -> NDArray[np.int64]:
    """Number of the value of ``own`` (rising) nearest to each of ``other``."""
    return np.asarray(np.abs(np.asarray(other)[:, None] - own).argmin(1))


def _before(room: int, step: int) -> int:
    """Coefficients beyond the outer centre, ``room`` px from the edge."""
    return max(2, -(-room // step) + 2)


@lru_cache(maxsize=64)
def _axis(start: int, step: int, count: int, side: int, every: int) -> Axis:
    """The axis of ``count`` centres from ``start`` on, ``step`` px apart, on ``side`` pixels in blocks of ``every``."""
    before, after = (_before(room, step) for room in (start, side - start - (count - 1) * step))
    solve = np.eye(count)
    if count > 2:  # natural: coefficients are straight at the ends, where they are the values
        inner = np.diag(np.full(count, 4.0)) + np.diag(np.ones(count - 1), 1) + np.diag(np.ones(count - 1), -1)
        inner[0], inner[-1] = 6 * np.eye(count)[0], 6 * np.eye(count)[-1]
        solve = np.linalg.solve(inner, 6 * np.eye(count))
    slope = (solve[1] - solve[0], solve[-1] - solve[-2]) if count > 1 else (0 * solve[0], 0 * solve[0])
    rows = [solve[0] - k * slope[0] for k in range(before, 0, -1)]
    rows += [*solve, *(solve[-1] + k * slope[1] for k in range(1, after + 1))]
    middles = (np.arange(-(-side // every)) + 0.5) * every - 0.5
    at = (middles - start) / step + before
    cell = np.floor(at).astype(np.int64)
    t = at - cell
    weights = np.array([(1 - t) ** 3, 4 - 6 * t**2 + 3 * t**3, 1 + 3 * t + 3 * t**2 - 3 * t**3, t**3]) / 6
    knots: Floats = start + (np.arange(len(rows), dtype=float) - before) * step
    return Axis(np.array(rows), knots, cell - 1, weights.astype(np.float32))


def spread(coefficients: Floats, down: Axis, across: Axis) -> NDArray[np.float32]:
    """The spline with ``coefficients`` (m, n) at the places of two axes, float32."""
    nodes = np.asarray(coefficients, np.float32)
    rows, columns = down.weights.shape[1], across.weights.shape[1]
    spare, found = np.empty((rows, nodes.shape[1]), np.float32), np.empty((rows, columns), np.float32)
    expand(nodes, down.first, down.weights, across.first, across.weights, spare, found)
    return found


@parallel_kernel
def expand(nodes, first_y, weights_y, first_x, weights_x, spare, found):
    """found[y, x] = sum_j sum_i weights_y[j, y] weights_x[i, x] nodes[first_y[y] + j, first_x[x] + i], j, i = 0 … 3.

    nodes (m, n), found (rows, columns), spare (rows, n) float32; the last two are overwritten.
    """
    for y in prange(found.shape[0]):
        k = first_y[y]
        for i in range(nodes.shape[1]):
            spare[y, i] = (
                weights_y[0, y] * nodes[k, i]
                + weights_y[1, y] * nodes[k + 1, i]
                + weights_y[2, y] * nodes[k + 2, i]
                + weights_y[3, y] * nodes[k + 3, i]
            )
        for x in range(found.shape[1]):
            k = first_x[x]
            found[y, x] = (
                weights_x[0, x] * spare[y, k]
                + weights_x[1, x] * spare[y, k + 1]
                + weights_x[2, x] * spare[y, k + 2]
                + weights_x[3, x] * spare[y, k + 3]
            )


def spline_matrix(nodes: Floats, points: Floats) -> Floats:
    """(points, nodes) matrix of interpolation: natural cubic spline, constant outside; lower order for few nodes."""
    if len(nodes) == 1:
        return np.ones((len(points), 1))
    order = 3 if len(nodes) > 3 else 1
    spline = make_interp_spline(nodes, np.eye(len(nodes)), order, bc_type="natural" if order == 3 else None)
    return np.asarray(spline(np.clip(points, nodes[0], nodes[-1])))
