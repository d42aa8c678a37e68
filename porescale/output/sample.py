"""Values of the fluid at points between the centres of cells."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike

from porescale.common.core.types import AnyArray

NOTHING = 1e-6
"""Share of fluid below which a point counts as solid: solid fractions are written in single precision."""
OPEN = 0.5
"""Solid fraction below which a cell tells the pressure at a surface: that of one nearly full is not the fluid's."""
FLAT = 1e-9
"""Of the weight of all cells: that of a plane without slope, which decides only where cells in a line say nothing."""


class Sampler:
    """Bilinear interpolation at fixed ``points`` (n, 2) m of a lattice of ``cells`` (nx, ny) with ``spacing``, m.

    Across a periodic side it goes on with the cells of the other.  Any other side lies half a cell outside the centres
    next to it; between them what ``of`` gives is that of the centre, ``to_sides`` and ``in_fluid`` go on to the side.
    """

    def __init__(
        self, points: ArrayLike, cells: tuple[int, int], spacing: float, periodic: tuple[bool, bool] = (False, False)
    ) -> None:
        self.points = np.asarray(points, float).reshape(-1, 2)
        places = self.points / spacing - 0.5  # in cells, from the first centre
        low, share, self._beyond = [], [], []
        for axis in range(2):
            at, last = places[:, axis], cells[axis] - 1
            self._beyond += (
                [np.zeros_like(at)] * 2 if periodic[axis] else [np.clip(it, 0, 0.5) for it in (-at, at - last)]
            )
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
        self._low, self._share, self._cells, self._periodic = np.array((x, y)), np.array((sx, sy)), cells, periodic
        centres = (np.array((x + sx, y + sy)).T + 0.5) * spacing  # of what is beyond the outermost ones
        self._inner = []  # per side: its points, how far beyond, and as many points a cell further in
        for side, beyond in enumerate(self._beyond):
            which = np.flatnonzero(beyond > NOTHING)
            if len(which) and cells[side // 2] > 1:
                inwards = centres[which]
                inwards[:, side // 2] += -spacing if side % 2 else spacing
                self._inner.append((which, beyond[which], Sampler(inwards, cells, spacing, periodic)))

    def of(self, values: AnyArray) -> AnyArray:
        """Interpolated ``values`` (ny, nx), (n,)."""
        return np.asarray((values.reshape(-1)[self._index] * self._weight).sum(axis=0))

    def to_sides(self, values: AnyArray, known: Sequence[float | None], solid: AnyArray) -> AnyArray:
        """As ``of``; from the outermost centres linear up to what is ``known`` of fluid at the left, right, bottom and
        top side (None: as at the centre), and by that share of it that is not ``solid`` (ny, nx)."""
        found, fluid = self.of(values), 1 - self.of(solid)
        for beyond, value in zip(self._beyond, known, strict=True):
            if value is not None:
                found = np.where(beyond > 0, found + 2 * beyond * fluid * (value - found), found)
        return np.asarray(found)

    def in_fluid(self, values: AnyArray, solid: AnyArray) -> AnyArray:
        """``values`` (ny, nx) of the fluid, (n,), with the ``solid`` fraction (ny, nx) of cells.

        Bilinear where all four cells are fluid.  At a surface, that of the plane through the open ones of the 16 cells
        around the point which are joined to its four (least squares): exact for a plane, so of second order.  Where
        none of the four is open, their mean by fluid share.  Not a number where all four are solid: inside grains there
        is none.  Between the outermost centres and a side it goes on with the slope of the last cell, if all is fluid.
        """
        covered = solid.reshape(-1)[self._index]
        weight = self._weight * np.clip(1 - covered, 0, 1)
        total = weight.sum(axis=0)
        value = (values.reshape(-1)[self._index] * weight).sum(axis=0)
        value = np.divide(value, total, out=np.full_like(value, np.nan, float), where=total > NOTHING)
        counts = self._weight > NOTHING
        edge = np.flatnonzero(((covered > NOTHING) & counts).any(0) & ((covered < OPEN) & counts).any(0))
        if len(edge):
            value[edge] = self._plane(edge, values, solid)
        found = value.copy()
        for which, beyond, inner in self._inner:
            clear = self._clear(solid)[which] & inner._clear(solid)
            slope = np.where(clear, value[which] - inner.of(values), 0.0)
            found[which] += beyond * slope
        return np.asarray(found)

    def _clear(self, solid: AnyArray) -> AnyArray:
        """Whether there is no solid in what each point reads, (n,)."""
        return np.asarray(((solid.reshape(-1)[self._index] <= NOTHING) | (self._weight <= NOTHING)).all(axis=0))

    def _plane(self, which: AnyArray, values: AnyArray, solid: AnyArray) -> AnyArray:
        """Least squares over 4 x 4 cells about each point of the numbers ``which``, each with an open cell of four.

        Weights fall as the square of those that would be bilinear: a field that bends by c/h² along a surface puts the
        plane off by 0.33 c to 0.45 c, in place of 0.5 c to 0.75 c.
        """
        around = np.arange(-1, 3)
        (x, y), (sx, sy) = self._low[:, which, None] + around, self._share[:, which, None]
        nx, ny = self._cells
        inside = [self._periodic[a] | ((at >= 0) & (at < n)) for a, (at, n) in enumerate(((x, nx), (y, ny)))]
        place = (y % ny)[:, :, None] * nx + (x % nx)[:, None, :]
        covered = solid.reshape(-1)[place]
        is_open = (covered < OPEN) & inside[1][:, :, None] & inside[0][:, None, :]
        joined = np.zeros_like(is_open)
        joined[:, 1:3, 1:3] = is_open[:, 1:3, 1:3]
        for _ in range(4):  # from the middle to a corner, around a cell
            grown = joined.copy()
            grown[:, 1:] |= joined[:, :-1]
            grown[:, :-1] |= joined[:, 1:]
            grown[:, :, 1:] |= joined[:, :, :-1]
            grown[:, :, :-1] |= joined[:, :, 1:]
            joined = grown & is_open
        dx, dy = around - sx, around - sy
        near = ((2 - np.abs(dy))[:, :, None] * (2 - np.abs(dx))[:, None, :]) ** 2
        weight = (joined * near * (1 - covered) ** 2).reshape(len(which), -1)
        one = np.ones_like(place, float)
        basis = np.stack([one, one * dx[:, None, :], one * dy[:, :, None]], -1).reshape(len(which), -1, 3)
        normal = np.einsum("nk,nki,nkj->nij", weight, basis, basis)
        normal += FLAT * weight.sum(1)[:, None, None] * np.diag([0.0, 1.0, 1.0])
        right = np.einsum("nk,nk,nki->ni", weight, values.reshape(-1)[place].reshape(len(which), -1), basis)
        return np.asarray(np.linalg.solve(normal, right[:, :, None])[:, 0, 0])


def along(start: tuple[float, float], end: tuple[float, float], count: int) -> AnyArray:
    """``count`` points from start to end, both included, (count, 2) m."""
    share = np.linspace(0, 1, count)[:, None]
    return np.asarray((1 - share) * np.asarray(start) + share * np.asarray(end))


def midpoints(start: tuple[float, float], end: tuple[float, float], count: int) -> AnyArray:
    """Centres of ``count`` equal pieces between start and end, (count, 2) m."""
    share = (np.arange(count)[:, None] + 0.5) / count
    return np.asarray((1 - share) * np.asarray(start) + share * np.asarray(end))
