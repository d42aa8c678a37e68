"""Where things are seen in a box that is periodic: once more at the other side of one that they reach over."""

import numpy as np

from porescale.common.core.types import AnyArray
from porescale.common.pictures.look import Look
from porescale.common.record.model import Cloud


def again(low: AnyArray, high: AnyArray, look: Look) -> tuple[AnyArray, AnyArray]:
    """Which thing is seen (m,), and by how much it is shifted (m, 2) m: all of them as they lie, then their images.

    low, high : (n, 2) m, corners of the rectangles that things take;  the box is from 0 to ``look.period``.
    """
    which, shift = np.arange(len(low)), np.zeros((len(low), 2))
    for axis, length in enumerate(look.period):
        if length:
            with np.errstate(invalid="ignore"):  # a place that is not known reaches over nothing
                over = np.flatnonzero(low[which, axis] < 0.0), np.flatnonzero(high[which, axis] > length)
            images = [shift[it] + way * length * np.eye(2)[axis] for it, way in zip(over, (1.0, -1.0), strict=True)]
            which, shift = np.concatenate([which, *(which[it] for it in over)]), np.concatenate([shift, *images])
    return which, shift


def discs_again(cloud: Cloud, look: Look) -> tuple[AnyArray, AnyArray]:
    """Which point of a cloud is seen (m,), and where (m, 2) m: of discs also their images, dots as they are."""
    if "radius" not in cloud.data:
        return np.arange(len(cloud.position)), cloud.position
    reach = np.asarray(cloud.data["radius"], float)[:, None]
    which, shift = again(cloud.position - reach, cloud.position + reach, look)
    return which, cloud.position[which] + shift


def shifts(cloud: Cloud, look: Look) -> AnyArray:
    """By how much (m, 2) m all bodies of a cloud are shifted where they are seen: not at all first."""
    reach = np.asarray(cloud.data.get("radius", np.zeros(len(cloud.position))), float)[:, None]
    found = again(cloud.position - reach, cloud.position + reach, look)[1]
    return np.concatenate([np.zeros((1, 2)), *(it[None] for it in np.unique(found, axis=0) if it.any())])
