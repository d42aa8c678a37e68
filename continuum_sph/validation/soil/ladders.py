"""Convergence of soil: the friction of an endless layer that slides, from a strewn lattice, at several spacings.

Noise of stress takes friction away, the more the finer the soil is, where each particle yields by its own mean stress;
by that of its surroundings most of the noise cancels.
"""

from continuum_sph.validation.soil.setups import TAN_PHI
from continuum_sph.validation.soil.slopes import strewn_friction
from porescale.common.evidence.convergence import Ladders

LADDERS = Ladders()
ROWS = (10, 20, 40, 80)
HELD = "no order is expected: half of the row at the floor is held, 0.5/N of what drives; "
ROTATING = (
    HELD + "upright columns of soil that rotate side by side are weaker, and form the easier the finer the soil is"
)
NOISY = HELD + "noise of stress takes friction away, the more the finer the soil is"


@LADDERS.ladder(
    "soil.friction",
    title="Relative error of the friction of an endless layer of strewn particles on a slope of 30°",
    along="rows of particles",
    levels=ROWS,
    because=ROTATING,
)
def friction(rows: float) -> float:
    """Without dilatancy, between 0.75 s and 1.5 s."""
    return abs(strewn_friction(int(rows)) / TAN_PHI - 1.0)


@LADDERS.ladder(
    "soil.friction_near_the_limit",
    title="The same on a slope of 28°, 1.4° beyond its limit",
    along="rows of particles",
    levels=ROWS,
    because=ROTATING,
)
def friction_near_the_limit(rows: float) -> float:
    """Without dilatancy, between 0.75 s and 1.5 s."""
    return abs(strewn_friction(int(rows), degrees=28.0) / TAN_PHI - 1.0)


@LADDERS.ladder(
    "soil.friction_by_own_pressure",
    title="The same on 30°, where each particle yields by its own mean stress",
    along="rows of particles",
    levels=ROWS,
    because=NOISY,
)
def friction_by_own_pressure(rows: float) -> float:
    """Without dilatancy, between 0.75 s and 1.5 s."""
    return abs(strewn_friction(int(rows), own=True) / TAN_PHI - 1.0)
