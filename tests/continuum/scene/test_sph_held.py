"""Ground that is held, and pores that are full up to a water table: built, at rest, resumed, refused."""

import numpy as np
import pytest

from continuum_sph.builders.parts.held_soil import HeldSoilPart
from continuum_sph.builders.parts.mixture import MixturePart, WetSoilPart
from continuum_sph.builders.parts.pore_water import water_counts
from continuum_sph.builders.parts.soil import SoilPart, soil_particles
from continuum_sph.builders.parts.stiffness import sound_speed
from continuum_sph.builders.report import report
from continuum_sph.builders.reports.time_report import OPENING, PORE_WATER, step_seconds
from continuum_sph.builders.simulation import Simulation
from continuum_sph.seepage.skeleton import Frame
from continuum_sph.soil import SoilFlow
from continuum_sph.validation.tanks import tank_scene
from porescale.common.core.errors import InputError
from tests.reference.same_run import leaves

BODY = {"outline": [[0.4, 0], [0.8, 0], [0.8, 0.4], [0.4, 0.4]]}
POOL = {"column": [{"width": 0.4, "height": 0.2}]}
CLOSED = {"tank": {"width": 0.8, "height": 0.5, "lid": False}}
"""A tank whose right wall closes the ground, so that water leaves it to the left only."""
RIVER = {"name": "river", "left": 0, "right": 0.2, "level": 0.2}


def scene(soil=None, **changes):
    given = {
        "water": {"sound_speed": 25.0} | POOL,
        "soil": {"permeability": 0.05, "body": [BODY]} | (soil or {}),
        "reservoir": [RIVER],
    }
    return tank_scene(1.2, 0.5, 0.05, 0.2, every=0.1, lid=False, **given | changes)


def test_held_ground_stays_and_water_enters_it():
    model = Simulation(scene({"held": True}))
    assert isinstance(model.flow.ground, Frame)
    assert not isinstance(model.flow.ground, SoilFlow)
    before = model.series()["front (m)"]
    x = model.part(HeldSoilPart).motion()[0].copy()
    model.advance(150)
    model.check()
    assert np.array_equal(model.part(HeldSoilPart).motion()[0], x)
    with pytest.raises(InputError, match=r"part = 'SoilPart': is not built by this scene \(allowed: .*HeldSoilPart"):
        model.part(SoilPart)
    with pytest.raises(InputError, match=r"part = .*SoilPart.*is not built"):
        model.part("SoilPart")
    row = model.series()
    assert not any(name.startswith("soil: ") for name in row)
    assert row["front (m)"] > before  # of the water: its face is that of the soil at the start
    loose = Simulation(scene())  # the check that fails: ground that is not held moves
    loose.advance(150)
    assert not np.array_equal(loose.part(WetSoilPart).motion()[0], loose.part(WetSoilPart).first)


def test_held_ground_shows_both_layers_and_the_pressure_of_its_water():
    clouds = Simulation(scene({"held": True, "saturated": True}, **CLOSED)).snapshot().clouds
    assert set(clouds) == {"particles", "water", "soil"}
    soil = clouds["soil"]
    assert "mean_stress" not in soil.data
    assert soil.data["saturation"].min() > 0.5
    inner = (soil.position[:, 0] > 0.6) & (soil.position[:, 1] < 0.2)  # where kernels lack no water over them
    depth = 0.4 - soil.position[inner, 1]
    # The mean over a kernel of a linear pressure is that of its centre; beside the floor the water over it weighs more:
    # by 0.55 of a spacing at most, the centre of half a kernel, 2h 0.37 5/14.
    found = soil.data["pore_pressure"][inner] / 9806.65
    assert np.abs(found - depth).max() < 0.55 * 0.05
    assert np.isnan(Simulation(scene({"held": True})).snapshot().clouds["soil"].data["pore_pressure"]).any()


def test_a_run_in_held_ground_goes_on_bit_for_bit():
    whole, part = (Simulation(scene({"held": True})) for _ in range(2))
    whole.advance(12)
    part.advance(5)
    resumed = Simulation(scene({"held": True}))
    resumed.restore(part.state())
    resumed.advance(7)
    assert dict(leaves(whole.state())) == dict(leaves(resumed.state()))


def test_pores_under_a_water_table_are_full_and_those_over_it_empty():
    model = Simulation(scene({"water_table": 0.2, "held": True}, **CLOSED))
    soil = model.snapshot().clouds["soil"]
    height = soil.position[:, 1]
    # W reaches over the level by 2.7 spacings, most of which lie under it at 0.1 m: nearer to full, 1, than to half
    # a kernel, which is a saturation of a half.
    assert soil.data["saturation"][height < 0.1].min() > 0.75
    assert soil.data["saturation"][height > 0.35].max() == 0.0
    for given, rows in (({"water_table": 0.2}, 4), ({"saturated": True}, 8), ({}, 0)):
        layer = Simulation(scene({"held": True} | given, reservoir=[], **CLOSED)).flow.water.layer
        assert layer.fluid == 8 * 4 + 8 * rows  # the pool's, and those in pores


@pytest.mark.parametrize(("pores", "rows", "tall"), [({"saturated": True}, 8, 0.4), ({"water_table": 0.2}, 4, 0.2)])
@pytest.mark.parametrize("held", [True, False])
def test_full_pores_are_water_where_a_scene_has_no_other(pores, rows, tall, held):
    """Earlier, `saturated` went unheard in a scene without open water: its ground was dry."""
    given = scene({"held": held} | pores, water={}, reservoir=[], **CLOSED)
    assert not given.dry
    if held:
        assert sound_speed(given) == pytest.approx(10.0 * (2.0 * given.gravity * tall) ** 0.5)
    column = {"column": [{"left": 0.4, "width": 0.4, "height": tall}], "pressure": "hydrostatic"}
    layer, laid = (
        Simulation(it).flow.water.layer for it in (given, scene({"held": held}, water=column, reservoir=[], **CLOSED))
    )
    assert layer.fluid == laid.fluid == 8 * rows
    for of in ("x", "mass", "density", "pressure"):  # the same water, laid into the pores as a column
        assert np.array_equal(*np.sort([getattr(layer, of)[: layer.fluid], getattr(laid, of)[: laid.fluid]], axis=1))
    assert scene(water={}, reservoir=[], **CLOSED).dry  # the check that fails: pores that are not full


def test_ground_with_full_pores_alone_needs_a_speed_of_sound_without_gravity():
    with pytest.raises(InputError, match=r"water\.sound_speed: is needed when there is no gravity"):
        scene({"saturated": True}, water={}, reservoir=[], gravity=0.0, **CLOSED)


def test_a_water_table_over_all_ground_and_water_is_said_to_fill_no_more_than_pores():
    def said(table):
        return [
            it for it in report(scene({"water_table": table, "held": True}, **CLOSED)).warnings if "water_table" in it
        ]

    (line,) = said(0.45)  # the ground is 0.4 m high
    assert line.startswith("soil.water_table lies over all ground and water, 0.05 m over the highest ground")
    assert not said(0.4)


def test_water_is_at_rest_where_pool_and_water_table_are_level():
    # A table that is level with the pool drives nothing through the pores; one that is a pool higher does.
    def fastest(table):
        model = Simulation(scene({"water_table": table, "held": True}, **CLOSED))
        model.advance(150)
        return model.series()["fastest seepage (m/s)"]

    assert fastest(0.2) < 0.3 * fastest(0.4)


@pytest.mark.parametrize(
    ("soil", "changes", "message"),
    [
        ({"held": True}, {"water": {}, "reservoir": []}, r"soil\.held = True: is of soil with water"),
        ({"water_table": 0.1, "saturated": True}, {}, r"soil\.water_table = 0\.1.*: cannot be with soil\.saturated"),
        ({"water_table": 0.1}, {"air": {}}, r"soil\.water_table = 0\.1.*: cannot be with air"),
        ({"held": True, "watch": [BODY]}, {}, r"soil\.watch = .*: has no displacement in soil that is held"),
    ],
)
def test_what_cannot_be_is_refused(soil, changes, message):
    with pytest.raises(InputError, match=message):
        scene(soil, **changes)


def test_check_says_nothing_of_the_stiffness_of_soil_that_is_held():
    rows, loose = str(report(scene({"held": True}))), str(report(scene()))
    assert "time in which drag stops water in pores" in rows
    assert "modulus of a column" not in rows
    assert "modulus of a column" in loose


def test_check_expects_the_time_of_the_steps_that_held_ground_takes(tmp_path, monkeypatch):
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))  # nothing was run
    given = scene({"held": True})
    model = Simulation(given)
    rows = {row.name: row.value for row in report(given).groups["steps"]}
    steps, soil = given.time.end / model.flow.next_step, model.flow.water.skeleton.count
    river = water_counts(given, soil_particles(given)[0])
    step = step_seconds((PORE_WATER, soil + river[0] + 0.5 * river[1])) + OPENING
    # The water at the floor lies half a spacing deeper than its particles: (γ - 1)/2 of g/c² of 0.025 m is 0.12 %.
    assert float(rows["of it steps"]) == pytest.approx(step * steps, rel=0.0012)


def test_a_scene_whose_soil_moves_builds_no_held_part():
    model = Simulation(scene())
    assert not any(isinstance(part, HeldSoilPart) for part in model.parts)
    assert model.part(MixturePart).soil is model.part(WetSoilPart)
