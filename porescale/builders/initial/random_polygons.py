"""Polygons placed at random in a rectangle."""

import math
from functools import lru_cache

import numpy as np

from porescale.common.core.errors import Fault, InputError
from porescale.common.neighbors.placement import place
from porescale.scene.bodies.segments import Points, PolygonBody, SegmentBody

Copy = tuple[tuple[float, float], float, float]
"""Point (m), angle (rad) and relative size."""

LOOSE = 0.55
"""Share of a rectangle that the circles about polygons placed at random fill without trouble."""


def check_random_places(it: PolygonBody) -> list[Fault]:
    """The fault of a number of polygons that do not fit, by the keys of the section."""
    if it.number is None or it.within is None:
        return []
    try:
        scattered(it.points, it.thickness, it.number, it.within, it.size_spread, it.seed)
    except InputError:
        left, bottom, right, top = it.within
        reach = max(math.hypot(x, y) for x, y in it.points) * (1.0 + it.size_spread) + it.thickness
        room = (right - left - reach) * (top - bottom - reach)
        problem, repair = "do not fit at random into the rectangle", "take fewer or smaller ones, or a larger rectangle"
        roughly = f"<= about {max(0, int(LOOSE * room / (math.pi * reach**2)))}"
        return [Fault("number", it.number, problem, "", roughly, repair)]
    return []


def copies_of(section: SegmentBody | PolygonBody) -> list[Copy]:
    """Every copy of a body, placed by hand or at random."""
    if isinstance(section, SegmentBody) or section.number is None or section.within is None:
        return section.copies
    it = section
    return scattered(it.points, it.thickness, section.number, section.within, it.size_spread, it.seed)


@lru_cache(maxsize=8)
def scattered(
    points: Points, thickness: float, number: int, within: tuple[float, float, float, float], spread: float, seed: int
) -> list[Copy]:
    """``number`` copies at random in a rectangle: point, angle, size; circles about them do not touch.

    Raises InputError where they do not fit.
    """
    rng = np.random.default_rng(seed)
    size = 1.0 + spread * (2.0 * (np.arange(number) + 0.5) / number - 1.0)
    rng.shuffle(size)
    reach = float(np.hypot(*np.array(points).T).max())
    found = place(within[:2], within[2:], radii=reach * size + thickness, seed=seed).position
    angle = rng.uniform(0.0, 2.0 * math.pi, number)
    return [
        ((float(x), float(y)), float(a), float(s)) for (x, y), a, s in zip(found.tolist(), angle, size, strict=True)
    ]
