"""Particles on a wall that are about to be in one place are parted along it.

A particle that reaches a wall is put on its surface (`leapfrog`), so those that lie there have a line to themselves.
As r goes to 0 what pushes a pair apart falls as r, and what presses it together from both sides falls as r, too: where
the latter is more, its distance falls as exp(-t/τ) until it is no number above 0, and then nothing parts the two for
ever.  Where distances fall so far that no other cause is left, each goes a tenth of a spacing along the wall.
"""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from continuum_sph.water.state import Layer, X
from porescale.common.core.types import Floats

LOOK = 50
"""Steps between looks: distances that fall by a decade in 700 steps, the fastest seen, are met long before rounding."""
TOUCH = 1e-6  # spacings: farther apart, a pair may still part of itself, or one of it leave the wall
ASIDE = 0.1  # spacings, that each goes


def part_at_walls(layer: Layer, bounds: Floats, spacing: float) -> int:
    """Part pairs of water that lie on a wall nearer than TOUCH; overwrites their places in ``layer``, of which the
    number is returned.  bounds (2, 2) m: lower and upper surfaces of the walls;  spacing m.
    """
    parted = 0
    x = layer.x[: layer.fluid]
    for axis in range(2):
        along = 1 - axis
        for surface in bounds[:, axis]:
            lying: NDArray[np.int64] = np.flatnonzero(x[:, axis] == surface)
            order: NDArray[Any] = lying[np.argsort(x[lying, along], kind="stable")]
            close = np.flatnonzero(np.diff(x[order, along]) < TOUCH * spacing)
            for one, other in zip(order[close], order[close + 1], strict=True):
                x[one, along] = max(bounds[0, along], x[one, along] - ASIDE * spacing)
                x[other, along] = min(bounds[1, along], x[other, along] + ASIDE * spacing)
                layer.record[[one, other], X + along] = x[[one, other], along]
                parted += 2
    return parted
