"""Films thinner than a cell, with the correction: a disc that closes on a wall, and two that close on each other.

Lattice units.  A closing force falls with the gap to the power -3/2, so that a film tells gaps apart.
"""

import math

import numpy as np

from porescale.common.evidence.validations import Measured, Validations
from porescale.lbm.lattice import viscosity
from porescale.validation.coupling.setups import PERIODIC, TAU
from porescale.validation.coupling.towed import SLOW, jeffrey_onishi, near_wall, steady, towed

VALIDATIONS = Validations()

REQUIRED = 0.05
"""Largest error of a force."""
AT_A_WALL = (0.02, 0.03, 0.05, 0.1)
"""Gaps in radii of ten cells: a fifth of a cell to a cell."""
BETWEEN = {0.02: 1.0381, 0.05: 1.1007, 0.1: 1.2145}
"""Force on discs that close on each other, over 3 sqrt(2) pi mu (R/2g)^(3/2) V, by the gap g in radii: two in a
periodic box of side 6 R, by point forces (tests/reference/coupling/stokes_array.py)."""
PLACES = ((0.1, 0.0, 0.0), (0.8, 0.3, 0.6), (1.4, 0.7, 0.2), (2.4, 0.5, 0.9))
"""Angle of the line of centres, rad, and the place of its middle within a cell."""


def closing(
    gap: float, way: tuple[float, float, float], *, radius: float = 10.0, relaxation_time: float = TAU,
    lubrication: bool = True,
) -> float:  # fmt: skip
    """Force on two discs, ``gap`` radii apart, that close on each other, over 3 sqrt(2) pi mu (R/2g)^(3/2) V.

    way: angle (rad) and place in a cell;  radius: cells.
    """
    angle, *place = way
    cells, nu = round(6 * radius), viscosity(relaxation_time)
    along = np.array([math.cos(angle), math.sin(angle)])
    middle, arm = np.array(place) + cells / 2, (1 + gap / 2) * radius * along
    coupled = towed(
        (cells, cells), [middle - arm, middle + arm], radius, [SLOW / 2 * along, -SLOW / 2 * along], density=2.0,
        relaxation_time=relaxation_time, sides=PERIODIC, lubrication=lubrication,
    )  # fmt: skip

    def load() -> float:
        """Half the difference of the forces along the line, films included."""
        force = coupled.fluid_force + (coupled.lubrication.force if coupled.lubrication else 0.0)
        return float((force[1] - force[0]) @ along) / 2

    found = steady(coupled, load, (cells / (2 * math.pi)) ** 2 / nu)
    law = 3 * math.sqrt(2) * math.pi * (0.5 / gap) ** 1.5
    return float(found / (law * nu * SLOW))


@VALIDATIONS.row(
    "coupling.films",
    source="Jeffrey & Onishi 1981: a cylinder closes on a wall, F 4 pi mu V/(alpha - tanh alpha)",
    because="required: 5 %; what the lattice lacks was measured here and between discs, which differ by 4 %",
    tolerance=REQUIRED,
)
def films() -> Measured:
    """Force over the law's at gaps of 0.2, 0.3, 0.5 and 1 cell, radius 10."""
    found = [near_wall("towards", gap, lubrication=True) / jeffrey_onishi("towards", gap) for gap in AT_A_WALL]
    return Measured.absolute([1.0] * len(found), found)


@VALIDATIONS.row(
    "coupling.films_between_discs",
    source="two discs close on each other: point forces",
    because="required: 5 %, as the mean over angles and places, which scatter by 3 %; what the lattice lacks was"
    " measured here, at other places, and at a wall, where it lacks 4 % more",
    tolerance=REQUIRED,
    slow=True,
)
def films_between() -> Measured:
    """Force over the exact one at gaps of 0.2, 0.5 and 1 cell, radius 10, mean over four angles and places."""
    found = [float(np.mean([closing(gap, way) for way in PLACES])) / exact for gap, exact in BETWEEN.items()]
    return Measured.absolute([1.0] * len(found), found)
