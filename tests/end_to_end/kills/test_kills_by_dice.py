"""A few of the kills that `python -m tests.reference.faults.killing` makes by the thousand, others every day."""

import datetime
import json
import os
import sys
from pathlib import Path
from unittest.mock import patch

import pytest

from porescale.common.compiled import jit
from tests.reference.faults import killing
from tests.reference.faults.killing import COLD_PATIENCE, SCENES
from tests.reference.folders import ROOT
from tests.reference.waiting import done

SEED = int(os.environ.get("PORESCALE_SEED", datetime.date.today().toordinal()))
"""Of the dice; it also chooses the scene."""


def killed(place: Path, *words: object) -> dict:
    """What a campaign of kills counted.  In a process of its own: one that has started threads must not fork."""
    command = [sys.executable, "-m", "tests.reference.faults.killing", *words, "--seed", SEED, "--out", place]
    ended = done(command, 2 * COLD_PATIENCE, cwd=ROOT)  # a child that hangs is told of earlier
    assert ended.returncode == 0, f"seed {SEED}: {ended.stderr[-2000:]}"
    return json.loads((place / "kills.json").read_text())


def test_that_a_kernel_is_kept_is_seen(tmp_path):
    marks, phase = killing.Marks(tmp_path / "marks"), killing.PHASES.index("keeping a kernel")
    for where, name, doing in killing.hooks():
        if doing == "keeping a kernel":
            with patch.object(where, name, killing.marked(marks, doing, getattr(where, name))):
                vars(jit.compiler())["_Files"](str(tmp_path), "", "").save("a", 1)
    assert marks.begun(phase) == 1
    assert [file.name for file in tmp_path.glob("*.nbc")] == ["a.nbc"]  # what a cold campaign throws away


@pytest.mark.slow
def test_kills_and_stops_at_any_moment_lose_nothing(tmp_path):
    name = list(SCENES)[SEED % len(SCENES)]
    made = killed(tmp_path, name, "--kills", 6, "--stops", 2)
    assert made["kills"] == 6
    assert made["wrong"] == []
    assert made["scenes"][name]["resumed to the same bits"] > 0
    assert len(json.loads((tmp_path / "stops.json").read_text())) == 2


@pytest.mark.slow
def test_kills_while_kernels_are_compiled_and_kept_lose_nothing(tmp_path):
    # The scene with the fewest kernels: a run from nothing takes as long as they take to compile.
    made = killed(tmp_path, "tank", "--kills", 4, "--cold", 4)["scenes"]["tank"]
    assert sum(count for doing, count in made["kills"].items() if doing.startswith("cold: ")) >= 4
    assert made["resumed to the same bits"] > 0
