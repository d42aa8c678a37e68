"""What measures of grains need of bodies of segments: their exact area in a region, and which bodies touch."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from porescale.builders.initial.frames import Placed, disc_count, free_rows
from porescale.common.core.types import Floats
from porescale.dem.bodies.frames import polygon_moments
from porescale.dem.bodies.rigid import areas, body_of
from porescale.dem.grains import Grains
from porescale.dem.measures.contact_list import nearest_image
from porescale.dem.measures.region import Region


def coordination_of_bodies(grains: Grains, placed: Sequence[Placed], held: int) -> float:
    """Mean number of other bodies that touch a grain, clump, polygon or segment that forces move.

    Two faces that touch at several points are one neighbour; walls are none, containers and held discs are.
    """
    number = body_of(grains)
    near = np.unique(np.sort(number[touching(grains)], axis=1), axis=0)
    free = np.unique(number[free_rows(grains, placed, held)])
    return float(np.isin(near, free).sum() / len(free)) if len(free) else 0.0


def touching(grains: Grains) -> NDArray[np.int64]:
    """Pairs of discs (c, 2) that touch, a segment as the disc at its first end; corners by the segments there."""
    d, pairs = grains.discs, grains.current_pairs()
    i, j = np.repeat(np.arange(d.count), np.diff(pairs.start)), pairs.partner.astype(np.int64)
    apart = np.hypot(*nearest_image(d.position[j] - d.position[i], grains.period).T)
    near = apart < d.radius[i] + d.radius[j]
    found = [np.column_stack((i[near], j[near]))]
    if grains.segments is not None:
        point, segment = grains.segments.near.T
        a, b = grains.segments.ends[segment].T
        way = d.position[b] - d.position[a]
        gone = nearest_image(d.position[point] - d.position[a], grains.period)
        share = np.clip(np.sum(gone * way, axis=1) / np.sum(way * way, axis=1), 0.0, 1.0)
        near = np.hypot(*(gone - share[:, None] * way).T) < d.radius[point] + d.radius[a]
        found.append(np.column_stack((point[near], a[near])))
    return np.concatenate(found)


def solid_in(grains: Grains, placed: Sequence[Placed], region: Region) -> float:
    """Area (m^2) of all frames in a region, periodic images too: polygons exactly, rods at the share of their ends in
    it.

    Their thickness is not counted, as it has no mass.
    """
    first, total, period = disc_count(grains), 0.0, grains.period
    for it in placed:
        at = grains.discs.position[first : first + len(it.frame.corners)]
        first += len(it.frame.corners)
        area = it.frame.mass_properties().area or 0.0
        if _solid(it):
            at = at[it.frame.loop] + region.near(at[:1], period) - at[:1]
            for shift in region.shifts(at, at, period):
                total += clipped_area(at + shift, region)
        elif it.free:
            total += area * float(np.mean(region.holds(at, period)))
    return total


def solid_areas(grains: Grains, placed: Sequence[Placed]) -> Floats:
    """Area that each disc stands for, (n,) m^2: corners of the frames that ``solid_in`` counts have shares of theirs,
    others none, as containers, which are walls."""
    found, first = areas(grains), disc_count(grains)
    for it in placed:
        own = slice(first, first + len(it.frame.corners))
        first = own.stop
        if not (_solid(it) or it.free):
            found[own] = 0.0
    return found


def _solid(placed: Placed) -> bool:
    """Whether a frame is solid within its outline: a polygon, no container."""
    return placed.frame.closed and placed.kind != "container"


def clipped_area(corners: Floats, region: Region) -> float:
    """Area (m^2) of a polygon (k, 2) m within a region: cut by its four sides, one after the other.

    Source: Sutherland & Hodgman 1974; parts of one that is not convex are joined by lines without area.
    """
    left = corners
    for axis in range(2):
        for side, sense in ((region.lower[axis], 1.0), (region.upper[axis], -1.0)):
            depth = sense * (left[:, axis] - side)
            kept = []
            for k in range(len(left)):
                if (depth[k - 1] > 0.0) != (depth[k] > 0.0):
                    share = depth[k - 1] / (depth[k - 1] - depth[k])
                    kept.append(left[k - 1] + share * (left[k] - left[k - 1]))
                if depth[k] > 0.0:
                    kept.append(left[k])
            if len(kept) < 3:
                return 0.0
            left = np.array(kept)
    area, _, _ = polygon_moments(left)
    return area
