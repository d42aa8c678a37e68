"""The phreatic line: a file of heights, and what pictures show of it."""

import numpy as np
import pytest

from continuum_sph.builders.parts.instruments import MeasuredWater
from continuum_sph.builders.parts.phreatic import END, FIRST, SAG, line_of, phreatic_row, places, top
from porescale.common.neighbors import square_lattice
from porescale.common.record.model import Cloud as Points
from porescale.common.record.model import Snapshot

SPACING, WIDTH = 0.1, 4.0


def wet(heights, soil=None):
    """A row of the file over water whose surface is ``heights`` of x, and soil at (n, 2) m, else none."""
    x = square_lattice((0.0, 0.0), (WIDTH, 1.0), SPACING)
    x = x[x[:, 1] < heights(x[:, 0])]
    n = len(x)
    cloud = MeasuredWater(x, np.full(n, SPACING**2), np.zeros(n), np.zeros((n, 2)), 1.3 * SPACING, SPACING, WIDTH)
    return {"time (s)": 0.5} | phreatic_row(cloud, np.zeros((0, 2)) if soil is None else soil)


def surfaces(row):
    """Heights of a row, by column."""
    return {name: height for name, height in row.items() if name.startswith(FIRST)}


def test_a_level_surface_is_level():
    # Half full is where half of the spline is summed. Heights a tenth of a spacing apart, and lines between: up to
    # 0.1²/8 W'/W = 0.0014 spacings off, with W'/W = 1.5/h at most there; sums of particles h/1.3 apart ripple by
    # 0.0011, as much as 0.0014 spacings.
    row = wet(lambda x: 0.6)
    assert row["time (s)"] == 0.5
    assert len(surfaces(row)) == len(places(WIDTH, SPACING)) == 20
    assert list(surfaces(row).values()) == pytest.approx([0.6] * 20, abs=2.8e-3 * SPACING)


def test_a_surface_that_falls_is_followed():
    # A strip is four spacings broad and a lattice steps by one: half a spacing either way.
    row = surfaces(wet(lambda x: 0.9 - 0.15 * x))
    x = np.array([float(name.removeprefix(FIRST).split()[0]) for name in row])
    assert np.abs(np.array(list(row.values())) - (0.9 - 0.15 * x))[1:-1].max() <= 0.5 * SPACING


def test_a_row_says_how_far_soil_is_wet_and_how_the_line_sags():
    soil = square_lattice((1.0, 0.0), (WIDTH, 1.0), SPACING)
    row = wet(lambda x: np.where(x < 1.0, 0.8, 0.8 * np.maximum(0.0, 1.0 - 0.5 * (x - 1.0))), soil)
    # The lowest row ends where the surface is half a spacing high, 1.25 spacings before; half of a strip has to hold
    # it, and strips are two spacings apart.
    assert 3.0 - 3.25 * SPACING <= row[END] <= 3.0
    # heights to half a spacing of 8, as above, half as much in their mean
    assert row[SAG] == pytest.approx(0.0, abs=0.5 * 0.5 / 8)
    hanging = wet(lambda x: np.where(x < 1.0, 0.8, 0.8 * np.maximum(0.0, 1.0 - 0.5 * (x - 1.0)) ** 2), soil)
    # (1 - s)² up to 0.6, where half a row is left to be seen near s = 0.65: (0.58 - 0.52)/0.84
    assert hanging[SAG] == pytest.approx(0.071, abs=0.5 * 0.5 / (0.84 * 8))
    assert (wet(lambda x: 0.8)[END], wet(lambda x: 0.8)[SAG]) == (0.0, 0.0)  # no soil


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
