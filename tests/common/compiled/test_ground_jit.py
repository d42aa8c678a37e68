"""Threads of the kernels: as many as asked for, or a refusal."""

import numpy as np
import pytest

from porescale.common.compiled.jit import kernel, prefetch, set_threads, threads, tree_sum, unchecked_view
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
def test_parts_are_slices_and_sums_by_halves_are_those_of_plain_python(dtype):
    total = tree_sum(8)

    @kernel
    def both(values):
        prefetch(values, 3)  # which changes nothing
        for i in range(8):
            unchecked_view(values, 3, 8)[i] *= 2
        return total(values, 3)

    values = np.random.default_rng(1).uniform(-1, 1, 20).astype(dtype)
    expected = values.copy()
    expected[3:11] *= 2
    found = both(values)
    np.testing.assert_array_equal(values, expected)
    np.testing.assert_array_equal(unchecked_view(values, 3, 8), values[3:11])
    by_halves = ((values[3] + values[7]) + (values[5] + values[9])) + (
        (values[4] + values[8]) + (values[6] + values[10])
    )
    assert found == total(values, 3) == by_halves  # to the bit: the order is part of the result
    assert by_halves.dtype == dtype
