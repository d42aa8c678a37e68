"""Runs killed at every call to the disk, and at moments of the clock: files whole, and resumed to the same bits."""

from __future__ import annotations

import os
import random
import signal
import time
from pathlib import Path

import pytest

from tests.reference.failing_disk import Disk, calls, failing, whole
from tests.reference.same_run import differences
from tests.reference.toy_model import Toy, run_toy

KILLS = int(os.environ.get("PORESCALE_KILLS", "100"))
"""At moments of the clock; those at calls to the disk come on top, two for each of some two hundred."""
SHORT = {"duration": 0.04, "checkpoint_seconds": 0.0}


@pytest.fixture(scope="module")
def untouched(tmp_path_factory) -> Path:
    folder = tmp_path_factory.mktemp("killed") / "untouched"
    run_toy(folder, **SHORT)
    return folder


def child(folder: Path, disk: Disk, pause: float = 0.0) -> int:
    """A process that runs the toy in ``folder``, resuming if it can; its number."""
    process = os.fork()
    if process == 0:
        try:
            with failing(disk):
                run_toy(folder, **SHORT, model=Toy(pause=pause), resume=(folder / "card.json").exists())
        finally:
            os._exit(0)
    return process


def ended_by_kill(process: int) -> bool:
    """Wait for a process; whether SIGKILL ended it."""
    return os.waitstatus_to_exitcode(os.waitpid(process, 0)[1]) == -signal.SIGKILL


def resumes_as(folder: Path, untouched: Path) -> None:
    run_toy(folder, **SHORT, resume=(folder / "card.json").exists())
    assert differences(folder, untouched) == []
    assert not list(folder.rglob(".*writing*"))


def killed_at(nth: int, when: str, folder: Path, untouched: Path) -> None:
    assert ended_by_kill(child(folder, Disk(folder, nth, kill=when)))
    whole(folder)
    resumes_as(folder, untouched)


@pytest.mark.parametrize("when", ["before", "after"])
def test_a_kill_at_a_call_to_the_disk_loses_nothing(tmp_path, untouched, when):
    for nth in range(5, calls(tmp_path / "count", lambda folder: run_toy(folder, **SHORT)), 61):
        killed_at(nth, when, tmp_path / f"run{nth}", untouched)


@pytest.mark.slow
@pytest.mark.parametrize("when", ["before", "after"])
def test_a_kill_at_no_call_to_the_disk_loses_anything(tmp_path, untouched, when):
    total = calls(tmp_path / "count", lambda folder: run_toy(folder, **SHORT))
    assert total > 200
    for nth in range(total):
        killed_at(nth, when, tmp_path / f"run{nth}", untouched)


@pytest.mark.slow
def test_kills_at_any_moment_lose_nothing(tmp_path, untouched):
    dice = random.Random(1)
    kills = number = 0
    while kills < KILLS:
        folder = tmp_path / f"run{number}"
        for _ in range(dice.randrange(1, 6)):  # again and again in one folder: while it resumes, too
            process = child(folder, Disk(folder), pause=5e-4)
            time.sleep(dice.uniform(0.0, 0.12))
            os.kill(process, signal.SIGKILL)
            kills += ended_by_kill(process)
            whole(folder)
        resumes_as(folder, untouched)
        number += 1


def test_the_comparison_sees_a_run_that_was_not_resumed(tmp_path, untouched):  # the twin that must fail
    assert ended_by_kill(child(tmp_path / "run", Disk(tmp_path / "run", 200, kill="before")))
    with pytest.raises((AssertionError, KeyError, OSError)):
        assert differences(tmp_path / "run", untouched) == []
