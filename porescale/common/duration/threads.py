"""As many threads as pay: a run takes fewer than it may have while fewer are faster.

Steps of a small scene are loops of tenths of a millisecond, at the end of each of which all threads wait for the last.
Where another program has one of the cores that one is late by a turn of the system, milliseconds: the main job with two
threads did 0.7 of the steps that it did with one (measured beside one endless loop).  On a quiet machine two are
faster.  So it is measured, again and again, on the run's own steps: results do not depend on the number of threads, in
any bit.

A number is timed, then half as many, one or twice as many in turns, then the first again, so that a machine that gets
busier or quieter on the way changes nothing.  Where nothing was faster the next is tried after twice the time.
"""

import time as clock
from collections.abc import Callable
from typing import TYPE_CHECKING

from porescale.common.compiled import jit
from porescale.common.compiled.turns import TURNS

if TYPE_CHECKING:
    from porescale.common.record.model import Model

WINDOW = 0.2
"""Seconds of steps for which a number of threads is timed: some turns of a busy system, of 4 to 100 ms."""
SOON, LATE = 0.5, 30.0
"""Seconds of steps between trials, at first and at most: a trial that takes twice as long costs a hundredth then."""
GAIN = 1.05
"""Times as fast, beyond which another number is taken: what rates of the same number scatter by."""


class Threads:
    """Context in which kernels have as many threads as are fastest, at most as many as now; afterwards as many as now.

    It can be entered again, for the next piece of a run, and goes on with what it has measured.
    most : threads (default: as many as now);  take : sets their number.
    """

    def __init__(self, most: int | None = None, take: Callable[[int], object] = jit.set_threads) -> None:
        self.most = jit.threads() if most is None else most
        self.take = take
        self.counts = [*(1 << k for k in range(self.most.bit_length()) if 1 << k < self.most), self.most]
        self.at, self.other, self.turn = len(self.counts) - 1, 0, 0
        self.wait, self.trials, self.slower = SOON, 0, set[int]()
        self.steps, self.seconds = 0, 0.0
        self.rates: list[float] | None = None  # of the number taken, of the other one, of the first again

    def __enter__(self) -> "Threads":
        self.take(self.counts[self._now()])
        return self

    def __exit__(self, *_: object) -> None:
        self.take(self.most)

    @property
    def count(self) -> int:
        """Threads that were found to be fastest so far."""
        return self.counts[self.at]

    @property
    def settled(self) -> bool:
        """Whether all that are tried beside that number were slower the last time."""
        return not self._beside() - self.slower

    def _beside(self) -> set[int]:
        """Which numbers are tried beside that taken: half of it, one, twice as many."""
        return {self.at - 1, 0, self.at + 1} & set(range(len(self.counts))) - {self.at}

    def advance(self, model: "Model", steps: int) -> float:
        """Advance a model, and count it unless kernels were compiled; returns seconds of the wall clock."""
        began, before, compiled = clock.perf_counter(), model.step, TURNS.seconds
        model.advance(steps)
        took = clock.perf_counter() - began
        if TURNS.seconds == compiled:
            self.spent(model.step - before, took)
        return took

    def spent(self, steps: int, seconds: float) -> None:
        """Count ``steps`` that took so many ``seconds``; now and then take another number."""
        if len(self.counts) == 1:
            return
        self.steps, self.seconds = self.steps + steps, self.seconds + seconds
        if self.seconds < (self.wait if self.rates is None else WINDOW):
            return
        if self.rates is None:
            self.rates, self.other = [], self._next()
        else:
            self.rates.append(self.steps / self.seconds)
        self.steps, self.seconds = 0, 0.0
        if len(self.rates) == 3:
            self._judge(*self.rates)
            self.rates = None
        else:
            self.take(self.counts[self._now()])

    def _now(self) -> int:
        """Which number is timed now: in the middle of a trial the other one."""
        return self.other if self.rates is not None and len(self.rates) == 1 else self.at

    def _next(self) -> int:
        """Which number is tried now: half of that taken, one, twice as many, and so on."""
        while True:
            found = (self.at - 1, 0, self.at + 1)[self.turn % 3]
            if found in self._beside():
                return found
            self.turn += 1

    def _judge(self, before: float, other: float, after: float) -> None:
        """Take the other number if its rate, steps a second, was higher than those before and after."""
        self.trials += 1
        if other <= GAIN * max(before, after):
            self.turn, self.wait = self.turn + 1, min(2.0 * self.wait, LATE)
            self.slower.add(self.other)
        else:
            self.at, self.wait, self.slower = self.other, SOON, set()
            self.take(self.count)
