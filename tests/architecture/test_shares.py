"""Every slow test has its day, and neighbours have the same one."""

from itertools import chain
from pathlib import Path
from types import SimpleNamespace
from typing import Any

from tests.shares import TOGETHER, long_first, share


def made(**counts: int) -> list[Any]:
    """So many tests of each file."""
    return [
        SimpleNamespace(path=Path(path), place=place, get_closest_marker=lambda _, path=path: path.startswith("slow"))
        for path, count in counts.items() for place in range(count)
    ]  # fmt: skip


SLOW = made(few=2, many=148, some=23, one=1)


def shares(parts: int) -> list[list[Any]]:
    return [share(SLOW, part, parts) for part in range(parts)]


def test_each_slow_test_is_in_one_share() -> None:
    for parts in (1, 3, 20, 200):
        places = [(it.path, it.place) for it in chain(*shares(parts))]
        assert len(places) == len(set(places)) == len(SLOW)
    assert [(it.path, it.place) for it in share(SLOW, 0, 1)] == [(it.path, it.place) for it in SLOW]


def test_a_share_that_is_left_out_is_missed() -> None:  # the check that must fail
    assert sum(map(len, shares(20)[1:])) < len(SLOW)


def test_shares_are_handfuls_of_neighbours() -> None:
    items = made(many=12 * TOGETHER, some=8 * TOGETHER)
    for part in range(20):
        places = [(it.path.name, it.place) for it in share(items, part, 20)]
        start = part * TOGETHER if part < 12 else (part - 12) * TOGETHER
        assert places == [("many" if part < 12 else "some", start + k) for k in range(TOGETHER)]


def test_long_files_come_first_and_stay_whole() -> None:
    items = made(**{"quick": 3, "slow_few": 2, "quick_many": 9, "end_to_end/run": 3, "slow_many": 4})
    long_first(items)
    found = ["slow_many", "end_to_end/run", "slow_few", "quick_many", "quick"]
    assert list(dict.fromkeys(it.path.as_posix() for it in items)) == found
    assert [it.place for it in items] == [*range(4), *range(3), *range(2), *range(9), *range(3)]
