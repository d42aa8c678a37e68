"""The smallest statement of a correlation pass does what the kernels do."""

import numpy as np
import pytest

from porescale.benchmarks.minimal_piv import correlation_at, displacement, peak_offset
from porescale.piv.estimate.correlate import Layout, correlation, peaks

EPS32 = float(np.finfo(np.float32).eps)
SIZE, SEARCH, PAD = 12, 3, 5


def spots(shift: tuple[float, float]) -> np.ndarray:
    """A picture (40, 40) of Gaussian tracers moved by (u, v) px, less its mean."""
    rng = np.random.default_rng(2)
    y, x = np.mgrid[:40, :40]
    places = rng.uniform(-2, 42, (120, 2)) + shift
    light = sum(np.exp(-((x - u) ** 2 + (y - v) ** 2) / 2.0) for u, v in places)
    return (light - light.mean()).astype(np.float32)


@pytest.mark.parametrize("solid", [False, True])
def test_the_smallest_pass_finds_what_the_kernels_find(solid):
    first, second = spots((0.0, 0.0)), spots((1.3, -0.6))
    ones = np.ones_like(first)
    mask = ones.copy()
    if solid:
        mask[8:15, 10:20] = 0
    a, b = first * mask, second * mask
    layout = Layout((2, 2), SIZE, 1, PAD, SEARCH)
    energy = np.array([[(b[j : j + SIZE, i : i + SIZE] ** 2).sum() for i in range(40)] for j in range(40)], np.float32)
    fast = correlation(layout, a, b, (mask, mask) if solid else None, energy)
    u, v, height, ratio = (np.empty((2, 2)) for _ in range(4))
    peaks(fast, u, v, height, ratio)
    for row in range(2):
        for column in range(2):
            corner = (PAD + SIZE * row, PAD + SIZE * column)
            plain = correlation_at((a, b), (mask, mask), corner, SIZE, (-1, 1))
            # Sums of 144 products in single precision
            assert fast[row, column, SEARCH - 1, SEARCH + 1] == pytest.approx(plain, abs=SIZE**2 * EPS32)
            found = displacement((a, b), (mask, mask), corner, SIZE, SEARCH)
            # The bend of the logarithms at the peak of these spots is no less than 0.1
            allowed = SIZE**2 * EPS32 / 0.1
            assert found == pytest.approx((u[row, column], v[row, column]), abs=allowed)
            other = displacement((a, np.roll(b, 1, axis=1)), (mask, mask), corner, SIZE, SEARCH)
            assert abs(other[0] - u[row, column]) > 0.5  # the check that must fail


def test_the_peak_of_a_gaussian_is_found_where_it_is():
    values = np.exp(-((np.arange(-1, 2) - 0.3) ** 2))
    assert peak_offset(*values) == pytest.approx(0.3, abs=1e-14)
