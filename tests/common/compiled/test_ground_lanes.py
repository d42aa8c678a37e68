"""Vectors of a few numbers: the same in kernels as in plain Python, to the bit."""

from __future__ import annotations

import numpy as np
import pytest

from porescale.common.compiled.jit import kernel
from porescale.common.compiled.simd import (
    COLUMNS,
    LANES,
    greater,
    kept,
    lesser,
    nearest,
    nothing,
    put_line,
    root,
    take_line,
    take_rows,
    take_two,
    total,
)


@kernel
def everything(record, row, first, end, other, found):
    """All that vectors can do; overwrites ``found`` (2 + LANES,)."""
    a, b, c, d, e, g, h, i = take_rows(record, row, first, end, other)
    s = nothing()
    s += a * 2.0 - b / (1.0 + root(c * c))
    s -= greater(0.0, d) + lesser(e, 0.5)
    s = s + nearest(10.0 * g) - (-h) * i
    j, k = take_two(record, row, first, end, other, 2, 1)
    s += j * take_line(found, 2, 2 + end - first) - kept(k, first, end)
    found[0] = total(s)
    put_line(found, 2, 2 + end - first, s)
    found[1] = greater(found[0], 3.0) - lesser(found[0], 3.0) + nearest(0.5) + root(2.0)
    return total(a)


@pytest.mark.parametrize(("first", "end"), [(0, 7), (1, 4), (4, 7), (2, 2 + LANES)])
def test_kernels_and_plain_python_agree_to_the_bit(first, end):
    rng = np.random.default_rng(1)
    record, row = rng.normal(size=(9, COLUMNS)), np.array([3, 1, 4, 1, 5, 8, 2], np.int32)
    compiled, plain = np.ones((2, 2 + LANES))
    sums = [f(record, row, first, end, 6, out) for f, out in ((everything, compiled), (everything.py_func, plain))]
    assert sums[0] == sums[1]
    np.testing.assert_array_equal(compiled, plain)


def test_beyond_the_end_stands_the_other_row():
    record = np.arange(4.0 * COLUMNS).reshape(4, COLUMNS)
    columns = take_rows(record, np.array([1, 2], np.int32), 0, 2, 3)
    np.testing.assert_array_equal(columns[0], record[[1, 2, *[3] * (LANES - 2)], 0])


def test_rows_count_from_a_number_on_and_columns_too():
    record = np.arange(4.0 * COLUMNS).reshape(4, COLUMNS)
    columns = take_two(record, np.array([7, 8], np.int32), 0, 2, 0, 4, 6)
    np.testing.assert_array_equal(columns[1], record[[1, 2, *[0] * (LANES - 2)], 5])


def test_nothing_is_taken_or_put_beyond_the_end():
    line = np.arange(1.0, 2.0 + LANES)
    np.testing.assert_array_equal(take_line(line, 1, 3), [2.0, 3.0, *[0.0] * (LANES - 2)])
    put_line(line, 1, 3, np.zeros(LANES))
    np.testing.assert_array_equal(line, [1.0, 0.0, 0.0, *range(4, 2 + LANES)])


def test_nothing_is_kept_beyond_the_end():
    np.testing.assert_array_equal(kept(np.ones(LANES), 3, 4), [1.0, *[0.0] * (LANES - 1)])
    np.testing.assert_array_equal(kept(np.ones(LANES), 3, 3 + LANES), np.ones(LANES))


def test_lanes_are_added_by_halves():
    tiny = 2.0**-53  # half a unit in the last place of 1: lost when it is added to 1 alone
    values = np.zeros(LANES)
    values[0], values[1], values[1 + LANES // 2] = 1.0, tiny, tiny
    assert total(values) == 1.0 + 2.0 * tiny  # the halves bring both together first
    assert sum(values) == 1.0
