"""Sizes of discs follow the curve they are drawn from."""

import numpy as np
import pytest

from porescale.common.core.errors import InputError
from porescale.common.neighbors.grading import graded_radii, lognormal_radii
from tests.reference.dem.grading import percent_finer

CURVE = ((0.3e-3, 0.0), (0.6e-3, 20.0), (1.0e-3, 55.0), (1.5e-3, 55.0), (3.0e-3, 100.0))


@pytest.mark.parametrize("area", [3e-4, 3e-3])
def test_mass_finer_follows_the_curve_to_half_a_disc(area):
    radius = graded_radii(CURVE, area)
    assert radius.max() / radius.min() == pytest.approx(10.0, rel=0.1)
    sizes = np.geomspace(0.3e-3, 3e-3, 60)
    exact = np.interp(np.log(sizes), *np.array([(np.log(d), p) for d, p in CURVE]).T)
    # Half a disc of that size over all, plus as much for the whole, which half a disc of the largest may be missing of.
    own = 50.0 * np.pi * sizes**2 / (4.0 * area)
    assert (np.abs(percent_finer(radius, sizes) - exact) <= 1.01 * (own + own[-1]) + 1e-9).all()
    whole = float(np.pi * np.sum(radius**2))
    assert abs(whole - area) <= 0.5 * np.pi * 1.5e-3**2
    assert not ((2 * radius > 1.01e-3) & (2 * radius < 1.49e-3)).any()  # a gap in the curve is one in the sizes
    # The twin that must fail: the same sizes drawn by number, not by mass.
    even = np.exp(np.interp(np.linspace(0, 100, len(radius)), [p for _, p in CURVE], [np.log(d / 2) for d, _ in CURVE]))
    assert (np.abs(percent_finer(even, sizes) - exact) > 1.01 * (own + own[-1])).any()


def test_lognormal_sizes_have_their_mean_and_spread():
    radius = lognormal_radii(4000, 1e-3, 0.3)
    assert 2 * radius.mean() == pytest.approx(1e-3, rel=1e-12)
    # Cut at 2.5 deviations the variance of the logarithm is 1 - 2 * 2.5 phi(2.5)/(1 - 0.0124) = 0.911 of the whole.
    assert np.log(radius).std() == pytest.approx(0.3 * np.sqrt(0.9113), rel=1e-3)


@pytest.mark.parametrize(("curve", "said"), [
    (((1e-3, 0.0),), "too few points"),
    (((1e-3, 0.0), (1e-3, 100.0)), "diameters must ascend"),
    (((1e-3, 0.0), (2.1e-2, 100.0)), "1 to 21"),
    (((1e-3, 10.0), (2e-3, 100.0)), "from 0 to 100"),
    (((1e-3, 0.0), (2e-3, 70.0), (3e-3, 60.0), (4e-3, 100.0)), "must ascend"),
])  # fmt: skip
def test_what_is_no_curve_is_refused(curve, said):
    with pytest.raises(InputError, match=said):
        graded_radii(curve, 1e-3)


def test_sizes_too_far_apart_and_areas_too_small_are_refused():
    with pytest.raises(InputError, match="log_spread"):
        lognormal_radii(10, 1e-3, 0.6)
    with pytest.raises(InputError, match="not one grain"):
        graded_radii(CURVE, 1e-9)


@pytest.mark.parametrize(
    ("curve", "words"),
    [
        (((1e-9, 0.0), (5e-9, 100.0)), "makes about"),
        (((1e-300, 0.0), (5e-300, 100.0)), "is out of range"),
        (((1e-300, 0.0), (5e300, 100.0)), "is out of range"),
    ],
)
def test_a_curve_of_far_too_many_grains_or_of_no_size_is_refused_at_once(curve, words):
    with pytest.raises(InputError, match=words):
        graded_radii(curve, 1e-3)
