"""The case from grains to the continuum: its material file is of its scene, and both columns do as it says."""

import math
import tomllib
from types import ModuleType

import pytest

from porescale import load
from porescale.analysis.homogenise import packing_of, pressure_of, section_of, stiffness_over_pressure
from tests.reference.folders import CASES, allowed, script

CASE = CASES / "micro_to_macro"
FINEST = 12  # rows of soil over the depth of the column


@pytest.fixture(scope="module")
def case() -> ModuleType:
    """The case's script as a module."""
    return script("micro_to_macro")


def test_the_material_file_is_of_the_scene_beside_it():
    scene = load(CASE / "bed.toml")
    made = tomllib.loads((CASE / "material.toml").read_text(encoding="utf-8"))["made"]
    section, packing = section_of(scene), packing_of(scene)
    assert scene.grains
    assert made["seeds"] == list(range(packing.seed, packing.seed + section.packings))
    assert (made["grains"], made["strain"], made["pressure"]) == (section.grains, section.strain, pressure_of(scene))
    assert (made["diameter"], made["grain_density"]) == (packing.diameter, scene.grains.density)
    assert made["lambda"] == scene.grains.hydraulic_radius_ratio
    assert made["stiffness_over_pressure"] == pytest.approx(stiffness_over_pressure(scene))
    assert made["cells"] == pytest.approx(section.cells, rel=0.01)


def test_both_columns_and_the_bed_are_of_the_same_grains():
    bed, column = load(CASE / "bed.toml"), load(CASE / "column.toml")
    for name in ("diameter", "size_spread", "settling_friction"):
        assert getattr(packing_of(bed), name) == getattr(packing_of(column), name)
    assert bed.contact == column.contact
    assert bed.grains
    assert column.grains
    assert bed.grains.density == column.grains.density


def test_an_element_is_as_strong_as_its_grains(case):
    soil = case.ground().soil
    stress = case.lab.biaxial(case.material_of(soil), soil.reference, 0.05, 500)[1][-1]
    strong = math.asin((stress[2] - stress[3]) / (stress[2] + stress[3]))
    angle, error = soil.origin.measured["critical_friction_angle"]
    value, tolerance = allowed("micro_to_macro", "critical angle of an element over that of grains")
    assert strong / angle == pytest.approx(value, abs=tolerance)
    peak = case.ground(("soil.strength=peak",)).soil  # the twin that must fail
    assert peak.friction_angle - angle > 3 * error


def soil_front(case: ModuleType, angle: float) -> float:
    """Front (m) of the finest column of soil of the case, with an angle of friction (rad)."""
    return case.soil_falls((f"numerics.spacing={0.03 / FINEST!r}", f"soil.friction_angle={angle!r}")).front()


@pytest.mark.slow
def test_a_column_of_soil_ends_where_the_case_says_and_one_of_another_strength_does_not(case):
    value, tolerance = allowed("micro_to_macro", "front of fallen soil")
    angle = case.ground().soil.friction_angle
    assert abs(soil_front(case, angle) - value) < tolerance
    assert abs(soil_front(case, 2.0 * angle) - value) > 3 * tolerance


def test_what_falls_is_the_grains_alone_above_held_discs_without_a_gap(case):
    scene = load(CASE / "column.toml")
    discs = script("micro_to_macro", "falls").held_discs(scene)
    size = discs[0]["diameter"]
    assert size == pytest.approx(packing_of(scene).diameter, rel=0.02)  # 27 of them in 4 cm
    ends = [it["x"] + 0.5 * size for it in discs]
    # round-off of the last, 0.24 m of 162 discs
    assert [it["x"] - 0.5 * size for it in discs] == pytest.approx([0.0, *ends[:-1]], abs=1e-15)
    assert ends[-1] == pytest.approx(scene.domain.width, abs=1e-15)
    assert min(abs(it - scene.gate.x) for it in ends) < 1e-15  # none stands across the gate
    fell, flat = (case.grains_fall(1, ("time.end=0.01",), rough) for rough in (True, False))
    assert len(fell.mass) == len(fell.place) == len(flat.mass)  # the held ones are in no front and in no centre
    assert 0.0 < fell.place[:, 1].min() < size  # heights are above their tops, between which grains sink
    assert fell.place[:, 0].max() < scene.gate.x + 0.01  # the check that must fail: discs lie along all of the floor
    assert ends[-1] > scene.gate.x + 0.01


@pytest.mark.slow
def test_columns_of_grains_end_where_the_case_says_and_smooth_ones_and_a_flat_floor_do_not(case):
    value, tolerance = allowed("micro_to_macro", "centre of fallen grains")
    fell = [case.grains_fall(seed).centre_at_rest for seed in range(1, 5)]
    assert abs(sum(fell) / 4 - value) < math.sqrt(2.0) * tolerance  # that of eight packings, of four
    smooth = case.grains_fall(1, ("contact.friction=0.1",)).centre_at_rest
    assert abs(smooth - value) > 3 * tolerance
    assert case.grains_fall(1, rough=False).centre_at_rest - value > 10 * tolerance  # there they slide and roll


@pytest.mark.slow
def test_soil_whose_friction_grows_with_the_rate_ends_where_grains_do_whatever_their_size(case):
    # twice as fine grains are at half the inertial number, so that the column goes on; of coarser grains one packing's
    # front deviates by 1.7 %, of which three, and half a spacing of the soil is 1.6 %: squared and added
    size, tolerance = 0.75e-3, math.hypot(3 * 0.017, 0.016)
    grains = case.grains_fall(1, (f"grains.packing.diameter={size}",)).front()

    def front(diameter: float) -> float:
        """Of the soil of grains of this diameter (m)."""
        own = f"soil.rate.grain_diameter={diameter}"
        return case.soil_falls((f"numerics.spacing={0.03 / FINEST!r}", "soil.material=rates.toml", own)).front()

    assert front(size) / grains == pytest.approx(1.0, abs=tolerance)
    assert abs(front(4.0 * size) / grains - 1.0) > tolerance  # the check that must fail: other grains
