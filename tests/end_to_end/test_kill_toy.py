"""A run killed at any moment resumes, and ends bit for bit as the run that nobody touched."""

from __future__ import annotations

import os
import random
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest

from porescale.runs.checkpoint import read_checkpoint
from porescale.runs.open_run import open_run
from tests.reference.same_run import contents
from tests.reference.toy_model import run_toy

ROOT = Path(__file__).resolve().parents[2]


def toy(folder: Path, *options: str) -> subprocess.Popen[bytes]:
    """The toy as a process of its own."""
    words = [sys.executable, "-m", "tests.reference.toy_model", str(folder), *options]
    return subprocess.Popen(words, cwd=ROOT, stderr=subprocess.PIPE)


def kill_in_the_middle(process: subprocess.Popen[bytes], folder: Path, delay: float) -> None:
    """SIGKILL ``delay`` seconds after the run has got further (importing takes most of the time)."""
    series = folder / "series.csv"
    size = series.stat().st_size if series.exists() else 0
    while process.poll() is None:
        moved = series.exists() and series.stat().st_size > size
        if moved and (any(folder.glob("parts/0*")) or any(folder.glob("*.vtkhdf"))):
            break
        time.sleep(0.002)
    time.sleep(delay)
    if process.poll() is None:
        os.kill(process.pid, signal.SIGKILL)
    process.communicate()


def assert_same(one: Path, other: Path) -> None:
    for name in ("series.csv", "beads.csv"):
        assert (one / name).read_bytes() == (other / name).read_bytes()
    first, second = (read_checkpoint(folder / "checkpoint.h5") for folder in (one, other))
    assert first["state"]["random"] == second["state"]["random"]
    for key in ("x", "v"):
        assert first["state"]["beads"][key].tobytes() == second["state"]["beads"][key].tobytes()
    assert first["state"]["field"].tobytes() == second["state"]["field"].tobytes()
    assert first["record"] == second["record"]
    for name in ("fields", "grains"):
        assert contents(one / f"{name}.vtkhdf") == contents(other / f"{name}.vtkhdf")


@pytest.mark.parametrize("varying", [False, True])
def test_a_run_killed_again_and_again_ends_as_the_untouched_one(tmp_path, varying):
    options = ("--varying",) if varying else ()
    untouched, killed = tmp_path / "untouched", tmp_path / "killed"
    process = toy(untouched, *options)
    _, said = process.communicate()
    assert process.returncode == 0, said.decode()
    dice = random.Random(varying)
    ends = []
    for number in range(2):
        resume = ("--resume",) if number else ()
        process = toy(killed, "--pause", "0.002", *resume, *options)
        kill_in_the_middle(process, killed, dice.uniform(0.0, 0.15))
        ends.append(process.returncode)
        run = open_run(killed)
        assert len(run) >= 1
        for snapshot in run.snapshots():
            assert np.isfinite(snapshot.grids["fields"].cells["velocity"]).all()
    assert -signal.SIGKILL in ends
    last = toy(killed, "--resume", *options)
    _, said = last.communicate()
    assert last.returncode == 0, said.decode()
    assert_same(untouched, killed)
    assert not (killed / "parts").exists()
    assert not list(killed.glob(".*writing*"))


def test_a_polite_stop_saves_and_says_so(tmp_path):
    untouched, stopped = tmp_path / "untouched", tmp_path / "stopped"
    run_toy(untouched, duration=0.2)
    process = toy(stopped, "--pause", "0.002")
    while not ((stopped / "series.csv").exists() and (stopped / "series.csv").stat().st_size):
        time.sleep(0.005)
    process.send_signal(signal.SIGINT)
    _, said = process.communicate()
    assert process.returncode == 130
    assert b"resume to continue" in said
    assert len(said.strip().splitlines()) == 1
    assert open_run(stopped).card["outcome"] == "interrupted"
    run_toy(stopped, duration=0.2, resume=True)
    assert_same(untouched, stopped)


def test_another_history_is_told_apart(tmp_path):
    # The twin that must fail: the comparison above sees a run that differs in one bit of one bead.
    from tests.reference.toy_model import Toy

    run_toy(tmp_path / "one")
    model = Toy()
    model.x[0, 0] = np.nextafter(model.x[0, 0], 1)
    run_toy(tmp_path / "other", model=model)
    with pytest.raises(AssertionError):
        assert_same(tmp_path / "one", tmp_path / "other")
