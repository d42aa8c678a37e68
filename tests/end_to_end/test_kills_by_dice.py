"""A few of the kills and stops that `python -m tests.reference.killing` makes by the thousand, others every day."""

from __future__ import annotations

import datetime
import json
import os
import subprocess
import sys
from pathlib import Path

import pytest

from tests.reference.killing import SCENES

ROOT = Path(__file__).resolve().parents[2]
SEED = int(os.environ.get("PORESCALE_SEED", datetime.date.today().toordinal()))
"""Of the dice; it also chooses the scene."""


@pytest.mark.slow
def test_kills_and_stops_at_any_moment_lose_nothing(tmp_path):
    # In a process of its own: a process that has started threads must not fork.
    name = list(SCENES)[SEED % len(SCENES)]
    words = [name, "--kills", "6", "--stops", "2", "--seed", str(SEED), "--out", str(tmp_path)]
    command = [sys.executable, "-m", "tests.reference.killing", *words]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False)
    assert done.returncode == 0, f"seed {SEED}: {done.stderr[-2000:]}"
    made = json.loads((tmp_path / "kills.json").read_text())
    assert made["kills"] >= 6
    assert made["scenes"][name]["resumed to the same bits"] > 0
    assert len(json.loads((tmp_path / "stops.json").read_text())) == 2
