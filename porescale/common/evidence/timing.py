"""Timing on machines that others use too: repeats, medians, and what is compared measured in turns."""

import statistics
import time
from collections.abc import Callable


def seconds_of(call: Callable[[], object]) -> float:
    """Wall-clock seconds of one call."""
    start = time.perf_counter()
    call()
    return time.perf_counter() - start


def core_seconds_of(call: Callable[[], object]) -> float:
    """Seconds of one call on the core of this thread; they stand still while others have it."""
    start = time.thread_time()
    call()
    return time.thread_time() - start


def repeated(measure: Callable[[], float], min_seconds: float = 1.0) -> list[float]:
    """Seconds of calls, as ``measure`` gives them, that fill ``min_seconds`` together; at least five."""
    spent: list[float] = []
    total = 0.0
    while len(spent) < 5 or total < min_seconds:
        spent.append(measure())
        total += spent[-1]
    return spent


def interleaved(a: Callable[[], object], b: Callable[[], object], rounds: int = 7) -> float:
    """The time of ``b`` over that of ``a``, both timed in turns (each goes first every other round) after one call each
    to warm up: the median over the rounds.

    Drifts of the machine then touch both alike; the ratio is formed round by round.
    """
    assert rounds > 0
    a()
    b()
    ratios: list[float] = []
    for turn in range(rounds):
        first, second = (b, a) if turn % 2 else (a, b)
        one, two = seconds_of(first), seconds_of(second)
        ratios.append(one / two if turn % 2 else two / one)
    return statistics.median(ratios)
