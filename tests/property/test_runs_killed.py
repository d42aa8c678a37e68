"""Runs killed at every call to the disk, and at moments of the clock: files whole, and resumed to the same bits."""

import os
import sys
from pathlib import Path

import pytest

from tests.reference.folders import ROOT
from tests.reference.same_run import differences
from tests.reference.waiting import done

KILLS = int(os.environ.get("PORESCALE_KILLS", "100"))
"""At moments of the clock; those at calls to the disk come on top, two for each of some two hundred."""


def killed(place: Path, *words: object) -> int:
    """How many runs `killing_toy` killed in ``place``, all of which were whole and resumed to the same bits."""
    ran = done([sys.executable, "-m", "tests.reference.faults.killing_toy", place, *words], cwd=ROOT)
    assert ran.returncode == 0, ran.stderr
    return int(ran.stdout)


@pytest.mark.parametrize("when", ["before", "after"])
def test_a_kill_at_a_call_to_the_disk_loses_nothing(tmp_path, when):
    assert killed(tmp_path, "--when", when, "--first", 5, "--every", 61) >= 4


@pytest.mark.slow
@pytest.mark.parametrize("when", ["before", "after"])
def test_a_kill_at_no_call_to_the_disk_loses_anything(tmp_path, when):
    assert killed(tmp_path, "--when", when) > 200


@pytest.mark.slow
def test_kills_at_any_moment_lose_nothing(tmp_path):
    assert killed(tmp_path, "--kills", KILLS) >= KILLS


def test_the_comparison_sees_a_run_that_was_not_resumed(tmp_path):  # the twin that must fail
    assert killed(tmp_path, "--leave", "--first", 200) == 1
    with pytest.raises((AssertionError, KeyError, OSError)):
        assert differences(tmp_path / "run", tmp_path / "untouched") == []
