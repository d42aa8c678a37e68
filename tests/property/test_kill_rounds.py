"""Campaigns of kills stop in time, and count what they did and what goes wrong."""

import json
import time
from collections import Counter
from pathlib import Path

from tests.reference.faults.kill_rounds import Goal, kinds, rounds


class Kills:
    """A campaign that kills twice a round;  spoils : every round goes wrong."""

    def __init__(self, spoils: bool = False) -> None:
        self.kills: Counter[str] = Counter()
        self.finals, self.spoils = 0, spoils

    def round(self, number: int, most: int, cold: Path | None, until: float) -> None:
        """Kills, at most so many."""
        self.kills["cold: row" if cold else "row"] += min(most, 2)
        assert not self.spoils, "differs"
        self.finals += 1


def goal(kills: int, cold: int = 0, seconds: float = 1e9) -> Goal:
    """So many kills."""
    return Goal(kills, cold, time.monotonic(), seconds, 1)


def test_as_many_as_asked_for(tmp_path):
    said = rounds({"x": Kills(), "y": Kills()}, goal(9, 3), tmp_path)
    assert said["kills"] == 9
    assert kinds(said) == {"row": 6, "cold: row": 3}
    assert sum(one["resumed to the same bits"] for one in said["scenes"].values()) == 5


def test_without_time_it_says_that_nothing_was_done(tmp_path):
    said = rounds({"x": Kills()}, goal(9, seconds=-1.0), tmp_path)
    assert said["kills"] == 0
    assert json.loads((tmp_path / "kills.json").read_text()) == said


def test_what_goes_wrong_is_counted_and_ends_a_campaign_that_only_goes_wrong(tmp_path):
    said = rounds({"x": Kills(), "spoilt": Kills(spoils=True)}, goal(9), tmp_path)
    assert len(said["wrong"]) == 3  # of five rounds the first, third and fifth; the twin below has none
    assert said["kills"] == 9
    assert len(rounds({"spoilt": Kills(spoils=True)}, goal(1000), tmp_path)["wrong"]) == 10
    assert rounds({"x": Kills()}, goal(9), tmp_path)["wrong"] == []
