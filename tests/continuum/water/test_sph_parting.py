"""Particles that lie on a wall and draw together are parted, in time, and no others."""

import numpy as np
import pytest

from continuum_sph.builders.simulation import Simulation
from continuum_sph.validation.water import setups as trials
from continuum_sph.water import step as step_module
from continuum_sph.water.parting import ASIDE, TOUCH, part_at_walls
from porescale.common.core.errors import Unstable

SPACING = 0.1


def on_the_floor(gap):
    """A tank with water whose first two particles lie on the floor, alone, ``gap`` (m) apart, and press on it."""
    model = Simulation(trials.column_scene(SPACING, tank=(2.0, 1.5), column=(0.5, 1.0), pressure="released"))
    layer = model.flow.layer
    layer.x[:2] = [[1.5, 0.0], [1.5 + gap, 0.0]]
    layer.v[:2], layer.acceleration[:2] = [0.0, -1.0], 0.0
    return model


@pytest.mark.parametrize("gap", [0.0, 0.5 * TOUCH * SPACING])
def test_two_in_one_place_on_the_floor_are_parted(gap, monkeypatch):
    model = on_the_floor(gap)
    model.advance(1)
    model.check()
    x = model.flow.layer.x
    assert abs(x[1, 0] - x[0, 0]) > ASIDE * SPACING
    monkeypatch.setattr(step_module, "part_at_walls", lambda *_: 0)  # the twin that must fail
    left = on_the_floor(gap)
    left.advance(1)
    assert abs(left.flow.layer.x[1, 0] - left.flow.layer.x[0, 0]) < 1e-3 * ASIDE * SPACING
    if gap == 0.0:
        with pytest.raises(Unstable, match="there, too"):
            left.check()


def test_others_are_left_alone():
    layer, bounds = on_the_floor(2.0 * TOUCH * SPACING).flow.layer, np.array([[0.0, 0.0], [2.0, 1.5]])
    before = layer.x.copy()
    assert part_at_walls(layer, bounds, SPACING) == 0
    layer.x[1] = [1.5, 1e-12]  # in the water, if barely
    assert part_at_walls(layer, bounds, SPACING) == 0
    assert np.array_equal(np.delete(layer.x, 1, 0), np.delete(before, 1, 0))


def test_two_in_a_corner_stay_in_the_tank():
    layer, bounds = on_the_floor(0.0).flow.layer, np.array([[0.0, 0.0], [2.0, 1.5]])
    layer.x[:2] = 0.0
    assert part_at_walls(layer, bounds, SPACING) > 0
    assert (layer.x[:2] >= 0.0).all()
    assert np.hypot(*(layer.x[1] - layer.x[0])) == pytest.approx(ASIDE * SPACING, rel=1e-12)
