"""Cracks of a run with bonds, for pictures and films: lines where bonds are gone that the bodies have not left yet."""

from __future__ import annotations

import numpy as np

from porescale.runs.look import Line
from porescale.runs.model import Array, Snapshot
from porescale.scene.bonds import BONDS

OPEN = 1.5
"""Bodies are shown as cracked off each other until they are this much further apart than when bonded."""
ALONE = 0.6
"""Length of the crack of a single bond, over the distance of what it held."""


def cracks(snapshot: Snapshot) -> list[Line]:
    """Where bonds broke between bodies that are still near: along what touched.

    The bonds of two polygons stand at the ends of their common side: the crack goes from one to the other.  A single
    bond is a line across it.
    """
    cloud = snapshot.clouds.get(BONDS)
    if cloud is None or not len(cloud.position):
        return []
    ends = cloud.position.reshape(-1, 2, 2)
    data = {name: np.asarray(values)[::2] for name, values in cloud.data.items()}
    middle, way = ends.mean(axis=1), ends[:, 1] - ends[:, 0]
    length = np.hypot(*way.T)
    names = "first_kind", "first_number", "second_kind", "second_number"
    both = np.column_stack([data[name] for name in names]).reshape(-1, 2, 2)
    pairs = np.array([sorted(row) for row in both.tolist()]).reshape(-1, 4)
    near = length < OPEN * np.median(length)
    gone = np.flatnonzero((data["whole"] == 0) & near)
    found: list[Line] = []
    for pair in np.unique(pairs[gone], axis=0):
        own = gone[np.all(pairs[gone] == pair, axis=1)]
        if len(own) > 1:
            found.append(_through(middle[own]))
        else:
            k = int(own[0])
            across = ALONE * 0.5 * np.array([-way[k, 1], way[k, 0]])
            found.append(_line(middle[k] - across, middle[k] + across))
    return found


def _through(points: Array) -> Line:
    """From one of the points (k, 2) to the other that are furthest apart along their longest side."""
    axis = int(np.ptp(points, axis=0).argmax())
    return _line(points[points[:, axis].argmin()], points[points[:, axis].argmax()])


def _line(a: Array, b: Array) -> Line:
    return (float(a[0]), float(a[1])), (float(b[0]), float(b[1]))
