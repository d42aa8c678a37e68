"""Air in the pores of soil: where it is, how hard it is to move, what scenes refuse."""

from dataclasses import replace

import numpy as np
import pytest

from continuum_sph.builders.parts.air import AIR, air_fluid, dry_pores, specific_weights, with_air
from continuum_sph.builders.reports.seepage_report import seepage_report
from continuum_sph.builders.simulation import Simulation
from continuum_sph.validation.seepage.air import TrappedAir
from continuum_sph.validation.tanks import level_ground, tank_scene
from continuum_sph.water.eos.adiabatic import AdiabaticGas
from continuum_sph.water.eos.liquid import Tait
from continuum_sph.water.eos.printed import PrintedGas
from continuum_sph.water.fluids import Fluid
from continuum_sph.water.parameters import Law
from continuum_sph.water.smoothing import Smoothing
from porescale.common.core.constants import GRAVITY
from porescale.common.core.errors import InputError


def scene(**changes):
    given = {
        "water": {"column": [{"bottom": 0.2, "width": 0.2, "height": 0.2}]},
        "soil": {"stiffness": 1e5, "body": [level_ground(0.2, 0.2)]},
        "air": {"density": 10.0, "pressure": 5e3},
        "numerics": {"spacing": 0.02, "tension": "cut"},
    }
    return tank_scene(0.2, 0.5, 0.02, lid=False, **given | changes)


def test_air_resists_as_much_less_as_it_is_thinner():
    law = Law(Smoothing("wendland", 0.01), 0.01, (Fluid(Tait(1000.0, 40.0), 1e-3),), (0.0, -9.8))
    both = with_air(law, Fluid(AdiabaticGas(1.2, 1e5), 2e-5))
    found = specific_weights(np.array([0, AIR]), both, GRAVITY)
    # β = n² μ/κ with one κ for both: that of water is ρ g n²/k
    assert found == pytest.approx([1000.0 * GRAVITY, 0.02 * 1000.0 * GRAVITY], rel=1e-15)


def test_air_is_in_pores_that_no_water_covers():
    given = scene(water={"column": [{"bottom": 0.1, "width": 0.2, "height": 0.2}]})
    soil = np.array([[0.1, 0.05], [0.1, 0.15], [0.19, 0.09]])
    assert dry_pores(given.water.column, soil).tolist() == [[0.1, 0.05], [0.19, 0.09]]


@pytest.mark.parametrize("asked", [seepage_report, Simulation])
def test_air_without_room_in_any_pore_is_refused(asked):
    # the series divided by the volume of no air
    with pytest.raises(InputError, match=r"air.*: has no room: water\.column covers all pores.*; lower the water"):
        asked(scene(water={"column": [{"width": 0.2, "height": 0.3}]}))


def test_gas_follows_the_law_of_its_section():
    air = scene().air
    assert air_fluid(air).state == AdiabaticGas(10.0, 5e3, 1.403)
    assert isinstance(air_fluid(air.model_copy(update={"law": "printed"})).state, PrintedGas)


@pytest.mark.parametrize(
    "changes",
    [
        {"soil": None},
        {"water": {}},
    ],
)
def test_air_without_soil_and_water_is_refused(changes):
    with pytest.raises(InputError) as refused:
        scene(**changes)
    assert "air" in {fault.key for fault in refused.value.faults}


def test_a_report_warns_of_heavy_air():
    assert not any("air.density" in warning for warning in seepage_report(scene()).warnings)
    heavy = seepage_report(scene(air={"density": 50.0}))
    assert any("air.density" in warning for warning in heavy.warnings)


def test_trapped_air_stops_water_where_it_bears_it():
    given = TrappedAir()
    z = given.front(60.0)
    held = 1000.0 * GRAVITY * (given.standing + (1.0 - given.porosity) * z)
    assert given.squeezed(z) == pytest.approx(held, rel=1e-4)  # what moves is damped by n g/k = 130/s
    assert replace(given, filled=False).front(1.0) > 2.0 * given.front(1.0)


@pytest.mark.slow
def test_a_scene_with_air_books_both_fluids_and_shows_them():
    model = Simulation(scene())
    first = model.series()
    model.advance(300)
    model.check()
    row, shot = model.series(), model.snapshot()
    # 10 by 10 pores of n = 0.4; kernels see fewer grains at the surface, one row in ten of 0.6 less by up to a half
    assert first["air: mass (kg/m)"] == pytest.approx(10.0 * 0.4 * 0.04, rel=0.5 * 0.6 / 0.4 / 10)
    assert row["water: mass (kg/m)"] == first["water: mass (kg/m)"]
    assert row["air: mass (kg/m)"] == first["air: mass (kg/m)"]
    assert row["air: mean pressure (Pa)"] > first["air: mean pressure (Pa)"]
    assert row["air: pore volume (m2)"] < first["air: pore volume (m2)"]
    assert len(shot.clouds["air"].position) == 100
    assert shot.clouds["soil"].data["saturation"].max() < 1.0
    assert "air: mass (kg/m)" not in Simulation(scene(air=None)).series()


@pytest.mark.slow
def test_a_scene_with_air_goes_on_bit_for_bit():
    straight, resumed = Simulation(scene()), Simulation(scene())
    straight.advance(40)
    resumed.restore(straight.state())
    for model in (straight, resumed):
        model.advance(40)
    assert straight.flow.water.layer.x.tobytes() == resumed.flow.water.layer.x.tobytes()
