"""Vectors of a few numbers: the same in kernels as in plain Python, to the bit."""

import numpy as np
import pytest

from porescale.common.compiled.jit import kernel
from porescale.common.compiled.simd import (
    COLUMNS,
    LANES,
    gather_rows,
    gather_two,
    load,
    mask_tail,
    maximum,
    minimum,
    reduce_add,
    rint,
    sqrt,
    store,
    zeros,
)


@kernel
def everything(record, row, first, end, other, found):
    """All that vectors can do; overwrites ``found`` (2 + LANES,)."""
    a, b, c, d, e, g, h, i = gather_rows(record, row, first, end, other)
    s = zeros()
    s += a * 2.0 - b / (1.0 + sqrt(c * c))
    s -= maximum(0.0, d) + minimum(e, 0.5)
    s = s + rint(10.0 * g) - (-h) * i
    j, k = gather_two(record, row, first, end, other, 2, 1)
    s += j * load(found, 2, 2 + end - first) - mask_tail(k, first, end)
    found[0] = reduce_add(s)
    store(found, 2, 2 + end - first, s)
    found[1] = maximum(found[0], 3.0) - minimum(found[0], 3.0) + rint(0.5) + sqrt(2.0)
    return reduce_add(a)


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
    columns = gather_rows(record, np.array([1, 2], np.int32), 0, 2, 3)
    np.testing.assert_array_equal(columns[0], record[[1, 2, *[3] * (LANES - 2)], 0])


def test_rows_count_from_a_number_on_and_columns_too():
    record = np.arange(4.0 * COLUMNS).reshape(4, COLUMNS)
    columns = gather_two(record, np.array([7, 8], np.int32), 0, 2, 0, 4, 6)
    np.testing.assert_array_equal(columns[1], record[[1, 2, *[0] * (LANES - 2)], 5])


def test_nothing_is_taken_or_put_beyond_the_end():
    line = np.arange(1.0, 2.0 + LANES)
    np.testing.assert_array_equal(load(line, 1, 3), [2.0, 3.0, *[0.0] * (LANES - 2)])
    store(line, 1, 3, np.zeros(LANES))
    np.testing.assert_array_equal(line, [1.0, 0.0, 0.0, *range(4, 2 + LANES)])


def test_nothing_is_kept_beyond_the_end():
    np.testing.assert_array_equal(mask_tail(np.ones(LANES), 3, 4), [1.0, *[0.0] * (LANES - 1)])
    np.testing.assert_array_equal(mask_tail(np.ones(LANES), 3, 3 + LANES), np.ones(LANES))


def test_lanes_are_added_by_halves():
    tiny = 2.0**-53  # half a unit in the last place of 1: lost when it is added to 1 alone
    values = np.zeros(LANES)
    values[0], values[1], values[1 + LANES // 2] = 1.0, tiny, tiny
    assert reduce_add(values) == 1.0 + 2.0 * tiny  # the halves bring both together first
    assert sum(values) == 1.0
