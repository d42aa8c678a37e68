"""Polygons in fluid: the references are those of forces along the sides, and rows would fail with the error next door.

That the rows hold is in test_coupling_validation.py.
"""

import math
from dataclasses import replace

import numpy as np
import pytest

from porescale.coupling.solid.choose import SOLID_OPERATORS
from porescale.validation.coupling import arrays, polygons, polygons_moving
from tests.reference.coupling.shapes import fractions
from tests.reference.coupling.stokes_polygons import Turning, regular
from tests.validation.tolerances import tolerance


@pytest.mark.slow
@pytest.mark.parametrize("degrees", [0, 20])
def test_drag_and_torque_of_squares_are_those_of_forces_along_their_sides(degrees):
    square = Turning(regular(4, 0.2, math.radians(45 + degrees)), levels=8, order=6)
    force, _ = square.loads([1.0, 0.0])
    # Stress at a corner goes as the distance to the power -0.455: what the last panel misses falls by 2^1.09 a level,
    # 6e-5 of the drag and 1.2e-4 of the torque at six of them, a fifth of that at eight.
    assert force[0] == pytest.approx(polygons.DENSER[degrees], rel=1e-4)
    # A square lattice of squares is as easy to flow through any way: nothing aside.
    assert abs(force[1]) < 1e-6 * force[0]
    _, torque = square.loads([0.0, 0.0], spin=1.0)
    assert -torque == pytest.approx(polygons.TURNING[degrees], rel=1e-4)


@pytest.mark.slow
def test_drag_of_plates_is_that_of_forces_along_their_sides():
    array = Turning(polygons.plate(0.6, 0.075), levels=5, order=6)
    along, across = array.loads([1.0, 0.0])[0][0], array.loads([0.0, 1.0])[0][1]
    assert along == pytest.approx(polygons.PLATES[0], rel=2e-4)
    assert across == pytest.approx(polygons.PLATES[90], rel=2e-4)


@pytest.mark.slow
def test_forces_along_many_sides_give_the_drag_of_discs():
    force, _ = Turning(regular(24, 0.2), levels=1, order=4).loads([1.0, 0.0])
    # The outline leaves the circle of its area by R (pi/n)²/3 at most, and drag goes with the radius to the power 1.4.
    assert force[0] == pytest.approx(arrays.SQUARE[0.2], rel=1.4 * (math.pi / 24) ** 2 / 3)


def test_fractions_by_points_do_not_add_up_to_the_area():
    corners = polygons.plate(20.0, 2.5, 30.0) + np.array((14.0, 14.0))

    def inside(x, y):
        found = np.ones(np.broadcast_shapes(x.shape, y.shape), bool)
        for (ax, ay), (bx, by) in zip(corners, np.roll(corners, -1, axis=0), strict=True):
            found &= (bx - ax) * (y - ay) - (by - ay) * (x - ax) > 0.0
        return found

    assert abs(fractions(inside, 28, 28).sum() - 50.0) > 1e6 * tolerance("coupling.area_of_polygons")


def test_squares_without_tips_let_too_much_through(monkeypatch):
    monkeypatch.setitem(SOLID_OPERATORS, "exact-wall", replace(SOLID_OPERATORS["exact-wall"], radius_shift=0.0))
    found = polygons.array_drag(polygons.square(0.1, 20.0), 32, places=[(0.3, 0.1)])[0]
    assert found / polygons.SQUARES[20] < 1 - 3 * tolerance("coupling.square_arrays_of_squares")


def test_a_plate_of_one_cell_is_no_plate():
    found = [polygons.plate_drag(13, turn) / polygons.PLATES[turn] - 1 for turn in (0, 90)]
    assert np.abs(found).max() > 2 * tolerance("coupling.arrays_of_plates")


def test_squares_half_a_cell_larger_take_too_much_torque():
    found = polygons.array_torque(polygons.square(0.2 * (10.34 / 9.84) ** 2, 0.0), 22)
    assert found / polygons.TURNING[0] > 1 + 3 * tolerance("coupling.torque_of_turning_squares")


def test_six_corners_do_not_make_a_disc():
    assert abs(polygons.beside_the_disc(6)) > 3 * tolerance("coupling.many_corners_make_a_disc")


def test_polygons_that_are_faster_than_the_flow_feel_it():
    assert max(polygons_moving.loads_on_neutral(5, extra=1e-9)) > 1e3 * tolerance(
        "coupling.neutral_polygons_feel_no_force"
    )


def test_without_the_fluid_inside_momentum_is_lost():
    assert polygons_moving.momentum_error(20, inside=False) > 1e6 * tolerance("coupling.momentum_of_polygons")


def test_a_plate_that_is_not_level_goes_aside():
    aside, tip = polygons_moving.level_plate(0.01, steps=100)
    assert abs(aside) > 1e3 * tolerance("coupling.level_plate_sinks_straight")
    assert abs(tip) > tolerance("coupling.level_plate_sinks_straight")


@pytest.mark.slow
def test_a_thinner_ellipse_turns_slower_than_jeffery_says_of_this_one():
    assert abs(polygons_moving.half_turn(64, 7.5, 3.0, 0.15) / (math.pi * 2.5) - 1) > tolerance(
        "coupling.jeffery_period"
    )
