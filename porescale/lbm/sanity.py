"""Bounds beyond which what the lattice holds is no fluid any more."""

import math

from porescale.lbm.fluid import Fluid

WORST_MACH = 0.6
"""Beyond it the lattice's equilibrium is not valid; populations turn negative near it."""
WORST_DENSITY = 0.5
"""Relative density change beyond which the fluid is not what is called a liquid."""
SOUND = 1 / math.sqrt(3)
"""Speed of sound, cells per step."""


def sane(fluid: Fluid) -> bool:
    """Whether every cell is a number, below Mach 0.6, and its density changed by less than a half."""
    found = fluid.totals()
    return found.fastest < WORST_MACH * SOUND and found.density_change < WORST_DENSITY  # neither holds for a nan
