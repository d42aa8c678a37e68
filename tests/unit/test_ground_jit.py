"""Threads of the kernels: as many as asked for, or a refusal."""

from __future__ import annotations

import pytest

from porescale.ground.check import InputError
from porescale.ground.jit import set_threads, threads


@pytest.mark.usefixtures("one_thread")
def test_threads_are_those_asked_for_or_refused_with_the_range():
    most = set_threads(None)
    assert threads() == most >= 2  # tests/conftest.py
    for count in (1, most):
        assert set_threads(count) == threads() == count
    for count in (0, -1, most + 1, 5000):
        with pytest.raises(InputError, match=rf"--threads = {count}: is out of range \(allowed: 1 to {most}\)"):
            set_threads(count)
        assert threads() == most  # nothing was set
