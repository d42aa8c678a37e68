"""A levee that stands by suction and fails as it is wetted."""

import math
from dataclasses import replace

import numpy as np
import pytest

from continuum_sph.scene.sections import Scene
from continuum_sph.validation.unsaturated import levee
from continuum_sph.validation.unsaturated.levee import KEPT, STANDARD, Course, Levee
from tests.validation.tolerances import ROWS


def test_its_scene_has_suction_and_no_particles_of_water():
    scene = Scene.model_validate(Levee().table())
    assert scene.soil.suction.water_table == pytest.approx(0.2)
    assert not scene.water.column
    assert [it.name for it in scene.reservoir] == ["river"]


def test_times_are_read_on_lines_between_rows():
    rows = np.array([[0.0, 0.0, 0.0, 0.0, -0.1], [1.0, 0.4, 0.1, 0.0, 0.1]])
    found = Levee().times(rows)
    assert found["toe"] == pytest.approx(0.5)
    assert found["overtopped"] == pytest.approx(0.5)
    assert math.isnan(found["middle"])


def test_the_time_of_a_factor_of_one_is_read_on_lines_too():
    time = np.linspace(0.0, 3.0, 301)
    toe = np.where(time > 2.0, (np.maximum(0.0, time - 2.0)) ** 3, 0.0)
    course = Course(np.column_stack((time, toe, toe, toe, toe)), time[::10], 2.0 - 0.5 * time[::10])
    assert course.critical == pytest.approx(2.0)
    assert course.falls == pytest.approx(0.5)
    assert course.slides(1.0) == pytest.approx(0.05 ** (1.0 / 3.0), abs=0.01)
    assert math.isnan(Course(course.rows, course.at, course.factors + 2.0).critical)


@pytest.mark.slow
def test_toe_middle_and_crest_go_in_this_order_and_then_the_crest_lies_under_the_river():
    found = STANDARD.times(levee.followed().rows)
    assert found["toe"] < found["middle"] < found["crest"]
    assert found["overtopped"] < found["crest"] + 1.0
    # with the river kept low none goes: continuum.levee_stands_by_suction


@pytest.mark.slow
def test_its_factor_is_above_one_until_it_moves():
    course = levee.followed()
    assert course.factors[0] > 1.1
    toe = float(np.interp(course.critical, course.rows[:, 0], course.rows[:, 1]))
    assert toe < 0.06 * STANDARD.height


@pytest.mark.slow
@pytest.mark.parametrize("row", [levee.sliding_row, levee.standing_row])
def test_the_rows_of_the_levee_hold(row):
    measured = row()
    name = {levee.sliding_row: "levee_slides_as_its_factor_falls", levee.standing_row: "levee_stands_by_suction"}[row]
    assert measured.error <= ROWS[f"continuum.{name}"].tolerance


@pytest.mark.slow
def test_without_suction_it_moves_three_times_as_far_as_it_may():  # the twin that must fail
    rows = np.array([row for row, _ in replace(KEPT, alpha=200.0).course()])
    assert rows[:, 1:4].max() / KEPT.height > 2.9 * ROWS["continuum.levee_stands_by_suction"].tolerance
