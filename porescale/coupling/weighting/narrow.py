"""narrow = 4 k D S/(2 k D S + 3 t⁴ (1 + s) Q): the weight of the solid operator solid/narrow_wall.py.

With t = 1 - e, k = tau - 1/2, D = e (e + E), S = t² + s and Q = D + G E;  2 in a full cell, which turns populations
back.  Derived there.
"""

from typing import NamedTuple

import numpy as np

from porescale.coupling.weighting.entry import Weighting
from porescale.coupling.weighting.law import weight
from porescale.lbm.collision.law import numbers

BEND = 0.2
"""s: of the share y = t³ (1 + s)/(t² + s) of the fluid's part in a wall's resistance, see solid/narrow_wall.py."""
ONSET = 0.05
"""E: solid fraction over which a cell turns from fluid to one with a wall."""
GRADE = 0.5 * (1 + BEND) / (1 + 3 * BEND)
"""G at magic parameter 3/16: such that the rate of q begins with the fluid's."""


class NarrowWeight(NamedTuple):
    """k : tau - 1/2;  bend : s;  onset : E;  start : G E."""

    k: np.floating
    bend: np.floating
    onset: np.floating
    start: np.floating


@weight.of(NarrowWeight)
def _weight(solid, theta, slip_x, slip_y, law):
    """Weight of the summed solid fraction."""
    c = numbers(solid)
    e = min(c.one, solid)
    t = c.one - e
    tt = t * t
    d = e * (e + law.onset)
    half = c.two * law.k * d * (tt + law.bend)
    return (half + half) / (half + c.three * tt * tt * (c.one + law.bend) * (d + law.start))


WEIGHTING = Weighting(
    name="narrow",
    purpose="goes with the solid operator narrow-wall",
    law=NarrowWeight,
    constants={"bend": BEND, "onset": ONSET, "start": GRADE * ONSET},
    general=False,
    order=3,
)
