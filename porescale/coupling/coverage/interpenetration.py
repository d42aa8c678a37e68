"""Whether convex polygons lie within each other, or discs in them.

Those in contact keep a film between them, and contacts push where corners touch sides within that film.  A body beyond
it is pushed no more: forces do not show that, so the outlines are compared.
"""

from collections.abc import Sequence

import numpy as np

from porescale.common.core.errors import Unstable
from porescale.common.core.types import Reals
from porescale.coupling.immersed_polygons import ImmersedPolygons
from porescale.dem.grains import Grains

CAUSE = "raise the stiffness, or shorten the contact step"


def depth(one: Reals, other: Reals) -> float:
    """How far convex polygons, corners (k, 2) m, or one and a point, would have to be moved apart, m; <= 0 if they are.

    Least overlap of their shadows on the normals of all sides (separating axes: Gottschalk, Lin & Manocha 1996).
    """
    least = np.inf
    for sides in (one, other)[: 1 + (len(other) > 1)]:
        along = np.roll(sides, -1, axis=0) - sides
        normal = np.column_stack((along[:, 1], -along[:, 0])) / np.hypot(along[:, 0], along[:, 1])[:, None]
        first, second = one @ normal.T, other @ normal.T
        overlap = np.minimum(first.max(axis=0) - second.min(axis=0), second.max(axis=0) - first.min(axis=0))
        least = min(least, float(overlap.min()))
    return least


def require_apart(polygons: ImmersedPolygons, grains: Grains, step: int, time: float) -> None:
    """Unstable where two of the ``polygons`` lie within each other, or the centre of a disc within one."""
    place, turned = polygons.position, polygons.angle
    reach = np.array([np.hypot(each[:, 0], each[:, 1]).max() for each in polygons.outlines])
    for n in range(len(reach)):
        near = _beside(place[n], place[n + 1 :], reach[n] + reach[n + 1 :], grains.box.period)
        for m, away in near:
            other = n + 1 + m
            deep = depth(_at(polygons.outlines[n], turned[n], 0.0), _at(polygons.outlines[other], turned[other], away))
            if deep > 0.0:
                raise Unstable(
                    f"polygon {n}", f"overlap with polygon {other}", deep, "m", step, time, CAUSE
                )  # fmt: skip
    discs = np.flatnonzero(grains.discs.radius > 0.0)
    if grains.segments is not None:
        discs = discs[~np.asarray(grains.segments.is_corner, bool)[discs]]
    for n in range(len(reach)):
        for m, away in _beside(
            place[n], grains.discs.position[discs], np.full(len(discs), reach[n]), grains.box.period
        ):
            deep = depth(_at(polygons.outlines[n], turned[n], 0.0), np.asarray(away)[None])
            if deep > 0.0:
                raise Unstable(
                    f"grain {discs[m]}", f"depth of its centre in polygon {n}", deep, "m", step, time, CAUSE
                )  # fmt: skip


def _at(outline: Reals, angle: float, place: Reals | float) -> Reals:
    """Corners (k, 2) m of a body turned by ``angle`` (rad)."""
    cosine, sine = np.cos(angle), np.sin(angle)
    return np.asarray(outline @ np.array([[cosine, sine], [-sine, cosine]]) + place)


def _beside(place: Reals, others: Reals, reach: Reals, period: Sequence[float]) -> list[tuple[int, Reals]]:
    """(number, vector from ``place``) of ``others`` (m, 2) m within ``reach`` (m,) m, nearest images."""
    away = others - place
    for axis in range(2):
        if period[axis] > 0.0:
            away[:, axis] -= period[axis] * np.round(away[:, axis] / period[axis])
    found = np.flatnonzero(np.hypot(away[:, 0], away[:, 1]) < reach)
    return [(int(m), away[m]) for m in found]
