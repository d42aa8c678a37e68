"""Voronoi cells and Delaunay triangles fill their rectangle and keep what defines them; shrinking moves sides."""

import numpy as np
import pytest

from porescale.common.core.errors import InputError
from porescale.dem.prepare.tessellate import area, delaunay, shrunk, voronoi

LOWER, UPPER = (0.5, -1.0), (3.5, 1.0)


def seeds(seed=0):
    """A rough grid of 12 by 8 seeds, none near another."""
    rng = np.random.default_rng(seed)
    grid = np.stack(np.meshgrid(np.arange(12), np.arange(8)), axis=-1).reshape(-1, 2)
    return LOWER + 0.25 * (grid + 0.5 + rng.uniform(-0.35, 0.35, grid.shape))


@pytest.mark.parametrize("make", [voronoi, delaunay])
@pytest.mark.parametrize("seed", range(3))
def test_polygons_fill_the_rectangle(make, seed):
    parts = make(seeds(seed), LOWER, UPPER)
    areas = np.array([area(each) for each in parts])
    assert areas.min() > 0.0
    # A hundred areas, corners by qhull to some 1e-14 of the rectangle, joined where closer than 1e-9.
    assert areas.sum() == pytest.approx(6.0, rel=1e-9)


def test_every_point_of_a_cell_is_nearest_to_its_seed():
    at = seeds()
    rng = np.random.default_rng(1)
    for k, cell in enumerate(voronoi(at, LOWER, UPPER)):
        for share in rng.dirichlet(np.ones(len(cell)), 20):
            assert np.hypot(*(share @ cell - at).T).argmin() == k


def test_no_seed_lies_in_the_circle_of_a_triangle():
    corners = delaunay(seeds(), LOWER, UPPER)
    every = np.unique(np.concatenate(corners), axis=0)
    assert len(every) == 96
    for a, b, c in corners:
        left = 2.0 * np.array([b - a, c - a])
        centre = np.linalg.solve(left, [b @ b - a @ a, c @ c - a @ a])
        radius = np.hypot(*(a - centre))
        assert np.hypot(*(every - centre).T).min() > radius * (1.0 - 1e-9)


def test_triangles_have_the_number_that_euler_says():
    parts = delaunay(seeds(), LOWER, UPPER)
    every = np.unique(np.concatenate(parts), axis=0)
    beside = np.any((every == LOWER) | (every == UPPER), axis=1)
    assert len(parts) == 2 * len(every) - 2 - beside.sum()


def test_cells_without_mirror_images_do_not_fill_it():  # the twin that must fail
    from scipy.spatial import ConvexHull

    assert ConvexHull(seeds()).volume < 0.95 * 6.0


def test_a_square_shrinks_on_all_sides_and_a_point_of_a_triangle_more():
    square = np.array([(0.0, 0.0), (2.0, 0.0), (2.0, 2.0), (0.0, 2.0)])
    left = shrunk(square, 0.25)
    assert left is not None
    assert area(left) == pytest.approx(1.5**2, rel=1e-14)
    assert shrunk(square, 1.0) is None
    needle = np.array([(0.0, 0.0), (4.0, 0.0), (0.0, 1.0)])
    left = shrunk(needle, 0.1)
    # Similar to itself: the inradius falls from r = 2 A/P by 0.1.
    inradius = 4.0 / (5.0 + np.sqrt(17.0))
    assert area(left) == pytest.approx(2.0 * (1.0 - 0.1 / inradius) ** 2, rel=1e-12)


def test_sides_that_vanish_or_are_short_leave_corners():
    house = np.array([(0.0, 0.0), (2.0, 0.0), (2.0, 0.1), (1.0, 1.1), (0.0, 0.1)])
    assert len(shrunk(house, 0.2)) == 3  # the low walls are gone
    assert len(shrunk(house, 0.01)) == 5
    assert len(shrunk(house, 0.01, shortest=0.2)) == 3


@pytest.mark.parametrize(
    ("at", "key"), [([(0.0, 0.0)], "in the rectangle"), ([], "in the rectangle"), ([(1.0, 0.0)] * 2, "one place")]
)
def test_seeds_without_sense_are_refused(at, key):
    with pytest.raises(InputError, match=key):
        voronoi(at, LOWER, UPPER)


def test_few_seeds_make_no_triangles():
    with pytest.raises(InputError, match="too few"):
        delaunay([(1.0, 0.0), (2.0, 0.5)], LOWER, UPPER)
