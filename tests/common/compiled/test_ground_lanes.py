"""Vectors of a few numbers: the same in kernels as in plain Python, to the bit."""

import numpy as np
import pytest

from porescale.common.compiled.jit import compiler, kernel
from porescale.common.compiled.simd import (
    COLUMNS,
    EIGHT,
    LANES,
    choose,
    fma,
    gather_rows,
    gather_two,
    load,
    load_eight,
    mask_tail,
    maximum,
    minimum,
    ramp,
    ramp_eight,
    reduce_add,
    rint,
    sqrt,
    store,
    store_eight,
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
    s = fma(choose(a, b, c, 0.25), ramp(), s)
    found[0] = reduce_add(s)
    store(found, 2, 2 + end - first, s)
    found[1] = maximum(found[0], 3.0) - minimum(found[0], 3.0) + rint(0.5) + sqrt(2.0) + choose(found[0], 0.0, 1.0, 2.0)
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


@kernel
def eights(one, two, found):
    """All that vectors of eight can do; overwrites ``found`` (EIGHT + 1,)."""
    a, b = load_eight(one, 1), load_eight(two, 0)
    c = choose(a, b, fma(a, b, ramp_eight(one)), a - b * b)
    store_eight(found, 1, c)
    found[0] = reduce_add(c)


@pytest.mark.parametrize("dtype", [np.float32, np.float64])
def test_eights_and_plain_python_agree_to_the_bit_in_both_precisions(dtype):
    one, two = np.random.default_rng(1).normal(size=(2, EIGHT + 1)).astype(dtype)
    compiled, plain = np.ones((2, EIGHT + 1), dtype)
    eights(one, two, compiled)
    eights.py_func(one, two, plain)
    np.testing.assert_array_equal(compiled, plain)
    s = plain[1:]
    by_halves = ((s[0] + s[4]) + (s[2] + s[6])) + ((s[1] + s[5]) + (s[3] + s[7]))
    assert plain[0] == by_halves  # the order is part of the result
    assert len({*(one[1:] > two[:EIGHT]).tolist()}) == 2  # both branches were taken


@kernel
def fused(a, b, c):
    """``fma`` of numbers."""
    return fma(a, b, c)


@pytest.mark.parametrize(("dtype", "tiny"), [(np.float32, 2.0**-13), (np.float64, 2.0**-30)])
def test_products_are_not_rounded_before_they_are_added(dtype, tiny):
    a, minus = dtype(1 + tiny), dtype(-(1 + 2 * tiny))
    exact = dtype(tiny * tiny)  # of a a - (1 + 2 tiny), which is what a a is rounded to
    assert fused(a, a, minus) == fma(a, a, minus) == exact
    assert dtype(a * a) + minus == 0.0
    assert type(fma(a, a, minus)) is dtype


@kernel
def rounded(line, values):
    """Lanes of float64 into a line of float32."""
    store(line, 1, 1 + LANES, load(values, 0, LANES))


def test_lanes_are_rounded_to_what_the_line_holds():
    line, values = np.zeros(LANES + 2, np.float32), np.array([1 / 3, 2 / 3, 1e-50, -0.1])
    rounded(line, values)
    np.testing.assert_array_equal(line, [0.0, *values.astype(np.float32), 0.0])


def test_kernels_take_the_widest_vectors_of_the_processor():
    features = str(compiler().cpu_target.target_context.codegen().magic_tuple()[2])
    assert ("+avx512f" in features) == ("-prefer-256-bit" in features)
