"""Runs of the toy killed at calls to the disk or at moments of the clock: python -m tests.reference.faults.killing_toy
PLACE.

The children are forked.  That is done from a process without threads, which is this one: of a process with threads only
the forking one goes on in the child, which then waits for ever for a lock that another held.
"""

import argparse
import faulthandler
import os
import random
import signal
import sys
import threading
import time
from pathlib import Path

from tests.reference.faults.failing_disk import Disk, calls, failing, whole
from tests.reference.same_run import differences
from tests.reference.toy_model import Toy, run_toy
from tests.reference.waiting import ended

SHORT = {"duration": 0.04, "checkpoint_seconds": 0.0}


def child(folder: Path, disk: Disk, toy: Toy | None = None) -> int:
    """A process that runs a toy in ``folder``, resuming if it can; its number."""
    assert threading.active_count() == 1
    process = os.fork()
    if process == 0:
        try:
            faulthandler.enable()
            with failing(disk):
                run_toy(folder, **SHORT, model=toy or Toy(), resume=(folder / "card.json").exists())
        finally:
            os._exit(0)
    return process


def ended_by_kill(process: int) -> bool:
    """Wait for a process; whether SIGKILL ended it."""
    return ended(process) == -signal.SIGKILL


def resumes_as(folder: Path, untouched: Path, varying: bool = False) -> None:
    """AssertionError unless the run of ``folder``, resumed, ends as the one of ``untouched``."""
    run_toy(folder, **SHORT, model=Toy(varying=varying), resume=(folder / "card.json").exists())
    assert differences(folder, untouched) == []
    assert not list(folder.rglob(".*writing*"))


def at_calls(place: Path, untouched: Path, when: str, first: int, every: int) -> int:
    """Kill runs "before" or "after" their call number ``first`` (from 0), and every ``every``-th later; how many."""
    total = calls(place / "count", lambda folder: run_toy(folder, **SHORT))
    numbers = range(first, total, every)
    for nth in numbers:
        folder = place / f"run{nth}"
        assert ended_by_kill(child(folder, Disk(folder, nth, kill=when)))
        whole(folder)
        resumes_as(folder, untouched)
    return len(numbers)


def at_moments(place: Path, untouched: Path, kills: int) -> int:
    """Kill runs ``kills`` times or a few more, at moments of the clock, every other one of varying steps; how often."""
    dice = random.Random(1)
    run_toy(varied := place / "varied", **SHORT, model=Toy(varying=True))
    made = number = 0
    while made < kills:
        folder, varying = place / f"run{number}", number % 2 == 1
        for _ in range(dice.randrange(1, 6)):  # again and again in one folder: while it resumes, too
            process = child(folder, Disk(folder), Toy(pause=5e-4, varying=varying))
            time.sleep(dice.uniform(0.0, 0.12))
            os.kill(process, signal.SIGKILL)
            made += ended_by_kill(process)
            whole(folder)
        resumes_as(folder, varied if varying else untouched, varying)
        number += 1
    return made


def main() -> int:
    """The command; prints how many runs were killed."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("place", type=Path)
    parser.add_argument("--when", choices=["before", "after"], help="at calls to the disk")
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--every", type=int, default=1)
    parser.add_argument("--kills", type=int, default=100, help="at moments of the clock")
    parser.add_argument("--leave", action="store_true", help="kill one run and do not resume it")
    options = parser.parse_args()
    untouched = options.place / "untouched"
    run_toy(untouched, **SHORT)
    if options.leave:
        folder = options.place / "run"
        print(int(ended_by_kill(child(folder, Disk(folder, options.first, kill="before")))))
    elif options.when:
        print(at_calls(options.place, untouched, options.when, options.first, options.every))
    else:
        print(at_moments(options.place, untouched, options.kills))
    return 0


if __name__ == "__main__":
    sys.exit(main())
