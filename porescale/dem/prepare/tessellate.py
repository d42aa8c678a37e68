"""Seeds in a rectangle made into polygons that fill it: Voronoi cells, or Delaunay triangles.

Voronoi: the cells of seeds and of their mirror images beyond all four sides, so that the cells of the seeds themselves
end at the sides.  Delaunay: seeds whose cells reach a side are moved onto it, those at a corner of the rectangle into
the corner, so that the triangles fill it as well; many on a line are no matter.
Source: Matsushima, DEMseg tutorial II-4.2.
"""

import numpy as np
from numpy.typing import ArrayLike

from porescale.common.core.errors import Fault, InputError
from porescale.common.core.types import Floats

Corner = tuple[float, float]

FLAT = 1e-9
"""Of the rectangle's shorter side: corners as close to each other as that are one, sides as short are none."""


def voronoi(seeds: ArrayLike, lower: Corner, upper: Corner) -> list[Floats]:
    """Voronoi cell of every seed (n, 2) m in the rectangle from ``lower`` to ``upper`` (m): corners (k, 2) m each,
    counter-clockwise.  Raises InputError at a seed outside, or two in one place.
    """
    at, scale = _inside(seeds, lower, upper)
    from scipy.spatial import Voronoi  # takes longer to import than a scene to be judged

    found = Voronoi(_mirrored(at, lower, upper))
    return [_ordered(found.vertices[found.regions[found.point_region[k]]], scale) for k in range(len(at))]


def delaunay(seeds: ArrayLike, lower: Corner, upper: Corner) -> list[Floats]:
    """Delaunay triangles (3, 2) m, counter-clockwise, of the seeds (n, 2) m, those beside the sides moved onto them.

    Raises InputError as voronoi does, and where there are too few seeds to have one at each corner.
    """
    at, scale = _inside(seeds, lower, upper)
    moved = at.copy()
    low, high = np.asarray(lower, float), np.asarray(upper, float)
    for k, cell in enumerate(voronoi(at, lower, upper)):
        for axis in range(2):
            for side in (low[axis], high[axis]):
                if np.abs(cell[:, axis] - side).min() <= FLAT * scale:
                    moved[k, axis] = side
    corners = {tuple(row) for row in moved[np.all((moved == low) | (moved == high), axis=1)].tolist()}
    if len(np.unique(moved, axis=0)) < len(moved) or len(corners) < 4:
        raise InputError(Fault("seeds", len(at), "too few, or too uneven, for one at each corner of the rectangle"))
    from scipy.spatial import Delaunay  # takes longer to import than a scene to be judged

    triangles = [_ordered(moved[corner], scale) for corner in Delaunay(moved).simplices]
    return [each for each in triangles if len(each) == 3 and area(each) > FLAT * scale**2]


def area(corners: Floats) -> float:
    """Area (m^2) of a polygon (k, 2) m that goes counter-clockwise."""
    x, y = (corners - corners[0]).T
    return 0.5 * float(x @ np.roll(y, -1) - y @ np.roll(x, -1))


def shrunk(corners: Floats, by: float, shortest: float = 0.0) -> Floats | None:
    """A convex polygon (k, 2) m, counter-clockwise, with every side moved inwards ``by`` (m): corners, or None where
    nothing is left.  Sides not longer than ``shortest`` (m) become corners.
    """
    left = corners
    for a, b in zip(corners, np.roll(corners, -1, axis=0), strict=True):
        way = (b - a) / np.hypot(*(b - a))
        depth = (left - a) @ np.array([-way[1], way[0]]) - by
        kept = []
        for k in range(len(left)):
            one, other = depth[k - 1], depth[k]
            if (one > 0.0) != (other > 0.0):
                kept.append(left[k - 1] + (left[k] - left[k - 1]) * (one / (one - other)))
            if other > 0.0:
                kept.append(left[k])
        if len(kept) < 3:
            return None
        left = np.array(kept)
    left = _joined(left, max(shortest, FLAT * float(np.ptp(corners, axis=0).max())))
    return left if len(left) > 2 else None


def _inside(seeds: ArrayLike, lower: Corner, upper: Corner) -> tuple[Floats, float]:
    """The seeds and the rectangle's shorter side."""
    at = np.array(seeds, float).reshape(-1, 2)
    if not (lower[0] < upper[0] and lower[1] < upper[1]):
        raise InputError(Fault("upper", upper, "must lie right of and above lower", "m", f"> {lower}"))
    out = np.flatnonzero(~np.all((at > lower) & (at < upper), axis=1))
    if len(out) or not len(at):
        where = f"seed {out[0]} at {tuple(at[out[0]].tolist())}" if len(out) else "none"
        raise InputError(Fault("seeds", where, "must lie in the rectangle", "m"))
    if len(np.unique(at, axis=0)) < len(at):
        raise InputError(Fault("seeds", problem="two are in one place", unit="m"))
    return at, float(min(upper[0] - lower[0], upper[1] - lower[1]))


def _mirrored(at: Floats, lower: Corner, upper: Corner) -> Floats:
    """The seeds, then their images beyond the four sides, (5 n, 2)."""
    images = [at]
    for axis in range(2):
        for side in (lower[axis], upper[axis]):
            image = at.copy()
            image[:, axis] = 2.0 * side - image[:, axis]
            images.append(image)
    return np.concatenate(images)


def _ordered(corners: Floats, scale: float) -> Floats:
    """Corners of a convex polygon counter-clockwise, those that coincide once."""
    middle = corners.mean(axis=0)
    order = np.argsort(np.arctan2(*(corners - middle).T[::-1]))
    return _joined(corners[order], FLAT * scale)


def _joined(corners: Floats, shortest: float) -> Floats:
    """The corners less those at the end of sides not longer than ``shortest`` (m)."""
    kept = list(range(len(corners)))
    k = 0
    while k < len(kept) and len(kept) > 2:
        if np.hypot(*(corners[kept[k]] - corners[kept[k - 1]])) <= shortest:
            kept.pop(k)
        else:
            k += 1
    return corners[kept]
