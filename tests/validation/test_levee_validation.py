"""A saturated levee fails from its toe upwards, and one that is flat enough does not fail."""

from __future__ import annotations

import numpy as np
import pytest

from continuum_sph.scene.trials_levee import FAR, PARTS, Levee


def course(given):
    """Rows of the course of a levee."""
    return np.array([row for row, _ in given.course()])


@pytest.mark.slow
def test_toe_middle_and_crest_go_one_after_the_other():
    given = Levee(rows=8, end=2.3)
    times = given.times(course(given))
    assert times["toe"] < times["middle"] < times["crest"]


@pytest.mark.slow
def test_a_saturated_slope_flatter_than_its_limit_stays():  # the twin that must fail
    # Seepage along a slope takes the grains' buoyant weight γ' = 0.5 γ of soil that weighs γ: without dilatancy it
    # holds up to tan β = sin φ γ'/γ = 0.249, 1 : 4.02. One of 1 : 6 is far below.
    given = Levee(rows=8, end=2.3, land=6.0, river=6.0, pool=0.8)
    rows = course(given)
    assert rows[:, 1 : 1 + len(PARTS)].max() < 0.5 * FAR


def test_the_parts_lie_one_above_the_other_on_the_land_side():
    given = Levee(rows=8)
    _, top, _, toe = given.corners
    x = np.column_stack((np.linspace(top, toe, 200), np.zeros(200)))
    x[:, 1] = np.clip((toe - x[:, 0]) / (toe - given.corners[2]), 0.0, 1.0) * given.height - 0.05
    parts = given.watched(x)
    assert all(part.any() for part in parts.values())
    heights = [x[part, 1].mean() for part in parts.values()]
    assert heights == sorted(heights)
    assert not np.logical_and.reduce(list(parts.values())).any()


def test_what_never_moved_has_no_time():
    rows = np.array([[0.0, 0.0, 0.0, 0.0, 0.0], [0.1, 0.3, 0.1, 0.0, 0.0]])
    times = Levee().times(rows)
    assert times["toe"] == 0.1
    assert all(np.isnan(times[name]) for name in ("middle", "crest", "overtopped"))
