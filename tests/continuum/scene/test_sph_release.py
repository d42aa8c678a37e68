"""Pressure of fluids just let go: the exact one of a column, none to move fluid at rest, and no knock at a bubble."""

import numpy as np
import pytest

from continuum_sph.builders.initial_pressure import lattice_pressure, released_pressure
from continuum_sph.builders.parts.water import water_flow
from continuum_sph.validation.tanks import tank_scene
from porescale.common.core.constants import GRAVITY
from porescale.common.core.errors import InputError
from porescale.common.neighbors import square_lattice


@pytest.mark.parametrize(("size", "lid"), [((0.5, 1.0), True), ((0.5, 1.2), False)])
def test_a_full_tank_has_the_pressure_of_rest(size, lid):
    x = square_lattice((0.0, 0.0), (0.5, 1.0), 0.05)
    found = lattice_pressure(x, np.full(len(x), 1000.0), 0.05, GRAVITY, size, lid)
    # linear: five-point differences are exact, what is left is the round-off of the solver
    np.testing.assert_allclose(found, 1000.0 * GRAVITY * (1.0 - x[:, 1]), atol=1e-8)


@pytest.mark.parametrize("across", [20, 40])
def test_a_column_with_a_free_face_has_the_series_pressure(across):
    x = square_lattice((0.0, 0.0), (1.0, 2.0), 1.0 / across)
    found = lattice_pressure(x, np.full(len(x), 1000.0), 1.0 / across, GRAVITY, (4.0, 3.0), True)
    exact = released_pressure(x[:, 0], x[:, 1], 1.0, 2.0, 1000.0, GRAVITY)
    # First order at the corner of face and floor, where the gradient has a logarithm: a twentieth of a spacing's head
    assert np.abs(found - exact).max() < 0.1 * 1000.0 * GRAVITY / across
    hydrostatic = 1000.0 * GRAVITY * (2.0 - x[:, 1])
    assert np.abs(hydrostatic - exact).max() > 10.0 * 1000.0 * GRAVITY / across  # the twin that must fail


def test_acceleration_is_continuous_across_a_layer_of_light_fluid():
    x = square_lattice((0.0, 0.0), (0.4, 1.0), 0.05)
    light = (x[:, 1] > 0.3) & (x[:, 1] < 0.5)
    density = np.where(light, 1.0, 1000.0)
    p = lattice_pressure(x, density, 0.05, GRAVITY, (0.4, 1.0), False)
    # layers that span the tank cannot move: the pressure carries their weight, half of each of two neighbours
    rows = p.reshape(-1, 8)
    weights = density.reshape(-1, 8)[:, 0]
    steps = 0.5 * (weights[:-1] + weights[1:]) * GRAVITY * 0.05
    np.testing.assert_allclose(-np.diff(rows, axis=0), np.broadcast_to(steps[:, None], (19, 8)), rtol=1e-9)


def let_go(width, column, **sections):
    """A tank 0.6 m high and ``width`` (m) wide with a column of water 0.4 m high, let go."""
    water = {"sound_speed": 20.0, "pressure": "released", "column": [{"width": column, "height": 0.4}]}
    return tank_scene(width, 0.6, 0.05, water=water, **sections)


def test_a_column_from_wall_to_wall_is_at_rest_when_let_go():
    """It had the pressure of one whose right face is free, 0 at the right wall, and ran to it."""
    scene = let_go(0.5, 0.5)
    rest = scene.model_copy(update={"water": scene.water.model_copy(update={"pressure": "hydrostatic"})})
    free = let_go(1.0, 0.5)  # the check that must fail
    released, at_rest, let = (water_flow(it).layer.density for it in (scene, rest, free))
    assert np.array_equal(released, at_rest)
    assert not np.array_equal(let, at_rest)


def ground(left):
    outline = [[left, 0], [1.0, 0], [1.0, 0.4], [left, 0.4]]
    return {"stiffness": 1e6, "permeability": 1e-2, "held": True, "body": [{"outline": outline}]}


@pytest.mark.parametrize("left", [0.5, 0.3])  # beside it, and in it
def test_a_column_beside_ground_is_not_let_go(left):
    with pytest.raises(InputError, match="is not known beside ground"):
        let_go(1.0, 0.5, soil=ground(left))


def test_a_column_apart_from_ground_is():
    assert let_go(1.0, 0.5, soil=ground(0.75)).water.pressure == "released"


@pytest.mark.parametrize("lid", [True, False])
def test_a_column_under_a_lid_is_not_let_go(lid):
    water = {"sound_speed": 20.0, "pressure": "released", "column": [{"width": 0.5, "height": 0.6}]}
    if lid:
        with pytest.raises(InputError, match="is not known under a lid"):
            tank_scene(1.0, 0.6, 0.05, water=water)
    else:
        assert tank_scene(1.0, 0.6, 0.05, water=water, lid=False)
