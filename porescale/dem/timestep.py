"""How long a contact step clumps allow, said as the mass of a disc that allows no more."""

from __future__ import annotations

import math
from collections.abc import Sequence

from porescale.dem.bodies.clumps import Clumps, fastest
from porescale.dem.contact.linear import Linear
from porescale.dem.contact.materials import Law
from porescale.dem.discs import Discs
from porescale.dem.step import NEIGHBOURS, packing_factor

HALVINGS = 60
"""Steps to a fixed point each of which halves the logarithm of the distance, at least."""


def stiffnesses(hard: Linear) -> tuple[float, float, float]:
    """Normal, tangential and rolling, N/m."""
    return hard.stiffness, hard.tangential_stiffness, hard.rolling_stiffness * hard.rolls


def dampings(hard: Linear) -> tuple[float, float, float]:
    """Normal, tangential and rolling, N s/m."""
    return hard.damping, hard.tangential_damping, hard.rolling_damping * hard.rolls


def lightest(clumps: Clumps, discs: Discs, laws: Sequence[Law]) -> float:
    """Mass (kg/m) that the smallest disc would have if its packing limit (integrate.packing_limit) were that of the
    fastest clump under all of ``laws``; infinite where all clumps are moved as told.

    Contacts of clumps count as stiff as those of the largest member, and as damped as those of the heaviest clump.
    """
    found, size, largest = [], float(discs.radius.min()), float(clumps.radius.max())
    for law in laws:
        for parts in (stiffnesses, dampings):
            own = parts(law.stiffest(float(clumps.mass.max()), largest))
            if max(own) > 0.0:
                most, mass = fastest(clumps, discs.radius, *own, NEIGHBOURS), float(discs.mass.min())
                if most == 0.0:  # all are moved as told
                    continue
                for _ in range(HALVINGS):  # dashpots of Hertz go with the root of the mass that is looked for
                    mass = packing_factor(*parts(law.stiffest(mass, size))) / most
                found.append(mass)
    return min(found, default=math.inf)
