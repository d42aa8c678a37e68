"""What `check` says of wet ground before it runs: what it costs, what lifts it, exit gradients that come out low."""

import numpy as np
import pytest

from continuum_sph.builders.report import report
from continuum_sph.builders.reports.seepage_report import bare_exit
from continuum_sph.builders.reports.time_report import PORE_WATER, step_seconds
from continuum_sph.builders.simulation import Simulation
from continuum_sph.look import look_of_scene
from continuum_sph.scene.sections import Scene
from continuum_sph.validation.tanks import tank_scene
from porescale.common.duration.expected import STEPS
from porescale.common.schema.sections import scene_as_dict, validate
from tests.reference.scenes import refusals

WIDE = [[0, 0], [1, 0], [1, 0.4], [0, 0.4]]
SMALL = [[0, 0], [0.2, 0], [0.2, 0.1], [0, 0.1]]


def scene(outline=WIDE, soil=None, depth=0.6, **changes):
    """Ground in a tank of 1 m by 0.8 m, with particles of 0.05 m, under water up to a ``depth``, m."""
    given = {
        "water": {"sound_speed": 60.0, "column": [{"width": 1.0, "height": depth}] if depth else []},
        "soil": {"stiffness": 5e5, "permeability": 5e-3, "saturated": True, "body": [{"outline": outline}]}
        | (soil or {}),
    }
    return tank_scene(1.0, 0.8, 0.05, 0.1, lid=False, **given | changes)


def rows(given):
    return {row.name: row.value for group in report(given).groups.values() for row in group}


POOL = {"left": 0.6, "right": 1.0, "bottom": 0.0, "level": 0.2}
KINDS = [
    scene(),
    scene(depth=0.0, soil={"held": True}, face=[{"side": "floor", "head": 1.0}]),
    scene(SMALL, {"held": True, "saturated": False}),
    scene(SMALL, {"saturated": False}, depth=0.2, reservoir=[POOL]),
    scene(SMALL, {"saturated": False}, depth=0.0, air={"density": 20.0}, reservoir=[POOL]),
    scene(soil={"held": True}, pile={"x": 0.475, "tip": 0.15}),
]


@pytest.mark.parametrize("given", KINDS, ids=["moving", "full", "pond", "filling", "air", "pile"])
def test_check_counts_the_particles_and_steps_that_are_built(given):
    model = Simulation(given)
    water, there = model.flow.water.layer, rows(given)
    air = int((water.material[: water.fluid] == 1).sum())
    assert there["soil particles"] == model.flow.water.skeleton.count
    assert there["water particles"] + there.get("particles that wait", 0) + air == water.fluid
    # sound of the deepest water, or of both layers: as it rests; what a face presses in comes later
    if not given.face:
        assert there["steps"] == pytest.approx(given.time.end / model.flow.next_step, rel=0.01)


def test_the_time_of_a_run_counts_the_open_water_of_a_pond():
    pond, ground = scene(SMALL, {"held": True}), scene(SMALL, {"held": True}, depth=0.2)
    for given, soil, fluid in ((pond, 8, 240), (ground, 8, 80)):
        seconds = report(given).work.seconds[STEPS] / rows(given)["steps"]
        # the number of steps is rounded in its row
        assert seconds == pytest.approx(step_seconds((PORE_WATER, soil + fluid)), rel=1e-3)
    assert rows(pond)["memory"] > 1.5 * rows(ground)["memory"]


def out_of(given):
    """Gradient of the flow out of the ground, by `check`; None where none is said."""
    return rows(given).get("gradient of the flow out of the ground")


def test_check_says_how_steep_the_flow_is_that_a_face_drives_out_of_ground_that_may_move():
    def floor(head, **soil):
        return out_of(scene(soil=soil, face=[{"side": "floor", "head": head}]))

    # from 0.6 m of water through 0.4 m of ground
    assert floor(1.05) == pytest.approx(0.45 / 0.4, rel=1e-12)
    assert floor(0.99) == pytest.approx(0.39 / 0.4, rel=1e-12)
    assert floor(0.1) is None  # as steep, downwards
    assert floor(1.05, held=True) is None
    texts = [
        row.note for group in report(scene(face=[{"side": "floor", "head": 1.05}])).groups.values() for row in group
    ]
    assert "about; more than 0.99 lifts it" in texts  # 1.59 - 0.6


def test_flow_between_two_sides_leaves_no_ground_and_flow_to_the_lid_does():
    closed = {"tank": {"width": 0.4, "height": 0.4}, "depth": 0.0}
    body = {"body": [{"outline": [[0, 0], [0.4, 0], [0.4, 0.4], [0, 0.4]]}]}
    left = {"side": "left", "head": 1.0}
    assert out_of(scene(soil=body, face=[left, {"side": "right", "head": 0.4}], **closed)) is None
    lid = scene(soil=body, face=[{"side": "floor", "head": 1.0}, {"side": "lid", "head": 0.4}], **closed)
    assert out_of(lid) == pytest.approx(0.6 / 0.35, rel=1e-12)  # between the outermost rows
    assert any("ground that flow lifts passes through it" in text for text in report(lid).warnings)


def piled(left, right, **changes):
    """Held ground of 0.4 m with a pile in its middle, water up to ``left`` and ``right``, m, beside it."""
    columns = [{"width": 0.5, "height": left}, {"left": 0.5, "width": 0.5, "height": right}]
    water = {"sound_speed": 60.0, "column": columns}
    return scene(**{"soil": {"held": True}, "water": water, "pile": {"x": 0.475, "tip": 0.15}} | changes)


def test_ground_that_a_lid_closes_beside_a_pile_has_no_exit_gradient_and_check_says_so():
    """It was 2.5 where nothing comes out: heads under the lid were taken over the height of the ground."""
    full = {"tank": {"width": 1.0, "height": 0.4}, "depth": 0.0, "water": {"sound_speed": 60.0}}
    sides = [{"side": "left", "head": 0.8}, {"side": "right", "head": 0.6}]
    far = [{"side": "lid", "end": 0.25, "head": 0.6}, {"side": "lid", "start": 0.7, "head": 0.4}]
    near = [{"side": "lid", "end": 0.45, "head": 0.6}, {"side": "lid", "start": 0.5, "head": 0.4}]
    for faces, shut in ((sides, True), (far, True), (near, False)):  # the last one must fail
        given = piled(0.0, 0.0, face=faces, **full)
        assert np.isnan(Simulation(given).series()["exit gradient ()"]) == shut
        assert any("ends at a closed lid" in text for text in report(given).warnings) == shut


def test_a_reservoir_across_a_pile_is_said_to_keep_the_mean_of_both_sides():
    for left, across in ((0.2, True), (0.5, False)):  # the last one must fail
        strip = {"left": left, "right": 1.0, "bottom": 0.4, "level": 0.6}
        said = " ".join(report(piled(0.6, 0.6, reservoir=[strip])).warnings)
        assert ("reservoir[0] reaches across the pile" in said) == across
        assert ("end it at 0.45 m, or begin it at 0.5 m" in said) == across


def test_reservoirs_that_meet_with_other_levels_are_said_to_feed_each_other():
    """One at 0.6 m let 115 kg/m into one at 0.4 m beside it in half a second, without a word."""
    for change, said in (({}, 1), ({"level": 0.7}, 0), ({"left": 0.6}, 0), ({"pile": True}, 0)):  # the last must fail
        pile = {} if change.pop("pile", False) else {"pile": None}
        strips = [{"right": 0.475, "level": 0.7}, {"left": 0.475, "right": 1.0, "level": 0.6} | change]
        given = piled(0.6, 0.6, reservoir=[{"left": 0.0, "bottom": 0.4} | it for it in strips], **pile)
        assert sum("reservoirs meet" in text for text in report(given).warnings) == said


def test_probes_across_a_pile_are_said_to_read_both_sides():
    """One on a pile between 1.1 and 0.6 m of water read 2512 Pa where 4905 and 0 were, without a word."""
    for place, across in ((0.475, 2), (0.5, 2), (0.35, 0), (0.6, 0)):  # the last two must fail
        over, under = {"x": place, "y": 0.4}, {"x": place, "y": 0.1}  # below its tip there is one side alone
        wide = {"x": place, "y": 0.4, "width": 0.1, "height": 0.1}
        said = report(piled(0.6, 0.6, probe=[over, under, wide])).warnings
        assert sum("of both sides at once" in text for text in said) == across
        assert not any("probe[1]" in text for text in said)


def test_an_exit_through_bare_ground_beside_a_pile_needs_five_rows():
    """Four under water: its second row, too, has no head to fit."""

    def said(given):
        return [text for text in report(given).warnings if "exit gradient () will be nan" in text]

    bare = piled(0.6, 0.4, pile={"x": 0.475, "tip": 0.2})  # four rows
    assert "the second where no water stands on the right; numerics.spacing = 0.04 mends it" in said(bare)[0]
    assert bare_exit(bare) == "right"
    assert bare_exit(piled(0.4, 0.6)) == "left"
    assert not bare_exit(piled(0.7, 0.5))
    rising = {"left": 0.6, "right": 1.0, "bottom": 0.4, "level": 0.5}
    assert not bare_exit(piled(0.6, 0.4, reservoir=[rising]))
    full = {"tank": {"width": 1.0, "height": 0.4}, "depth": 0.0, "water": {"sound_speed": 60.0}}
    faces = [{"side": "lid", "end": 0.45, "head": 0.6}, {"side": "lid", "start": 0.5, "head": 0.4}]
    assert not bare_exit(piled(0.0, 0.0, face=faces, **full))
    level = piled(0.4, 0.4, pile=bare.pile)  # bare on both sides, where nothing comes out
    assert "the second where no water stands on the left; numerics.spacing = 0.04 mends it" in said(level)[0]
    assert not said(piled(0.4, 0.4))
    assert not said(piled(0.6, 0.4))
    assert not said(piled(0.7, 0.5, pile={"x": 0.475, "tip": 0.2}))
    for given, there in (
        (bare, False),
        (level, False),
        (piled(0.4, 0.4), True),
        (piled(0.6, 0.4), True),
        (piled(0.7, 0.5, pile=bare.pile), True),
    ):
        assert np.isfinite(Simulation(given).series()["exit gradient ()"]) == there


def test_the_sheet_is_drawn_in_the_column_that_stands_for_it():
    (x, low), (same, high) = look_of_scene(scene_as_dict(piled(0.6, 0.5, pile={"x": 0.45, "tip": 0.15})), "").lines[-1]
    assert x == same == pytest.approx(0.475, rel=1e-12)
    assert (low, high) == (0.15, 0.8)


def test_check_says_where_the_sheet_stands():
    assert rows(piled(0.6, 0.5, pile={"x": 0.45, "tip": 0.15}))["stands at"] == pytest.approx(0.475, rel=1e-12)


@pytest.mark.parametrize("times", [1.0, 10.0])
def test_permeability_is_that_under_the_gravity_of_the_earth(times):
    """In a centrifuge of 10 g water passes ten times as fast; k M/(ρ g) of consolidation, with the g of k, stays.

    `check` took the scene's gravity: its times were too long by as much."""
    heads = {"face": [{"side": "left", "head": 1.0}, {"side": "right", "head": 0.9}]}
    tank = {"tank": {"width": 1.0, "height": 0.4}, "water": {"sound_speed": 60.0 * times**0.5}}
    given = scene(depth=0.0, soil={"held": True}, gravity=9.81 * times, **heads, **tank)
    told, k, n = rows(given), 5e-3, 0.4
    assert told["time in which drag stops water in pores"] == pytest.approx(k / (n * 9.81))
    storage = n / (1000.0 * 60.0**2 * times)  # of the water alone
    assert told["time until the flow is steady"] == pytest.approx(2.0 * 1.0**2 * 1000.0 * 9.81 * storage / k, rel=1e-6)
    soon = told["time in which water passes half a spacing"]
    assert soon * times == pytest.approx(0.5 * 0.05 * n / (k * 0.1), rel=0.1)  # particles stand 0.95 m apart, not 1 m
    model = Simulation(given)
    while model.time < 0.3 / times:
        model.advance(20)
    flow = model.series()["face 0 flow in (m2/s)"]
    assert flow == pytest.approx(times * k * 0.1 * 0.4, rel=0.03)
    # D t/L² is 1.4: exp(-π² 1.4) is left, and 2 % of 8 rows; the earth's flow at 10 g would be 90 % off
    loose = scene(gravity=9.81 * times)
    spread = rows(loose)["consolidation coefficient"]
    assert spread == pytest.approx(k * rows(loose)["modulus of a column at the floor"] / 9810.0)


def test_the_energy_balance_of_water_among_grains_is_said_to_be_open():
    told = "energy balance (J/m) is of the water alone"
    output = {"snapshot_interval": 0.1, "series_interval": 0.1, "energy": True}
    assert any(told in it for it in report(scene(output=output)).warnings)
    assert not any(told in it for it in report(scene()).warnings)
    alone = scene_as_dict(scene(output=output)) | {"soil": None}
    assert not any(told in it for it in report(validate(Scene, alone)).warnings)


def test_nothing_is_asked_of_water_that_is_not_there():
    asked = {"probe": [{"x": 0.5, "y": 0.1}], "level": [{"x": 0.5}]}
    wrong = "is of water, of which there is none; leave it out"
    said = refusals(lambda: scene(depth=0.0, soil={"saturated": False}, **asked))
    assert said == [f"probe = 'given': {wrong}", f"level = 'given': {wrong}"]
    scene(depth=0.0, **asked)  # a check that must not refuse: water in pores is water


def test_grains_that_float_under_water_are_warned_of():
    """Ground of 300 kg/m³ at a porosity of 0.4 rose through the water above it, without a word."""

    def said(density):
        return [text for text in report(scene(soil={"density": density})).warnings if "do not sink" in text]

    assert "makes grains of 500 kg/m³" in said(300.0)[0]
    assert said(600.0)  # as heavy as water
    assert not said(610.0)


@pytest.mark.parametrize(
    "pores",
    [{}, {"saturated": False, "suction": {"alpha": 5.0, "n": 3.0, "water_table": 0.2}}, {"saturated": False}],
    ids=["full", "suction", "dry"],
)
def test_the_density_of_grains_in_place_of_that_of_soil_is_warned_of(pores):
    def said(density):
        soil = {"density": density, "porosity": 0.4} | pores
        given = scene(soil=soil, depth=0.0 if pores else 0.6)
        return [it for it in report(given).warnings if "soil.density" in it]

    (line,) = said(2650.0)
    assert line.startswith("soil.density = 2650 kg/m³ is of grains per whole volume")
    assert "makes grains of 4417 kg/m³" in line
    assert not said(0.6 * 2650.0)


@pytest.mark.parametrize(("rest", "warned"), [(0.3, True), (0.35, False), (2.9, False), (3.1, True)])
def test_check_warns_of_stress_that_wet_ground_cannot_bear(rest, warned):
    # at 30 degrees ground bears 1/3 to 3 times its upright stress, wet as dry
    assert warned == any(it.startswith("soil.rest = ") for it in report(scene(soil={"rest": rest})).warnings)
    held = [it for it in report(scene(soil={"rest": rest, "held": True})).warnings if it.startswith("soil.rest")]
    assert held == [f"soil.rest = {rest:g} has no effect: soil.held has no stress; take it out"]
