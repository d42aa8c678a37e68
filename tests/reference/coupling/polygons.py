"""Areas of convex polygons in cells by clipping, in rational numbers: exact, slow, obvious."""

from fractions import Fraction

import numpy as np


def clipped(corners, inside, crossing):
    """The part of a polygon (list of points) on one side of a line (Sutherland & Hodgman 1974)."""
    found = []
    for one, other in zip(corners, corners[1:] + corners[:1], strict=True):
        if inside(one):
            found.append(one)
        if inside(one) != inside(other):
            found.append(crossing(one, other))
    return found


def area(corners):
    """Of a polygon, counterclockwise, by the shoelace formula."""
    following = corners[1:] + corners[:1]
    return sum((a[0] * b[1] - a[1] * b[0] for a, b in zip(corners, following, strict=True)), Fraction(0)) / 2


def at_level(axis, level):
    """Where the way from one point to another meets a coordinate's level."""

    def crossing(one, other):
        share = (level - one[axis]) / (other[axis] - one[axis])
        return tuple(a + share * (b - a) for a, b in zip(one, other, strict=True))

    return crossing


def in_cell(corners, x, y):
    """Area of a convex polygon within the cell with its lower left corner at (x, y)."""
    left = list(corners)
    for axis, low in ((0, x), (1, y)):
        left = clipped(left, lambda p, a=axis, v=low: p[a] >= v, at_level(axis, low))
        left = clipped(left, lambda p, a=axis, v=low + 1: p[a] <= v, at_level(axis, low + 1))
    return area(left) if left else Fraction(0)


def fractions_of(corners, nx, ny):
    """Areas of a convex polygon (k, 2), counterclockwise, within the cells of a box, (ny, nx)."""
    exact = [(Fraction(float(x)), Fraction(float(y))) for x, y in corners]
    return np.array([[float(in_cell(exact, x, y)) for x in range(nx)] for y in range(ny)])
