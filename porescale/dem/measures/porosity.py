"""Porosity and void ratio of a region: one minus the area of discs inside it, exact for discs cut by its edges.

The part of a disc left of and below a point has a closed form; four of them make the part within a rectangle.  Where
two discs overlap the lens counts twice: (4/3) sqrt(r) d^1.5 for equal discs with overlap d, of order 3/2 in it, 1.3e-5
of a disc's area at d = 1e-3 r.
"""

import numpy as np

from porescale.common.core.types import Floats
from porescale.dem.measures.region import Period, Region


def left_part(a: Floats) -> Floats:
    """Area of the unit disc left of x = ``a``, -1 <= a <= 1: pi/2 + a sqrt(1 - a²) + asin a."""
    return np.asarray(0.5 * np.pi + a * np.sqrt((1.0 - a) * (1.0 + a)) + np.arcsin(a))


def corner_part(a: Floats, b: Floats) -> Floats:
    """Area of the unit disc left of x = ``a`` and below y = ``b``, any numbers (n,).

    With the corner inside the disc (L(a) + L(b))/2 - pi/4 + a b, L the part left of a line; outside of it the lines cut
    off segments that do not touch.
    """
    a, b = np.clip(a, -1.0, 1.0), np.clip(b, -1.0, 1.0)
    left, below = left_part(a), left_part(b)
    inside = 0.5 * (left + below) - 0.25 * np.pi + a * b
    outside = np.where(a > 0.0, np.where(b > 0.0, left + below - np.pi, below), np.where(b > 0.0, left, 0.0))
    return np.where(a * a + b * b <= 1.0, inside, outside)


def disc_areas(region: Region, position: Floats, radius: Floats, period: Period = (0.0, 0.0)) -> Floats:
    """Area (n,) m² of each disc inside the region, of all its periodic images together.

    position (n, 2), radius (n,) m;  period m, 0 where not periodic.
    """
    total = np.zeros(len(radius))
    reach, position = np.where(radius > 0.0, radius, 1.0)[:, None], region.near(position, period)
    for shift in region.shifts(position - reach, position + reach, period):
        low, high = ((np.array(corner) - position - shift) / reach for corner in (region.lower, region.upper))
        (x0, y0), (x1, y1) = low.T, high.T
        part = corner_part(x1, y1) - corner_part(x0, y1) - corner_part(x1, y0) + corner_part(x0, y0)
        total += np.maximum(part, 0.0) * radius**2
    return total


def disc_shares(region: Region, position: Floats, radius: Floats, period: Period = (0.0, 0.0)) -> Floats:
    """Share (n,) of each disc inside the region, of a point 1 or 0; arrays as in disc_areas."""
    area, inside = np.pi * radius**2, disc_areas(region, position, radius, period)
    whole = np.where(area > 0.0, area, 1.0)
    return np.asarray(np.where(area > 0.0, inside / whole, region.holds(position, period)))


def porosity(region: Region, position: Floats, radius: Floats, period: Period = (0.0, 0.0)) -> float:
    """Area of pores over area, -; arrays as in disc_areas."""
    return 1.0 - float(disc_areas(region, position, radius, period).sum()) / region.area


def void_ratio(porosity: float) -> float:
    """Area of pores over that of discs, n/(1 - n); infinite where there is no disc."""
    return porosity / (1.0 - porosity) if porosity < 1.0 else float("inf")
