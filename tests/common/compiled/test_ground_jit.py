"""Threads of the kernels: as many as asked for, or a refusal."""

import numpy as np
import pytest
from numba.core.caching import NullCache

from porescale.common.compiled.jit import disjoint, inline, kernel, prefetch, set_threads, threads, unchecked_view
from porescale.common.core.errors import InputError


def test_threads_are_those_asked_for_or_refused_with_the_range():
    most = set_threads(None)
    assert threads() == most >= 2  # tests/conftest.py
    for count in (1, most):
        assert set_threads(count) == threads() == count
    for count in (0, -1, most + 1, 5000):
        with pytest.raises(InputError, match=rf"--threads = {count}: is out of range \(allowed: 1 to {most}\)"):
            set_threads(count)
        assert threads() == most  # nothing was set


@pytest.mark.parametrize("dtype", [np.float32, np.float64])
def test_parts_are_slices(dtype):
    @kernel
    def double(values):
        prefetch(values, 3)  # which changes nothing
        for i in range(8):
            unchecked_view(values, 3, 8)[i] *= 2

    values = np.random.default_rng(1).uniform(-1, 1, 20).astype(dtype)
    expected = values.copy()
    expected[3:11] *= 2
    double(values)
    np.testing.assert_array_equal(values, expected)
    np.testing.assert_array_equal(unchecked_view(values, 3, 8), values[3:11])


@pytest.mark.parametrize(("how", "compared"), [(disjoint, False), (inline, True)])
def test_arrays_that_share_no_memory_are_not_compared(how, compared):
    @how
    def add(a, b, c):
        for i in range(a.shape[0]):
            c[i] = a[i] + b[i]

    @kernel
    def sums(values, n):
        add(unchecked_view(values, 0, n), unchecked_view(values, n, n), unchecked_view(values, 2 * n, n))

    vars(sums.compiled)["_cache"] = NullCache()  # what is read from disk has no intermediate code
    values = np.arange(300.0)
    sums(values, 100)
    np.testing.assert_array_equal(values[200:], values[:100] + values[100:200])
    (code,) = sums.compiled.inspect_llvm().values()
    assert "x double>" in code  # several at a time
    assert ("vector.memcheck" in code) == compared
