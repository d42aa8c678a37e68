"""Rounds of kills until there are as many as asked for, or no time is left, and what they came to."""

import json
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


def kinds(said: Mapping[str, Any]) -> Counter[str]:
    """How many kills came in each phase, over all scenes."""
    return sum((Counter(one["kills"]) for one in said["scenes"].values()), Counter())


def report(said: Mapping[str, Any], goal: Goal) -> None:
    """One line on how far it is."""
    ends = sum(one["resumed to the same bits"] for one in said["scenes"].values())
    wrong = f", {len(said['wrong'])} WRONG" if said["wrong"] else ""
    print(f"{said['kills']} of {goal.kills} kills, {ends} runs ended{wrong}", file=sys.stderr, flush=True)
