"""What unit tests share."""

from __future__ import annotations

from collections.abc import Iterator

import pytest


@pytest.fixture
def one_thread() -> Iterator[None]:
    """Kernels on one thread: in scenes of a few cells waiting for a second one is all that is done."""
    from porescale.ground.jit import set_threads, threads

    before = threads()
    set_threads(1)
    yield
    set_threads(before)
