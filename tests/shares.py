"""Which of the slow tests run on a day, and which files the workers of pytest-xdist begin with."""

from collections import Counter
from collections.abc import Iterable
from pathlib import Path

import pytest

TOGETHER = 5
"""Slow tests of a file that are in one share: neighbours need the same kernels and fixtures."""


def share(tests: Iterable[pytest.Item], part: int, parts: int) -> list[pytest.Item]:
    """Every ``parts``-th handful of tests, from the ``part``-th."""
    handfuls: dict[tuple[Path, int], list[pytest.Item]] = {}
    places = Counter[Path]()
    for item in tests:
        handfuls.setdefault((item.path, places[item.path] // TOGETHER), []).append(item)
        places[item.path] += 1
    return [item for handful in list(handfuls.values())[part::parts] for item in handful]


LONG = {"end_to_end", "manual", "validation"}
"""Folders whose tests run whole programs and experiments."""


def long_first(items: list[pytest.Item]) -> None:
    """Files with slow tests or in LONG, then others, of each those with many tests first.

    No worker then begins with a long file when the other is about to end.
    """
    tests = Counter(item.path for item in items)
    first = {item.path for item in items if item.get_closest_marker("slow") or LONG & set(item.path.parts)}
    items.sort(key=lambda item: (item.path not in first, -tests[item.path]))
