"""Convergence of soil: the friction of an endless layer that slides, from a strewn lattice, at several spacings.

Noise of stress takes friction away where each particle yields by its own mean stress, as much as diffusion leaves;
by that of its surroundings most of it cancels.
"""

from functools import partial
from typing import Any

from continuum_sph.validation.soil.setups import TAN_PHI
from continuum_sph.validation.soil.slopes import strewn_friction
from porescale.common.evidence.convergence import Ladders

LADDERS = Ladders()
HELD = "no order is expected: half of the row at the floor is held, 0.5/N of what drives; "
ROTATING = (
    HELD + "upright columns of soil that rotate side by side are weaker, and form the easier the finer the soil is"
)
NOISY = HELD + "noise of stress takes friction away, as much as diffusion leaves of it"


def friction_error(options: dict[str, Any], rows: float) -> float:
    """|friction that a layer shows between 0.75 s and 1.5 s over sin φ, less 1|;  options : of `strewn_friction`."""
    return abs(strewn_friction(int(rows), **options) / TAN_PHI - 1.0)


for name, title, because, options in (
    ("soil.friction", "Relative error of the friction of an endless layer of strewn particles on a slope of 30°",
     ROTATING, {}),
    ("soil.friction_near_the_limit", "The same on a slope of 28°, 1.4° beyond its limit", ROTATING, {"degrees": 28.0}),
    ("soil.friction_by_own_pressure", "The same on 30°, where each particle yields by its own mean stress", NOISY,
     {"own": True}),
):  # fmt: skip
    LADDERS.ladder(name, title=title, along="rows of particles", levels=(10, 20, 40, 80), because=because)(
        partial(friction_error, options)
    )
