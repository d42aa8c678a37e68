"""Any three of spacing, step, relaxation time and viscosity determine the fourth, whichever three they are."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from porescale import Scene
from porescale.builders.derive import fluid_scales
from porescale.common.core.errors import InputError
from porescale.common.schema.sections import scene_as_dict, validate
from porescale.lbm.scales import AGREEMENT, NAMES, implied
from porescale.scene.fluid import Fluid
from tests.reference.scenes import grain, table

FOURS = st.builds(
    lambda spacing, step, tau: {
        "spacing": spacing, "step": step, "relaxation_time": tau, "viscosity": (tau - 0.5) / 3 * spacing**2 / step,
    },
    st.floats(1e-6, 1e-2), st.floats(1e-7, 1e-2), st.floats(0.501, 3.0),
).filter(lambda four: 1e-11 < four["viscosity"] < 1e2)  # fmt: skip


@given(FOURS, st.sampled_from(NAMES))
def test_each_three_give_the_lattice_of_all_four(four, left_out):
    three = {name: value for name, value in four.items() if name != left_out}
    scales = fluid_scales(Fluid(**three))
    for name, value in four.items():
        # Four or five roundings; tau - 1/2 loses at most a factor tau/(tau - 1/2) = 500 of them.
        assert getattr(scales, name) == pytest.approx(value, rel=500 * 5 * 2**-52)


@given(FOURS)
def test_four_that_agree_to_the_digits_of_input_are_taken(four):
    rounded = {name: float(f"{value:.6g}") for name, value in four.items()}
    # Six digits: 5e-6 each, at worst times two for the square and times tau/(tau - 1/2) = 500 for tau.
    spread = 5e-6 * (2 + 1 + 1) * max(1.0, four["relaxation_time"] / (four["relaxation_time"] - 0.5))
    if spread < AGREEMENT:
        assert Fluid(**rounded).spacing == rounded["spacing"]


@given(FOURS, st.sampled_from(NAMES), st.floats(1.02, 3.0))
def test_four_that_disagree_are_refused_with_values_that_would_agree(four, wrong, factor):
    # Not the relaxation time by its factor: its distance from 1/2 is what counts.
    given_four = dict(four)
    given_four[wrong] = 0.5 + (four[wrong] - 0.5) * factor if wrong == "relaxation_time" else four[wrong] * factor
    if abs(given_four[wrong] / four[wrong] - 1) < 2 * AGREEMENT:
        return
    with pytest.raises(InputError) as caught:
        validate(Scene, table(fluid=given_four, grains=None, contact=None, gate=None))
    repairs = {fault.key.removeprefix("fluid."): fault for fault in caught.value.faults}
    assert repairs.keys() <= set(NAMES)
    assert wrong in repairs
    # The repair named for the wrong one is the right one, in the six digits printed.
    assert float(repairs[wrong].repair.rpartition("or give ")[2].split()[0]) == pytest.approx(four[wrong], rel=1e-5)
    assert implied(**given_four).keys() == set(NAMES)


@given(
    st.lists(st.tuples(st.integers(1, 10), st.integers(1, 6)), min_size=1, max_size=5, unique=True),
    st.floats(100.0, 10000.0), st.floats(0.01, 1.0),
)  # fmt: skip
def test_a_scene_written_in_full_is_the_same_scene(places, density, restitution):
    grains = [grain(0.001 * i, 0.001 * j, 0.0009, spin=float(i)) for i, j in places]
    scene = validate(
        Scene,
        table(grains={"density": density, "hydraulic_radius_ratio": 0.9, "grain": grains}, gate=None,
              contact={"stiffness": 1e5, "restitution": restitution}),
    )  # fmt: skip
    assert validate(Scene, scene_as_dict(scene)) == scene
