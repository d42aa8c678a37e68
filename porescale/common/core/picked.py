"""Which of many frames or rows are taken where all would be too many."""

import numpy as np


def every_so_many(count: int, every: int) -> list[int]:
    """Of ``count`` things, counted from 0, every so many-th, and the last."""
    found = list(range(0, count, every))
    return found if not count or found[-1] == count - 1 else [*found, count - 1]


def spread(count: int, most: int) -> list[int]:
    """At most ``most`` of ``count`` > 0 things, from the first to the last and evenly spread."""
    return sorted({round(it) for it in np.linspace(0, count - 1, min(most, count)).tolist()})
