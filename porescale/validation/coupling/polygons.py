"""Polygons that stand still in slow flow: the area they cover, drag and torque of square arrays.  Lattice units.

References: drag F/(mu U) of square arrays, U superficial, and torque over mu w and the cell, of forces along the sides
(tests/reference/coupling/stokes_polygons.py), five digits.
"""

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike

from porescale.common.core.types import Floats
from porescale.common.evidence.validations import Measured, Validations
from porescale.coupling.coverage.polygon import Polygons
from porescale.coupling.coverage.rows import make_patches
from porescale.coupling.psm import SaturatedCells
from porescale.lbm.fluid import Fluid
from porescale.lbm.lattice import viscosity
from porescale.validation.coupling.setups import NO_DISCS, PERIODIC, TAU
from porescale.validation.coupling.towed import square_array_drag
from porescale.validation.lbm.channels import run

EPS = float(np.finfo(float).eps)
VALIDATIONS = Validations()


def regular(corners: int, area: float, degrees: float = 0.0) -> Floats:
    """Corners (k, 2) of a regular polygon of this area about 0, the first one ``degrees`` from the x axis."""
    radius = math.sqrt(2.0 * area / (corners * math.sin(2.0 * math.pi / corners)))
    angle = math.radians(degrees) + 2.0 * np.pi * np.arange(corners) / corners
    return radius * np.column_stack((np.cos(angle), np.sin(angle)))


def plate(length: float, thickness: float, degrees: float = 0.0) -> Floats:
    """Corners (4, 2) of a plate about 0, its length ``degrees`` from the x axis."""
    a, b = 0.5 * length, 0.5 * thickness
    cosine, sine = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
    x, y = np.array([-a, a, a, -a]), np.array([-b, -b, b, b])
    return np.column_stack((cosine * x - sine * y, sine * x + cosine * y))


def ellipse(a: float, b: float, corners: int = 48) -> Floats:
    """Corners (k, 2) of a polygon with the area and, but for its corners, the shape of an ellipse about 0."""
    angle = 2.0 * np.pi * (np.arange(corners) + 0.5) / corners
    wider = math.sqrt(2.0 * math.pi / (corners * math.sin(2.0 * math.pi / corners)))
    return wider * np.column_stack((a * np.cos(angle), b * np.sin(angle)))


def array_drag(
    corners: ArrayLike,
    cells: int,
    *,
    places: Sequence[tuple[float, float]] = ((0.125, 0.125), (0.125, 0.375), (0.375, 0.125), (0.375, 0.375)),
    change: float = 1e-5,
) -> list[float]:
    """Drag F/(mu U) of a square array of a polygon (k, 2), in parts of the period, for each place in a cell.

    Driven by a body force G along x: the drag is G times the box, U the conserved flux.
    """
    nu, found = viscosity(TAU), []
    force = 1e-6 * nu
    for place in places:
        fluid = Fluid(cells, cells, TAU, force=(force, 0.0), sides=PERIODIC)
        body = Polygons([cells * np.asarray(corners, float)])
        body.centre[0] = 0.5 * cells + place[0], 0.5 * cells + place[1]
        wet = SaturatedCells(fluid, np.zeros(0), polygons=body)
        flux, before = 0.0, math.nan
        while not abs(flux - before) <= change * abs(flux):
            run(lambda: wet.advance(fluid, *NO_DISCS), max(50, math.ceil(cells**2 / (25.0 * nu))))  # noqa: B023
            flux, before = fluid.momentum()[0] / cells**2, flux
        found.append(force * cells**2 / (nu * flux))
    return found


def array_torque(corners: ArrayLike, cells: int) -> float:
    """Torque over mu w and the box's area of a square array of a polygon, in parts of the period, that all turn with w
    and have not got anywhere."""
    nu, spin = viscosity(TAU), 1e-9
    fluid = Fluid(cells, cells, TAU, sides=PERIODIC)
    body = Polygons([cells * np.asarray(corners, float)])
    body.centre[0], body.spin[0] = (0.5 * cells + 0.3, 0.5 * cells + 0.1), spin
    wet = SaturatedCells(fluid, np.zeros(0), polygons=body)
    run(lambda: wet.advance(fluid, *NO_DISCS), math.ceil(cells**2 / nu))
    return -float(wet.polygon_load[0, 2]) / (nu * spin * cells**2)


def area_errors(shapes: Sequence[Floats], angles: int) -> list[float]:
    """Largest errors of the sum of solid fractions over angles and places, cells², of each polygon (k, 2)."""
    fluid, found = Fluid(64, 64, TAU), []
    for corners in shapes:
        body = Polygons([corners])
        cells = body.fit(fluid, 0.0, 0)
        patches = make_patches(cells, cells, np.dtype(np.float64))
        worst = 0.0
        for k in range(angles):
            body.angle[0], body.centre[0] = math.pi * k / angles, (20.0 + 0.618 * k % 1.0, 30.0 + 0.414 * k % 1.0)
            body.cover(patches, 0)
            covered = patches.fraction[: patches.height[0] * patches.stride[0]]
            worst = max(worst, abs(float(covered.sum()) - float(body.area[0])))
        found.append(worst)
    return found


SQUARES = {0: 26.945294, 20: 27.982393, 45: 29.739357}
"""Drag of square arrays of squares, solid fraction 0.1, turned by so many degrees."""

DENSER = {0: 55.353423, 20: 60.926498}
"""The same at solid fraction 0.2."""

TURNING = {0: 1.209845, 20: 1.283351}
"""Torque of turning squares, solid fraction 0.2."""

PLATES = {0: 13.673741, 30: 18.646834, 90: 71.364736}
"""Drag of square arrays of plates, 0.6 by 0.075 of the period, turned by so many degrees, that turn flow aside freely:
of the tensor R, R_xx - R_xy²/R_yy."""

REQUIRED = 0.01
"""Largest error of a mean over places in a cell, as for discs (arrays.py)."""


def square(fraction: float, degrees: float) -> Floats:
    """A square that takes this part of a cell of side 1, its sides turned by ``degrees`` from the axes."""
    return regular(4, fraction, 45.0 + degrees)


@VALIDATIONS.row(
    "coupling.area_of_polygons",
    source="shoelace formula",
    because="each of some 100 cells that the outlines cross is good to a rounding of the extent of 24 cells, all one"
    " way",
    tolerance=EPS * 24 * 100,
)
def areas() -> Measured:
    """Largest error of the sum of fractions, cells, of a square, a plate and an ellipse at 180 angles and places."""
    return Measured.absolute(0.0, area_errors([regular(4, 100.0), plate(20.0, 2.5), ellipse(10.0, 4.0)], 180))


@VALIDATIONS.row(
    "coupling.square_arrays_of_squares",
    source="Stokes drag on square arrays of squares, solid fraction 0.1 and 0.2, turned by 0, 20, 45 degrees, by forces"
    " along the sides",
    because="1 % as for discs; tips at the corners follow from the radius shift of discs: no constant was chosen on"
    " these",
    tolerance=REQUIRED,
    slow=True,
)
def squares() -> Measured:
    """Drag at 10 cells a side, tau 0.8, mean over places."""
    found = [
        float(np.mean(array_drag(square(c, turn), cells)))
        for c, cells, drags in ((0.1, 32, SQUARES), (0.2, 22, DENSER))
        for turn in drags
    ]
    return Measured.relative([*SQUARES.values(), *DENSER.values()], found)


@VALIDATIONS.row(
    "coupling.arrays_of_plates",
    source="Stokes drag on square arrays of plates, 8 : 1, along, across and at 30 degrees, by forces along the sides",
    because="1 % as for discs: faces of a plate of 3 cells have a full cell between them",
    tolerance=REQUIRED,
    slow=True,
)
def plates() -> Measured:
    """Drag at 24 by 3 cells, tau 0.8, mean over two places."""
    return Measured.relative(list(PLATES.values()), [plate_drag(40, turn) for turn in PLATES])


def plate_drag(cells: int, degrees: float) -> float:
    """Drag of the array of plates in a box of so many cells."""
    return float(np.mean(array_drag(plate(0.6, 0.075, degrees), cells, places=[(0.125, 0.375), (0.375, 0.125)])))


@VALIDATIONS.row(
    "coupling.torque_of_turning_squares",
    source="squares of a square array that all turn, solid fraction 0.2, by forces along the sides",
    because="as discs (coupling.torque_of_a_turning_array): of the shift that the drag wants, 0.28 cells², at most all"
    " is too much for the torque, 2 pi 0.28 in an area that it goes with to the power 1.25: 2.3 % at 10 cells a side",
    tolerance=1.25 * 2 * math.pi * 0.28125 / (0.2 * 22**2),
)
def turning() -> Measured:
    """Torque over mu w and the cell at 10 cells a side, tau 0.8, sides at 0 and 20 degrees."""
    return Measured.relative(list(TURNING.values()), [array_torque(square(0.2, turn), 22) for turn in TURNING])


def beside_the_disc(corners: int, cells: int = 25, solid_fraction: float = 0.2) -> float:
    """Drag of a square array of polygons over that of discs of the same area, at the same place, less one."""
    place = [(0.125, 0.375)]
    radius = math.sqrt(solid_fraction / math.pi)
    disc = square_array_drag(2 * radius * cells, solid_fraction, places=place)[0]
    return array_drag(regular(corners, solid_fraction, 7.0), cells, places=place, change=1e-6)[0] / disc - 1


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
