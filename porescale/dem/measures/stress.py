"""Mean stress of a region after Love and Weber: contact forces times branch vectors.

    sigma_ab = 1/A sum_c s_c F_a l_b  (+ 1/A sum_i A_i/(pi r_i²) m_i (v - V)_a (v - V)_b),

F the force of body i on the other, l the branch vector: from the centroid of i to that of j, or to the point of contact
at a wall, of clumps as of discs; s_c the share of l that lies inside the region, so that a region that cuts contacts
has the mean of the field that spreads each contact's stress evenly along its branch (Goldhirsch 2010, Granular Matter
12, 239, with a kernel of vanishing width).  The kinetic part counts each disc by the share of its area inside, against
the mass mean V of the velocity.  Compression is positive; index a is that of the force: div sigma_a = d sigma_ab/dx_b.
Sources: Love 1927, A Treatise on the Mathematical Theory of Elasticity, note B; Weber 1966, Bull. Liaison Ponts
Chaussees 20.
"""

import math
from typing import NamedTuple

import numpy as np

from porescale.common.core.types import Floats
from porescale.dem.discs import Discs
from porescale.dem.measures.contact_list import Contacts
from porescale.dem.measures.porosity import disc_shares
from porescale.dem.measures.region import Period, Region


class Principal(NamedTuple):
    """Mean pressure (Pa), half difference of the principal values (Pa), direction of the major one (rad from x)."""

    mean: float
    deviator: float
    angle: float


def contact_stress(region: Region, contacts: Contacts, period: Period = (0.0, 0.0)) -> Floats:
    """Love-Weber stress of contacts, (2, 2) Pa, without the kinetic part; periodic images of contacts count too."""
    share = region.share_of_branch(contacts.start, contacts.branch, period)
    return np.asarray(np.einsum("c,ca,cb->ab", share, contacts.force, contacts.branch) / region.area)


def kinetic_stress(region: Region, discs: Discs, period: Period = (0.0, 0.0)) -> Floats:
    """Stress of the velocities about their mass mean, (2, 2) Pa; zeros where there is no disc."""
    mass = discs.mass * disc_shares(region, discs.position, discs.radius, period)
    total = mass.sum()
    if not total > 0.0:
        return np.zeros((2, 2))
    off = discs.velocity - (mass[:, None] * discs.velocity).sum(axis=0) / total
    return np.asarray(np.einsum("i,ia,ib->ab", mass, off, off) / region.area)


def principal(stress: Floats) -> Principal:
    """Invariants of the symmetric part of a stress or fabric tensor (2, 2)."""
    mean = 0.5 * float(stress[0, 0] + stress[1, 1])
    half, shear = 0.5 * float(stress[0, 0] - stress[1, 1]), 0.5 * float(stress[0, 1] + stress[1, 0])
    return Principal(mean, math.hypot(half, shear), 0.5 * math.atan2(shear, half))
