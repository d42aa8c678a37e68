"""The case from grains to the continuum: a bed and a layer of its soil consolidate as Terzaghi says."""

import json
import math
from dataclasses import replace
from types import ModuleType

import numpy as np
import pytest

from porescale.output.case import expected
from tests.reference.continuum.growing_layer import half_times
from tests.reference.folders import CASES, allowed, script

HALVES = 0.196731, 0.275038
"""T_v at which 0.5 = sum of 2/l² exp(-l² T_v), and of 6/l⁴ exp(-l² T_v), l = pi/2, 3 pi/2 ...: by bisection."""
FITTED = 2e-4
"""What a parabola through a decay from 0.65 to 0.35 misses of its half: both are exponential but for modes of which
exp(-2 pi² T_v) = 0.02 is left, a third of it of third order over the window."""


@pytest.fixture(scope="module")
def case() -> ModuleType:
    """The case's script as a module."""
    return script("micro_to_macro")


@pytest.fixture(scope="module")
def layers() -> ModuleType:
    """What is read of a layer, as a module."""
    return script("micro_to_macro", "layers")


def exact(layers: ModuleType, storage: float = 0.0):
    """A layer of M = 15 kPa and K/(rho nu) = 1e-7 m²/(Pa s) that does what Terzaghi says, with water of this storage
    (1/Pa), the load put on at once."""
    modulus, mobility, height, load = 15e3, 1e-7, 0.02, 200.0
    borne = 1.0 / (1.0 + storage * modulus)
    times = np.linspace(1e-3, 0.3, 600)
    factor = mobility / (1.0 / modulus + storage) * times / height**2
    heights = np.linspace(0.0, height, 5)
    left, to_come = layers.terzaghi(factor, heights / height)
    settled = load * height / (3.0 * modulus) * (1.0 - borne * to_come)
    return layers.Layer(
        height, 0.2, load, times, heights, borne * load * left, settled, storage, sudden=True, mobility=mobility
    )


@pytest.mark.parametrize("storage", [0.0, 4e-6])
def test_an_exact_layer_is_read_as_it_was_made(layers, storage):
    layer = exact(layers, storage)
    # the slowest mode alone is to come at the end, T_v 0.11 to 1.1: the next is exp(-2 pi² T_v) of it
    assert layer.modulus == pytest.approx(15e3, rel=1e-3)
    assert (layer.half_left, layer.half_settled) == pytest.approx(HALVES, abs=FITTED + 1e-3 * max(HALVES))
    # between trapezia of 0.5 ms and the first look below a level, of 40 ms and more
    assert layer.seen == pytest.approx(layer.mobility, rel=0.01)


def test_a_layer_read_with_twice_its_k_or_with_water_that_is_taken_for_stiff_is_not(layers):
    layer = exact(layers, 4e-6)  # 6 % of 1/M
    for wrong in (replace(layer, mobility=2.0 * layer.mobility), replace(layer, storage=0.0)):
        assert abs(wrong.half_left - HALVES[0]) > 10 * FITTED
    value, tolerance = allowed("micro_to_macro", "K of beds that consolidate over that at their porosity")
    assert abs(value / 2.0 - value) > 3 * tolerance


def test_what_decays_too_little_has_no_half(layers):
    times = np.linspace(0.0, 1.0, 20)
    assert math.isnan(layers.half_way(times, 1.0 - 0.1 * times))
    assert layers.half_way(times, 0.5 ** (times / 0.4)) == pytest.approx(0.4)  # the twin


def test_without_beds_the_rows_of_consolidation_have_no_number(case):
    numbers = case.layer_numbers([], [])
    assert len(numbers) == 6
    assert set(numbers.values()) == {None}
    assert numbers.keys() <= {it["name"] for it in expected(CASES / "micro_to_macro")}


@pytest.mark.slow
def test_a_layer_of_soil_consolidates_as_terzaghi_says_and_one_of_soft_water_does_not(case):
    layer = case.consolidated(40)
    for name, half, seen in zip(
        ("half of the excess, T_v of soil", "half settled, T_v of soil"), HALVES, (layer.half_left, layer.half_settled),
        strict=True,
    ):  # fmt: skip
        value, tolerance = allowed("micro_to_macro", name)
        assert half == pytest.approx(value, abs=1e-4)  # four digits are written there
        assert abs(seen - value) < tolerance
    stiff = replace(case.consolidated(20, ("water.sound_speed=10",)), storage=0.0)  # 4.6 n M, taken for stiff
    assert abs(stiff.half_settled - HALVES[1]) > 3 * allowed("micro_to_macro", "half settled, T_v of soil")[1]


@pytest.mark.slow
def test_a_bed_lets_its_water_out_as_the_case_says_and_one_of_twice_the_k_does_not(case):
    value, tolerance = allowed("micro_to_macro", "K of beds that consolidate over that at their porosity")
    one = math.sqrt(8.0) * tolerance  # that of eight beds, of one

    def seen(*settings: str) -> float:
        """K of a bed over that of specimens at its porosity."""
        bed = case.squeezed(1, settings)
        k, _ = case.power(*case.specimens(), np.array([bed.porosity]))
        (with_k,) = case.with_permeability([bed], k)
        for name, half in zip(("half of the excess", "half settled"), HALVES, strict=True):
            own = replace(with_k, mobility=with_k.seen)
            found = own.half_left if name == "half of the excess" else own.half_settled
            assert found / half == pytest.approx(
                1.0, abs=math.sqrt(8.0) * allowed("micro_to_macro", f"{name}, T_v of grains over soil")[1]
            )
        return float(with_k.seen / with_k.mobility)

    assert abs(seen() - value) < one
    # the twin: K goes with lambda to the power of -10, so that 0.75 has 1.9 times that of 0.8
    assert abs(seen("grains.hydraulic_radius_ratio=0.75") - value) > 3 * one


def test_half_times_of_grains_are_those_of_a_layer_of_one_stiffness_and_not_of_one_that_grows():
    numbers = json.loads((CASES / "micro_to_macro" / "recorded.json").read_text(encoding="utf-8"))["numbers"]
    names = "half of the excess, T_v of {}", "half settled, T_v of {}"
    excess, settled = (numbers[it.format("grains over soil")] * numbers[it.format("soil")] for it in names)
    bars = [allowed("micro_to_macro", it.format("grains over soil"))[1] for it in names]
    bar = math.hypot(*bars) * excess / settled
    (one, two), growing = half_times(0.0, 40), half_times(0.1, 40)
    # the floor's pressure is a line through those dy/2 and 3 dy/2 above it, 3/8 dy² u'' off, u'' = pi²/4 u = -du/dT_v:
    # half is left 3/8 dy² later, 1.9 dy² of the time
    assert (one, two) == pytest.approx(HALVES, rel=1.9 * 40**-2)
    assert excess / settled == pytest.approx(one / two, abs=bar)
    assert abs(excess / settled - growing[0] / growing[1]) > 1.5 * bar
