"""Convergence of soil: the friction of an endless layer that slides, at several spacings.

Two errors: the floor holds half of its row, 0.5/N of what drives, and noise of stress takes friction away, the more the
finer the soil is (cases/soil_stress_noise).
"""

import math

from continuum_sph.validation.soil.setups import TAN_PHI
from continuum_sph.validation.soil.slopes import sliding
from porescale.common.core.constants import GRAVITY
from porescale.common.evidence.convergence import Ladders

LADDERS = Ladders()
ROWS = (10, 14, 20, 28, 40, 56)
BECAUSE = (
    "no order is expected: half of the row at the floor is held, 0.5/N of what drives, and noise of stress takes"
    " friction away, the more the finer the soil is"
)


def friction_error(degrees: float, rows: float) -> float:
    """|mobilised friction (g sin β - a)/(g cos β) of a layer that slides with a, over sin φ, less 1|."""
    tilt = math.radians(degrees)
    acceleration, _ = sliding(degrees, int(rows))
    friction = (GRAVITY * math.sin(tilt) - acceleration) / (GRAVITY * math.cos(tilt))
    return abs(friction / TAN_PHI - 1.0)


@LADDERS.ladder(
    "soil.friction_just_beyond_the_limit",
    title="Relative error of the friction of an endless layer on a slope of 28°, 1.4° beyond its limit",
    along="rows of particles",
    levels=ROWS,
    because=BECAUSE,
)
def gentle(rows: float) -> float:
    """Without dilatancy, between 0.5 s and 1 s."""
    return friction_error(28.0, rows)


@LADDERS.ladder(
    "soil.friction_far_beyond_the_limit",
    title="Relative error of the friction of an endless layer on a slope of 35°",
    along="rows of particles",
    levels=ROWS,
    because=BECAUSE,
)
def steep(rows: float) -> float:
    """Without dilatancy, between 0.5 s and 1 s."""
    return friction_error(35.0, rows)
