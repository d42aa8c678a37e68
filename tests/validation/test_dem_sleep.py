"""The validations of sleep hold, and would not if sleepers were deaf or fell asleep too early."""

import pytest

from porescale.validation.dem import sleep as lab
from porescale.validation.dem import sleep as verify_sleep
from porescale.validation.dem.sleep import VALIDATIONS


def test_sleepers_that_do_not_wake_are_out_of_balance():
    assert lab.struck(deaf=True).imbalance > 10 * VALIDATIONS["dem.sleepers_are_in_balance"].tolerance


@pytest.mark.slow
def test_sleep_at_half_the_weight_leaves_a_column_standing():
    # Out of balance by half of its weight a grain is on its way down a slope of 30 degrees.
    assert verify_sleep.off(0.5).error > VALIDATIONS["dem.sleep_leaves_the_run_out"].tolerance
