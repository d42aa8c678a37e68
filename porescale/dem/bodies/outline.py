"""Points against bodies of segments: how far they are from the sides, and whether an outline holds them."""

import numpy as np
from numpy.typing import NDArray

from porescale.common.core.types import Floats


def from_sides(points: Floats, sides: Floats) -> tuple[Floats, Floats]:
    """Distance (n,) m of points (n, 2) m from the nearest of sides (s, 2, 2) m, end to end, and the way (n, 2) m from
    there."""
    nearest, ways = np.full(len(points), np.inf), np.zeros((len(points), 2))
    for a, b in sides:
        along, gone = b - a, points - a
        share = np.clip(gone @ along / float(along @ along), 0.0, 1.0)
        way = gone - share[:, None] * along
        distance = np.hypot(*way.T)
        nearer = distance < nearest
        nearest[nearer], ways[nearer] = distance[nearer], way[nearer]
    return nearest, ways


def within_outline(points: Floats, outline: Floats) -> NDArray[np.bool_]:
    """Which points (n, 2) m lie within the polygon with corners ``outline`` (k, 2) m, by the parity of sides above."""
    inside = np.zeros(len(points), bool)
    x, y = points.T
    for (ax, ay), (bx, by) in zip(outline, np.roll(outline, -1, axis=0), strict=True):
        spans = (ax > x) != (bx > x)
        if ax != bx:
            inside ^= spans & (y < ay + (by - ay) * (x - ax) / (bx - ax))
    return inside
