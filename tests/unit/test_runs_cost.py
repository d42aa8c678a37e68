"""What a run costs whoever waits: steps, their pace as it began, and what is besides."""

from __future__ import annotations

import time

import pytest

from porescale.common.record.cost import PACED, UNCOUNTED, Cost


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


def test_what_is_besides_steps_goes_on_over_sessions():
    cost = Cost()
    until = time.process_time() + 0.02
    while time.process_time() < until:
        pass
    cost.block(1, 0.005)  # of which so much was a step
    assert 0.01 < cost.besides() < 10.0
    later = Cost.restored(cost.state())
    assert later.besides() >= cost.state()["besides"] - 1e-3
    assert Cost.restored({}).besides() < 0.01  # of a version that did not count
