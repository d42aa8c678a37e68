"""Side walls of a channel brake the soil between them, hold what is at rest, and cost nothing where there are none."""

import math

import numpy as np
import pytest

from continuum_sph.builders.parts.soil import soil_law
from continuum_sph.scene.sections import Scene
from continuum_sph.soil import flow as soil_flow
from continuum_sph.soil.side_walls import brake_beside_walls
from continuum_sph.validation.soil.slopes import layer
from continuum_sph.validation.tanks import level_ground, tank_scene
from porescale.common.core.errors import InputError

WALLS = {"distance": "0.2 m", "friction_angle": "15 degree"}


def braked(v, stress, friction=3.0, step=0.01, density=1500.0):
    """Velocities (n, 2) m/s after a ``step`` (s) between walls."""
    v, stress = np.array(v), np.array(stress)
    brake_beside_walls.py_func(len(v), v, stress, np.full(len(v), density), friction, step)
    return v


def test_walls_take_their_share_of_the_mean_stress_against_the_velocity():
    found = braked([[3.0, -4.0]], [[1000.0, 3000.0, 500.0, 7.0]])
    taken = 0.01 * 3.0 * 2000.0 / 1500.0
    np.testing.assert_allclose(found, [[3.0 - 0.6 * taken, -4.0 + 0.8 * taken]], rtol=4e-16)


def test_walls_hold_what_they_can_and_push_nothing():
    found = braked([[0.01, 0.0], [0.0, 0.0], [1.0, 2.0]], [[2000.0] * 4, [2000.0] * 4, [-500.0, 400.0, 0.0, 0.0]])
    np.testing.assert_array_equal(found, [[0.0, 0.0], [0.0, 0.0], [1.0, 2.0]])  # soil under tension is off the walls


def scene(**soil) -> Scene:
    """A scene of level ground with ``soil`` in its section."""
    return tank_scene(1.0, 0.5, 0.05, lid=False, soil={"body": [level_ground(1.0, 0.3)]} | soil)


def test_a_scene_with_walls_has_their_friction_and_one_without_has_none():
    assert soil_law(scene(side_walls=WALLS)).side_friction == pytest.approx(2.0 * math.tan(math.radians(15.0)) / 0.2)
    assert soil_law(scene()).side_friction == 0.0


def test_a_soil_without_walls_runs_none_of_their_kernel(monkeypatch):
    called = []
    monkeypatch.setattr(soil_flow, "brake_beside_walls", lambda *given: called.append(given))
    for friction in (0.0, 1.0):
        layer(30.0, 6, side_friction=friction).advance()
        assert bool(called) == (friction > 0.0)


def test_walls_of_ground_that_is_held_are_refused():
    with pytest.raises(InputError, match=r"soil\.held.*side_walls"):
        soil_law(scene(held=True, saturated=True, side_walls=WALLS))


def test_a_layer_between_walls_that_bear_all_of_it_stays():
    """At d0 = 0: walls that rub by more than what friction lacks at any depth that has 0.01 of the layer."""
    spare = math.tan(math.radians(30.0)) - 0.5
    flow = layer(30.0, 6, side_friction=100.0 * spare)
    while flow.time < 0.2:
        flow.advance()
    free = layer(30.0, 6)
    while free.time < 0.2:
        free.advance()
    held, slid = (float(np.abs(it.soil.v[: it.soil.soil]).max()) for it in (flow, free))
    assert held < 0.05 * slid
