"""The case from grains to the continuum: slopes under water, of grains and of the soil that they make."""

import math
import tomllib
from dataclasses import replace
from types import ModuleType
from typing import Any

import numpy as np
import pytest
from matplotlib.figure import Figure

from porescale import load
from porescale.builders.build import build
from porescale.output.case import expected
from porescale.scene.packing import Packing
from tests.reference.folders import CASES, allowed, script

CASE = CASES / "micro_to_macro"


@pytest.fixture(scope="module")
def case() -> ModuleType:
    """The slopes of the case as a module; its script puts the folder on the path."""
    script("micro_to_macro")
    return script("micro_to_macro", "slides")


def slid(case: ModuleType, soil: float, rated: float) -> Any:
    """Slopes of four packings, of mean 0.31, and of soil with these frictions at each spacing."""
    grains = [case.Slide(it, 0.1) for it in (0.30, 0.31, 0.31, 0.32)]
    return case.Slopes(
        grains, [case.Slide(soil, 0.2)] * 3, [case.Slide(rated, 0.1)] * 3, (0.007, 0.007), (0.002, 0.001)
    )


def test_the_slope_is_of_the_grains_of_the_bed_and_as_steep_as_its_script_says(case):
    slope, bed = load(CASE / "slope.toml"), load(CASE / "bed.toml")
    assert slope.grains
    assert bed.grains
    packings = slope.grains.packing, bed.grains.packing
    assert all(isinstance(it, Packing) for it in packings)
    for name in ("diameter", "size_spread"):
        assert getattr(packings[0], name) == getattr(packings[1], name)
    assert slope.contact == bed.contact
    assert (slope.grains.density, slope.grains.hydraulic_radius_ratio) == (
        bed.grains.density, bed.grains.hydraulic_radius_ratio,
    )  # fmt: skip
    along, across = slope.gravity
    assert math.hypot(along, across) == pytest.approx(case.GRAVITY, rel=1e-6)  # digits given
    assert math.degrees(math.atan2(along, -across)) == pytest.approx(case.STEEP, abs=1e-4)
    held = sorted(it.x for it in slope.disc)
    assert np.diff([*held, held[0] + slope.domain.width]) == pytest.approx(0.0015)  # a floor without a gap


def test_the_slopes_lie_on_both_sides_of_the_limit_of_the_soil(case):
    limit = case.layer(10, case.STEEP).limit()
    low, high = (math.degrees(math.atan(math.sin(math.radians(it)))) for it in (14.9, 15.3))  # 15.1° ± 0.2°
    assert low < limit < high
    assert case.FLAT < low < high < case.STEEP


def test_what_is_let_go_gains_its_buoyant_weight_along_the_slope_until_the_floor_takes_of_it(case):
    settings = ["grains.packing.height=0.004", "domain.height=0.01"]
    simulation = build(load(CASE / "slope.toml", quality="draft", settings=settings))
    scene = simulation.scene
    mass = simulation.masses[: len(simulation.masses) - len(scene.disc)].sum()
    assert scene.grains
    assert scene.fluid
    assert simulation.coupled
    driven = scene.gravity[0] * mass * (1.0 - scene.fluid.density / scene.grains.density)
    gained = []
    for _ in range(40):
        simulation.advance(1)
        gained.append(float(simulation.coupled.momentum()[0]) / (driven * simulation.time))
    # in one step nothing slips yet: what the grains at the floor are held by grows from zero
    assert gained[0] == pytest.approx(1.0, abs=2e-3)
    assert gained[-1] < 0.5  # the twin: then friction holds


def test_the_material_with_rates_is_the_other_one_and_how_its_friction_grows():
    plain, rated = (tomllib.loads((CASE / it).read_text(encoding="utf-8")) for it in ("material.toml", "rates.toml"))
    assert {it: plain[it] for it in ("format", "soil", "strength", "pores")} == {
        it: rated[it] for it in ("format", "soil", "strength", "pores")
    }
    assert plain["measured"].items() <= rated["measured"].items()
    assert plain["made"]["seeds"] == rated["made"]["seeds"]
    assert "rate" in rated
    assert "rate" not in plain  # else one of them would do


def test_friction_is_read_of_the_acceleration_that_it_leaves(case):
    given = case.layer(10, case.STEEP)
    assert given.shown(given.acceleration()) == pytest.approx(given.friction, rel=1e-12)
    assert given.shown(0.0) == pytest.approx(math.tan(math.radians(case.STEEP)), rel=1e-12)  # what rests
    assert replace(given, friction=0.1).acceleration() > given.acceleration()


def test_a_table_says_whether_both_scales_agree_and_the_rows_are_those_of_the_case(case):
    plain, rated = slid(case, 0.27, 0.305).compared()
    assert rated.inside
    assert not plain.inside  # the check that must fail
    numbers = case.numbers_of_slopes(slid(case, 0.27, 0.305))
    assert numbers["friction of soil that grows with the rate over that of grains"] == pytest.approx(0.305 / 0.31)
    names = {it["name"] for it in expected(CASE)}
    assert numbers.keys() <= names
    assert case.numbers_of_slopes(None) == dict.fromkeys(numbers)
    panel = Figure().subplots()
    case.draw_slopes(panel, slid(case, 0.27, 0.305), ("C0", "C1", "C2"))
    assert len(panel.lines) > 0
    case.draw_slopes(panel, None, ("C0", "C1", "C2"))
    assert not panel.axison


def test_soil_shears_at_the_friction_of_the_case_and_soil_of_another_angle_does_not(case):
    value, tolerance = allowed("micro_to_macro", "friction of a slope of soil under water")
    found = case.soil_slides(case.layer(case.FEW, case.STEEP)).friction
    # 10 rows in place of 40: what half of the row at the floor takes of a depth, 0.5/10 of the value, more
    assert abs(found - value) < tolerance + 0.05 * value
    other = case.soil_slides(case.layer(case.FEW, case.STEEP, ("soil.friction_angle=0.16",))).friction
    assert abs(other - value) > 2 * (tolerance + 0.05 * value)  # the twin


@pytest.mark.slow
def test_grains_slide_as_the_case_says_and_smooth_ones_do_not(case):
    value, tolerance = allowed("micro_to_macro", "friction of a slope of grains under water")
    found = [case.grains_slide(seed, case.STEEP).friction for seed in (1, 2, 3)]
    assert abs(sum(found) / 3 - value) < math.sqrt(8 / 3) * tolerance  # that of eight packings, of three
    smooth = case.grains_slide(1, case.STEEP, ("contact.friction=0.1",)).friction
    assert abs(smooth - value) > 3 * tolerance


@pytest.mark.slow
def test_grains_rest_below_the_limit(case):
    rests = case.grains_slide(1, case.FLAT)
    # the floor takes all that drives, and brakes what the loose grains moved at first: but for what sways yet, 1 mm/s
    # over the window, 0.001/0.4/9.81 of it.  The twin: on the steep slope it takes less.
    assert rests.friction > math.tan(math.radians(case.FLAT)) - 1e-3
    assert abs(rests.speed) < 1e-3
    slides = case.grains_slide(1, case.STEEP)
    assert slides.friction < math.tan(math.radians(case.STEEP)) - 0.01
    assert slides.speed > 0.01
