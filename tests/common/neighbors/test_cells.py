"""Cells hold every point once, in order, wherever it lies."""

import numpy as np
import pytest

from porescale.common.neighbors import PairList
from porescale.common.neighbors.cells import (
    Grid,
    cell_of,
    grid_shape,
    largest_below,
    minimum_image,
    sort_into_cells,
    wrapped,
)


def sort(x, columns=4, rows=3, period=(0.0, 0.0), compiled=True):
    """Sort into cells of 1 m from the origin."""
    n = len(x)
    cell, order = np.empty(n, np.int32), np.empty(n, np.int32)
    start = np.empty(columns * rows + 1, np.int64)
    run = sort_into_cells if compiled else sort_into_cells.py_func
    levels = np.array([(*Grid(0.0, 0.0, 1.0, 1.0, columns, rows, *period), 1.0, 0)])
    run(x, np.ones(n), levels, cell, start, order)
    return cell, start, order


def test_sorting_is_stable_and_complete():
    x = np.random.default_rng(1).uniform(0.0, [4.0, 3.0], (200, 2))
    cell, start, order = sort(x)
    assert start[0] == 0
    assert start[-1] == len(x)
    assert sorted(order) == list(range(len(x)))
    for c in range(12):
        inside = order[start[c] : start[c + 1]]
        assert np.array_equal(inside, np.flatnonzero(cell == c))  # ascending: stable
    assert np.array_equal(cell, x[:, 0].astype(int) + 4 * x[:, 1].astype(int))


@pytest.mark.parametrize("compiled", [True, False])
def test_points_of_each_level_lie_in_cells_of_their_own(compiled):
    run, below = (it if compiled else it.py_func for it in (sort_into_cells, largest_below))
    x, reach = np.array([[0.5, 0.5], [1.5, 0.5], [0.6, 0.5], [0.5, 0.4]]), np.array([1.0, 0.2, 0.9, 0.1])
    assert below(reach, np.inf) == (1.0, 4)
    assert below(reach, 0.25) == (0.2, 2)
    assert below(reach, 0.05) == (-1.0, 0)
    levels = np.array([(*Grid(0.0, 0.0, 0.5, 0.5, 1, 1), 1.0, 0), (*Grid(0.0, 0.0, 1.0, 1.0, 2, 1), 0.2, 1)])
    cell, start, order = np.empty(4, np.int32), np.empty(4, np.int64), np.empty(4, np.int32)
    run(x, reach, levels, cell, start, order)
    assert cell.tolist() == [0, 2, 0, 1]
    assert start.tolist() == [0, 2, 3, 4]
    assert order.tolist() == [0, 2, 3, 1]


def test_points_outside_fall_into_the_nearest_border_cell():
    cell, _, _ = sort(np.array([[-5.0, 1.5], [1e300, -1e300], [3.5, 99.0]]))
    assert cell.tolist() == [4, 3, 11]


def test_points_outside_a_periodic_side_fall_into_their_images_cell():
    cell, _, _ = sort(np.array([[-0.5, 0.5], [4.5, 0.5], [9.5, -1.0]]), period=(4.0, 3.0))
    assert cell.tolist() == [3, 0, 9]


def test_plain_python_and_compiled_agree():
    x = np.random.default_rng(2).uniform(-1.0, 5.0, (40, 2))
    for plain, compiled in zip(sort(x, compiled=False), sort(x), strict=True):
        assert np.array_equal(plain, compiled)


def test_minimum_image_is_the_shortest_of_all_images():
    dx = np.linspace(-7.3, 7.3, 41)
    for value in dx:
        images = value + 2.0 * np.arange(-5, 6)
        # round-off of one product and one difference of numbers up to 8
        assert abs(minimum_image(value, 2.0)) == pytest.approx(np.abs(images).min(), abs=4e-15)
        assert minimum_image(value, 0.0) == value
        assert minimum_image.py_func(value, 2.0) == minimum_image(value, 2.0)


def test_wrapping_lands_in_the_box():
    for value in (-1e3, -0.25, 0.0, 1.999, 2.0, 17.5):
        assert 1.0 <= wrapped(value, 1.0, 2.0) <= 3.0
        assert wrapped.py_func(value, 1.0, 0.0) == value


def test_cell_index_is_monotone_and_clamped():
    index = [cell_of(v, 0.0, 2.0, 5) for v in np.linspace(-1.0, 4.0, 101)]
    assert index == sorted(index)
    assert (index[0], index[-1]) == (0, 4)
    assert cell_of.py_func(1.2, 0.0, 2.0, 5) == 2


def test_cells_are_no_smaller_than_asked_and_bounded_in_number():
    assert grid_shape((0.0, 0.0), (10.0, 5.0), 1.0, 1000) == (10, 5)
    columns, rows = grid_shape((0.0, 0.0), (1e6, 1e6), 1e-3, 500)
    assert columns * rows <= 500
    assert grid_shape((0.0, 0.0), (1.0, 1.0), 3.0, 500) == (1, 1)


@pytest.mark.parametrize("far", [*(s * 10.0**k for s in (-1, 1) for k in (0, 3, 9, 12, 13, 16, 100, 300))])
def test_images_lie_in_the_box_however_far_the_point(far):
    # From 1e13 m on neighbouring numbers are a third of the first period apart.
    for lower, period in ((0.0, 6e-3), (0.0, 0.7), (-1.0, 0.7)):
        assert lower <= wrapped.py_func(far, lower, period) <= lower + period


def test_rounding_alone_leaves_the_box():
    far = -1e16 / 3  # neighbouring numbers are half a metre apart
    assert not 0.0 <= far - 0.7 * np.floor(far / 0.7) <= 0.7  # what was searched before, and crashed


def test_pairs_are_found_beside_a_point_that_ran_away():
    x = np.array([[1e-3, 3e-3], [-1.1201e12, 4.3e6], [1.9e-3, 3e-3]])
    listed = PairList(3, 1e-4, (0.0, 0.0), (6e-3, 6e-3), periodic=(True, True))
    listed.build(x, np.full(3, 5e-4))
    assert 2 in listed.partner[listed.start[0] : listed.start[1]]
