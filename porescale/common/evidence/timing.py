"""Timing on machines that others use too: repeats, medians, and what is compared measured in turns."""

import statistics
import time
from collections.abc import Callable
from dataclasses import dataclass


@dataclass(frozen=True)
class Timing:
    """rate : updates per second (median);  seconds : median of one call;  calls : repeats behind it."""

    rate: float
    seconds: float
    calls: int


@dataclass(frozen=True)
class Comparison:
    """a, b : median seconds of a call;  ratio : median over the rounds of b's time over a's."""

    a: float
    b: float
    ratio: float


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


def rate(call: Callable[[], object], updates_per_call: float, min_seconds: float = 1.0) -> Timing:
    """Updates per second: median of the calls that fill ``min_seconds``, at least five, after one to warm up."""
    call()
    spent: list[float] = []
    total = 0.0
    while len(spent) < 5 or total < min_seconds:
        spent.append(seconds_of(call))
        total += spent[-1]
    median = statistics.median(spent)
    return Timing(updates_per_call / median, median, len(spent))


def interleaved(a: Callable[[], object], b: Callable[[], object], rounds: int = 7) -> Comparison:
    """Time ``a`` and ``b`` in turns (each goes first every other round), after one call each to warm up.

    Drifts of the machine then touch both alike; the ratio is formed round by round.
    """
    assert rounds > 0
    a()
    b()
    pairs: list[tuple[float, float]] = []
    for turn in range(rounds):
        if turn % 2:
            second = seconds_of(b)
            pairs.append((seconds_of(a), second))
        else:
            first = seconds_of(a)
            pairs.append((first, seconds_of(b)))
    return Comparison(
        statistics.median(first for first, _ in pairs),
        statistics.median(second for _, second in pairs),
        statistics.median(second / first for first, second in pairs),
    )
