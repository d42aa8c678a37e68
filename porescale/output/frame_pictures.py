"""Bodies of segments in pictures; cracks: lines where bonds are gone that bodies have not left yet."""

from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection, PolyCollection

from porescale.common.core.types import AnyArray
from porescale.common.pictures.look import Line, Look, length_unit
from porescale.common.pictures.repeated import shifts
from porescale.common.record.model import Cloud, Snapshot
from porescale.output.frame_clouds import BONDS

OPEN = 1.5
"""Bodies are shown as cracked off each other until they are this much further apart than when bonded."""
ALONE = 0.6
"""Length of the crack of a single bond, over the distance of what it held."""


def cracks(snapshot: Snapshot) -> list[Line]:
    """Lines of broken bonds between bodies that are still near, along their former contact.

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


def _through(points: AnyArray) -> Line:
    """Line between the two of the points (k, 2) that are furthest apart along their longest side."""
    axis = int(np.ptp(points, axis=0).argmax())
    return _line(points[points[:, axis].argmin()], points[points[:, axis].argmax()])


def _line(a: AnyArray, b: AnyArray) -> Line:
    return (float(a[0]), float(a[1])), (float(b[0]), float(b[1]))


def draw_frames(axes: Axes, frames: Cloud, look: Look, colours: Any, rims: Any) -> None:
    """Polygons filled, other segments as lines; ``colours`` and ``rims``: one for all, or one of each point."""
    assert look.view
    factor, _ = length_unit(look.view)
    offsets, corners = frames.polygons or (np.zeros(1, np.int64), np.zeros(0, np.int64))
    loops = [corners[a:b] for a, b in zip(offsets[:-1].tolist(), offsets[1:].tolist(), strict=True)]
    first = np.array([loop[0] for loop in loops], np.int64)
    one = isinstance(colours, str)
    faces, edges = (colours, rims) if one else (colours[first], np.asarray(rims)[first].tolist())
    for shift in shifts(frames, look):
        at = factor * (frames.position + shift)
        axes.add_collection(
            PolyCollection([at[loop] for loop in loops], facecolors=faces, edgecolors=edges, linewidths=0.6)
        )
        if frames.lines is not None and len(frames.lines):
            shade = rims if one else np.asarray(rims)[frames.lines[:, 0]].tolist()
            axes.add_collection(LineCollection(list(at[frames.lines]), colors=shade, linewidths=2.0, capstyle="round"))
