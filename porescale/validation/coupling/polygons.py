"""Validations of polygons in fluid: what they cover, drag and torque in slow flow, laws of rigid bodies.

References: drag F/(mu U) of square arrays, U superficial, and torque over mu w and the cell, of forces along the sides
(tests/reference/stokes_polygons.py), five digits.
"""

from __future__ import annotations

import math

import numpy as np

from porescale.common.evidence.validations import Measured, Validations
from porescale.validation.coupling import polygons_trials as lab
from porescale.validation.coupling.towed import square_array_drag

VALIDATIONS = Validations()

EPS = float(np.finfo(float).eps)
SQUARES = {0: 26.945294, 20: 27.982393, 45: 29.739357}
"""Drag of square arrays of squares, solid fraction 0.1, turned by so many degrees."""
DENSER = {0: 55.353423, 20: 60.926498}
"""The same at solid fraction 0.2."""
TURNING = {0: 1.209845, 20: 1.283351}
"""Torque of turning squares, solid fraction 0.2."""
PLATES = {0: 13.673741, 30: 18.646834, 90: 71.364736}
"""Drag of square arrays of plates, 0.6 by 0.075 of the period, turned by so many degrees, that turn flow aside freely:
of the tensor R, R_xx - R_xy²/R_yy."""
ASKED = 0.01
"""Largest error of a mean over places in a cell, as asked for of discs (verify_arrays.py)."""


def square(fraction: float, degrees: float) -> lab.Array:
    """A square that takes this part of a cell of side 1, its sides turned by ``degrees`` from the axes."""
    return lab.regular(4, fraction, 45.0 + degrees)


@VALIDATIONS.row(
    "coupling.area_of_polygons",
    source="shoelace formula",
    because="each of some 100 cells that the outlines cross is good to a rounding of the extent of 24 cells, all one"
    " way",
    tolerance=EPS * 24 * 100,
)
def areas() -> Measured:
    """Largest error of the sum of fractions, cells, of a square, a plate and an ellipse at 180 angles and places."""
    errors = lab.area_errors([lab.regular(4, 100.0), lab.plate(20.0, 2.5), lab.ellipse(10.0, 4.0)], 180)
    return Measured(0.0, errors, max(errors))


@VALIDATIONS.row(
    "coupling.square_arrays_of_squares",
    source="Stokes drag on square arrays of squares, solid fraction 0.1 and 0.2, turned by 0, 20, 45 degrees, by forces"
    " along the sides",
    because="1 % as for discs; tips at the corners follow from the radius shift of discs: no constant was chosen on"
    " these",
    tolerance=ASKED,
    slow=True,
)
def squares() -> Measured:
    """Drag at 10 cells a side, tau 0.8, mean over places."""
    cases = [(0.1, 32, turn, drag) for turn, drag in SQUARES.items()]
    cases += [(0.2, 22, turn, drag) for turn, drag in DENSER.items()]
    found = [float(np.mean(lab.array_drag(square(c, turn), cells))) for c, cells, turn, _ in cases]
    exact = [drag for *_, drag in cases]
    return Measured(exact, found, float(np.abs(np.divide(found, exact) - 1).max()))


@VALIDATIONS.row(
    "coupling.arrays_of_plates",
    source="Stokes drag on square arrays of plates, 8 : 1, along, across and at 30 degrees, by forces along the sides",
    because="1 % as for discs: faces of a plate of 3 cells have a full cell between them",
    tolerance=ASKED,
    slow=True,
)
def plates() -> Measured:
    """Drag at 24 by 3 cells, tau 0.8, mean over two places."""
    found = [plate_drag(40, turn) for turn in PLATES]
    exact = list(PLATES.values())
    return Measured(exact, found, float(np.abs(np.divide(found, exact) - 1).max()))


def plate_drag(cells: int, degrees: float) -> float:
    """Drag of the array of plates in a box of so many cells."""
    return float(
        np.mean(lab.array_drag(lab.plate(0.6, 0.075, degrees), cells, places=[(0.125, 0.375), (0.375, 0.125)]))
    )


@VALIDATIONS.row(
    "coupling.torque_of_turning_squares",
    source="squares of a square array that all turn, solid fraction 0.2, by forces along the sides",
    because="as discs (coupling.torque_of_a_turning_array): of the shift that the drag wants, 0.28 cells², at most all"
    " is too much for the torque, 2 pi 0.28 in an area that it goes with to the power 1.25: 2.3 % at 10 cells a side",
    tolerance=1.25 * 2 * math.pi * 0.28125 / (0.2 * 22**2),
)
def turning() -> Measured:
    """Torque over mu w and the cell at 10 cells a side, tau 0.8, sides at 0 and 20 degrees."""
    found = [lab.array_torque(square(0.2, turn), 22) for turn in TURNING]
    exact = list(TURNING.values())
    return Measured(exact, found, float(np.abs(np.divide(found, exact) - 1).max()))


def beside_the_disc(corners: int, cells: int = 25, solid_fraction: float = 0.2) -> float:
    """Drag of a square array of polygons over that of discs of the same area, at the same place, less one."""
    place = [(0.125, 0.375)]
    radius = math.sqrt(solid_fraction / math.pi)
    disc = square_array_drag(2 * radius * cells, solid_fraction, places=place)[0]
    return lab.array_drag(lab.regular(corners, solid_fraction, 7.0), cells, places=place, change=1e-6)[0] / disc - 1


@VALIDATIONS.row(
    "coupling.many_corners_make_a_disc",
    source="a polygon of many corners is a disc",
    because="its outline leaves the circle of its area by R (pi/n)²/3 at most: 0.25 % of the radius at 36 corners, and"
    " drag goes with the radius to the power 1.4 at solid fraction 0.2",
    tolerance=1.4 * (math.pi / 36) ** 2 / 3,
    slow=True,
)
def many_corners() -> Measured:
    """Drag of arrays of 6, 12 and 36 corners over that of discs, less one: the last counts, each is closer."""
    found = [beside_the_disc(count) for count in (6, 12, 36)]
    size = [abs(each) for each in found]
    return Measured([0.0] * 3, found, size[2] if size[0] > size[1] > size[2] else math.inf)


@VALIDATIONS.row(
    "coupling.neutral_polygons_feel_no_force",
    source="Galilean invariance: b rho (u - v) = 0 in every cell",
    because="round-off: four roundings of 0.036 in each of the 110 cells of the largest, all one way",
    tolerance=4 * 110 * 0.036 * EPS,
)
def neutral() -> Measured:
    """Largest load, and torque over the size, on three polygons of density 1 that uniform flow carries, 300 steps."""
    loads = lab.loads_on_neutral(300)
    return Measured(0.0, loads, max(loads))


@VALIDATIONS.row(
    "coupling.momentum_of_polygons",
    source="Newton: momentum of polygons, discs and fluid, less that of the fluid inside and with virtual masses",
    because="round-off: each of 400 fluid and 1600 contact steps rounds every velocity, all one way: 2000 eps",
    tolerance=2000 * EPS,
)
def momentum() -> Measured:
    """Error of the book over sum m |v| at the start: polygons and discs that meet in a periodic box under gravity."""
    errors = [lab.momentum_error(400, ratio) for ratio in (2.0, 0.5)]
    return Measured([0.0, 0.0], errors, max(errors))


@VALIDATIONS.row(
    "coupling.level_plate_sinks_straight",
    source="mirror symmetry",
    because="round-off: sums over 3e3 cells of populations less those at rest, as large as the speed: 3e3 eps",
    tolerance=3000 * EPS,
)
def mirror() -> Measured:
    """Sideways speed and tip speed of a level plate that sinks, over the speed down."""
    aside, tip = lab.level_plate(0.0)
    return Measured([0.0, 0.0], [aside, tip], max(abs(aside), abs(tip)))


@VALIDATIONS.row(
    "coupling.jeffery_period",
    source="Jeffery 1922, in two dimensions: half a turn of an ellipse, free in shear g, takes pi (r + 1/r)/g",
    because="walls 4.3 half lengths off slow it by the order of (2 a/H)², 5.5 % (2.9 % at half as much again), inertia"
    " at g a²/nu = 0.15 by less than 1 %",
    tolerance=(2 * 7.5 / 64) ** 2,
    slow=True,
)
def jeffery() -> Measured:
    """Time of half a turn over Jeffery's: ellipse of 48 corners, axes 15 and 7.5 cells, between walls that slide."""
    found = lab.half_turn(64, 7.5, 3.75, 0.15) / (math.pi * 2.5)
    return Measured(1.0, found, abs(found - 1))
