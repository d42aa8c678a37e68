"""Convergence of exact walls on discs and polygons: drag, permeability, leak and torque at several resolutions.

Drags are means over places of the centre within a cell, eight or four, as a single place scatters by half of the error;
the leak is the largest of four places, the torque that of one.  The order expected of a drag is 2: exact walls put a
plane wall at its place, and what is left is a curvature of size 1/R².
"""

import math
from collections.abc import Iterable, Sequence

import numpy as np

from porescale.common.evidence.convergence import Ladders
from porescale.validation.coupling.arrays import SQUARE, leak
from porescale.validation.coupling.polygons import SQUARES, array_drag
from porescale.validation.coupling.polygons import square as square_body
from porescale.validation.coupling.rings import couette_torque
from porescale.validation.coupling.setups import TAU
from porescale.validation.coupling.towed import square_array_drag

LADDERS = Ladders()
LOOSE, DENSE = 0.2, 0.6
SPREAD = [((0.5 + 0.7549 * k) % 1, (0.5 + 0.5698 * k) % 1) for k in range(8)]
"""Spread evenly over a cell: multiples of the powers of 1/1.3247, the root of x³ = x + 1."""
ALONE = 0.5
"""Scatter of the error at single places, in parts of its mean."""
MOST = 0.36
"""What no order may fall short by, however few the places: at a half it could be the order below by a half."""


def scatter(levels: Sequence[float], places: int) -> float:
    """How far an order fitted to errors at these levels, means over so many places, may fall short of what it is.

    Two standard deviations of the least-squares slope, 2 (0.5/sqrt places)/sqrt sum (x - mean x)², x = log(level), but
    `MOST` at most.  So rows of four places (0.65 over 10 to 30 cells, 1.06 over 18 to 35) and of one place (1.30 over
    10 to 28) are held to more than scatter asks: they hold at the places that they name.
    """
    x = np.log(levels)
    return min(MOST, round(2 * ALONE / math.sqrt(places) / float(np.sqrt(np.sum((x - x.mean()) ** 2))), 2))


def diameters(periods: Iterable[int], solid_fraction: float) -> list[float]:
    """Cells per diameter of square arrays whose period is so many whole cells, to three decimals."""
    return [round(2 * cells * math.sqrt(solid_fraction / math.pi), 3) for cells in periods]


def drag_error(diameter: float, solid_fraction: float, places: int) -> float:
    """|mean drag of a square array over the exact one, less 1|."""
    found = square_array_drag(diameter, solid_fraction, relaxation_time=TAU, places=SPREAD[:places])
    return abs(float(np.mean(found)) / SQUARE[solid_fraction] - 1)


LOOSE_LEVELS, DENSE_LEVELS = diameters((10, 20, 30, 40), LOOSE), diameters((12, 17, 23, 34), DENSE)
SQUARE_LEVELS, RING_LEVELS = (18, 25, 35), (10, 14, 20, 28)


@LADDERS.ladder(
    "coupling.drag_of_a_square_array",
    title="Relative error of the drag of a square array of discs, solid fraction 0.2, mean over eight places",
    along="cells per diameter",
    levels=LOOSE_LEVELS,
    expected=2.0,
    within=scatter(LOOSE_LEVELS, 8),
    because="curvature of size 1/R²; two standard deviations by the scatter of places; below 8 cells per diameter the"
    " next order counts",
)
def loose_array(diameter: float) -> float:
    """Gaps of 0.98 diameters between the discs, at solid fraction 0.2."""
    return drag_error(diameter, LOOSE, 8)


@LADDERS.ladder(
    "coupling.drag_of_a_dense_square_array",
    title="Relative error of the drag, solid fraction 0.6, whose gaps are 0.14 diameters wide, mean over four places",
    along="cells per diameter",
    levels=DENSE_LEVELS,
    expected=2.0,
    within=scatter(DENSE_LEVELS, 4),
    because="as for the loose array; the drag goes as the gap to the power -5/2, so the error is larger",
)
def dense_array(diameter: float) -> float:
    """Solid fraction 0.6; the error of its permeability is the same to first order."""
    return drag_error(diameter, DENSE, 4)


@LADDERS.ladder(
    "coupling.leak_of_touching_discs",
    title="Permeability K/R² of touching discs, which close the plane: all of it is error",
    along="cells per diameter",
    levels=(8, 15, 30),
    expected=2.0,
    within=0.0,
    because="second order at least; through an opening of a share of a cell it falls as the power 5/2 (Gebart 1992)",
)
def touching_discs(diameter: float) -> float:
    """Largest of four places."""
    return leak(diameter)


@LADDERS.ladder(
    "coupling.drag_of_a_square_array_of_squares",
    title="Relative error of the drag of a square array of squares turned by 20°, solid fraction 0.1",
    along="cells per period",
    levels=SQUARE_LEVELS,
    expected=1.0,
    within=scatter(SQUARE_LEVELS, 4),
    because="flow is singular at corners: first order at least, a straight side alone would be of the second",
)
def squares(cells: float) -> float:
    """Mean over the places of the validation."""
    found = array_drag(square_body(0.1, 20), int(cells))
    return abs(float(np.mean(found)) / SQUARES[20] - 1)


@LADDERS.ladder(
    "coupling.torque_between_disc_and_ring",
    title="Relative error of the torque on a disc that turns in a ring of twice its radius",
    along="cells per diameter of the disc",
    levels=RING_LEVELS,
    expected=2.0,
    within=scatter(RING_LEVELS, 1),
    because="exact solution of Taylor-Couette flow; curvature of size 1/R² as for the drag; one place of the centre",
)
def taylor_couette(diameter: float) -> float:
    """Torque over that of Taylor & Couette, less 1, at the relaxation time 0.8."""
    inner = diameter / 2
    return abs(abs(couette_torque(inner, 2 * inner, TAU)[0]) - 1)
