"""Seconds of a machine that does nothing else: those of the wall clock, with the load taken out.

Where others work on the same cores, a thread waits for one.  Linux counts both for every thread, the time that it was
on a core and the time that it waited for one (``schedstat`` in proc(5)); a span of time takes

    wall · on / (on + waited)

on a quiet machine: what the thread waits for besides (other threads, another process, the disk) is taken to have got
the same share.  Other systems do not say so; there the seconds are those of the wall clock.  That others make a core
slower (a clock that is throttled, hyperthreads, caches) is not taken out.
"""

import os
import time as clock
from pathlib import Path
from typing import NamedTuple

from porescale.common.compiled.turns import TURNS
from porescale.common.core.machine import cores

SCHEDSTAT = Path("/proc/thread-self/schedstat")
BUSY = 1.2
"""Times as long as alone, beyond which it is worth a word that others slow a run down."""


class Moment(NamedTuple):
    """Clocks of this thread, all in s.

    wall : of the wall clock;  on, waited : on a core, and waiting for one;  compiling : of kernels, and ``compiled``
    their number.
    """

    wall: float
    on: float
    waited: float
    compiling: float = 0.0
    compiled: int = 0


def moment() -> Moment:
    """Clock, seconds on a core and waiting, and what was compiled so far, now."""
    return Moment(clock.perf_counter(), *scheduled(), TURNS.seconds, TURNS.count)


def scheduled() -> tuple[float, float]:
    """Seconds that this thread was on a core so far and waited for one; (1, 0) where the system does not count them."""
    try:
        on, waited, *_ = SCHEDSTAT.read_text(encoding="ascii").split()
        return 1e-9 * int(on), 1e-9 * int(waited)
    except (OSError, ValueError):
        return 1.0, 0.0


def share(since: Moment, until: Moment) -> float:
    """Share of a core that this thread got of what it wanted, above 0 and at most 1."""
    on, waited = until.on - since.on, until.waited - since.waited
    return on / (on + waited) if on > 0.0 else 1.0


def quiet_seconds(since: Moment, until: Moment) -> float:
    """Seconds from one moment to another on a quiet machine, but for the compiling of kernels."""
    wall = until.wall - since.wall - (until.compiling - since.compiling)
    return max(wall, 0.0) * share(since, until)


def load_now() -> float:
    """How many times as long as on a quiet machine a run takes that begins now; 1 where the system does not say.

    It shares the cores with as many processes as wanted one in the last minute.
    """
    try:
        wanted = os.getloadavg()[0] + 1.0
    except (AttributeError, OSError):
        return 1.0
    return max(1.0, wanted / cores())
