"""What a step allocates, measured."""

import tracemalloc
from collections.abc import Iterator
from contextlib import contextmanager


@contextmanager
def traced() -> Iterator[None]:
    """Within it tracemalloc traces; numpy reports its arrays to it."""
    tracemalloc.start()
    try:
        yield
    finally:
        tracemalloc.stop()


def peak(step) -> int:
    """Most bytes held at once of what ``step()`` allocates."""
    with traced():
        step()
        return tracemalloc.get_traced_memory()[1]


def growth(step, steps=50):
    """Most bytes by which memory grew within one of ``steps`` steps."""
    for _ in range(4):
        step()
    with traced():
        return max(grown(step) for _ in range(steps))


def grown(step) -> int:
    """Bytes by which memory grew at most within ``step()``; only where it is `traced`."""
    tracemalloc.reset_peak()
    before = tracemalloc.get_traced_memory()[0]
    step()
    return tracemalloc.get_traced_memory()[1] - before
