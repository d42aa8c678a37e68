"""wall = 4 k e/(4 k e + 3 (1 - e)²),  k = tau - 1/2: the weight of the solid operator solid/exact_wall.py.

Derived there.
"""

from typing import NamedTuple

import numpy as np

from porescale.coupling.coverage.soft_rim import SLIP_FACTOR
from porescale.coupling.weighting.entry import Weighting
from porescale.coupling.weighting.law import weight
from porescale.lbm.collision.law import numbers


class WallWeight(NamedTuple):
    """k : tau - 1/2."""

    k: np.floating


class SoftWallWeight(NamedTuple):
    """k : tau - 1/2;  slip_factor : of theta times slip in it (coverage/soft_rim.py)."""

    k: np.floating
    slip_factor: np.floating


@weight.of(WallWeight)
def _weight(solid, theta, slip_x, slip_y, law):
    """Weight of cells with the relaxation time of the fluid: rims are sharp."""
    c = numbers(solid)
    e = min(c.one, solid)
    t = c.one - e
    n = law.k * e
    return n / (n + c.c34 * t * t)


@weight.of(SoftWallWeight)
def _soft_weight(solid, theta, slip_x, slip_y, law):
    """Weight of cells where the slip is added to k at soft rims."""
    c = numbers(solid)
    e = min(c.one, solid)
    t = c.one - e
    n = (law.k + law.slip_factor * theta * np.sqrt(slip_x * slip_x + slip_y * slip_y)) * e
    return n / (n + c.c34 * t * t)


WEIGHTING = Weighting(
    name="wall",
    purpose="goes with the solid operator exact-wall",
    law=WallWeight,
    soft_law=SoftWallWeight,
    constants={"slip_factor": SLIP_FACTOR},
    general=False,
    order=0,
)
