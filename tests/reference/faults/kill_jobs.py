"""Kills by several processes side by side, each in a folder of its own, and what they came to together."""

import json
import os
import sys
import time
import traceback
from collections import Counter
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from porescale.common.core.atomic import write_text

Tell = Callable[[dict[str, Any]], object]
LOOK = 5.0
"""Seconds between looks at what the processes have done."""
MOST_WRONG = 10
"""Rounds gone wrong after which there is nothing to be learnt from another."""
COLD_UNTIL = 0.6
"""Share of the time after which no cold round begins: its end compiles all that a run needs, minutes."""


@dataclass(frozen=True)
class Goal:
    """What is to be done: ``kills``, ``cold`` of them from nothing, within ``seconds`` from when it ``began`` (of the
    clock that only goes forward), by the dice of ``seed``."""

    kills: int
    cold: int
    began: float
    seconds: float
    seed: int

    def share(self, job: int, jobs: int) -> "Goal":
        """What process ``job`` of so many does of it."""
        one = [(total + job) // jobs for total in (self.kills, self.cold)]
        return Goal(one[0], one[1], self.began, self.seconds, self.seed + job)

    def over(self, share: float = 1.0) -> bool:
        """Whether this share of the time has passed."""
        return time.monotonic() > self.began + share * self.seconds


def rounds(all_of: Mapping[str, Any], goal: Goal, place: Path, tell: Tell = lambda said: None) -> dict[str, Any]:
    """Kill runs of the campaigns in turns until there are as many kills, or no time is left; what it came to.

    That is kept in kills.json after every round.  A round that goes wrong is said there, and its folder stays.
    """
    names, number, wrong = list(all_of), goal.seed, []
    until = goal.began + goal.seconds
    while True:
        done = {name: {"kills": dict(each.kills), "resumed to the same bits": each.finals}
                for name, each in all_of.items()}  # fmt: skip
        count = sum(sum(each.kills.values()) for each in all_of.values())
        said = {"seed": goal.seed, "kills": count, "scenes": done, "wrong": wrong}
        write_text(place / "kills.json", json.dumps(said, indent=1))
        tell(said)
        if count >= goal.kills or goal.over() or len(wrong) == MOST_WRONG:
            return said
        cold_so_far = sum(n for each in all_of.values() for k, n in each.kills.items() if k.startswith("cold"))
        is_cold = not goal.over(COLD_UNTIL) and cold_so_far < goal.cold * (count + 1) / goal.kills
        most = min(goal.kills - count, goal.cold - cold_so_far) if is_cold else goal.kills - count
        try:
            all_of[names[number % len(names)]].round(
                number, most, (place / "cold").resolve() if is_cold else None, until
            )
        except AssertionError as error:
            wrong.append(f"{names[number % len(names)]}, round {number}: {error}")
            traceback.print_exc()
        number += 1


def side_by_side(all_of: Mapping[str, Any], goal: Goal, place: Path, jobs: int, tell: Tell) -> dict[str, Any]:
    """The same by ``jobs`` processes forked from this one, each with its share of the goal and other dice.

    tell : is told what they came to so far, now and then
    """
    if jobs == 1:
        return rounds(all_of, goal, place, tell)
    folders = [place / f"job{job}" for job in range(jobs)]
    running = {}
    for job, folder in enumerate(folders):
        (folder / "kills.json").unlink(missing_ok=True)

        def work(job: int = job, folder: Path = folder) -> None:
            for name, each in all_of.items():
                each.apart(folder / name, goal.seed + job)
            rounds(all_of, goal.share(job, jobs), folder)

        running[forked(work)] = job
    lost = []
    while running:
        time.sleep(LOOK)
        for number in list(running):
            ended, status = os.waitpid(number, os.WNOHANG)
            if ended:
                job = running.pop(number)
                lost += [f"process {job} ended with {status}"] * bool(status)
        said = together(folders, goal.seed)
        said["wrong"] += lost
        write_text(place / "kills.json", json.dumps(said, indent=1))
        tell(said)
    return said


def forked(work: Callable[[], object]) -> int:
    """Number of a process forked from this one that does some work and ends, with 1 where that raised."""
    number = os.fork()
    if number == 0:
        code = 1
        try:
            work()
            code = 0
        except BaseException:
            traceback.print_exc()
        finally:
            os._exit(code)
    return number


def together(folders: list[Path], seed: int) -> dict[str, Any]:
    """The sum of what kills.json says in each of the ``folders`` in which there is one."""
    parts = [json.loads(file.read_text()) for folder in folders if (file := folder / "kills.json").exists()]
    scenes: dict[str, dict[str, Any]] = {}
    for part in parts:
        for name, one in part["scenes"].items():
            so_far = scenes.setdefault(name, {"kills": {}, "resumed to the same bits": 0})
            so_far["kills"] = dict(Counter(so_far["kills"]) + Counter(one["kills"]))
            so_far["resumed to the same bits"] += one["resumed to the same bits"]
    return {
        "seed": seed,
        "kills": sum(part["kills"] for part in parts),
        "scenes": scenes,
        "wrong": [text for part in parts for text in part["wrong"]],
    }


def kinds(said: Mapping[str, Any]) -> Counter[str]:
    """How many kills came in each phase, over all scenes."""
    return sum((Counter(one["kills"]) for one in said["scenes"].values()), Counter())


def report(said: Mapping[str, Any], goal: Goal) -> None:
    """One line on how far it is."""
    ends = sum(one["resumed to the same bits"] for one in said["scenes"].values())
    wrong = f", {len(said['wrong'])} WRONG" if said["wrong"] else ""
    print(f"{said['kills']} of {goal.kills} kills, {ends} runs ended{wrong}", file=sys.stderr, flush=True)
