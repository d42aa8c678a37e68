"""Films thinner than a cell, with the correction: a disc that closes on a wall, and two that close on each other.

Lattice units.  A closing force falls with the gap to the power -3/2, so that a film tells gaps apart.
"""

import math

import numpy as np

from porescale.common.evidence.validations import Measured, Validations
from porescale.coupling.step import Coupled
from porescale.lbm.lattice import viscosity
from porescale.validation.coupling.setups import DEFAULT, PERIODIC, TAU, Method, immersed
from porescale.validation.coupling.towed import SLOW, jeffrey_onishi, near_wall, steady, towed
from porescale.validation.lbm.channels import one_thread

VALIDATIONS = Validations()

REQUIRED = 0.05
"""Largest error of a force."""
AT_A_WALL = (0.2, 0.3, 0.5, 1.0)
"""Gaps in cells."""
BETWEEN = {0.02: 1.0381, 0.05: 1.1007, 0.1: 1.2145}
"""Force on discs that close on each other, over 3 sqrt(2) pi mu (R/2g)^(3/2) V, by the gap g in radii: two in a
periodic box of side 6 R, by point forces (tests/reference/coupling/stokes_array.py)."""
SMALL = 5.0
"""Radius in cells where grains have as many cells as they usually have."""
BETWEEN_SMALL = {
    0.02: (1.0378, 1.0360, 1.0345), 0.04: (1.0785, 1.0734, 1.0690), 0.06: (1.1211, 1.1117, 1.1035),
    0.1: (1.2111, 1.1906, 1.1727), 0.2: (1.4600, 1.3987, 1.3460),
}  # fmt: skip
"""The same of discs of that size, for each of ``ANGLES``: gaps of 0.1, 0.2, 0.3, 0.5 and 1 cell."""
NARROW = Method(magic=1 / 24)
"""Outlines in the lattice that lie nearer by 0.025 cells between two discs of this size, not by 0.11."""
ANGLES = tuple((k + 0.5) * math.pi / 12 for k in range(3))
"""Of the line of centres, rad: an eighth of a turn, after which angles repeat."""
SPREAD = 0.7549, 0.5698
"""Places k times these, modulo 1, are spread evenly over a cell: 1/p and 1/p² of p³ = p + 1 (Roberts 2018, R2)."""
PLACES = ((0.1, 0.0, 0.0), (0.8, 0.3, 0.6), (1.4, 0.7, 0.2), (2.4, 0.5, 0.9))
"""Angle of the line of centres, rad, and the place of its middle within a cell."""


def closing(
    gap: float, way: tuple[float, float, float], *, radius: float = 10.0, lubrication: bool = True,
    method: Method = DEFAULT,
) -> float:  # fmt: skip
    """Force on two discs, ``gap`` radii apart, that close on each other, over 3 sqrt(2) pi mu (R/2g)^(3/2) V.

    way: angle (rad) and place in a cell;  radius: cells.
    """
    angle, *place = way
    cells, nu = round(6 * radius), viscosity(TAU)
    along = np.array([math.cos(angle), math.sin(angle)])
    middle, arm = np.array(place) + cells / 2, (1 + gap / 2) * radius * along
    coupled = towed(
        (cells, cells), [middle - arm, middle + arm], radius, [SLOW / 2 * along, -SLOW / 2 * along], density=2.0,
        sides=PERIODIC, lubrication=lubrication, method=method,
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
    because="required: 5 %; what the lattice lacks was measured here, and at other sizes and places",
    tolerance=REQUIRED,
    slow=True,
)
def films() -> Measured:
    """Force over the law's at gaps of 0.2, 0.3, 0.5 and 1 cell, radius 10, and the same with radius 5."""
    found = [
        near_wall("towards", cells / radius, radius, lubrication=True) / jeffrey_onishi(cells / radius)
        for radius in (10.0, SMALL)
        for cells in AT_A_WALL
    ]
    return Measured.absolute([1.0] * len(found), found)


@VALIDATIONS.row(
    "coupling.films_between_discs",
    source="two discs close on each other: point forces",
    because="required: 5 %, as the mean over angles and places, which scatter by 3 %; what the lattice lacks was"
    " measured at other places",
    tolerance=REQUIRED,
    slow=True,
)
def films_between() -> Measured:
    """Force over the exact one at gaps of 0.2, 0.5 and 1 cell, radius 10, mean over four angles and places."""
    found = [float(np.mean([closing(gap, way) for way in PLACES])) / exact for gap, exact in BETWEEN.items()]
    return Measured.absolute([1.0] * len(found), found)


def small(gap: float, *, places: int = 4, lubrication: bool = True, method: Method = DEFAULT) -> float:
    """Force over the exact one on discs of radius ``SMALL``, mean over ``ANGLES`` at so many places each."""
    found = []
    for k in range(places * len(ANGLES)):
        way = ANGLES[k % len(ANGLES)], (k + 1) * SPREAD[0] % 1, (k + 1) * SPREAD[1] % 1
        force = closing(gap, way, radius=SMALL, lubrication=lubrication, method=method)
        found.append(force / BETWEEN_SMALL[gap][k % len(ANGLES)])
    return float(np.mean(found))


@VALIDATIONS.row(
    "coupling.films_between_small_discs",
    source="two discs close on each other: point forces",
    because="required: 5 %, as the mean over angles and places; those scatter by 7 % at a tenth and a fifth of a cell,"
    " 2 % of the mean of twelve",
    tolerance=REQUIRED,
    slow=True,
)
def films_between_small() -> Measured:
    """Force over the exact one at gaps of 0.1, 0.2, 0.3, 0.5 and 1 cell, radius 5, mean over twelve places."""
    found = [small(gap) for gap in BETWEEN_SMALL]
    return Measured.absolute([1.0] * len(found), found)


@VALIDATIONS.row(
    "coupling.films_between_narrow_outlines",
    source="two discs close on each other: point forces",
    because="required: 5 %; magic parameter 1/24, for which nothing was fitted: places scatter by 3 %",
    tolerance=REQUIRED,
    slow=True,
)
def films_between_narrow() -> Measured:
    """The same at gaps of 0.1, 0.2 and 0.5 cells with a magic parameter of 1/24."""
    found = [small(gap, method=NARROW) for gap in (0.02, 0.04, 0.1)]
    return Measured.absolute([1.0] * len(found), found)


SINKS = 1.0, 0.25
"""Gaps in cells between which a disc that sinks is timed; below 0.13 films count as that thick."""


def sinking(*, lubrication: bool = True) -> float:
    """Time in which a disc of radius ``SMALL`` sinks onto a floor from one gap of ``SINKS`` to the other, over the
    law's, without inertia: weight over speed is 4 pi mu/(alpha - tanh alpha) at every gap."""
    radius, density, fall = SMALL, 3.0, (0.0, -4e-5)
    plain = immersed(
        (round(12 * radius), round(6 * radius)), [(6 * radius + 0.3, radius + 1.3)], radius, density,
        acceleration=fall, relaxation_time=TAU,
    )  # fmt: skip
    coupled = Coupled(
        plain.fluid, plain.grains, plain.scales, hydraulic_ratio=1.0, contact_steps=4, acceleration=fall,
        lubrication=lubrication,
    )  # fmt: skip
    gaps = np.linspace(*SINKS, 101)
    weight = (density - 1) * math.pi * radius**2 * -fall[1]
    exact = np.trapezoid([jeffrey_onishi(gap / radius) for gap in gaps], -gaps) * viscosity(TAU) / weight
    steps = []
    with one_thread():
        for gap in SINKS:
            steps.append(0)
            while coupled.grains.discs.position[0, 1] > radius + gap:
                coupled.advance()
                steps[-1] += 1
    return float(steps[-1] / exact)


@VALIDATIONS.row(
    "coupling.sinking_through_a_film",
    source="Jeffrey & Onishi 1981: weight over speed at every gap, summed up",
    because="required of a film: 5 %; the speed follows the gap within 16 steps of five thousand",
    tolerance=REQUIRED,
    slow=True,
)
def sinking_row() -> Measured:
    """Time over the law's from a gap of a cell to one of a quarter, a free disc of radius 5 above a floor, tau 0.8."""
    return Measured.absolute(1.0, sinking())
