"""Areas, overlaps and covered cells of random polygons, held against shapely (GEOS), which shares no code with ours."""

import math

import numpy as np
import pytest
import shapely
from hypothesis import given
from hypothesis import strategies as st

from porescale.builders.parts.frame_measures import clipped_area
from porescale.coupling.coverage.interpenetration import depth
from porescale.dem.bodies.frames import polygon_moments
from porescale.dem.measures.region import Region
from porescale.dem.prepare.tessellate import area, shrunk, voronoi
from tests.coupling.test_coupling_polygons import patch_of

EPS = np.finfo(float).eps
REACH = 10.0
"""Largest distance of a corner from the middle, here: cells, or m."""
seeds = st.integers(0, 2**32 - 1)


def convex(seed: int, places: float = 0.0) -> np.ndarray:
    """Corners (k, 2), counterclockwise, of a random convex polygon."""
    numbers = np.random.default_rng(seed)
    points = numbers.uniform(-0.7 * REACH, 0.7 * REACH, (12, 2)) * 10 ** numbers.uniform(-1, 0, 2)
    hull = shapely.convex_hull(shapely.multipoints(points + places * numbers.uniform(-1, 1, 2)))
    return np.array(shapely.orient_polygons(hull).exterior.coords)[:-1]


def star(seed: int) -> np.ndarray:
    """Corners (k, 2), counterclockwise, of a polygon that is not convex: random distances around its middle."""
    numbers = np.random.default_rng(seed)
    k = int(numbers.integers(4, 15))  # none half a turn from the next: the middle lies within
    way = 2 * math.pi * (np.arange(k) + numbers.uniform(0.1, 0.9, k)) / k
    return numbers.uniform(0.1, 1.0, k)[:, None] * REACH * np.column_stack((np.cos(way), np.sin(way)))


def rounding(corners: np.ndarray) -> float:
    """What sums over the corners may be off by: ten roundings of the box's area for each, in two sums."""
    return 2 * 10 * len(corners) * REACH**2 * EPS


@given(seeds)
def test_areas_and_centroids(seed):
    corners = star(seed)
    theirs = shapely.Polygon(corners)
    found, centroid, _ = polygon_moments(corners)
    assert found == pytest.approx(theirs.area, abs=rounding(corners))
    assert area(corners) == pytest.approx(theirs.area, abs=rounding(corners))
    # first moments are a length larger than areas, and divided by the area
    off = 3 * REACH * rounding(corners) / theirs.area
    assert centroid == pytest.approx(np.array(theirs.centroid.coords[0]), abs=off)


@given(seeds)
def test_covered_cells_are_intersections_with_them(seed):
    corner, fraction, body = patch_of(convex(seed), (7.3, 6.6), 0.4)
    # The corners that the kernel keeps count from the patch's left side, and from the centre's cell upwards.
    moved = shapely.Polygon(np.add(body._at, [0.0, 6 - corner[1]]))
    y, x = np.mgrid[: fraction.shape[0], : fraction.shape[1]]
    theirs = shapely.area(shapely.intersection(shapely.box(x, y, x + 1, y + 1), moved))
    # An edge's area is good to some ten roundings of places, and GEOS rounds the places where edges cross cells.
    size = 2 * REACH
    np.testing.assert_allclose(fraction, theirs, rtol=0, atol=2 * len(body._at) * 10 * size * EPS)
    assert fraction.sum() == pytest.approx(moved.area, abs=fraction.size * len(body._at) * 10 * size * EPS)


def test_another_outline_would_be_noticed():
    corner, fraction, body = patch_of(convex(1), (7.3, 6.6), 0.4)
    moved = shapely.Polygon(np.add(body._at, [1e-9, 6 - corner[1]]))  # a nanocell to the right
    y, x = np.mgrid[: fraction.shape[0], : fraction.shape[1]]
    theirs = shapely.area(shapely.intersection(shapely.box(x, y, x + 1, y + 1), moved))
    assert abs(fraction - theirs).max() > 2 * len(body._at) * 10 * 2 * REACH * EPS


@given(seeds, seeds)
def test_what_lies_in_a_region_is_the_intersection_with_it(seed, other):
    corners, numbers = star(seed), np.random.default_rng(other)
    lower, upper = np.sort(numbers.uniform(-1.2 * REACH, 1.2 * REACH, (2, 2)), axis=0)
    theirs = shapely.Polygon(corners).intersection(shapely.box(*lower, *upper))
    assert clipped_area(corners, Region(tuple(lower), tuple(upper))) == pytest.approx(
        theirs.area, abs=4 * rounding(corners)
    )


@given(seeds, seeds)
def test_polygons_lie_within_each_other_where_they_intersect(seed, other):
    one, two = convex(seed), convex(other, 2 * REACH)
    found, theirs = depth(one, two), shapely.Polygon(one).intersection(shapely.Polygon(two)).area
    near = 10 * REACH * EPS  # of places: closer than this either may say so
    assert (found > near) <= (theirs > 0.0)
    assert (theirs > REACH * near) <= (found > 0.0)
    gap = shapely.Polygon(one).distance(shapely.Polygon(two))
    assert -found <= gap + near  # the least way apart along a side's normal is never more than the distance


@given(seeds, st.floats(0.01, 0.9))
def test_a_polygon_shrunk_is_one_with_a_negative_buffer(seed, share):
    corners = convex(seed)
    inside = shapely.maximum_inscribed_circle(shapely.Polygon(corners)).length
    by = share * inside
    made = shrunk(corners, by)
    theirs = shapely.Polygon(corners).buffer(-by, join_style="mitre", mitre_limit=1e6)
    assert made is not None
    # Corners lie where two sides cross: at an angle of a between them their places are off by 1/sin(a) roundings.
    ahead = np.roll(corners, -1, axis=0) - corners
    ahead /= np.hypot(*ahead.T)[:, None]
    behind = np.roll(ahead, 1, axis=0)
    sine = abs(behind[:, 0] * ahead[:, 1] - behind[:, 1] * ahead[:, 0]).min()
    assert area(made) == pytest.approx(theirs.area, abs=10 * rounding(corners) / sine)


@given(seeds)
def test_voronoi_cells(seed):
    numbers = np.random.default_rng(seed)
    at = numbers.uniform(0.05, 0.95, (25, 2)) * [2.0, 1.0]
    frame = shapely.box(0.0, 0.0, 2.0, 1.0)
    theirs = shapely.get_parts(shapely.voronoi_polygons(shapely.multipoints(at), extend_to=frame))
    made = voronoi(at, (0.0, 0.0), (2.0, 1.0))
    assert len(made) == len(theirs) == 25
    for place, cell in zip(at, made, strict=True):
        (own,) = (it for it in theirs if it.contains(shapely.Point(place)))
        # Corners are centres of circles through three seeds: those of three that nearly lie on a line are far away and
        # badly known, which a billionth allows for; a seed that moves by a micrometre is noticed.
        assert area(cell) == pytest.approx(own.intersection(frame).area, abs=1e-9)
    assert sum(map(area, made)) == pytest.approx(2.0, abs=1e-9)
