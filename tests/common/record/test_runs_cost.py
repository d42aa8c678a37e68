"""What a run costs whoever waits: steps, their pace as it began, and what is besides."""

import time

import pytest

from porescale.common.record.cost import PACED, UNCOUNTED, Cost
from tests.reference.waiting import awaited


def counted(*blocks: tuple[int, float]) -> Cost:
    made = Cost()
    for block in [(1, 100.0)] * UNCOUNTED + list(blocks):
        made.block(*block)
    return made


def test_the_first_blocks_compile_and_are_left_out():
    cost = counted((10, 1.0), (10, 3.0))
    assert cost.of(40) == pytest.approx(40 * 4.0 / 20)
    assert counted().of(40) is counted().pace() is None


def test_the_pace_is_that_of_the_beginning():
    cost = counted((10, 0.9 * PACED), (10, 0.2 * PACED), (10, 50.0))
    assert cost.pace() == pytest.approx(1.1 * PACED / 20)


def test_what_is_besides_steps_goes_on_over_sessions(monkeypatch):
    spent = [100.0]
    monkeypatch.setattr(time, "process_time", lambda: spent[0])
    cost = Cost(began=100.0)
    spent[0] += 20.0
    cost.block(1, 5.0)  # of which so much was a step
    assert cost.besides() == 15.0
    later = Cost.restored(cost.state())
    older = Cost.restored({})  # of a version that did not count
    for one, earlier in ((later, 15.0), (older, 0.0)):
        one.began = 120.0
        assert one.besides() == earlier
    spent[0] += 1.0
    assert (later.besides(), older.besides()) == (16.0, 1.0)


def test_the_clock_is_that_of_the_cores_the_process_was_on():
    cost = Cost()
    assert awaited(lambda: cost.besides() > 0.0)
