"""The validations of sleep hold, and would not if sleepers were deaf or fell asleep too early."""

import pytest

from porescale.validation.dem import sleep as lab
from tests.validation.tolerances import tolerance


def test_sleepers_that_do_not_wake_are_out_of_balance():
    assert lab.struck(deaf=True).imbalance > 10 * tolerance("dem.sleepers_are_in_balance")


@pytest.mark.slow
def test_sleep_at_half_the_weight_leaves_a_column_standing():
    # Out of balance by half of its weight a grain is on its way down a slope of 30 degrees.
    assert lab.off(0.5).error > tolerance("dem.sleep_leaves_the_run_out")
