"""Convergence of exact walls on discs and polygons: drag, permeability, leak and torque at several resolutions.

Means over places of the centre within a cell, as a single place scatters by half of the error.  The order expected of
a drag is 2: exact walls put a plane wall at its place, and what is left is a curvature of size 1/R².
"""

import math
from collections.abc import Iterable

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
SCATTER = 0.36
"""Of an order over one doubling: single places scatter by half of the mean, means of eight by 0.5/sqrt 8; two of them,
sqrt 2 0.18/ln 2.  Over two doublings it is half of that."""


def diameters(periods: Iterable[int], solid_fraction: float) -> list[float]:
    """Cells per diameter of square arrays whose period is so many whole cells, to three decimals."""
    return [round(2 * cells * math.sqrt(solid_fraction / math.pi), 3) for cells in periods]


def drag_error(diameter: float, solid_fraction: float, places: int) -> float:
    """|mean drag of a square array over the exact one, less 1|."""
    found = square_array_drag(diameter, solid_fraction, relaxation_time=TAU, places=SPREAD[:places])
    return abs(float(np.mean(found)) / SQUARE[solid_fraction] - 1)


@LADDERS.ladder(
    "coupling.drag_of_a_square_array",
    title="Relative error of the drag of a square array of discs, solid fraction 0.2, mean over eight places",
    along="cells per diameter",
    levels=diameters((10, 20, 30, 40), LOOSE),
    expected=2.0,
    within=SCATTER,
    because="curvature of size 1/R²; scatter of places, 0.36 of the order over a doubling; below 8 cells per diameter"
    " the next order counts",
)
def loose_array(diameter: float) -> float:
    """Solid fraction 0.2."""
    return drag_error(diameter, LOOSE, 8)


@LADDERS.ladder(
    "coupling.drag_of_a_dense_square_array",
    title="Relative error of the drag, solid fraction 0.6, whose gaps are 0.14 diameters wide, mean over four places",
    along="cells per diameter",
    levels=diameters((12, 17, 23, 34), DENSE),
    expected=2.0,
    within=SCATTER,
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
    levels=(18, 25, 35),
    expected=1.0,
    within=SCATTER,
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
    levels=(10, 14, 20, 28),
    expected=2.0,
    within=SCATTER,
    because="exact solution of Taylor-Couette flow; curvature of size 1/R² as for the drag; one place of the centre",
)
def taylor_couette(diameter: float) -> float:
    """tau 0.8."""
    inner = diameter / 2
    return abs(abs(couette_torque(inner, 2 * inner, TAU)[0]) - 1)
