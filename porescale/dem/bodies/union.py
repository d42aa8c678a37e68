"""Area, centroid and second moment of a union of discs, exact, by Green's theorem over its outline.

The outline is made of arcs: of every circle the part that lies in no other disc.  Over an arc of centre c and radius r
from angle a to b, with dx = -r sin t dt, dy = r cos t dt, the boundary integrals
    A = 1/2 (x dy - y dx),     A x = 1/2 x^2 dy,     A y = -1/2 y^2 dx,     J = 1/3 (x^3 dy - y^3 dx)
have closed forms; J = integral of x^2 + y^2.  The only error is round-off.
"""

import math
from typing import NamedTuple

import numpy as np

from porescale.common.core.types import Floats

NEAR_TOUCH = 0.99
"""Cosine from which on an angle is not taken from it: its error is eps/sin there, 7 eps."""


class Outline(NamedTuple):
    """Area, centroid and polar second moment about it, and how much of it every disc shows."""

    area: float  # m^2
    centroid: Floats  # (2,) m
    second_moment: float  # m^4
    exposed: Floats  # (k,) length of each disc's part of the outline, m


def outline(position: Floats, radius: Floats) -> Outline:
    """The union of discs at ``position`` (k, 2) m with ``radius`` (k,) m.  Two equal discs in one place count once."""
    origin = position.mean(axis=0)
    scale = float(radius.max())
    at, size = (position - origin) / scale, radius / scale
    area = second = 0.0
    first = np.zeros(2)
    exposed = np.zeros(len(size))
    for i in range(len(size)):
        for a, b in arcs(i, at, size):
            part = _arc(float(at[i, 0]), float(at[i, 1]), float(size[i]), a, b)
            area += part[0]
            first += part[1:3]
            second += part[3]
            exposed[i] += (b - a) * float(size[i]) * scale
    centroid = first / area
    return Outline(
        area * scale**2, origin + scale * centroid, (second - area * float(centroid @ centroid)) * scale**4, exposed
    )


def arcs(i: int, at: Floats, size: Floats) -> list[tuple[float, float]]:
    """Angles (from, to) of the arcs of circle i that lie in no other disc."""
    covered: list[tuple[float, float]] = []
    for j in range(len(size)):
        if j == i:
            continue
        way = at[j] - at[i]
        distance = math.hypot(*way)
        if distance + size[i] <= size[j] and (distance > 0.0 or size[i] < size[j] or j < i):
            return []  # wholly inside of j, or the second of two equal ones
        if distance >= size[i] + size[j] or distance + size[j] <= size[i]:
            continue
        half, towards = _half_angle(distance, float(size[i]), float(size[j])), math.atan2(way[1], way[0])
        low = (towards - half) % (2.0 * math.pi)
        high = low + 2.0 * half
        covered.append((low, min(high, 2.0 * math.pi)))
        if high > 2.0 * math.pi:
            covered.append((0.0, high - 2.0 * math.pi))
    free, reached = [], 0.0
    for low, high in sorted(covered):
        if low > reached:
            free.append((reached, low))
        reached = max(reached, high)
    if reached < 2.0 * math.pi:
        free.append((reached, 2.0 * math.pi))
    return free


def _half_angle(d: float, r: float, other: float) -> float:
    """Half of the angle (rad) under which the centre of a circle of radius ``r`` sees the chord that it has in common
    with one of radius ``other``, ``d`` away.

    Near a touch its cosine has no digits left, and the two circles would not agree on the ends of their chord.  There
    both legs give it: half a chord is 1/(2 d) times the root of Heron's product of the three lengths.
    """
    adjacent = d**2 + r**2 - other**2
    cosine = adjacent / (2.0 * d * r)
    if abs(cosine) < NEAR_TOUCH:
        return math.acos(cosine)
    product = (r + other - d) * (d + r + other) * (d + r - other) * (d - r + other)
    return math.atan2(math.sqrt(max(product, 0.0)), adjacent)


def _arc(x: float, y: float, r: float, a: float, b: float) -> Floats:
    """Contributions of one arc: area, both first moments about the origin, polar second moment about it."""
    turn, sine, cosine = b - a, math.sin(b) - math.sin(a), math.cos(b) - math.cos(a)
    double, fourfold = math.sin(2.0 * b) - math.sin(2.0 * a), math.sin(4.0 * b) - math.sin(4.0 * a)
    # Integrals of the first four powers of cos, and of sin; 3 turn/8 and its like are those of the even ones.
    c = sine, 0.5 * turn + 0.25 * double, sine - (math.sin(b) ** 3 - math.sin(a) ** 3) / 3.0
    s = -cosine, 0.5 * turn - 0.25 * double, -cosine + (math.cos(b) ** 3 - math.cos(a) ** 3) / 3.0
    c4 = 0.375 * turn + 0.25 * double + fourfold / 32.0
    s4 = 0.375 * turn - 0.25 * double + fourfold / 32.0
    second_x = x**3 * c[0] + 3.0 * x * x * r * c[1] + 3.0 * x * r * r * c[2] + r**3 * c4
    second_y = y**3 * s[0] + 3.0 * y * y * r * s[1] + 3.0 * y * r * r * s[2] + r**3 * s4
    return np.array(
        [
            0.5 * r * (x * c[0] + y * s[0] + r * turn),
            0.5 * r * (x * x * c[0] + 2.0 * x * r * c[1] + r * r * c[2]),
            0.5 * r * (y * y * s[0] + 2.0 * y * r * s[1] + r * r * s[2]),
            r / 3.0 * (second_x + second_y),
        ]
    )
