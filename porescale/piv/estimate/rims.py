"""Rims of solids that stand still, where a viscous flow does too: data for a fit beyond what pictures show.

A rim runs between a solid pixel and its fluid neighbours, half a pixel from the middles of both.
"""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from scipy.sparse import csr_matrix

from porescale.common.core.types import Flags, Singles
from porescale.piv.estimate.grid import Grid

WEIGHT = 3.0
"""Square px of the fluid that a point of a rim, about one a px, weighs as much as: a spot's width."""


class Rims(NamedTuple):
    """values (points, coefficients) : from the coefficients of a fit, row by row, to its values at the rims' points."""

    values: csr_matrix

    def pulled(self, p: Singles) -> Singles:
        """Sum over points of the weights that carry coefficients p (m, n) to a point times p's value there."""
        return np.asarray(self.values.T @ (self.values @ p.ravel()), np.float32).reshape(p.shape)

    def diagonal(self, shape: tuple[int, int]) -> Singles:
        """Squared weights summed over points, (m, n)."""
        return np.asarray(self.values.multiply(self.values).sum(0), np.float32).reshape(shape)


def rims(grid: Grid, masks: Sequence[Flags | None]) -> Rims | None:
    """Rims that both pictures show at one place; None where there are none."""
    if any(mask is None for mask in masks):
        return None
    edges = [[_edges(mask, axis) for axis in (0, 1)] for mask in masks if mask is not None]
    x, y = [], []
    for axis in (0, 1):
        rows, columns = np.nonzero(np.logical_and.reduce([both[axis] for both in edges]))
        y.append(rows + (0.5 if axis == 0 else 0.0))
        x.append(columns + (0.5 if axis == 1 else 0.0))
    at_x, at_y = np.concatenate(x), np.concatenate(y)
    if not len(at_x):
        return None
    down, across = grid.axes()
    n = across.at.size
    which, parts, first = [], [], []
    for line, at in ((down, at_y), (across, at_x)):
        place = (at - line.at[0]) / grid.step
        cell = np.floor(place).astype(np.int64)
        t = place - cell
        first.append(cell - 1)
        parts.append(np.array([(1 - t) ** 3, 4 - 6 * t**2 + 3 * t**3, 1 + 3 * t + 3 * t**2 - 3 * t**3, t**3]) / 6)
    weights = []
    for j in range(4):
        for i in range(4):
            which.append((first[0] + j) * n + first[1] + i)
            weights.append(parts[0][j] * parts[1][i])
    points = np.tile(np.arange(len(at_x)), 16)
    shape = (len(at_x), down.at.size * n)
    return Rims(csr_matrix((np.concatenate(weights).astype(np.float32), (points, np.concatenate(which))), shape=shape))


def _edges(mask: Flags, axis: int) -> Flags:
    """Whether a pixel and the next along ``axis`` are of two kinds."""
    return np.asarray(np.diff(mask.astype(np.int8), axis=axis) != 0, bool)
