"""A run takes as many threads as are fastest, on machines that are made up."""

from collections.abc import Callable

import pytest

from porescale.common.compiled import jit
from porescale.common.compiled.turns import TURNS
from porescale.common.duration.threads import LATE, SOON, WINDOW, Threads
from tests.reference.toy_model import Toy

STEP = 0.001
"""Seconds of a step with one thread."""


class Machine:
    """Steps as many threads as it is told, at a speed by their number and the time."""

    def __init__(self, most: int, speed: Callable[[int, float], float]) -> None:
        self.speed, self.time, self.taken, self.of = speed, 0.0, most, dict[int, float]()
        self.threads = Threads(most, self.take)

    def take(self, count: int) -> None:
        self.taken = count

    def run(self, seconds: float) -> "Machine":
        """Steps for so long; seconds with each number are counted anew."""
        until, self.of = self.time + seconds, {}
        while self.time < until:
            took = STEP / self.speed(self.taken, self.time)
            self.time += took
            self.of[self.taken] = self.of.get(self.taken, 0.0) + took
            self.threads.spent(1, took)
        return self


def quiet(count: int, _: float) -> float:
    return count**0.8


def busy(count: int, _: float) -> float:
    return 1.0 if count == 1 else 0.3


def small(count: int, _: float) -> float:
    """Four are best: beyond, threads wait for each other."""
    return {1: 1.0, 2: 1.8, 4: 2.6, 8: 2.0, 12: 1.2}[count]


@pytest.mark.parametrize(("most", "speed", "best"), [
    (2, quiet, 2), (2, busy, 1), (12, small, 4), (12, quiet, 12), (12, busy, 1), (1, quiet, 1),
])  # fmt: skip
def test_the_fastest_number_is_found_and_kept(most, speed, best):
    machine = Machine(most, speed).run(20.0)
    assert machine.threads.count == best
    machine.run(300.0)
    # Two windows of three have the best one; trials follow each other after LATE seconds.
    assert machine.of[best] > (1 - 1.5 * WINDOW / LATE) * 300.0
    assert machine.threads.settled


def test_a_number_is_settled_once_all_others_have_been_tried_beside_it():
    machine = Machine(12, lambda count, _: 2.0 if count == 1 else 1.0)  # half as many are no faster, one is
    while not machine.threads.settled:
        machine.run(STEP)
    assert machine.threads.count == 1
    assert machine.threads.trials == 3  # eight and one beside twelve, two beside one


def test_two_threads_on_a_busy_machine_last_a_second():
    machine = Machine(2, busy).run(20.0)
    # SOON and two windows, before and after the one that shows one to be faster; then a window of each trial, which end
    # by 2 s and after waits of 1, 2, 4 and 8 s more with three windows each: five within 20 s; a step too long each.
    assert machine.of[2] <= SOON + 2 * WINDOW + 5 * WINDOW + 10 * STEP / 0.3
    assert machine.threads.trials >= 3


def test_a_machine_that_gets_busy_and_quiet_again_is_followed():
    machine = Machine(2, lambda count, now: (busy if 100.0 < now < 300.0 else quiet)(count, now))
    assert machine.run(100.0).threads.count == 2
    assert machine.run(100.0).threads.count == 1
    assert machine.run(100.0).threads.count == 1
    assert machine.run(2 * LATE).threads.count == 2  # a trial comes LATE seconds after the last


def test_a_machine_that_only_gets_quieter_changes_nothing():
    machine = Machine(2, lambda _, now: 1.0 + 0.05 * now).run(60.0)
    assert machine.threads.count == 2


def test_steps_that_compile_are_not_counted(monkeypatch):
    told, threads = [], Threads(2)
    monkeypatch.setattr(threads, "spent", lambda steps, seconds: told.append((steps, seconds)))
    model = Toy()
    compiling = model.advance

    def compiled(steps: int) -> None:
        compiling(steps)
        TURNS.seconds += 1.0

    monkeypatch.setattr(TURNS, "seconds", TURNS.seconds)
    assert threads.advance(model, 3) > 0.0
    monkeypatch.setattr(model, "advance", compiled)
    threads.advance(model, 5)
    assert [steps for steps, _ in told] == [3]
    assert model.step == 8


def test_afterwards_kernels_have_what_they_had():
    before = jit.threads()
    with Threads() as threads:
        threads.take(1)
    assert jit.threads() == before


def test_pieces_of_a_run_go_on_with_what_is_measured():
    machine = Machine(2, busy)
    for _ in range(100):  # each shorter than what is timed
        with machine.threads:
            machine.run(0.02)
        assert machine.taken == 2
    with machine.threads:
        assert machine.taken == 1
