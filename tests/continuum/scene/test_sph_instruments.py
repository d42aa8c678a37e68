"""Probes and levels read what is there."""

import csv

import numpy as np
import pytest

from continuum_sph.builders.parts.instruments import (
    MeasuredWater,
    discharge,
    interpolate,
    level_row,
    open_depth,
    probe_row,
    surface_height,
)
from continuum_sph.builders.parts.mixture import PoreInstruments
from continuum_sph.builders.simulation import Simulation
from continuum_sph.scene.instruments import LevelSection, ProbeSection
from continuum_sph.scene.sections import Scene
from continuum_sph.validation.tanks import tank_scene
from porescale.common.core.errors import InputError
from porescale.common.neighbors import square_lattice
from porescale.common.record.drive import drive
from porescale.common.schema.sections import validate

eps = np.finfo(float).eps
SPACING = 0.05


def cloud(height=0.5, width=1.0):
    x = square_lattice((0.0, 0.0), (width, height), SPACING)
    x += np.random.default_rng(2).uniform(-0.2, 0.2, x.shape) * SPACING
    p = 100.0 + 40.0 * x[:, 0] - 70.0 * x[:, 1]
    v = np.column_stack((x[:, 1], -2.0 * x[:, 0]))
    return MeasuredWater(x, np.full(len(x), SPACING**2), p, v, 1.3 * SPACING, SPACING, width)


@pytest.mark.parametrize("at", [(0.5, 0.25), (0.0, 0.0), (0.97, 0.5)])
def test_probes_are_exact_in_linear_fields(at):
    exact = 100.0 + 40.0 * at[0] - 70.0 * at[1], at[1], -2.0 * at[0]
    # three moments of some 10 particles; one-sided places have moments of condition 1e3
    np.testing.assert_allclose(interpolate(at, cloud()), exact, rtol=1e5 * eps, atol=1e5 * eps)


def test_a_probe_without_water_has_no_value_and_one_by_a_drop_has_the_drops():
    water = cloud()
    assert np.isnan(interpolate((0.5, 2.0), water)).all()
    drop = MeasuredWater(
        np.array([[0.5, 0.9]]), np.array([SPACING**2]), np.array([7.0]), np.array([[1.0, 2.0]]), 0.065, SPACING, 1.0
    )
    np.testing.assert_allclose(interpolate((0.52, 0.9), drop), [7.0, 1.0, 2.0], rtol=4 * eps)


@pytest.mark.parametrize("x", [0.0, 0.5, 1.0])
@pytest.mark.parametrize("height", [0.3, 0.5])
def test_levels_are_heights_of_the_surface(x, height):
    # particles are off their places by up to 0.2 spacings, and so are those that are in the strip by chance
    assert surface_height(LevelSection(x=x, breadth=0.4), cloud(height)) == pytest.approx(height, abs=0.2 * SPACING)


def test_a_drop_is_no_surface():
    water = cloud()
    x = np.vstack((water.x, [[0.5, 1.5]]))
    one = np.ones(len(x))
    more = MeasuredWater(x, SPACING**2 * one, one, np.zeros_like(x), water.length, SPACING, 1.0)
    assert surface_height(LevelSection(x=0.5), more) == pytest.approx(0.5, abs=0.3 * SPACING)
    assert (
        surface_height(
            LevelSection(x=0.5), MeasuredWater(x[-1:], one[-1:] * SPACING**2, one[-1:], x[-1:], 0.065, SPACING, 1.0)
        )
        == 0.0
    )


def test_levels_do_not_see_water_beside_their_strip():  # the twin that must fail
    assert surface_height(LevelSection(x=2.0, breadth=0.2), cloud(width=1.0)) == 0.0


def half_a_metre():
    """Water 0.5 m deep in a tank of 1 m, on a lattice, and ones for each particle."""
    at = square_lattice((0.0, 0.0), (1.0, 0.5), SPACING)
    one = np.ones(len(at))
    return MeasuredWater(at, SPACING**2 * one, one, np.outer(one, [0.3, 0.1]), 0.065, SPACING, 1.0), one


@pytest.mark.parametrize("breadth", [0.3, 1.0, 1.5, 4.0, 6.2])
@pytest.mark.parametrize("x", [0.0, 0.01, 0.5, 0.525, 0.54, 0.99])
def test_a_strip_holds_the_same_depth_of_water_wherever_it_lies_and_however_narrow_it_is(x, breadth):
    water, one = half_a_metre()
    level = LevelSection(x=x, breadth=breadth * SPACING)
    # sums of some 60 numbers; the strip's ends are known to eps of x, a share eps x/breadth of it
    assert open_depth(level, water, one < 0.0) == pytest.approx(0.5, rel=200 * eps)
    assert discharge(level, water, 0.4 * one) == pytest.approx(0.4 * 0.3 * 0.5, rel=200 * eps)
    # Of an even lattice's rows: one half is where the rows below are half of all, at the edge of the topmost row.
    assert surface_height(level, water) == pytest.approx(0.5, abs=0.02 * SPACING)


def test_whole_columns_of_particles_are_not_what_a_strip_holds():
    water, one = half_a_metre()
    whole = np.sum(np.abs(water.x[:, 0] - 0.525) <= 2.0 * SPACING + 1e-9) * SPACING**2 / (4.0 * SPACING)
    assert whole == pytest.approx(0.5 * 5 / 4, rel=1e-12)  # what a strip about the middle of a column was said to hold
    assert open_depth(LevelSection(x=0.525, breadth=4.0 * SPACING), water, one < 0.0) < 0.81 * whole


def still(x, held=True):
    """Instruments of still water 0.4 m deep over flat ground, with a level at ``x``."""
    ground = {"held": True} if held else {"stiffness": 4e5, "elastic": True}
    given = {
        "tank": {"width": 1.0, "height": 1.0, "lid": False},
        "water": {"sound_speed": SOUND, "column": [{"width": 1.0, "height": 0.8}]},
        "soil": {**ground, "permeability": 0.01, "body": [{"outline": [[0, 0], [1, 0], [1, 0.4], [0, 0.4]]}]},
        "level": [{"x": x}], "probe": [],
    }  # fmt: skip
    return Simulation(validate(Scene, {**SCENE, **given})).part(PoreInstruments)


SOUND = 30.0  # m/s


@pytest.mark.parametrize("held", [True, False])
@pytest.mark.parametrize("x", [0.0, 0.5, 0.525])
def test_the_open_depth_of_still_water_over_flat_ground_is_its_depth(x, held):
    # Rows lie beside the plane of the ground, not in it; what is left is what the water's weight presses it together
    # by, g times its depth over c^2.
    depth = still(x, held).tables()["levels"]["level 0 open depth (m)"]
    assert depth == pytest.approx(0.4, rel=9.81 * 0.4 / SOUND**2)


def test_water_about_which_there_are_few_grains_is_not_all_that_is_open():  # the twin that must fail
    flow = still(0.5).flow
    volume, n = flow.layer.mass[: flow.layer.fluid] / (flow.porosity * flow.layer.density), flow.resistance.porosity
    few = volume[flow.porosity > 1.0 - (1.0 - n) / 6.0].sum() / 1.0
    assert few == pytest.approx(0.4 - SPACING, rel=0.01)  # the first row over flat ground has a quarter of its grains


SCENE = {
    "tank": {"width": 1.0, "height": 0.8},
    "water": {"column": [{"width": 1.0, "height": 0.5}]},
    "probe": [{"name": "deep", "x": 0.5, "y": 0.05}, {"x": 0.5, "y": 0.7}],
    "level": [{"x": 0.3}],
    "numerics": {"spacing": 0.05},
    "time": {"end": 0.02},
    "output": {"snapshot_interval": 0.02, "series_interval": 0.005},
}


def test_a_run_leaves_probes_and_levels_and_cuts_them_back_on_resume(tmp_path):
    def run(folder, end, resume=False):
        drive(
            Simulation(validate(Scene, SCENE)), folder, end, snapshot_interval=0.02, series_interval=0.005,
            checkpoint_seconds=1e9, card={"scene": SCENE}, resume=resume, quiet=True,
        )  # fmt: skip
        return (folder / "probes.csv").read_text(), (folder / "levels.csv").read_text()

    whole = run(tmp_path / "whole", 0.02)
    run(tmp_path / "parts", 0.01)
    with (tmp_path / "parts" / "probes.csv").open("a") as file:  # rows beyond the checkpoint
        file.write("9,9,9,9,9,9,9\n")
    assert run(tmp_path / "parts", 0.02, resume=True) == whole
    rows = list(csv.DictReader(whole[0].splitlines()))
    # ρ g depth of 0.45 m, to the half spacing of the surface row
    assert float(rows[0]["deep pressure (Pa)"]) == pytest.approx(9810.0 * 0.45, rel=0.06)
    assert np.isnan(float(rows[0]["probe 1 pressure (Pa)"]))
    level = next(csv.DictReader(whole[1].splitlines()))["level 0 (m)"]
    assert float(level) == pytest.approx(0.5, abs=0.01)


def test_a_scene_without_instruments_has_no_tables():
    scene = validate(Scene, {**SCENE, "probe": [], "level": []})
    assert Simulation(scene).tables() == {}
    assert set(level_row((LevelSection(x=0.5),), cloud())) == {"level 0 (m)"}


def test_a_probe_with_sides_takes_the_mean_of_the_water_in_it():
    x = square_lattice((0.0, 0.0), (1.0, 0.5), SPACING)
    one, p = np.ones(len(x)), 100.0 + 40.0 * x[:, 0] - 70.0 * x[:, 1]
    water = MeasuredWater(x, SPACING**2 * one, p, np.column_stack((x[:, 1], -2.0 * x[:, 0])), 0.065, SPACING, 1.0)
    probe = ProbeSection(name="pore", x=0.6, y=0.25, width=0.2, height=0.3)  # sides between particles
    row = probe_row((probe,), water)
    # The mean of a linear field is that of the centre; sums of 24 numbers.
    exact = [100.0 + 24.0 - 17.5, 0.25, -1.2, 1.0]
    np.testing.assert_allclose(list(row.values()), exact, rtol=100 * eps)
    names = "mean pressure (Pa)", "mean velocity x (m/s)", "mean velocity y (m/s)", "fluid share ()"
    assert list(row) == [f"pore {name}" for name in names]
    # Half as much water in the right half, whose middle is 0.05 m off like that of the left: it weighs half.
    share = np.where(x[:, 0] > 0.6, 0.4, 0.8)
    soaked = probe_row((probe,), water, share)
    shifted = 40.0 * 0.05 * (0.4 - 0.8) / (0.4 + 0.8)
    assert soaked["pore mean pressure (Pa)"] == pytest.approx(exact[0] + shifted, rel=100 * eps)
    assert soaked["pore fluid share ()"] == pytest.approx(0.6, rel=100 * eps)
    assert abs(shifted) > 0.5  # the twin: the plain mean is another
    dry = list(probe_row((ProbeSection(x=0.5, y=2.0, width=0.2, height=0.2),), water).values())
    assert np.isnan(dry[:3]).all()
    assert dry[3] == 0.0


def test_a_probe_with_one_side_is_refused():
    with pytest.raises(InputError, match=r"height: a rectangle needs both"):
        validate(ProbeSection, {"x": 0.1, "y": 0.1, "width": 0.2})


@pytest.mark.parametrize(
    ("given", "said"),
    [
        ({"probe": [{"x": 2.5, "y": 0.1}]}, r"^probe\[0\] = \(2\.5, 0\.1\) m: lies outside of the tank"),
        ({"level": [{"x": 2.5}]}, r"^level\[0\]\.x = 2\.5 m: lies outside of the tank"),
        (
            {"probe": [{"x": 0.1, "y": 0.1, "width": 0.3, "height": 0.1}]},
            r"^probe\[0\]\.width = 0\.3 m: reaches out of the tank .allowed: <= 0\.2 m.; narrow it",
        ),
        (
            {"probe": [{"x": 0.1, "y": 0.1, "width": 0.2, "height": 0.001}]},
            r"^probe\[0\]\.height = 0\.001 m: is less than a spacing, so that no particle may be there",
        ),
    ],
)
def test_instruments_outside_of_the_tank_are_refused(given, said):
    with pytest.raises(InputError, match=said):
        validate(Scene, {**SCENE, **given})


def test_columns_of_water_that_share_room_are_refused():
    # Every place of what they share would get two particles, in one place: the run stopped, and blamed courant.
    column = SCENE["water"]["column"][0]
    half = {**column, "width": 0.5 * column["width"]}
    beside = {**half, "left": half["width"]}
    water = {**SCENE["water"], "column": [half, beside]}
    assert len(Simulation(validate(Scene, {**SCENE, "water": water})).positions) == len(
        Simulation(validate(Scene, SCENE)).positions
    )
    with pytest.raises(InputError, match=r"^water\.column\[1\]: overlaps water\.column\[0\] by "):
        validate(Scene, {**SCENE, "water": {**water, "column": [column, beside]}})


@pytest.mark.parametrize(
    ("key", "sections"),
    [
        ("level", [{"name": "a", "x": 0.2}, {"name": "a open depth", "x": 0.6}]),
        ("probe", [{"name": "a mean", "x": 0.2, "y": 0.2},
                   {"name": "a", "x": 0.5, "y": 0.2, "width": 0.2, "height": 0.2}]),
    ],
)  # fmt: skip
def test_names_that_make_one_column_of_two_are_refused(key, sections):
    """The column of one of them was lost."""
    ground = {"body": [{"outline": [[0, 0], [1, 0], [1, 0.2], [0, 0.2]]}], "held": True}
    column = [{"width": 1.0, "height": 0.4, "bottom": 0.2}]

    def made(of, **more):
        return tank_scene(1.0, 0.8, SPACING, soil=ground, water={"column": column}, **{key: of}, **more)

    with pytest.raises(InputError, match="makes a column that another one has; rename it"):
        made(sections)
    made([it | {"name": f"{it['name']} b"} for it in sections])
