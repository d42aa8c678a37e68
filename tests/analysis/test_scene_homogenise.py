"""What `porescale homogenise` makes of a scene, and of the tests of its specimens."""

import math

import numpy as np
import pytest

from porescale import Scene, check
from porescale.analysis.biaxial import WINDOW, numbers, running
from porescale.analysis.homogenise import WAVES, pressure_of, ramp_of, section_of, specimen, stiffness_over_pressure
from porescale.builders.initial.placed import packed_count
from porescale.common.core.errors import InputError
from porescale.common.schema.sections import validate
from porescale.scene.measures.homogenise import Homogenise
from porescale.validation import homogenise as verify
from porescale.validation.homogenise import VALIDATIONS
from tests.reference.scenes import column, dry


def tolerance(name):
    return VALIDATIONS[name].tolerance


def test_means_and_slopes_of_a_straight_line_are_its_own():
    x = np.linspace(0.0, 0.1, 198)  # no row at the rim of another's window
    mean, slope = running(x, 3.0 * x + 1.0)
    inside = np.isfinite(mean)
    assert inside.sum() == ((x > 0.5 * WINDOW) & (x < 0.1 - 0.5 * WINDOW)).sum() > 100
    assert mean[inside] == pytest.approx(3.0 * x[inside] + 1.0, rel=1e-12)
    assert slope[inside] == pytest.approx(3.0, rel=1e-10)


def test_a_specimen_of_given_sizes_has_their_shares():
    packing = {"sizes": [["0.8 mm", 30], ["1.2 mm", 10]], "diameter": None, "packing_fraction": None, "left": 0,
               "width": 0.008, "height": 0.006}  # fmt: skip
    scene = dry(homogenise={"pressure": 100, "grains": 200}, **{f"grains__packing__{k}": v for k, v in packing.items()})
    made = validate(Scene, specimen(scene)).grains.packing
    assert made.sizes == ((0.0008, 150.0), (0.0012, 50.0))
    assert made.packing_fraction == pytest.approx(0.83, rel=1e-12)  # SOLID, by the side of the cell
    assert made.sizes != scene.grains.packing.sizes  # the twin: the numbers of the scene are those of its column


@pytest.mark.parametrize("sizes", [{"log_spread": 0.5}, {"grading": [[0.0005, 0], [0.001, 50], [0.0025, 100]]}])
def test_a_specimen_of_many_sizes_has_the_number_of_grains_that_is_asked_for(sizes):
    # A cell is as large as so many grains of the mean area need, and the last of them counts or does not.
    packing = {"diameter": None if "grading" in sizes else 0.001, "left": 0, "width": 0.008, "height": 0.006, **sizes}
    scene = dry(homogenise={"pressure": 100, "grains": 400}, **{f"grains__packing__{k}": v for k, v in packing.items()})
    made = validate(Scene, specimen(scene))
    assert abs(packed_count(made) - 400) <= 2
    assert packed_count(scene) < 100  # the check that must fail: the packing of the scene has as many as it has


def test_a_known_soil_is_found():
    assert VALIDATIONS["scene.biaxial_test_of_a_known_soil"].run().passed


def test_soil_of_another_strength_is_told_apart():  # the twin that must fail
    found = verify.known_numbers(verify.known_test(friction=1.01 * verify.FRICTION))
    assert max(abs(value - 1.0) for value in found) > 1e9 * tolerance("scene.biaxial_test_of_a_known_soil")


def test_a_peak_is_told_from_the_critical_state():
    series = verify.known_test()
    a = -series["strain yy ()"]
    bump = 0.3 * np.exp(-(((a - 0.03) / 0.02) ** 2))
    series["stress yy (Pa)"] = 1e4 + (series["stress yy (Pa)"] - 1e4) * (1.0 + bump)
    (found,) = numbers([series])
    assert found["critical friction angle"] == pytest.approx(verify.FRICTION, rel=1e-9)
    assert found["peak friction angle"] > 1.1 * verify.FRICTION
    assert found["porosity"] == pytest.approx(0.19, rel=1e-12)


def test_a_peak_is_that_of_the_mean_not_the_largest_swing_of_each():
    # Two tests that swing against each other about one strength: the mean has no peak, each of them has.
    tests = []
    for sign in (1.0, -1.0):
        series = verify.known_test()
        swing = 1.0 + sign * 0.1 * np.sin(40.0 * np.pi * -series["strain yy ()"])
        q = series["stress yy (Pa)"] - 1e4
        series["stress yy (Pa)"] = 1e4 + np.where(-series["strain yy ()"] > 0.02, q * swing, q)
        tests.append(series)
    both = numbers(tests)
    mean = sum(math.sin(it["peak friction angle"]) for it in both) / 2.0
    # sin φ = q/(q + 2p) is concave in q: swings of ± 10 % take at most 0.1² q p/(q + 2p)² off or on, below 0.001
    assert mean == pytest.approx(math.sin(verify.FRICTION), abs=1e-3)
    alone = math.sin(numbers(tests[:1])[0]["peak friction angle"])
    assert alone > math.sin(verify.FRICTION) + 0.015


def test_a_run_that_never_sheared_is_no_test():
    series = {name: values[:20] for name, values in verify.known_test().items()}
    with pytest.raises(InputError, match="holds no test"):
        numbers([series])


def test_a_test_of_the_least_strain_is_one_though_it_ends_a_step_short():
    (least,) = Homogenise.model_fields["strain"].metadata
    (found,) = numbers([verify.known_test((1.0 - 1e-4) * least.ge)])
    assert found["porosity"] == pytest.approx(0.19, rel=1e-12)
    with pytest.raises(InputError, match="holds no test"):
        numbers([verify.known_test(0.8 * least.ge)])


def test_a_packing_whose_sides_stand_is_as_stiff_as_its_contacts_and_without_springs_across_it_is_not():
    row = VALIDATIONS["scene.stiffness_of_a_packing_whose_sides_stand"].run()
    assert row.passed, row
    strained, springs = verify.confined(1, slides=False)
    assert abs(springs[1] / strained[1] - 1.0) > 2 * row.tolerance


def test_flow_through_a_square_array_is_what_its_drag_says():
    row = VALIDATIONS["scene.permeability_of_a_square_array"].run()
    assert row.passed
    assert abs(verify.array_permeability(0.9) - 1.0) > 10 * row.tolerance  # the twin that must fail


@pytest.mark.slow
def test_discs_reach_the_critical_state_of_the_paper_and_discs_without_friction_do_not():
    row = VALIDATIONS["scene.critical_state_of_discs"].run()
    assert row.passed, row
    assert abs(verify.critical_angle(0.0, 1) - row.reference) > 3 * row.tolerance


@pytest.mark.slow
def test_discs_in_fast_shear_have_the_friction_of_the_paper_and_at_half_the_rate_they_have_not():
    row = VALIDATIONS["scene.friction_of_discs_in_fast_shear"].run()
    assert row.passed, row
    assert abs(verify.stress_ratio(0.1, 1) - row.reference) > 2 * row.tolerance


def test_pressure_is_what_is_asked_else_the_packings_else_the_weights():
    # half of a height of 5.5 mm at a packing fraction of 0.7: wet grains of 2500 kg/m³ weigh 1500 kg/m³ times g
    wet = column()
    assert pressure_of(wet) == pytest.approx(0.5 * 0.7 * 1500.0 * 9.81 * 0.0055, rel=1e-3)
    assert pressure_of(dry()) == pytest.approx(0.5 * 0.7 * 2500.0 * 9.81 * 0.0055, rel=1e-3)
    assert pressure_of(column(homogenise__pressure="2 kPa")) == 2000.0
    assert stiffness_over_pressure(column(homogenise__pressure="2 kPa")) == pytest.approx(100.0)


def test_a_specimen_is_a_scene_of_the_same_grains_without_walls_weight_and_water():
    given = column(homogenise={"pressure": 200, "grains": 300, "inertial_number": 2e-3})
    table = specimen(given)
    made = validate(Scene, table)
    assert made.fluid is None
    assert made.gate is None
    assert all(made.domain.periodic)
    assert not any(made.gravity)
    packing = made.grains.packing
    assert (packing.diameter, packing.size_spread, packing.pressure) == (0.0008, 0.1, 200.0)
    assert made.contact.friction == given.contact.friction
    mass = math.pi / 4.0 * 0.0008**2 * 2500.0
    rate = -made.cell.rate_yy.values[-1]
    assert rate == pytest.approx(2e-3 * math.sqrt(200.0 / mass), rel=1e-12)
    # the logarithmic strain at the end: the rate's integral, half of it while it grows
    strain = rate * (made.time.end - 0.5 * made.cell.rate_yy.times[-1])
    assert strain == pytest.approx(0.24, rel=1e-12)


def test_a_slender_specimen_has_the_same_area():
    square, slender = (specimen(column(homogenise={"pressure": 200, "aspect_ratio": a}))["domain"] for a in (1, 2))
    assert square["width"] == square["height"]
    assert slender["height"] / slender["width"] == pytest.approx(2.0, rel=1e-14)
    assert slender["height"] * slender["width"] == pytest.approx(square["width"] ** 2, rel=1e-14)


@pytest.mark.parametrize("aspect_ratio", [1, 2])
def test_the_first_loading_lasts_as_long_as_waves_take(aspect_ratio):
    given = column(homogenise={"pressure": 200, "aspect_ratio": aspect_ratio})
    packing = given.grains.packing
    table = specimen(given)
    times, rate = table["cell"]["rate_yy"][1]
    wave = table["domain"]["height"] * math.sqrt(2500.0 / given.contact.stiffness)
    strain = 200.0 / given.contact.stiffness
    assert math.sqrt(2.0 * strain * times / -rate) == pytest.approx(WAVES * wave, rel=1e-12)
    assert ramp_of(section_of(given), packing) == pytest.approx(-rate * times, rel=1e-12)


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        ({"grains__packing": None, "grains__grain": [{"x": 0.01, "y": 0.004, "diameter": 0.001}]}, "no packing"),
        ({"contact": {"law": "hertz", "young": 1e7, "restitution": 0.5}}, "contact.law"),
        ({"homogenise__pressure": "100 kPa"}, "would press"),
        ({"gravity": [0, 0]}, "homogenise.pressure"),
    ],
)
def test_what_cannot_be_homogenised_is_refused(changes, said):
    with pytest.raises(InputError, match=said):
        specimen(column(**changes))


def test_check_says_what_homogenise_would_refuse():
    pressed, hard = (
        [it for it in check(dry(homogenise={"pressure": p})).warnings if "homogenise" in it] for p in (100_000, 100)
    )
    assert len(pressed) == 1
    assert "homogenise.pressure" in pressed[0]
    assert not hard  # a check that must not warn


@pytest.mark.parametrize(
    "changes",
    [
        {"pressure": 0}, {"packings": 1}, {"grains": 10}, {"strain": 2}, {"cels": 3}, {"aspect_ratio": 5},
        {"rates": [0.1, 0.2, 0.3]}, {"rates": [0.1, 0.1, 0.2, 0.3]}, {"rates": [0.1, 0.2, 0.3, 2.0]}, {"rates": 0.1},
    ],
)  # fmt: skip
def test_wrong_keys_are_refused(changes):
    with pytest.raises(InputError, match="homogenise"):
        column(homogenise=changes)
