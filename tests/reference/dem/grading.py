"""The grading curve of given discs."""

import numpy as np

from porescale.common.core.types import Floats


def percent_finer(radius: Floats, diameter: Floats) -> Floats:
    """Percent of the mass of discs of ``radius`` (n,) m that is finer than each ``diameter`` (k,) m, (k,)."""
    size = np.sort(2.0 * radius)
    mass = np.concatenate(([0.0], np.cumsum(size**2)))
    return np.asarray(100.0 * mass[np.searchsorted(size, diameter)] / mass[-1])
