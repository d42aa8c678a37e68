"""What lies outside the ground: places of a lattice over the whole tank, each covered by soil, under water or in air.

A place is covered where soil fills more than half of a kernel about it.  Others are under water where they lie below
the level of a reservoir and are connected with its strip through such places; the rest is air.  Open water is at rest:
its head is the level.  Where it stands over the crest it stands on both sides.
"""

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from continuum_sph.seepage.overlap import Overlap
from continuum_sph.water.smoothing import CUBIC, kernel_value
from porescale.common.compiled.jit import parallel_kernel, prange
from porescale.common.core.types import Floats
from porescale.common.neighbors.cells import minimum_image

COVERED, AIR = -1, 0
"""Kinds of places; water has the number of its reservoir, from 1 on."""
HALF = 0.5
PX, PY, LEVEL, KIND = range(4)
"""Columns of places: m, m; head of the water there, m; kind."""


class Outer(NamedTuple):
    """start (n + 1,), partner (m,): rows of the soil in a list of places and soil;  places (k, 4)."""

    start: Any
    partner: Any
    places: Any


@parallel_kernel
def cover(count, start, partner, x, volume, covered, h, period_x, period_y):
    """Overwrites ``covered`` (count,) with Σ V W of soil about each place.

    start, partner: a list of places and soil, whose places x (count + s, 2) m are;  volume (s,) m²;  h: smoothing
    length;  periods, m or 0.
    """
    for i in prange(count):
        total = 0.0
        for k in range(np.uint64(start[i]), np.uint64(start[i + 1])):
            j = np.uint64(partner[k])
            dx = minimum_image(x[i, 0] - x[j, 0], period_x)
            dy = minimum_image(x[i, 1] - x[j, 1], period_y)
            total += volume[j - np.uint64(count)] * kernel_value(CUBIC, np.sqrt(dx * dx + dy * dy) / h, h)
        covered[i] = total


@dataclass
class Level:
    """Water over a strip from ``left`` to ``right`` and above ``bottom`` (m), kept at ``levels`` (k,) m at ``times``
    (k,) s, straight lines between."""

    name: str
    left: float
    right: float
    bottom: float
    times: Floats
    levels: Floats

    def at(self, time: float) -> float:
        """Level (m) at a ``time`` (s)."""
        return float(np.interp(time, self.times, self.levels))


@dataclass
class Outside:
    """Places (k, 2) m on a lattice of ``rows`` by ``columns``, bottom row first, of a ``spacing`` (m).

    overlap : of places, first, and soil;  levels : reservoirs, by number less 1.
    """

    x: Floats
    rows: int
    columns: int
    spacing: float
    overlap: Overlap
    levels: Sequence[Level]
    places: Floats = field(init=False)
    covered: Floats = field(init=False)  # (k,) share of a kernel about each that soil fills

    def __post_init__(self) -> None:
        assert len(self.x) == self.rows * self.columns
        self.places, self.covered = np.zeros((len(self.x), 4)), np.zeros(len(self.x))
        self.places[:, :2] = self.x

    def look(self, soil: Floats, volume: Floats, time: float) -> None:
        """Find what every place is at a ``time`` (s), from ``soil`` (s, 2) m of a ``volume`` (s,) m²."""
        self.overlap.update(self.x, soil)
        self.see(volume, time)

    def see(self, volume: Floats, time: float) -> None:
        """What `look` does, of soil where it was seen last."""
        overlap, pairs = self.overlap, self.overlap.pairs
        cover(len(self.x), pairs.start, pairs.partner, overlap.x, volume, self.covered, overlap.length, *pairs.period)
        self.kinds(self.covered <= HALF, time)

    def kinds(self, free: NDArray[np.bool_], time: float) -> None:
        """Set the kinds of places, of which those ``free`` (k,) of soil are known."""
        from scipy.ndimage import label  # takes longer to import than a scene to be judged

        x, places = self.x, self.places
        places[:, KIND] = np.where(free, AIR, COVERED)
        places[:, LEVEL] = 0.0
        for number, pool in enumerate(self.levels, 1):
            height = pool.at(time)
            below = free & (x[:, 1] < height) & (places[:, KIND] == AIR)
            strip = below & (x[:, 0] > pool.left) & (x[:, 0] < pool.right) & (x[:, 1] > pool.bottom)
            parts, _ = label(below.reshape(self.rows, self.columns))
            found = parts.ravel()
            joined = np.isin(found, np.unique(found[strip])) & below
            places[joined, KIND], places[joined, LEVEL] = number, height

    @property
    def outer(self) -> Outer:
        """What kernels over soil take of it."""
        pairs = self.overlap.pairs
        return Outer(pairs.start[len(self.x) :], pairs.partner, self.places)
