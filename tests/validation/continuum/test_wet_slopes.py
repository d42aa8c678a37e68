"""Beside each row on slopes under water a twin that must fail."""

from dataclasses import replace

import pytest

from continuum_sph.builders.simulation import Simulation
from continuum_sph.validation.seepage import permeability, wet_slopes
from continuum_sph.validation.seepage.wet_slopes import SEEPING, STILL, WetSlope
from tests.reference.continuum import continuum_cases
from tests.reference.continuum.continuum_cases import missed
from tests.validation.tolerances import ROWS, tolerance

STEEP = "soil.body=[{outline=[[0,0],[2.2,0],[2.2,0.2],[1.0,0.2],[0.3,0.8],[0,0.8]]}]"
"""41 degrees: it moves by a third of a metre in two seconds.  One of 33, 12 rows high, creeps by 0.3 mm."""


def test_limits_of_wet_slopes_are_those_of_the_textbook():
    # γ' = 990, γ_sat = 1990 kg/m³: half of sin φ with water that seeps along the slope
    assert WetSlope(20.0, False).limit() == pytest.approx(26.565, abs=5e-4)
    assert WetSlope(20.0, True).limit() == pytest.approx(13.968, abs=5e-4)
    for seeping in (False, True):
        limit = WetSlope(20.0, seeping).limit()
        assert WetSlope(limit, seeping).acceleration() == pytest.approx(0.0, abs=1e-14)


def test_a_layer_of_another_depth_slides_alike_where_all_else_goes_with_it():
    deep = WetSlope(28.0, False, rows=10)
    part = 0.04  # of depth and stress, Froude's: times and speeds go with its root
    root = part**0.5
    flat = replace(
        deep, depth=part, stiffness=part * deep.stiffness, permeability=root * deep.permeability,
        sound_speed=root * deep.sound_speed,
    )  # fmt: skip
    wanted, found = deep.slides(0.1, 0.2)[0], flat.slides(0.1 * root, 0.2 * root)[0]
    # the same steps but for round-off of the times, eps a step, and for the step at which a time is reached: 1e-9
    assert found == pytest.approx(wanted, rel=1e-9)
    other = replace(flat, permeability=deep.permeability, friction=0.4)  # the twin: friction does not go with the depth
    assert other.slides(0.1 * root, 0.2 * root)[0] > 1.5 * wanted


@pytest.mark.slow
@pytest.mark.parametrize(("given", "row"), [(STILL, "under_water"), (SEEPING, "with_seepage")])
def test_a_slope_in_still_water_does_not_slide_as_with_seepage_nor_the_other_way_round(given, row):
    found = wet_slopes.friction(given, not given.seeping)
    assert abs(found / given.friction - 1.0) > 3.0 * tolerance(f"continuum.soil_slides_{row}")


@pytest.mark.slow
def test_a_slope_beyond_its_wet_limit_does_not_rest():
    assert SEEPING.acceleration(False) < 0.0 < wet_slopes.slides(SEEPING)[0]
    assert wet_slopes.slides(SEEPING)[1] > 3.0 * tolerance("continuum.soil_rests_below_its_wet_limits")


@pytest.mark.slow
def test_permeability_that_does_not_follow_porosity_is_told_apart():
    exact = ROWS["continuum.permeability_follows_porosity"].run().reference
    for porosity, wanted in zip(2 * permeability.CHANGED, exact, strict=True):
        found = permeability.passed("constant", porosity)
        assert abs(found / wanted - 1.0) > 10.0 * tolerance("continuum.permeability_follows_porosity")


def series(*settings):
    """Columns of the case's series, two seconds after it settled."""
    return continuum_cases.series(Simulation, 200, "submerged_slope", "time.end=5", *settings)


@pytest.mark.slow
def test_a_slope_under_water_does_as_its_case_says():
    assert missed("submerged_slope", series()) == []


@pytest.mark.slow
def test_a_steep_slope_under_water_does_not_rest():  # the twin that must fail
    assert "nothing creeps" in missed("submerged_slope", series(STEEP))
