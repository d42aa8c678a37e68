"""The phreatic line: a file of heights, and what pictures show of it."""

import numpy as np
import pytest

from continuum_sph.builders.parts.instruments import MeasuredWater
from continuum_sph.builders.parts.phreatic import FIRST, line_of, phreatic_row, places, top
from porescale.common.neighbors import square_lattice
from porescale.common.record.model import Cloud as Points
from porescale.common.record.model import Snapshot

SPACING, WIDTH = 0.1, 4.0


def wet(heights):
    """A row of the file over water whose surface is ``heights`` of x."""
    x = square_lattice((0.0, 0.0), (WIDTH, 1.0), SPACING)
    x = x[x[:, 1] < heights(x[:, 0])]
    n = len(x)
    cloud = MeasuredWater(x, np.full(n, SPACING**2), np.zeros(n), np.zeros((n, 2)), 1.3 * SPACING, SPACING, WIDTH)
    return {"time (s)": 0.5} | phreatic_row(cloud)


def test_a_level_surface_is_level():
    # Half full is where half of the spline is summed. Heights a tenth of a spacing apart, and lines between: up to
    # 0.1²/8 W'/W = 0.0014 spacings off, with W'/W = 1.5/h at most there; sums of particles h/1.3 apart ripple by
    # 0.0011, as much as 0.0014 spacings.
    row = wet(lambda x: 0.6)
    assert row.pop("time (s)") == 0.5
    assert len(row) == len(places(WIDTH, SPACING)) == 20
    assert list(row.values()) == pytest.approx([0.6] * 20, abs=2.8e-3 * SPACING)


def test_a_surface_that_falls_is_followed():
    # A strip is four spacings broad and a lattice steps by one: half a spacing either way.
    row = wet(lambda x: 0.9 - 0.15 * x)
    x = np.array([float(name.removeprefix(FIRST).split()[0]) for name in list(row)[1:]])
    assert np.abs(np.array(list(row.values())[1:]) - (0.9 - 0.15 * x))[1:-1].max() <= 0.5 * SPACING


def snapshot(soil, time=0.5):
    """A snapshot with soil at (n, 2) m."""
    return Snapshot(time, 1, clouds={"soil": Points(soil)})


def table(*rows):
    """Columns of a file of rows."""
    return {name: np.array([row[name] for row in rows]) for name in rows[0]}


def test_the_line_is_drawn_within_soil_only():
    ground = square_lattice((0.0, 0.0), (2.0, 0.8), SPACING)
    drawn = line_of(table(wet(lambda x: 0.6)), SPACING)(snapshot(ground))
    assert max(end[0] for part in drawn for end in part) <= 2.0 + SPACING
    assert min(end[0] for part in drawn for end in part) <= 2.0 * SPACING
    flooded = square_lattice((0.0, 0.0), (WIDTH, 0.3), SPACING)
    assert line_of(table(wet(lambda x: 0.6)), SPACING)(snapshot(flooded)) == []  # the twin that must draw nothing


def test_it_is_that_of_the_time_of_the_picture():
    rows = [wet(lambda x: 0.3) | {"time (s)": 0.0}, wet(lambda x: 0.6) | {"time (s)": 1.0}]
    ground = square_lattice((0.0, 0.0), (WIDTH, 0.8), SPACING)
    line = line_of(table(*rows), SPACING)
    for time, height in ((0.1, 0.3), (0.9, 0.6)):
        assert line(snapshot(ground, time))[3][0][1] == pytest.approx(height, abs=0.01 * SPACING)


def test_a_run_without_the_file_has_no_line():
    assert line_of({}, SPACING)(snapshot(np.zeros((0, 2)))) == []


def test_there_is_no_top_where_there_is_no_soil():
    assert top(np.array([[0.5, 0.2], [0.55, 0.4]]), np.array([0.5, 2.0]), SPACING).tolist() == [0.4, -np.inf]
