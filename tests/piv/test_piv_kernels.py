"""Kernels of displacement measurement against slow twins, compiled and as plain Python."""

import math

import numpy as np
import pytest
from scipy.interpolate import make_interp_spline
from scipy.ndimage import map_coordinates, spline_filter

from porescale.piv.estimate import fit, interpolate, outliers
from porescale.piv.estimate import splines as lattice
from porescale.piv.estimate.correlate import Layout, block_products, correlation, peaks
from porescale.piv.estimate.grid import Grid, expand, spline_matrix, spread
from porescale.piv.estimate.rims import rims
from porescale.piv.estimate.smoothing import smoothed
from porescale.piv.images import spots

RNG = np.random.default_rng(6)
EPS32 = float(np.finfo(np.float32).eps)


@pytest.mark.parametrize("kernel", [spots.add_spots, spots.add_spots.py_func])
def test_a_spot_is_the_mean_of_its_gaussian_over_each_pixel(kernel):
    image = np.zeros((9, 11))
    kernel(np.array([4.3]), np.array([4.8]), np.array([100.0]), 0.7, image)
    fine = (np.arange(-50, 50) + 0.5) / 100
    y, x = np.meshgrid(4 + fine, 5 + fine, indexing="ij")
    twin = 100 * np.exp(-((x - 4.3) ** 2 + (y - 4.8) ** 2) / (2 * 0.7**2)).mean()
    # Midpoints: h²/24 times the second derivative, at most 100/0.49, along each axis.
    assert image[4, 5] == pytest.approx(twin, abs=2 * 1e-4 / 24 * 100 / 0.49)
    assert image[0, 0] == 0


def test_the_interpolator_is_the_quintic_spline_of_scipy():
    picture = RNG.uniform(0, 200, (40, 44)).astype(np.float32)
    shift = RNG.uniform(-2.5, 2.5, (2, 40, 44)).astype(np.float32)
    found = np.empty((40, 44), np.float32)
    interpolate.sample(interpolate.coefficients(picture), shift[0], shift[1], 0, found)
    y, x = np.mgrid[:40, :44]
    filtered = spline_filter(picture.astype(float), 5, mode="mirror")
    twin = map_coordinates(filtered, [y + shift[1], x + shift[0]], order=5, prefilter=False, mode="mirror")
    # Coefficients reach 2.3^2 times the values of white noise; 36 + 82 products, half a unit of round-off each.
    assert np.abs(found - twin).max() < 5.3 * 200 * (36 + 82) * EPS32 / 2
    plain = np.empty_like(found[:2])
    for row in range(2):
        interpolate.sample_row.py_func(interpolate.coefficients(picture), row, shift[0, row], shift[1, row], plain[row])
    np.testing.assert_allclose(plain, found[:2], rtol=0, atol=5.3 * 200 * 36 * EPS32)


@pytest.mark.parametrize(("dx", "dy"), [(6.3, 0.4), (-7.6, 0.4), (5.2, -6.7), (0.3, 30.2), (60.0, 0.0)])
def test_a_picture_that_moves_out_as_a_whole_is_the_spline_where_it_is_seen(dx, dy):
    # Where all pixels move alike a run of them is a whole row; the part of it that is in the picture is no less exact.
    picture = RNG.uniform(0, 200, (40, 44)).astype(np.float32)
    shift = np.empty((2, 40, 44), np.float32)
    shift[0], shift[1] = dx, dy
    y, x = np.mgrid[:40, :44]
    filtered = spline_filter(picture.astype(float), 5, mode="mirror")
    twin = map_coordinates(filtered, [y + shift[1], x + shift[0]], order=5, prefilter=False, mode="mirror")
    seen = (y + dy >= 0) & (y + dy <= 39) & (x + dx >= 0) & (x + dx <= 43)
    for compiled in (True, False):
        found, c = np.full((40, 44), np.nan, np.float32), interpolate.coefficients(picture)
        if compiled:
            interpolate.sample(c, shift[0], shift[1], 0, found)
        else:
            for row in range(40):
                interpolate.sample_row.py_func(c, row, shift[0, row], shift[1, row], found[row])
        assert np.isfinite(found).all()
        assert np.abs(found - twin)[seen].max(initial=0.0) < 5.3 * 200 * (36 + 82) * EPS32 / 2


def test_a_cubic_spline_is_another_one():
    picture = RNG.uniform(0, 200, (40, 44))
    y, x = np.mgrid[10:30, 10:30] + 0.5
    cubic, quintic = (map_coordinates(picture, [y, x], order=k, mode="mirror") for k in (3, 5))
    assert np.abs(cubic - quintic).max() > 5.3 * 200 * (36 + 82) * EPS32 / 2


def slow_correlation(a, b, ma, mb, top, left, size, sy, sx):
    """R of one window and shift, from its definition."""
    one = (slice(top, top + size), slice(left, left + size))
    two = (slice(top + sy, top + sy + size), slice(left + sx, left + sx + size))
    below = math.sqrt((a[one] ** 2 * mb[two]).sum() * (b[two] ** 2 * ma[one]).sum())
    return (a[one] * b[two]).sum() / below


@pytest.mark.parametrize("masked", [False, True])
def test_correlation_is_that_of_its_definition(masked):
    a, b = RNG.normal(size=(2, 40, 40)).astype(np.float32)
    ma, mb = np.ones_like(a), np.ones_like(b)
    if masked:
        ma[8:15, 10:20] = mb[9:16, 11:19] = 0
    a, b = a * ma, b * mb
    layout = Layout((3, 2), 6, 2, 5, 3)
    energy = np.array([[(b[j : j + 12, i : i + 12] ** 2).sum() for i in range(40)] for j in range(40)], np.float32)
    found = correlation(layout, a, b, (ma, mb) if masked else None, energy)
    for row, column, sy, sx in [(0, 0, 0, 0), (1, 1, 3, 3), (2, 0, 6, 1), (0, 1, 2, 6)]:
        twin = slow_correlation(a, b, ma, mb, 5 + 6 * row, 5 + 6 * column, 12, sy - 3, sx - 3)
        assert found[row, column, sy, sx] == pytest.approx(twin, abs=144 * EPS32)


def test_products_as_plain_python_are_those_compiled():
    a, b = RNG.normal(size=(2, 12, 12)).astype(np.float32)
    found, plain = np.empty((2, 2, 3, 3), np.float32), np.empty((2, 2, 3, 3), np.float32)
    lane = np.empty((2, 10), np.float32)
    block_products(a, b, 1, 5, lane, found)
    block_products.py_func(a, b, 1, 5, lane, plain)
    np.testing.assert_allclose(found, plain, rtol=0, atol=25 * 10 * EPS32)


def test_a_gaussian_peak_is_found_where_it_is():
    j, i = np.mgrid[-3:4, -3:4]
    total = 0.8 * np.exp(-((i - 0.3) ** 2 + (j + 0.4) ** 2) / 2.0)[None, None].astype(np.float32)
    u, v, value, ratio = (np.empty((1, 1)) for _ in range(4))
    peaks(total, u, v, value, ratio)
    assert u[0, 0] == pytest.approx(0.3, abs=1e-5)  # logarithms of float32 peaks: a few round-offs over the bend, 1
    assert v[0, 0] == pytest.approx(-0.4, abs=1e-5)
    assert ratio[0, 0] > 1


def test_grids_lie_on_whole_pixels_and_cover_the_picture():
    grid = Grid((512, 300), 16, 8)
    assert grid.shape == (63, 36)
    assert (grid.x[0], grid.x[-1], grid.y[-1]) == (8, 288, 504)


def test_values_between_vectors_are_natural_splines_straight_beyond():
    grid = Grid((64, 80), 16, 8)
    values = RNG.normal(size=grid.shape)
    dense = spread(grid.coefficients(values), *grid.axes())
    spline = make_interp_spline(grid.x, values[3], 3, bc_type="natural")
    np.testing.assert_allclose(dense[32, 8:73], spline(np.arange(8, 73)), atol=30 * EPS32)
    np.testing.assert_allclose(np.diff(dense[32, :9], 2), 0, atol=30 * EPS32)
    np.testing.assert_allclose(spline_matrix(grid.x, grid.x), np.eye(grid.shape[1]), atol=1e-12)


def test_one_vector_is_the_same_everywhere():
    grid = Grid((20, 20), 16, 8)
    np.testing.assert_allclose(spread(grid.coefficients(np.array([[3.5]])), *grid.axes()), 3.5, rtol=10 * EPS32)


@pytest.mark.parametrize("kernel", [outliers.median_residual, outliers.median_residual.py_func])
def test_the_median_residual_is_that_of_its_definition(kernel):
    u, v = RNG.normal(size=(2, 5, 6))
    use = np.ones((5, 6), bool)
    found = np.empty((5, 6))
    kernel(u, v, use, 0.1, found)
    around = [(j, i) for j in (1, 2, 3) for i in (2, 3, 4) if (j, i) != (2, 3)]
    parts = []
    for it in (u, v):
        near = np.array([it[k] for k in around])
        middle = np.median(near)
        parts.append((it[2, 3] - middle) / (np.median(np.abs(near - middle)) + 0.1))
    assert found[2, 3] == pytest.approx(math.hypot(*parts), rel=1e-12)


def test_gaps_are_filled_by_the_plane_around_them():
    y, x = np.mgrid[:9, :9].astype(float)
    u, v = 0.1 * x, 0.2 * y - 1
    good = np.ones((9, 9), bool)
    good[3:6, 4:6] = False
    found = outliers.filled(np.where(good, u, 99.0), v, good)
    # Symmetric gaps: the wish for flatness takes RIDGE over RIDGE + 2.25 of slope, times an offset below a step.
    assert np.abs(found[0] - u).max() < 0.1 * outliers.RIDGE / (outliers.RIDGE + 2) * 4
    assert np.isfinite(found).all()
    nothing = outliers.filled(u, v, np.zeros((9, 9), bool))
    assert not np.any(nothing)


def test_planes_survive_smoothing_and_noise_does_not():
    y, x = np.mgrid[:30, :40].astype(float)
    plane = 0.1 * x - 0.2 * y + 3
    found = smoothed(plane + RNG.normal(0, 0.05, plane.shape), plane, 8, 1e-3)
    assert np.abs(smoothed(plane, plane, 8, 1e-3).u - plane).max() < 1e-9
    # Little but the four modes of a plane is kept: 0.05 sqrt(4/1200) = 0.003, a fifth of the noise allowed for all.
    assert np.sqrt(np.mean((found.u - plane) ** 2)) < 0.01
    wave = np.sin(2 * np.pi * x / 8)
    assert np.abs(smoothed(wave, wave, 8, 1e-3).u - wave).max() < 0.05
    # As many coefficients as knots where next to nothing is smoothed, the four of a plane where all is.
    assert smoothed(wave, wave, 8, 1e-9, choose=False).freedom == pytest.approx(1 / 64, rel=1e-3)
    assert smoothed(plane, plane, 8, 1e9, choose=False).freedom == pytest.approx(4 / 1200 / 64, rel=1e-3)


def test_collecting_is_the_adjoint_of_expanding():
    grid = Grid((40, 52), 16, 8)
    down, across = grid.axes(4)
    nodes = RNG.normal(size=(down.at.size, across.at.size)).astype(np.float32)
    values = RNG.normal(size=(10, 13)).astype(np.float32)
    spare = np.empty((10, across.at.size), np.float32)
    there, back = np.empty_like(values), np.empty_like(nodes)
    expand(nodes, down.first, down.weights, across.first, across.weights, spare, there)
    for kernel in (lattice.collect, lattice.collect.py_func):
        kernel(values, down.first, down.weights, across.first, across.weights, spare, back)
        # 130 products of numbers of order one, half a unit of round-off each, some of whose sums cancel.
        assert float((there * values).sum()) == pytest.approx(float((nodes * back).sum()), abs=130 * 3 * EPS32)


def test_splines_of_places_are_the_places():
    grid = Grid((40, 52), 16, 8)
    down, across = grid.axes()
    values = np.add.outer(0 * down.at, across.at)
    found = grid.values(values)
    np.testing.assert_allclose(found, np.broadcast_to(grid.x, found.shape), rtol=0, atol=1e-12)
    np.testing.assert_allclose(grid.values(grid.coefficients(found**2)), found**2, rtol=1e-12)


def test_bending_is_the_gradient_of_squared_second_differences():
    c = RNG.normal(size=(5, 7))
    y, x = np.mgrid[:5, :7]

    def energy(c):
        parts = np.diff(c, 2, 0), np.diff(c, 2, 1), np.diff(np.diff(c, 1, 0), 1, 1) * math.sqrt(2)
        return sum((it**2).sum() for it in parts) / 2

    found, plain, turned = np.empty_like(c), np.empty_like(c), np.empty_like(c)
    lattice.bending(c, found)
    lattice.bending.py_func(c, plain)
    np.testing.assert_allclose(found, plain, atol=1e-13)
    way = RNG.normal(size=c.shape)
    # The energy is quadratic: its central difference is exact, to round-off over the step.
    assert (found * way).sum() == pytest.approx((energy(c + 1e-3 * way) - energy(c - 1e-3 * way)) / 2e-3, abs=1e-9)
    lattice.bending(2.0 * x - y + 3, turned)
    assert np.abs(turned).max() < 1e-12


def test_rims_lie_between_pixels_and_pull_as_they_look():
    mask = np.zeros((48, 48), bool)
    mask[20:28, 16:32] = True
    grid = Grid((48, 48), 16, 8)
    found = rims(grid, (mask, mask))
    assert found.values.shape[0] == 2 * 8 + 2 * 16  # a point for every side of a pixel
    down, across = grid.axes()
    plane = np.add.outer(0 * down.at, across.at).astype(np.float32)
    at = found.values @ plane.ravel()
    # Sums of 16 float32 products of places up to 48 px.
    np.testing.assert_allclose(np.unique(np.round(at, 2)), sorted([15.5, 31.5, *range(16, 32)]), atol=0.01)
    np.testing.assert_allclose((found.pulled(plane) * plane).sum(), (at**2).sum(), rtol=100 * EPS32)
    np.testing.assert_allclose(found.diagonal(plane.shape).sum(), found.values.power(2).sum(), rtol=100 * EPS32)
    assert rims(grid, (mask, np.roll(mask, 4, (0, 1)))) is None  # it moved
    assert rims(grid, (mask, None)) is None
    assert rims(grid, (mask, ~np.ones_like(mask))) is None


def deformed(shift: float, size: int = 48) -> tuple[np.ndarray, ...]:
    """Two pictures, ``shift`` px apart, and a mask, all float32."""
    y, x = np.mgrid[:size, :size].astype(float)
    phases = RNG.uniform(0, 2 * np.pi, 12)
    waves = [(0.9 * math.cos(p), 0.9 * math.sin(p), q) for p, q in zip(phases, phases[::-1], strict=True)]
    a, b = (sum(np.sin(p * (x + s) + r * y + q) for p, r, q in waves) for s in (shift / 2, -shift / 2))
    return tuple(it.astype(np.float32) for it in (a, b, np.ones_like(a)))


def block_sums(a, b, mask, moments, weighted):
    down, across = -(-a.shape[0] // 4), -(-a.shape[1] // 4)
    lanes = np.empty((down, 9, a.shape[1]), np.float32)
    six, five = np.empty((6, down, across), np.float32), np.empty((5, down, across), np.float32)
    moments(a, b, mask, 4, lanes, six)
    known = np.array([np.full((down, across), it) for it in (0.1, -0.2, 1.1, 0.01)], np.float32)
    weighted(a, b, mask, known, np.float32(0.04), 4, lanes, five)
    return six, five


def test_sums_over_blocks_are_those_of_their_definition():
    a, b, mask = (it[:22, :27].copy() for it in deformed(0.3))
    mask[5:9, 3:14] = 0
    six, five = block_sums(a, b, mask, lattice.moments, lattice.weighted)
    plain = block_sums(a, b, mask, lattice.moments.py_func, lattice.weighted.py_func)
    for one, other in ((six, plain[0]), (five, plain[1])):
        np.testing.assert_allclose(one, other, rtol=0, atol=16 * 8 * EPS32 * np.abs(other).max())
    assert six[5, 1, 1] == pytest.approx(float((mask * a * b)[4:8, 4:8].astype(float).sum()), abs=1e-4)
    mean = 0.5 * (a + 1.1 * b)
    g = (8 * (mean[:, 3:-1] - mean[:, 1:-3]) - (mean[:, 4:] - mean[:, :-4])) / 12
    r = (a - 0.1) - 1.1 * (b + 0.2)
    rows, columns = slice(12, 16), slice(12, 16)
    gx = g[rows, 10:14]
    h = (8 * (mean[3:-1] - mean[1:-3]) - (mean[4:] - mean[:-4])) / 12
    gy = h[10:14, columns]
    due = 0.01 + 0.04 * (gx**2 + gy**2)
    w = due / (due + r[rows, columns] ** 2)
    twin = [(w * it).sum() for it in (gx * gx, gx * gy, gy * gy, gx * r[rows, columns], gy * r[rows, columns])]
    np.testing.assert_allclose(five[:, 3, 3], twin, rtol=0, atol=16 * 20 * EPS32 * max(map(abs, twin)))


def test_an_update_finds_a_small_shift():
    a, b, mask = deformed(0.1)
    grid = Grid((48, 48), 16, 8)
    _, five = block_sums(a, b, mask, lattice.moments, lattice.weighted)
    known = fit.Equations(five, five[:3], five[0], np.full(five.shape[1:], 16, np.float32))
    zero = grid.both(np.zeros(grid.shape), np.zeros(grid.shape))
    found = grid.values(fit.solved(grid, zero, known, 1e-2)[0])
    exact = grid.values(fit.solved(grid, zero, _again(a, b, mask), 1e-2)[0])
    # Gradients by differences fall short by (0.9)^4/30 of theirs, 2 %, conjugate gradients end at 2 % of the rest.
    np.testing.assert_allclose(exact[1:-1, 1:-1], 0.1, rtol=0.06)
    # Means and gain that are not the pictures' own spoil it: what the local sums are for.
    assert np.abs(found - 0.1).max() > 0.01


def test_an_update_is_the_same_when_the_second_picture_is_dimmer():
    a, b, mask = deformed(0.1)
    grid = Grid((48, 48), 16, 8)
    zero = grid.both(np.zeros(grid.shape), np.zeros(grid.shape))
    like, dim, untold = (
        grid.values(fit.solved(grid, zero, _again(a, scale * b, mask, gain), 1e-2)[0])
        for scale, gain in ((1, 1), (0.5, 2), (0.5, 1))
    )
    # Halves and doubles are exact: the same sums.
    assert np.array_equal(dim, like)
    # The check that must fail: without the gain half of the light of the first picture is left over as a residual.
    assert np.abs(untold - like)[1:-1, 1:-1].max() > 0.01


def _again(a, b, mask, gain=1.0):
    down, across = a.shape[0] // 4, a.shape[1] // 4
    lanes = np.empty((down, 9, a.shape[1]), np.float32)
    five = np.empty((5, down, across), np.float32)
    known = np.zeros((4, down, across), np.float32)
    known[2], known[3] = gain, 1
    lattice.weighted(a, b, mask, known, np.float32(0.04), 4, lanes, five)
    return fit.Equations(five, five[:3], five[0], np.full((down, across), 16, np.float32))
