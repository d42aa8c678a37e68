"""Bounds beyond which what the lattice holds is no fluid any more."""

import math

import numpy as np

from porescale.lbm.fluid import Fluid

WORST_MACH = 0.6
"""Beyond it the lattice's equilibrium is not valid; populations turn negative near it."""
WORST_DENSITY = 0.5
"""Relative density change beyond which the fluid is not what is called a liquid."""
SOUND = 1 / math.sqrt(3)
"""Speed of sound, cells per step."""


def sane(fluid: Fluid) -> bool:
    """Whether every cell is a number, below Mach 0.6, and its density changed by less than a half."""
    rho, ux, uy = fluid.fields()
    slow = np.hypot(ux, uy) < WORST_MACH * SOUND
    return bool(np.all(slow & (np.abs(rho - 1) < WORST_DENSITY)))  # no comparison holds for a nan
