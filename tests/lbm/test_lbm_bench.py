"""The rates of the lattice: steps that a call takes, and boxes too small to time."""

import pytest

from porescale.benchmarks.lbm import (
    CELLS_A_CALL,
    MOST_STEPS,
    SIZE,
    SMALLEST,
    bench_lbm,
    bench_operators,
    bytes_of,
    side_of,
    steps_of,
)  # fmt: skip
from porescale.benchmarks.psm import bench_psm
from porescale.common.core.errors import InputError
from porescale.lbm.collision.choose import OPERATORS


@pytest.mark.parametrize("bench", [bench_lbm, bench_psm, bench_operators])
@pytest.mark.parametrize("size", [1, SMALLEST - 1])
def test_a_box_too_small_to_time_is_refused_with_the_bound(bench, size):
    with pytest.raises(InputError, match=rf"--size = {size}: is too small to be timed \(allowed: >= {SMALLEST}\)"):
        bench(size, 1, "float64")


def test_a_call_takes_an_even_number_of_steps_and_never_more_than_an_end_can_be_awaited_for():
    for side in (1, SMALLEST, 100, SIZE, 10 * SIZE):
        steps = steps_of(side**2)
        assert steps % 2 == 0
        assert 2 <= steps <= MOST_STEPS
    assert steps_of(1) == steps_of(SMALLEST**2) == MOST_STEPS
    # Where neither bound holds a call is CELLS_A_CALL cell steps, to the even number of steps: half of two of 100^2.
    assert abs(steps_of(100**2) * 100**2 - CELLS_A_CALL) <= 100**2
    assert side_of(None) == SIZE


def test_the_smallest_box_counts_its_cell_steps(monkeypatch):
    monkeypatch.setattr("porescale.benchmarks.lbm.MOST_STEPS", 2)
    works = [
        bench_lbm(SMALLEST, 1, "float32"),
        *bench_operators(SMALLEST, 1, "float32"),
        *bench_psm(SMALLEST, 1, "float32"),
    ]
    for work in works:
        work.call()
        assert (work.updates, work.size, work.bytes) == (2 * SMALLEST**2, SMALLEST, bytes_of("float32"))


def test_every_operator_is_timed_without_and_with_eddies():
    names = [work.variant for work in bench_operators(SMALLEST, 1, "float64")]
    assert names == [name for operator in OPERATORS for name in (operator, f"{operator}_eddies")]
