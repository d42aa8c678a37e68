"""Which soil particles lie near which water particles, and the kernel between them.

The kernel is the cubic spline: its sum over a square lattice of spacing h/1.3 is 1 to 0.0011 wherever the point lies,
and so are porosity and drag of water that moves through soil at rest; that of Wendland C2 is to 0.0105.
"""

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from continuum_sph.water.smoothing import CUBIC, kernel_value
from porescale.common.compiled.jit import inline, parallel_kernel, prange
from porescale.common.compiled.simd import LANES, gather_two, rint, sqrt, store
from porescale.common.core.types import Floats
from porescale.common.neighbors import PairList


@inline
def overlap_kernel(dx, dy, h, period_x, period_y, turns_x, turns_y):
    """W, 1/m², of the nearest images at (dx, dy) m;  turns: 1/period, 1/m, or 0."""
    dx -= period_x * rint(dx * turns_x)
    dy -= period_y * rint(dy * turns_y)
    return kernel_value(CUBIC, sqrt(dx * dx + dy * dy) * (1.0 / h), h)


@parallel_kernel
def overlap_weights(start, partner, x, weight, h, period_x, period_y):
    """Overwrites ``weight`` (m,) 1/m², W of every entry of a full list;  x (n, 2) m;  h: smoothing length;  periods, m
    or 0.  A step has them from `mixture.gather_soil` and `mixture.load_soil`, to the same bits; here they are made
    anew."""
    turns_x = 1.0 / period_x if period_x > 0.0 else 0.0
    turns_y = 1.0 / period_y if period_y > 0.0 else 0.0
    for i in prange(x.shape[0]):
        k = start[i]
        while k < start[i + 1]:
            xj, yj = gather_two(x, partner, k, start[i + 1], i)
            near = overlap_kernel(x[i, 0] - xj, x[i, 1] - yj, h, period_x, period_y, turns_x, turns_y)
            store(weight, k, start[i + 1], near)
            k += LANES


class Reach(NamedTuple):
    """h: smoothing length, m;  period_x, period_y: m or 0."""

    h: Any
    period_x: Any
    period_y: Any


class Overlap:
    """Rows of water particles first, with their soil partners, then rows of soil particles, with their water's.

    Partners of both are numbered as in ``x`` (water + soil, 2) m: soil from ``water`` on.  start, partner: the list;
    weight : (m + spare,) 1/m², W of each entry, and room for a whole vector at the last.  Pairs within a layer are not
    listed.
    """

    def __init__(
        self,
        water: int,
        soil: int,
        length: float,
        skin: float,
        lower: tuple[float, float],
        upper: tuple[float, float],
        periodic: tuple[bool, bool] = (False, False),
    ) -> None:
        self.water, self.length = water, length
        self.pairs = PairList(water + soil, skin, lower, upper, periodic, full=True, between=water)
        self.pairs.adaptive = True
        self.x = np.zeros((water + soil, 2))
        self.reach = np.full(water + soil, length)
        self.weight = np.zeros(0)

    def update(self, water: Floats, soil: Floats) -> bool:
        """Take positions (n, 2) m of both layers; lists follow, and room for the weights.  Whether lists are new."""
        self.x[: self.water], self.x[self.water :] = water, soil
        new = self.pairs.update(self.x, self.reach)
        self._make_room()
        return new

    def restore(self, state: dict[str, NDArray[np.generic]], water: Floats, soil: Floats) -> None:
        """Go on from the ``state`` of the list, taken at these positions (n, 2) m: it holds, and nothing is counted."""
        pairs = self.pairs
        pairs.restore(state)
        self.x[: self.water], self.x[self.water :] = water, soil
        self._make_room()
        overlap_weights(pairs.start, pairs.partner, self.x, self.weight, self.length, *pairs.period)

    def _make_room(self) -> None:
        """Enlarge ``weight`` where the list has outgrown it."""
        if len(self.weight) < len(self.pairs.partner) + LANES:
            self.weight = np.zeros(len(self.pairs.partner) * 3 // 2 + LANES)

    @property
    def rows(self) -> tuple[NDArray[np.int64], NDArray[np.int32], Floats]:
        """The list with its weights: start (n + 1,), partner (pairs,) and weight (pairs,) of the kernel."""
        return self.pairs.start, self.pairs.partner, self.weight
