"""Scenes of soil and water: refused, built, at rest, resumed."""

import numpy as np
import pytest

from continuum_sph.builders.parts import pore_water
from continuum_sph.builders.parts.mixture import DRY, WET
from continuum_sph.builders.parts.sheet_pile import NAME
from continuum_sph.builders.parts.stiffness import sound_speed
from continuum_sph.builders.reports.seepage_report import seepage_report
from continuum_sph.builders.simulation import Simulation
from continuum_sph.cli import PACKAGE
from continuum_sph.seepage import Seepage
from continuum_sph.soil.stress import YY
from continuum_sph.validation.seepage.saturated_box import saturated_box
from continuum_sph.validation.tanks import tank_scene
from porescale.common.compiled.jit import set_threads
from porescale.common.core.constants import GRAVITY
from porescale.common.core.errors import InputError
from tests.reference.same_run import leaves

OUTLINE = [[0, 0], [0.3, 0], [0.3, 0.2], [0, 0.2]]


def scene(**changes):
    given = {
        "water": {"column": [{"width": 0.3, "height": 0.4}], "sound_speed": 80.0},
        "soil": {"stiffness": 1e6, "permeability": 1e-3, "body": [{"outline": OUTLINE}]},
        "numerics": {"spacing": 0.02, "artificial_viscosity": 0.1},
        "probe": [{"x": 0.15, "y": 0.1}],
        "level": [{"x": 0.15}],
    }
    return tank_scene(0.3, 0.5, 0.02, **given | changes)


def test_soft_water_is_warned_of_and_second_fluids_are_refused():
    column = {"column": [{"width": 0.3, "height": 0.4}]}
    soft = scene(water=column | {"sound_speed": 30.0})
    assert any("n M" in warning for warning in seepage_report(soft).warnings)
    assert not seepage_report(scene()).warnings
    assert not seepage_report(scene(water=column)).warnings
    bubble = {"disc": [{"x": 0.15, "y": 0.3, "radius": 0.08}]}
    with pytest.raises(InputError, match="inclusion"):
        seepage_report(scene(inclusion=bubble))


def test_water_left_to_itself_is_as_stiff_as_its_head_and_the_ground_ask_for():
    def fast(given, **soil):
        water = {"column": [{"width": 0.3, "height": 0.4}]} | given
        return sound_speed(scene(water=water, soil={"body": [{"outline": OUTLINE}]} | soil))

    falls = 10.0 * (2.0 * GRAVITY * 0.4) ** 0.5
    column = 0.7 / (1.3 * 0.4)  # M/E with ν = 0.3
    assert fast({"sound_speed": 30.0}, stiffness=2e7) == 30.0
    assert fast({}, stiffness=1e4) == pytest.approx(falls)
    assert fast({}, stiffness=2e7) == pytest.approx((10.0 * 0.4 * column * 2e7 / 1000.0) ** 0.5)
    assert fast({}, stiffness=2e7, held=True) == pytest.approx(falls)
    assert fast({}, stiffness=1e10) == pytest.approx((2.2e9 / 1000.0) ** 0.5)  # no stiffer than water is
    hard = {"stiffness": 1e10, "body": [{"outline": OUTLINE}]}
    hard = scene(water={"column": [{"width": 0.3, "height": 0.4}]}, soil=hard)
    assert not any("n M" in warning for warning in seepage_report(hard).warnings)


def test_water_pulls_on_nothing_beside_ground_and_does_in_the_open_and_in_air():
    column = {"column": [{"width": 0.3, "height": 0.4}]}
    dry = scene(water={}, probe=[], level=[])
    open_water = tank_scene(0.3, 0.6, 0.02, water=column)
    airy = scene(air={}, tank={"width": 0.3, "height": 0.6})
    assert scene().numerics.tension == "cut"
    assert [it.numerics.tension for it in (dry, open_water, airy)] == ["kept"] * 3
    given = {"spacing": 0.02, "tension": "kept"}
    assert scene(numerics=given).numerics.tension == "kept"
    assert tank_scene(0.3, 0.6, 0.02, water=column, numerics={"tension": "cut"}).numerics.tension == "cut"


def test_water_beside_and_over_ground_is_not_in_its_pores():
    """All water about which kernels found any grains was counted: 2.7 rows of it along every surface of the ground."""
    wide, spacing, porosity = 0.3, 0.02, 0.4

    def in_pores(**changes):
        return Simulation(scene(**changes)).series()["water in pores (kg/m)"]

    beside = [{"left": 0.16, "width": 0.14, "height": 0.3}, {"width": 0.16, "bottom": 0.2, "height": 0.1}]
    bank = {"body": [{"outline": [[0, 0], [0.16, 0], [0.16, 0.2], [0, 0.2]]}]}
    assert in_pores(water={"column": beside, "sound_speed": 80.0}, soil=bank) == 0.0
    # Full ground, whose uppermost row holds up to 0.16 of an open row too much (docs/theory/seepage.md, limits), and
    # water that is compressed by 0.06 % at 80 m/s: g H/c^2 = 9.81 * 0.4/80^2.
    held, row = 1000.0 * porosity * wide * 0.2, 1000.0 * wide * spacing
    found = in_pores()
    assert held <= found < held * 1.0007 + 0.16 * row
    # the check that must fail: ground that is a row lower
    lower = {"body": [{"outline": [[0, 0], [0.3, 0], [0.3, 0.18], [0, 0.18]]}]}
    assert in_pores(soil=lower) < held - porosity * row + 0.0007 * held + 0.16 * row < held


@pytest.mark.slow
def test_soil_under_water_bears_its_weight_less_buoyancy_and_stays_at_rest():
    model = Simulation(scene())
    soil, n = model.flow.ground.soil, model.flow.ground.soil.soil
    depth = 0.2 - soil.x[:n, 1]
    buoyant = 0.6 * 1650.0 * GRAVITY
    np.testing.assert_allclose(soil.stress[:n, YY], buoyant * depth, rtol=1e-12)
    model.advance(600)
    model.check()
    row = model.series()
    assert NAME not in row  # without a pile
    # Gradients are exact but at the surface of the soil, where the weight of half a row, 1/20, is borne as it may be:
    # the layer settles by that share of its elastic settlement, buoyant H²/2M
    assert row["soil: largest displacement (m)"] < 0.05 * buoyant * 0.2**2 / (2.0 * 1.35e6) * 10.0
    assert row["soil: stress upright over weight ()"] == pytest.approx(1650.0 / 2650.0, rel=0.05)
    tables = model.tables()
    assert tables["levels"]["level 0 (m)"] == pytest.approx(0.4, abs=0.01)
    assert tables["probes"]["probe 0 pressure (Pa)"] == pytest.approx(0.3 * 1000.0 * GRAVITY, rel=0.03)
    cloud = model.snapshot().clouds["particles"]
    assert np.isin(cloud.data["layer"], (0, DRY, WET)).all()
    assert (cloud.data["layer"] == WET).sum() == n


def test_soil_under_water_is_shown_with_the_pressure_of_its_water():
    """Its own mean stress stood there, beside water, in the same colours under the same name."""
    clouds = Simulation(scene()).snapshot().clouds
    whole, soil = clouds["particles"], clouds["soil"]
    shown, y = whole.data["pressure"][whole.data["layer"] == WET], soil.position[:, 1]
    inner = y > 2.75 * 0.02  # kernels reach no floor
    exact = 1000.0 * GRAVITY * (0.4 - y[inner])
    # The mean of a linear pressure over a kernel is that of its centre; what is left is water that is compressed by
    # g H/c^2 = 0.0006, and so denser and heavier below.
    np.testing.assert_allclose(shown[inner], exact, rtol=0.0006)
    stress = soil.data["mean_stress"][inner]  # the twin: half of it and less
    assert (stress < 0.7 * exact).all()


@pytest.mark.slow
def test_a_resumed_run_goes_on_bit_for_bit():
    whole, part, resumed = (Simulation(scene()) for _ in range(3))
    whole.advance(30)
    part.advance(13)
    resumed.restore(part.state())
    # All of it, how long lists have lasted too: by that they are made anew, and sums go in another order.
    assert dict(leaves(resumed.state())) == dict(leaves(part.state()))
    resumed.advance(17)
    assert dict(leaves(resumed.state())) == dict(leaves(whole.state()))
    assert np.array_equal(whole.flow.water.layer.x, resumed.flow.water.layer.x)
    assert np.array_equal(whole.flow.ground.soil.stress, resumed.flow.ground.soil.stress)
    assert whole.series() == resumed.series()


@pytest.mark.slow
def test_one_thread_and_many_give_the_same_bits():
    ends = []
    for threads in (1, 2):
        set_threads(threads)
        both = saturated_box(16, 3, speed=0.1)
        for _ in range(20):
            both.advance()
        ends.append((both.water.layer.x.copy(), both.water.skeleton.v.copy(), both.water.heat.copy()))
    assert all(np.array_equal(one, many) for one, many in zip(*ends, strict=True))


@pytest.mark.slow
def test_soil_that_forgets_its_buoyancy_swells(monkeypatch):  # the twin that must fail
    monkeypatch.setattr(pore_water, "submerge", lambda *_: None)
    model = Simulation(scene())
    model.advance(300)
    assert model.series()["soil: stress upright over weight ()"] > 0.8


@pytest.mark.slow
def test_the_command_builds_what_the_scene_holds():
    assert isinstance(PACKAGE.build(scene()).flow, Seepage)
