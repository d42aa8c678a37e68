"""A few of the kills and stops that `python -m tests.reference.killing` makes by the thousand, others every day."""

from __future__ import annotations

import datetime
import os

import pytest

from tests.reference.killing import SCENES, Campaign

SEED = int(os.environ.get("PORESCALE_SEED", datetime.date.today().toordinal()))
"""Of the dice; it also chooses the scene."""
KILLS, STOPS = 8, 3


@pytest.mark.slow
def test_kills_in_any_phase_lose_nothing(tmp_path):
    name = list(SCENES)[SEED % len(SCENES)]
    campaign = Campaign(name, tmp_path, SEED)
    number = 0
    while sum(campaign.kills.values()) < KILLS:
        campaign.round(number)
        number += 1
    assert campaign.finals == number, f"seed {SEED}"


@pytest.mark.slow
def test_a_run_that_is_asked_to_stop_saves_its_state_at_once(tmp_path):
    campaign = Campaign(list(SCENES)[(SEED + 1) % len(SCENES)], tmp_path, SEED)
    found = [campaign.stop(number) for number in range(STOPS)]
    # The clock of a machine is not asked: how long a step and a save take beside others is anybody's guess.  What is
    # held is that the state is saved after it was asked for, and the run ends as one that was interrupted.
    assert all(it is None or it[2] <= it[3] for it in found)
    assert any(found)
