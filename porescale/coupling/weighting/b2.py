"""B2 = e k/((1 - e) + k),  k = tau - 1/2 (Noble & Torczynski 1998).

It makes the position of a wall independent of tau to first order.
"""

from typing import NamedTuple

import numpy as np

from porescale.coupling.weighting.entry import Weighting
from porescale.coupling.weighting.law import weight
from porescale.lbm.collision.law import numbers


class B2(NamedTuple):
    """k : tau - 1/2."""

    k: np.floating


@weight.of(B2)
def _weight(solid, theta, slip_x, slip_y, law):
    """Noble & Torczynski's weight."""
    one = numbers(solid).one
    e = min(one, solid)
    return e * law.k / ((one - e) + law.k)


WEIGHTING = Weighting("B2", "depends on the viscosity so that walls stay where they are", B2, order=1)
