"""B1 = e, the solid fraction itself (Noble & Torczynski 1998): walls move with the viscosity."""

from typing import NamedTuple

import numpy as np

from porescale.coupling.weighting.entry import Weighting
from porescale.coupling.weighting.law import weight
from porescale.lbm.collision.law import numbers


class B1(NamedTuple):
    """k : tau - 1/2, not used."""

    k: np.floating


@weight.of(B1)
def _weight(solid, theta, slip_x, slip_y, law):
    """The solid fraction itself."""
    return min(numbers(solid).one, solid)


WEIGHTING = Weighting("B1", "the solid fraction: walls move with the viscosity", B1, order=2)
