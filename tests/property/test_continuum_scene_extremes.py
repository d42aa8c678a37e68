"""Extreme numbers in scenes of ground, water and air end in a report or in refusals, never in another error."""

import math
import tomllib
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from continuum_sph.program import report
from continuum_sph.scene.sections import Scene
from porescale.common.core.errors import InputError
from porescale.common.schema.sections import validate
from tests.reference.grounds import SCENES, put

KEYS = {
    "pile": [
        "gravity", "tank.width", "tank.height", "water.density", "water.viscosity", "water.sound_speed",
        "water.column.0.height", "soil.density", "soil.porosity", "soil.stiffness", "soil.poisson", "soil.permeability",
        "soil.friction_angle", "soil.dilatancy_angle", "soil.cohesion", "soil.tension", "soil.reference",
        "soil.exponent", "soil.numerics.settle", "soil.numerics.repulsion", "soil.body.0.outline.2.1", "pile.x",
        "pile.tip", "reservoir.0.right", "reservoir.0.bottom", "reservoir.0.rise.1.0", "reservoir.0.rise.1.1",
        "reservoir.1.left", "reservoir.1.level", "probe.0.x", "level.0.x", "level.0.breadth", "numerics.spacing",
        "numerics.smoothing_ratio", "numerics.artificial_viscosity", "numerics.courant", "time.end",
        "output.snapshot_interval", "output.series_interval",
    ],
    "air": [
        "air.density", "air.viscosity", "air.pressure", "air.sound_speed", "soil.permeability", "soil.porosity",
        "water.sound_speed", "water.column.0.bottom", "tank.height", "numerics.spacing", "numerics.shifting",
    ],
    "bubble": [
        "inclusion.density", "inclusion.viscosity", "inclusion.surface_tension", "inclusion.sound_speed",
        "inclusion.disc.0.x", "inclusion.disc.0.radius", "numerics.spacing", "numerics.density_diffusion",
        "numerics.density_filter", "numerics.xsph", "water.column.0.width",
    ],
}  # fmt: skip
"""Keys that hold numbers, those that a scene leaves out among them."""
CHOICES = [
    ("tank.walls", "stick"), ("tank.lid", True), ("tank.wall_particles", "images"), ("water.pressure", "none"),
    ("soil.elastic", True), ("soil.stress", "none"), ("soil.permeability_law", "kozeny-carman"), ("pile.faces", "slip"),
    ("numerics.kernel", "cubic"), ("numerics.gradient", "plain"), ("numerics.smoothing_length", "evolved"),
    ("numerics.tension", "kept"), ("inclusion.law", "printed"),
]  # fmt: skip
ALONE = [(name, key) for name, keys in KEYS.items() for key in keys]


def numbers() -> st.SearchStrategy[float]:
    """Any order of magnitude, either sign, and none."""
    powers = st.floats(-16, 16).map(lambda exponent: 10**exponent)
    return st.one_of(powers, powers.map(lambda value: -value), st.just(0.0))


def changes() -> st.SearchStrategy[tuple[str, dict[str, float]]]:
    """A scene and numbers for some of its keys."""
    return st.sampled_from(sorted(KEYS)).flatmap(
        lambda name: st.tuples(st.just(name), st.dictionaries(st.sampled_from(KEYS[name]), numbers(), max_size=6))
    )


def said(name: str, changed: dict[str, Any]) -> bool:
    """Whether a scene is reported rather than refused, in lines that can be read."""
    table = tomllib.loads(SCENES[name])
    for key, value in changed.items():
        put(table, key, value)
    try:
        report(validate(Scene, table))
    except InputError as error:
        lines = [fault.line() for fault in error.faults]
        assert lines
        assert all(line.strip() and len(line.splitlines()) == 1 and len(line) < 2000 for line in lines), lines
        return False
    return True


def judged(changed: tuple[str, dict[str, float]], chosen: list[tuple[str, Any]]) -> None:
    """Whatever it is, it is reported or refused."""
    name, values = changed
    sections = tomllib.loads(SCENES[name])
    said(name, {**values, **{key: value for key, value in chosen if key.partition(".")[0] in sections}})


def test_the_scenes_are_sound_as_they_are():
    assert all(said(name, {}) for name in SCENES)


@settings(max_examples=120)
@given(changes(), st.lists(st.sampled_from(CHOICES), max_size=2))
def test_any_numbers_of_ground_end_in_a_report_or_in_refusals(changed, chosen):
    judged(changed, chosen)


@pytest.mark.slow
@settings(max_examples=1500)
@given(changes(), st.lists(st.sampled_from(CHOICES), max_size=2))
def test_many_numbers_of_ground_end_in_a_report_or_in_refusals(changed, chosen):
    judged(changed, chosen)


def test_each_number_of_ground_alone_is_judged(subtests):
    values = [0.0, *(sign * 10.0**exponent for exponent in (-300, -12, -6, -3, 0, 3, 9, 15, 300) for sign in (1, -1))]
    for name, key in ALONE:
        with subtests.test(name=name, key=key):
            assert False in {said(name, {key: value}) for value in values}  # some of it is refused
            assert {said(name, {key: value}) for value in (math.nan, math.inf)} == {False}
