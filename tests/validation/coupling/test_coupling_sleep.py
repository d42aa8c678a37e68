"""The validations of sleep under water hold, and would not if sleepers were deaf or fell asleep too early."""

import pytest

from porescale.validation.coupling import sleep as lab
from tests.validation.tolerances import tolerance

pytestmark = pytest.mark.slow


@pytest.mark.parametrize("sinks", [False, True])
def test_the_water_and_a_grain_wake_sleepers_and_they_sleep_again(sinks):
    found = lab.disturbed(sinks, steps=8000)
    before, fewest = found.asleep
    assert before == 12
    assert fewest < 6
    assert found.coupled.grains.sleep.count >= 12


@pytest.mark.parametrize("sinks", [False, True])
def test_sleepers_that_do_not_wake_are_out_of_balance(sinks):
    found = lab.disturbed(sinks, deaf=True)
    assert found.imbalance > 2 * tolerance("coupling.sleepers_under_water_are_in_balance")


def test_sleep_at_half_the_weight_stops_a_collapse_too_early():
    assert lab.off(0.5).error > tolerance("coupling.sleep_leaves_a_collapse_under_water")
