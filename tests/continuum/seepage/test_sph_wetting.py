"""How a wetting line sags: what phreatic.csv says of it, and what Boussinesq's equation and Darcy's law say it does."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from continuum_sph import load
from continuum_sph.builders.parts.phreatic import sagging, wetting_line
from continuum_sph.validation.seepage.wetting import LEVEE, in_strips, lines

X = np.linspace(0.0, 1.0, 201)
BOUSSINESQ = 1.616
"""Way of the front over √(k h0 t/n), n ∂h/∂t = k ∂(h ∂h/∂x)/∂x, h = h0 at an upright face (Barenblatt 1952)."""


@pytest.mark.parametrize(
    ("shape", "expected"),
    [(lambda s: 1.0 - s, 0.0), (lambda s: (1.0 - s) ** 2, 1.0 / 6.0), (lambda s: np.sqrt(1.0 - s), -1.0 / 6.0)],
)
def test_sag_tells_straight_hanging_and_standing_lines_apart(shape, expected):
    end, sag = sagging(X, 0.3 * shape(X))
    assert end == 1.0
    # trapezoids of 1/200: exact, 1/200² f'/12 of a parabola, 0.21 (1/200)^1.5 of a root at its upright end
    assert sag == pytest.approx(expected, abs=0.21 * 0.005**1.5 + 1e-12)


def test_a_line_that_does_not_fall_or_has_hardly_begun_has_no_sag():
    assert sagging(X[:3], np.array([0.3, 0.2, 0.1])) == (0.0, 0.0)
    assert sagging(X, np.full(len(X), 0.3)) == (0.0, 0.0)
    assert sagging(np.zeros(0), np.zeros(0)) == (0.0, 0.0)


def test_the_line_starts_where_the_rivers_surface_meets_the_ground():
    x = np.arange(0.02, 2.0, 0.04)
    ground = np.where((x > 0.3) & (x < 1.86), LEVEE.ground(x), -np.inf)
    heights = np.where(x < 0.86, 0.28, np.maximum(0.0, 0.28 - 0.5 * (x - 0.86)))
    places, line = wetting_line(x, heights, ground)
    # both are straight between strips, but for the corner of the surface itself, which lies on the crossing
    assert (places[0], line[0]) == pytest.approx((0.86, 0.28), abs=0.02)
    assert places[-1] == pytest.approx(1.42 - 0.02, abs=0.02)
    assert sagging(places, line)[1] == pytest.approx(0.0, abs=0.02)
    # none without a river on its left, nor where the river stands over all of the ground
    assert not wetting_line(x[10:15], heights[10:15] * 0.1, ground[10:15])[0].size
    assert not wetting_line(x, np.full(len(x), 0.4), ground)[0].size


def test_it_ends_where_water_comes_out_again():
    x = np.arange(0.02, 2.0, 0.04)
    ground = np.where((x > 0.3) & (x < 1.86), LEVEE.ground(x), -np.inf)
    places, line = wetting_line(x, np.where(x < 1.86, 0.2, 0.1), ground)
    assert places[-1] == pytest.approx(1.86 - 0.4, abs=0.04)  # where the land side is 0.2 m high, to a strip
    assert line[-1] == 0.2


def test_the_foot_in_dry_ground_goes_as_boussinesq_says():
    # (H H')' + ξ/2 H' = 0 from the foot, where H = ξ_f/2 (ξ_f - ξ), back to the face, where H is 1; four digits given
    def slope(back, y):
        return [y[1], (0.5 * (BOUSSINESQ - back) * y[1] - y[1] ** 2) / y[0]]

    start = 1e-5
    foot = [0.5 * BOUSSINESQ * start, 0.5 * BOUSSINESQ]
    found = solve_ivp(slope, (start, BOUSSINESQ), foot, rtol=1e-9, atol=1e-11, dense_output=True)
    assert found.y[0, -1] == pytest.approx(1.0, abs=5e-4)
    x = np.linspace(start, BOUSSINESQ, 1001)
    assert sagging(x, found.sol(x)[0][::-1])[1] == pytest.approx(-0.049, abs=5e-4)


def darcy(seconds, times):
    """(last place m, sag) at ``times`` (s) in the levee of the case, the river risen in so many ``seconds``."""
    levee = replace(LEVEE, rising=seconds)
    found, (x, heights) = [], lines(levee, times, 0.03)
    for time, line in zip(times, heights, strict=True):
        edge = 0.3 + 2.0 * levee.level(time)
        within = (x > edge) & (line > 0.0)
        found.append(sagging(np.append(edge, x[within]), np.append(levee.level(time), line[within])))
    return np.array(found)


def test_by_darcys_law_the_line_sags_as_long_as_the_river_rises_and_no_longer():
    rising, standing = darcy(5.0, (3.0, 5.0)), darcy(0.1, (5.0, 8.0))
    assert (rising[:, 1] > 0.08).all()
    assert (standing[:, 1] < 0.04).all()  # the check that must fail: a river that stands


def test_strips_blunt_the_corner_of_a_line_the_less_the_narrower_they_are():
    # a line that falls at 1 : 2 from half of the river's height on, which it drops to where the river meets the slope
    time, x = 5.0, np.linspace(0.0, 2.16, 2161)
    level = LEVEE.level(time)
    edge = 0.3 + 2.0 * level
    line = np.maximum(0.0, 0.5 * level - 0.5 * (x - edge))
    exact = 0.25  # mean of the chord level/2, of the line level/4
    sags = [in_strips(LEVEE, time, x, line, spacing)[1] for spacing in (0.03, 0.015, 0.0075)]
    assert sags == sorted(sags)
    # half a strip of four spacings is averaged over at the corner, of a line as long as the river is high
    assert [exact - sag for sag in sags] == pytest.approx([0.0] * 3, abs=0.5 * exact)
    assert exact - sags[-1] < 2.0 * 0.0075 / level


def test_the_levee_of_the_row_is_that_of_the_case():
    case, row = load("dry_levee"), LEVEE.scene(0.02)
    assert (row.tank.width, row.tank.height) == pytest.approx((case.tank.width, case.tank.height))
    assert row.water == case.water
    for key in ("porosity", "permeability"):
        assert getattr(row.soil, key) == getattr(case.soil, key)
    assert sorted(row.soil.body[0].outline) == sorted(case.soil.body[0].outline)
    assert [it.table for it in row.reservoir] == [it.table for it in case.reservoir]
    sides = [[side for it in scene.reservoir for side in (it.left, it.right)] for scene in (row, case)]
    assert sides[0] == pytest.approx(sides[1])
