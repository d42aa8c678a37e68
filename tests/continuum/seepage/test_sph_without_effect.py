"""Keys that change nothing in a scene are said, and change nothing."""

import numpy as np
import pytest

from continuum_sph.builders.report import report
from continuum_sph.builders.reports.effect_report import IN_THE_OPEN, OF_WATER
from continuum_sph.builders.simulation import Simulation
from continuum_sph.validation.tanks import tank_scene
from porescale.common.core.errors import InputError

OTHER = {
    "artificial_viscosity": 0.05, "artificial_viscosity_2": 1.0, "softening": 1.0, "density_diffusion": 0.05,
    "diffusion_of": "plain", "noise_floor": 0.5, "density_filter": 2, "gradient": "corrected", "shifting": 1.0,
    "smoothing_length": "evolved", "xsph": 0.3,
}  # fmt: skip
STEPS = 40  # in which the water comes to move by more than what shifting leaves alone


def scene(kind, **numerics):
    """A bank of soil, "dry", with "suction" or "wet", beside water, and with ``numerics``."""
    corners = [[0.5, 0], [1, 0], [1, 0.3], [0.5, 0.3]]
    soil = {"stiffness": 1e6, "permeability": 1e-2, "body": [{"outline": corners}], "saturated": kind == "wet"}
    if kind == "suction":
        soil["suction"] = {"alpha": 10.0, "n": 3.0, "water_table": 0.1}
    water = {"sound_speed": 30.0, "column": [{"width": 0.25, "height": 0.4}] if kind == "wet" else []}
    return tank_scene(1.0, 0.6, 0.05, numerics=numerics, soil=soil, water=water)


def told(kind, **numerics):
    """Keys that its report says to have no effect."""
    lines = [it for it in report(scene(kind, **numerics)).warnings if "has no effect" in it]
    return [it.split(" = ")[0].removeprefix("numerics.") for it in lines]


def end(kind, **numerics):
    """Places of the soil and of the water after some steps."""
    model = Simulation(scene(kind, **numerics))
    for _ in range(STEPS):
        model.flow.advance()
    return {name: it.position for name, it in model.snapshot().clouds.items()}


@pytest.mark.parametrize("kind", ["dry", "suction", "wet"])
def test_what_has_no_effect_is_said_and_nothing_else(kind):
    given = end(kind)
    for key, value in OTHER.items():
        other = end(kind, **{key: value})
        same = all(np.array_equal(given[name], other[name]) for name in given)
        assert told(kind, **{key: value}) == ([key] if same else []), key
        assert same == (key in (IN_THE_OPEN if kind == "wet" else OF_WATER)), key


def test_nothing_is_said_of_defaults():
    assert set(OTHER) == set(OF_WATER)
    assert told("wet", gradient="plain") == told("dry", artificial_viscosity=0.02) == []


def dry(tank=None, **soil):
    """A bank of dry soil."""
    table = {"width": 1.0, "height": 0.6, "lid": False} | (tank or {})
    corners = [[0.5, 0], [1, 0], [1, 0.3], [0.5, 0.3]]
    return tank_scene(1.0, 0.6, 0.05, tank=table, soil={"body": [{"outline": corners}]} | soil)


@pytest.mark.parametrize(
    ("made", "key"),
    [
        (dry({"walls": "stick"}), "tank.walls"),
        (dry({"wall_particles": "images"}), "tank.wall_particles"),
        (dry(strength="peak"), "soil.strength"),
    ],
)
def test_dry_soil_has_neither_walls_of_water_nor_strengths_of_a_file_that_is_not_there(made, key):
    assert [it.split(" = ")[0] for it in report(made).warnings if "has no effect" in it] == [key]
    soils = [Simulation(it).snapshot().clouds["particles"].data for it in (made, dry())]
    assert all(np.array_equal(soils[0][name], soils[1][name]) for name in soils[0])


@pytest.mark.parametrize(("key", "value"), [("viscosity", 1.0), ("exponent", 2.0), ("pressure", "none")])
@pytest.mark.parametrize("suction", [None, {"alpha": 10.0, "n": 3.0, "water_table": 0.1}])
def test_soil_without_particles_of_water_has_nothing_of_them(suction, key, value):
    """Flow in pores that are partly full follows soil.permeability: a sweep over the viscosity changed nothing."""
    made = [
        tank_scene(1.0, 0.6, 0.05, soil={"body": [{"outline": [[0.5, 0], [1, 0], [1, 0.3]]}], "suction": suction},
                   water={"sound_speed": 30.0} | more)
        for more in ({}, {key: value})
    ]  # fmt: skip
    said = [[it.split(" = ")[0] for it in report(each).warnings if "has no effect" in it] for each in made]
    assert said == [[], [f"water.{key}"]]
    states = []
    for each in made:
        model = Simulation(each)
        model.advance(STEPS)
        states.append(model.snapshot().clouds["soil" if suction else "particles"])
    assert all(np.array_equal(states[0].data[name], states[1].data[name]) for name in states[0].data)


@pytest.mark.parametrize("law", ["liquid", "adiabatic", "printed"])
@pytest.mark.parametrize(("key", "value"), [("sound_speed", 80.0), ("pressure", 5e4), ("exponent", 2.0)])
def test_what_a_second_fluid_does_not_have_is_said(law, key, value):
    """A sweep over the pressure of a liquid, or the speed of sound of a gas, showed no error and changed nothing."""
    made = []
    for more in ({}, {key: value}):
        fluid = {"law": law, "density": 800.0, "disc": [{"x": 0.5, "y": 0.3, "radius": 0.15}]} | more
        water = {"column": [{"width": 1.0, "height": 0.5}]}
        made.append(tank_scene(1.0, 0.6, 0.05, water=water, inclusion=fluid))
    said = [it.split(" = ")[0] for it in report(made[1]).warnings if "has no effect" in it]
    layers = [Simulation(it).flow.layer for it in made]
    same = np.array_equal(layers[0].density, layers[1].density)
    assert said == ([f"inclusion.{key}"] if same else [])
    assert not any("has no effect" in it for it in report(made[0]).warnings)


@pytest.mark.parametrize("suction", [None, {"alpha": 10.0, "n": 3.0, "water_table": 0.1}])
@pytest.mark.parametrize(("right", "said"), [(0.2, 1), (0.3, 0)])
def test_strips_that_meet_at_other_levels_are_said_with_and_without_suction(suction, right, said):
    corners = [[0.7, 0], [1, 0], [1, 0.3], [0.7, 0.3]]
    soil = {"stiffness": 1e6, "body": [{"outline": corners}], "suction": suction}
    strips = [{"left": 0.0, "right": 0.2, "level": 0.2}, {"left": right, "right": right + 0.2, "level": 0.1}]
    made = tank_scene(1.0, 0.6, 0.05, soil=soil, water={"sound_speed": 30.0}, reservoir=strips)
    assert sum("strips of reservoirs meet" in it for it in report(made).warnings) == said


def test_held_soil_has_no_stress_at_rest():
    """A sweep over K0 of ground that is held showed no error and changed nothing."""
    corners = [[0.5, 0], [1, 0], [1, 0.3], [0.5, 0.3]]
    soil = {"stiffness": 1e6, "permeability": 1e-2, "held": True, "body": [{"outline": corners}]}
    water = {"sound_speed": 30.0, "column": [{"width": 0.25, "height": 0.4}]}
    made = [tank_scene(1.0, 0.6, 0.05, soil=soil | more, water=water) for more in ({"rest": 0.7}, {})]
    said = [[it.split(" = ")[0] for it in report(each).warnings if "has no effect" in it] for each in made]
    assert said == [["soil.rest"], []]
    models = [Simulation(each) for each in made]
    for model in models:
        model.advance(STEPS)
    clouds = [model.snapshot().clouds for model in models]
    assert all(np.array_equal(clouds[0][name].position, clouds[1][name].position) for name in clouds[0])


def test_steps_are_limited_by_what_the_scene_has():
    """Without a second fluid the step for capillarity was infinite, and said to be."""
    disc = {"x": 0.5, "y": 0.3, "radius": 0.15}
    tension = {"law": "liquid", "density": 800.0, "surface_tension": 0.07, "disc": [disc]}
    rows = []
    for more in ({}, {"inclusion": tension}):
        made = tank_scene(1.0, 0.6, 0.05, water={"column": [{"width": 1.0, "height": 0.5}]}, **more)
        rows.append({it.name: it.value for it in report(made).groups["steps"]})
    assert "longest step for capillarity" not in rows[0]
    assert 0.0 < rows[1]["longest step for capillarity"] < np.inf
    assert all(np.isfinite(it) for it in rows[0].values() if isinstance(it, float))


def test_water_beside_suction_is_refused_once():
    """A thin column was refused twice, the second time with a finer spacing that would not help."""
    corners = [[0.7, 0], [1, 0], [1, 0.3], [0.7, 0.3]]
    soil = {"stiffness": 1e6, "body": [{"outline": corners}], "suction": {"alpha": 10.0, "n": 3.0, "water_table": 0.1}}
    with pytest.raises(InputError) as found:
        tank_scene(1.0, 0.6, 0.05, soil=soil, water={"sound_speed": 30.0, "column": [{"width": 0.1, "height": 0.1}]})
    assert [it.key for it in found.value.faults] == ["water.column"]
