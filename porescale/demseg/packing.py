"""Random discs of mode 0, spread evenly: as many, and as large ones, everywhere in the domain.

Places and radii drawn independently would differ by a tenth from strip to strip, and a pile settled from them would
lean.  So places are drawn one from each of as many equal parts of the domain as there are discs, and radii in groups of
neighbours, each of which has one from each of GROUP equal shares of all radii (stratified sampling).
"""

import math

import numpy as np

from porescale.common.core.types import Floats

GROUP = 16
"""Discs that have one radius of each share: about four by four neighbours."""


def even_start(radius: Floats, size: tuple[float, float], rng: np.random.Generator) -> tuple[Floats, Floats]:
    """Places (n, 2) in a box from the origin to ``size``, not yet without overlap, and the radii (n,) of the discs
    there: those of ``radius`` in another order."""
    count, (width, height) = len(radius), size
    rows = max(round(math.sqrt(count * height / width)), 1)
    row = np.arange(count) * rows // count
    many = np.bincount(row, minlength=rows)
    place = np.arange(count) - (np.cumsum(many) - many)[row]
    drawn = rng.uniform(size=(count, 2))
    start = np.column_stack(((place + drawn[:, 0]) / many[row] * width, (row + drawn[:, 1]) / rows * height))
    own = np.empty(count)
    own[_neighbours(start, size)] = _mixed(radius, rng)
    return start, own


def _neighbours(start: Floats, size: tuple[float, float]) -> np.ndarray:
    """Numbers of the discs column by column, about four discs wide, each from below: runs of GROUP lie together."""
    columns = max(round(math.sqrt(len(start) / GROUP * size[0] / size[1])), 1)
    parts = np.array_split(np.argsort(start[:, 0], kind="stable"), columns)
    return np.concatenate([part[np.argsort(start[part, 1], kind="stable")] for part in parts])


def _mixed(radius: Floats, rng: np.random.Generator) -> Floats:
    """The radii in an order in which each run of GROUP has one of each of GROUP shares, as long as they last."""
    shares = [rng.permutation(part) for part in np.array_split(np.sort(radius), GROUP)]
    runs = [rng.permutation([part[k] for part in shares if k < len(part)]) for k in range(len(shares[0]))]
    return np.concatenate(runs)
