"""A run killed at any moment resumes, and ends bit for bit as the run that nobody touched."""

import random
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest

from porescale.common.record.checkpoint import read_checkpoint
from porescale.common.record.open_run import open_run
from tests.reference.folders import ROOT
from tests.reference.same_run import contents
from tests.reference.toy_model import run_toy
from tests.reference.waiting import done, kill, running, talked, until


def words(folder: Path, *options: str) -> list[str]:
    """The toy's command line, as a process of its own."""
    return [sys.executable, "-m", "tests.reference.toy_model", str(folder), *options]


def size(series: Path) -> int:
    return series.stat().st_size if series.exists() else 0


def killed_in_the_middle(folder: Path, delay: float, *options: str) -> int:
    """Exit code of a run killed ``delay`` seconds after it has got further (importing takes most of the time)."""
    series = folder / "series.csv"
    before = size(series)

    def moved() -> bool:
        return size(series) > before and (any(folder.glob("parts/0*")) or any(folder.glob("*.vtkhdf")))

    with running(words(folder, *options), cwd=ROOT) as process:
        assert until(process, moved)
        time.sleep(delay)
        kill(process)
        talked(process)
        return process.returncode


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
    first = done(words(untouched, *options), cwd=ROOT)
    assert first.returncode == 0, first.stderr
    dice = random.Random(varying)
    ends = []
    for number in range(2):
        resume = ("--resume",) if number else ()
        hold = ("--hold", str(120 + 60 * number))  # of 200 steps: however late the kill comes, there is a run to kill
        delay = dice.uniform(0.0, 0.15)
        ends.append(killed_in_the_middle(killed, delay, "--pause", "0.002", *hold, *resume, *options))
        run = open_run(killed)
        assert len(run) >= 1
        for snapshot in run.snapshots():
            assert np.isfinite(snapshot.grids["fields"].cells["velocity"]).all()
    assert ends == [-signal.SIGKILL] * 2
    last = done(words(killed, "--resume", *options), cwd=ROOT)
    assert last.returncode == 0, last.stderr
    assert_same(untouched, killed)
    assert not (killed / "parts").exists()
    assert not list(killed.glob(".*writing*"))


def test_a_polite_stop_saves_and_says_so(tmp_path):
    untouched, stopped = tmp_path / "untouched", tmp_path / "stopped"
    run_toy(untouched, duration=0.2)
    slow = ("--pause", "0.1")  # 20 s for all steps: it still runs when the signal comes
    with running(words(stopped, *slow), cwd=ROOT, stderr=subprocess.PIPE) as process:
        assert until(process, lambda: size(stopped / "series.csv"))
        process.send_signal(signal.SIGINT)
        _, said = talked(process)
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
