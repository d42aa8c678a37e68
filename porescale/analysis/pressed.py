"""How the stiffness of a packing at rest grows with the mean stress: E ~ p^m, as the law of a continuum has it.

The same packing is pressed to FURTHER times its pressure, under its own friction, and its springs are asked there, too.
A continuum keeps Poisson's ratio and lets E grow, while in grains ν falls: m is that of M, stress over strain of what
cannot widen, which settlements follow.  Of E alone it would be twice as large.
"""

import math

from porescale.analysis.material import EXPONENT
from porescale.common.core.errors import PorescaleError
from porescale.common.core.types import Floats
from porescale.dem.contact.linear import Linear
from porescale.dem.measures.network import confined, elasticity
from porescale.dem.prepare.compaction import DEEPEST, Compactor

FURTHER = 2.0
"""Pressures between which the exponent is taken, one over the other."""


def stiffness_numbers(
    position: Floats, radius: Floats, box: tuple[float, float], law: Linear, pressure: float
) -> dict[str, float]:
    """E (Pa), ν and EXPONENT of discs (n, 2) m, (n,) m that rest under ``pressure`` (Pa) in a periodic ``box`` (m).

    The exponent is nan where the packing cannot be pressed further: where contacts are too soft for it, do not make an
    elastic soil, or no rest is found.
    """
    stiffness, poisson = elasticity(position, radius, box, law)
    made = {"stiffness": stiffness, "Poisson's ratio": poisson, EXPONENT: math.nan}
    if FURTHER * pressure > DEEPEST * law.stiffness:
        return made
    try:
        pressed = Compactor((0.0, 0.0), box, law).further(position, radius, (pressure, FURTHER * pressure))
    except PorescaleError:
        return made
    low, high = (confined(*elasticity(*discs, box, law)) for discs in pressed)
    if low > 0.0 and high > 0.0:
        made[EXPONENT] = math.log(high / low) / math.log(FURTHER)
    return made
