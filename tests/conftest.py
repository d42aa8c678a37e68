"""Options of the test suite: slow tests are left out unless asked for, and can be run in shares."""

from __future__ import annotations

import os

import pytest
from hypothesis import settings

# The same examples on every machine, however slow: a failure can be repeated, and a kernel may be compiled within one.
settings.register_profile("steady", deadline=None, derandomize=True)
settings.load_profile("steady")

# Tests compare one thread with two, on machines with one core too; read by numba when it is first imported.
os.environ.setdefault("NUMBA_NUM_THREADS", str(max(2, os.cpu_count() or 1)))


def pytest_addoption(parser: pytest.Parser) -> None:
    parser.addoption("--share", default="0/1", help="run every n-th of the chosen tests, from the k-th: k/n")


def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    if not config.option.markexpr:
        deselected = [item for item in items if item.get_closest_marker("slow")]
        items[:] = [item for item in items if not item.get_closest_marker("slow")]
        config.hook.pytest_deselected(items=deselected)
    part, parts = map(int, config.getoption("--share").split("/"))
    if parts > 1:
        config.hook.pytest_deselected(items=[item for k, item in enumerate(items) if k % parts != part])
        items[:] = items[part::parts]
