"""Excess of the volume of water among grains: what it is, where there is none, and what becomes of it."""

from typing import Any

import numpy as np
import pytest

from continuum_sph.builders.simulation import Simulation
from continuum_sph.seepage.mixture import INSIDE, LEAST_ROOM, LINES, POROSITY, SLIP_X, SLIP_Y, SOIL, find_enclosed
from continuum_sph.seepage.overlap import Overlap, overlap_weights
from continuum_sph.seepage.volume_excess import (
    BULK,
    LET,
    PACE,
    Edges,
    excess_about_water,
    fill_about_soil,
    room_before,
    take_up,
)
from continuum_sph.validation.tanks import level_ground, tank_scene
from continuum_sph.water.smoothing import SUPPORT
from continuum_sph.water.state import DIFFUSIVE, VOLUME, P
from tests.reference.continuum import seepage as slow

eps = np.finfo(float).eps
H, PERIOD = 0.13, np.array([1.0, 1.0])


def lattice(columns: int = 10, spacing: float = 0.1) -> np.ndarray:
    i, j = np.meshgrid(np.arange(columns), np.arange(columns))
    return (np.column_stack((i.ravel(), j.ravel())) + 0.5) * spacing


def found(x, volume, material, soil_x, bulk, room):
    """Excess of the kernels in a periodic box."""
    n, s = len(x), len(soil_x)
    overlap = Overlap(n, s, H, 0.02, (0.0, 0.0), (1.0, 1.0), (True, True))
    overlap.update(x, soil_x)
    start, partner, weight = overlap.rows
    overlap_weights(start, partner, overlap.x, weight, H, 1.0, 1.0)
    record, burden = np.zeros((n, 8)), np.zeros((s, 8))
    record[:, VOLUME], burden[:, BULK] = volume, bulk
    full, excess, pores = np.zeros(s), np.full(n, np.nan), np.ones((LINES, n))
    fill_about_soil(n, start, partner, weight, record, material, room, full)
    own, rows = np.repeat(np.arange(n), np.diff(start[: n + 1])), slice(start[n])
    pores[SOIL] = np.bincount(own, burden[partner[rows] - n, BULK] * weight[rows], n)
    enclosed = np.zeros(n, np.bool_)
    find_enclosed(n, pores, enclosed)
    excess_about_water(n, start, partner, weight, burden, material, enclosed, full, excess)
    return excess


def test_what_runs_along_the_surface_of_soil_is_left_alone():
    x, room, water = lattice(), np.ones(100), np.zeros(100, np.int64)
    bulk = np.where(x[:, 1] < 0.5, 0.01, 0.0)  # no soil above
    excess = found(x, np.full(100, 0.0104), water, x, bulk, room)
    deep = (x[:, 1] > 0.2) & (x[:, 1] < 0.3)  # the box is periodic, and the kernel reaches 0.26
    assert (excess[deep] > 0.0).all()
    assert not excess[x[:, 1] > 0.4].any()


def test_the_excess_is_that_of_the_dense_sums():
    rng = np.random.default_rng(3)
    x, soil_x = (lattice() + rng.uniform(-0.03, 0.03, (100, 2)) for _ in range(2))
    volume, bulk, room = rng.uniform(0.009, 0.012, 100), rng.uniform(0.009, 0.011, 100), rng.uniform(0.9, 1.0, 100)
    material = (rng.uniform(size=100) < 0.1).astype(np.int64)
    expected = slow.excess(x, volume, material == 0, soil_x, bulk, room, H, PERIOD, LET, INSIDE)
    assert 20 < (expected > 0.0).sum() < 95
    # sums of some 25 terms of one sign, twice, less 1
    np.testing.assert_allclose(found(x, volume, material, soil_x, bulk, room), expected, atol=100 * eps)


def test_a_full_lattice_has_none_and_one_of_larger_particles_what_they_are_larger_by():
    x, room, water = lattice(), np.ones(100), np.zeros(100, np.int64)
    bulk = np.full(100, 0.01)
    assert not found(x, bulk, water, x, bulk, room).any()
    # sums of the cubic spline over a lattice of h/1.3 are 1 to 0.0011 wherever the point lies (`overlap`), here twice
    np.testing.assert_allclose(found(x, 1.04 * bulk, water, x + 0.03, bulk, room), 0.04 - LET, atol=2.5 * 0.0011)
    assert not found(x, 0.9 * bulk, water, x, bulk, room).any()


def test_the_way_through_soil_takes_the_excess_up_and_the_budget_says_so():
    n = 4
    record, pores, mass = np.zeros((n, 8)), np.zeros((LINES, n)), np.array([4.0, 4.0, 4.0, 0.0])
    pores[POROSITY] = 0.4
    rho = np.array([1000.0, 1010.0, 1020.0, 1000.0])
    record[:, VOLUME], record[:, P] = mass / (0.4 * rho), [100.0, 200.0, 300.0, 0.0]
    pores[SLIP_X], pores[SLIP_Y] = [0.3, 0.0, 0.3, 0.0], [0.4, 0.0, 0.4, 0.0]
    excess, rate, power = np.array([0.02, 0.02, 0.0, 0.02]), np.ones(n), np.zeros((n, 6))
    take_up(n, mass, record, pores, excess, PACE / H, rate, power)
    # none at rest, none without an excess, none where a reservoir has taken the particle out since
    gained = np.array([1000.0 * 0.02 * PACE * 0.5 / H, 0.0, 0.0, 0.0])
    np.testing.assert_allclose(rate, 1.0 + gained, rtol=10 * eps)
    np.testing.assert_allclose(power[:, DIFFUSIVE], -mass * record[:, P] / rho**2 * gained, rtol=10 * eps)
    assert not np.delete(power, DIFFUSIVE, axis=1).any()


def dense_room(x, seen, h):
    """Sums of W over lattice points that are ``seen`` from x, their spacing 1."""
    return slow.spline(np.hypot(seen[:, 0] - x[0], seen[:, 1] - x[1]), h).sum()


@pytest.mark.parametrize(
    "at", [(0.5, 0.5), (1.5, 0.5), (2.5, 0.5), (10.5, 0.5), (10.5, 0.9), (10.5, 10.5), (19.5, 39.5)]
)
def test_room_before_walls_is_that_of_the_lattice_before_them(at):
    h = 1.375
    walls = Edges(np.zeros(2), np.array([20.0, 40.0]))
    i, j = np.meshgrid(np.arange(20) + 0.5, np.arange(40) + 0.5)
    points = np.column_stack((i.ravel(), j.ravel()))
    # the kernel is no product: 1 % in a corner; its sum over a lattice is up to 1.0016
    assert room_before(walls, np.array([at]), 1.0, h)[0] == pytest.approx(dense_room(at, points, h), abs=0.01 * 0.56)


@pytest.mark.parametrize("at", [(19.0, 20.5), (18.0, 20.5), (21.0, 20.5), (19.0, 19.5), (20.0, 19.5), (19.0, 25.5)])
def test_room_beside_a_pile_is_that_of_what_is_seen_past_it(at):
    h, pile = 1.375, (20.0, 20.0, 0.5)
    i, j = np.meshgrid(np.arange(41.0), np.arange(41) + 0.5)
    points = np.column_stack((i.ravel(), j.ravel()))
    above, behind = points[:, 1] > 20.0, (points[:, 0] > 20.0) == (at[0] < 20.0)
    hidden = above & ((np.abs(points[:, 0] - 20.0) < 0.5) | (behind & (at[1] > 20.0)))
    walls = Edges(np.full(2, -np.inf), np.full(2, np.inf), pile)
    found = room_before(walls, np.array([at]), 1.0, h)[0]
    assert found == pytest.approx(dense_room(at, points[~hidden], h), abs=0.005)
    assert found < 1.0 - 0.01 or at[0] == 18.0


def test_no_wall_is_all_room():
    x = np.array([[0.0, 0.0], [-SUPPORT, 3.0]])
    none = Edges(np.full(2, -np.inf), np.full(2, np.inf))
    np.testing.assert_array_equal(room_before(none, x, 1.0, 1.375), 1.0)


def test_soil_that_has_left_the_tank_has_some_room_too():
    edges = Edges(np.zeros(2), np.array([20.0, 40.0]))
    assert room_before(edges, np.array([[-9.0, 3.0]]), 1.0, 1.375)[0] == LEAST_ROOM


def held(depth: float, height: float, water: dict[str, Any], **more: Any) -> Simulation:
    """Ground of a ``depth`` (m) that is held, in a tank 0.4 m wide and of a ``height`` (m), with a column of water."""
    given = {
        "soil": {"stiffness": 2e6, "held": True, "permeability": 0.05, "body": [level_ground(0.4, depth)]},
        "water": {"column": [{"width": 0.4, "height": 0.3} | water]},
    }
    return Simulation(tank_scene(0.4, height, 0.02, lid=False, **given | more))


def wetted() -> Simulation:
    """Water that sinks into dry ground."""
    numerics = {"spacing": 0.02, "tension": "cut", "artificial_viscosity": 0.1}
    return held(0.3, 0.8, {"bottom": 0.3}, numerics=numerics)


def test_water_at_rest_in_ground_has_none_at_walls_either():
    model = held(0.2, 0.5, {}, pile={"x": 0.2, "tip": 0.1})
    model.advance(50)
    water = model.flow.water
    water.find_excess()
    assert not water.corrected
    assert np.abs(water.full).max() < 0.01  # a kernel that is no product: 1 % in corners


def test_a_resumed_run_goes_on_with_the_excess_it_had():
    model = wetted()
    while not model.flow.water.corrected:
        model.advance(20)
    state = model.state()
    other = wetted()
    other.restore(state)
    assert other.flow.water.corrected
    for each in (model, other):
        each.advance(40)
    a, b = model.state()["water"]["flow"], other.state()["water"]["flow"]
    np.testing.assert_array_equal(a["layer"]["x"], b["layer"]["x"])
    np.testing.assert_array_equal(a["excess"], b["excess"])
