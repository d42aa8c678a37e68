"""Ground just laid under water: its water bears its weight, it starts in balance, and consolidates as Terzaghi says."""

import numpy as np
import pytest

from continuum_sph.builders.simulation import Simulation
from continuum_sph.validation.tanks import level_ground, tank_scene
from porescale.common.core.constants import GRAVITY
from porescale.common.core.errors import InputError
from tests.reference.same_run import leaves

HIGH, WIDE, ROWS = 0.4, 0.25, 8
M, K = 1e7, 5e-4
BORNE = 0.6 * 1650.0 * GRAVITY * HIGH  # Pa, of the grains under water
SOUND = 283.0


def scene(of=None, **soil):
    ground = {"saturated": True, "stress": "unconsolidated", "stiffness": M * 0.52 / 0.7, "elastic": True,
              "permeability": K, "body": [level_ground(WIDE, HIGH)]}  # fmt: skip
    given = {
        "water": {"sound_speed": SOUND},
        "soil": ground | soil,
        "face": [{"side": "lid", "head": HIGH}],
        "probe": [{"name": "floor", "x": 0.5 * WIDE, "y": 0.0}],
    }
    return tank_scene(WIDE, HIGH, HIGH / ROWS, 0.1, **given | (of or {}))


def floor(model):
    """Pressure at the floor less that of water at rest, over the weight of the grains."""
    return (model.tables()["probes"]["floor pressure (Pa)"] - 1000.0 * GRAVITY * HIGH) / BORNE


def exact(time):
    """The same by Terzaghi: Σ 2/λ² exp(-λ² T_v)."""
    root = (2 * np.arange(200) + 1) * np.pi / 2
    spread = K / (1000.0 * GRAVITY * (1.0 / M + 0.4 / (1000.0 * SOUND**2)))
    return float((2.0 / root**2 * np.exp(-(root**2) * spread * time / HIGH**2)).sum())


def largest_error(given, since, until):
    model, worst = Simulation(given), 0.0
    while model.time < until:
        model.advance(20)
        if model.time > since:
            worst = max(worst, abs(floor(model) - exact(model.time)))
    model.check()
    return worst


def test_its_weight_leaves_the_water_as_terzaghi_has_it():
    """Sound of the start is k c/(g H) = 0.04 from rest and a fraction of it with Darcy's velocity; density diffusion
    spreads pressure by up to δ n² h g/(k c0) = 0.075 faster, 0.3 of which the pressure at the floor shows at most.
    From 0.01 s on, when two rows and more beside the floor have drained (√(4 c_v t) = 0.35 H): a floor is known to a
    part of a row."""
    assert largest_error(scene(), 0.01, 0.06) < 0.04 + 0.3 * 0.075
    # the check that fails: soil and water at rest without stress swing by all of the weight
    assert largest_error(scene(stress="none"), 0.0, 0.01) > 0.5


def test_water_and_grains_pass_each_other_at_darcys_velocity_and_displace_nothing():
    water = Simulation(scene()).flow.water
    v, soil = water.layer.v[: water.layer.fluid, 1], water.skeleton.v[:, 1]
    assert 0.4 * v + 0.6 * soil.mean() == pytest.approx(np.zeros(len(v)), abs=1e-15)
    assert 0.4 * (v - soil.mean()) == pytest.approx(np.full(len(v), K * 0.99))


def test_under_ten_g_they_pass_each_other_ten_times_as_fast():
    """k is that under 9.81 m/s²; the same velocity at any gravity would begin with nine tenths of it missing."""
    water = Simulation(scene(of={"gravity": 98.1})).flow.water
    v, soil = water.layer.v[: water.layer.fluid, 1], water.skeleton.v[:, 1]
    assert 0.4 * (v - soil.mean()) == pytest.approx(np.full(len(v), 10.0 * K * 0.99))


def test_it_goes_on_bit_for_bit():
    whole, part, resumed = (Simulation(scene()) for _ in range(3))
    whole.advance(9)
    part.advance(4)
    resumed.restore(part.state())
    resumed.advance(5)
    assert dict(leaves(whole.state())) == dict(leaves(resumed.state()))


@pytest.mark.parametrize("soil", [{"held": True}, {"saturated": False}])
def test_ground_that_cannot_consolidate_is_refused(soil):
    with pytest.raises(InputError, match="is of ground with full pores that may move"):
        scene(**soil)
