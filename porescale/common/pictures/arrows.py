"""Arrows of the velocity on a regular raster, of a grid or of dots, in metres."""

import numpy as np

from porescale.common.core.types import AnyArray
from porescale.common.pictures.look import Survey
from porescale.common.record.model import Cloud, Grid, Snapshot

SPECK = 0.09
"""Arrows shorter than this share of the raster are left out."""


def arrows(snapshot: Snapshot, found: Survey) -> AnyArray:
    """Outlines of the arrows, (n, 7, 2) m: so many across the view as the look says, one of the survey's fastest as
    long as the raster is wide; none where nothing moves but by round-off."""
    look = found.look
    grid, cloud = look.painted(snapshot), look.drawn(snapshot)
    if not look.arrows or not found.fastest:
        return np.zeros((0, 7, 2))
    left, right, bottom, top = found.view
    pitch = (right - left) / look.arrows
    x = left + pitch * (np.arange(look.arrows) + 0.5)
    y = np.arange(bottom + 0.5 * pitch, top, pitch)
    if grid is not None and "velocity" in grid.cells:
        middle, velocity = _of_grid(grid, x, y)
    elif cloud is not None and "velocity" in cloud.data:
        middle, velocity = _of_cloud(cloud, (left, bottom, pitch), (len(y), len(x)))
    else:
        return np.zeros((0, 7, 2))
    along = 0.9 * pitch / found.fastest * velocity
    length = np.hypot(along[:, 0], along[:, 1])
    seen = length > SPECK * pitch
    middle, along, length = middle[seen], along[seen] / length[seen, None], np.minimum(length[seen], pitch)[:, None]
    half, head = 0.045 * length + 0.013 * pitch, 0.36 * length
    profile = [(0 * length, half), (length - head, half), (length - head, 3.2 * half), (length, 0 * length)]
    points = [*profile, *((way, -side) for way, side in profile[2::-1])]
    across = np.column_stack((-along[:, 1], along[:, 0]))
    return np.stack([middle + (way - length / 2) * along + side * across for way, side in points], axis=1)


def _of_grid(grid: Grid, x: AnyArray, y: AnyArray) -> tuple[AnyArray, AnyArray]:
    """Points (n, 2) m of a raster that lie in a grid, and the velocity (n, 2) of their cells."""
    (ny, nx), (left, _, bottom, _) = grid.shape, grid.extent
    column = np.floor((x - left) / grid.spacing[0]).astype(int)
    row = np.floor((y - bottom) / grid.spacing[1]).astype(int)
    (x, column), (y, row) = ((at[inside], cell[inside]) for at, cell, inside in (
        (x, column, (column >= 0) & (column < nx)), (y, row, (row >= 0) & (row < ny))))  # fmt: skip
    middle = np.stack(np.meshgrid(x, y), axis=-1).reshape(-1, 2)
    return middle, np.asarray(grid.cells["velocity"][np.ix_(row, column)], float)[..., :2].reshape(-1, 2)


def _of_cloud(cloud: Cloud, raster: tuple[float, float, float], shape: tuple[int, int]) -> tuple[AnyArray, AnyArray]:
    """Mean places and velocities of the points in each square of a raster (left, bottom, side), where there are any."""
    left, bottom, pitch = raster
    place = np.floor((cloud.position - (left, bottom)) / pitch)
    good = np.isfinite(place).all(1) & (place >= 0).all(1) & (place < (shape[1], shape[0])).all(1)
    square = (place[good, 1] * shape[1] + place[good, 0]).astype(int)
    count = np.bincount(square, minlength=shape[0] * shape[1])
    own = np.column_stack((cloud.position, np.asarray(cloud.data["velocity"], float)[:, :2]))[good]
    means = np.stack([np.bincount(square, it, len(count)) for it in own.T], axis=1) / np.maximum(count, 1)[:, None]
    return means[count > 0, :2], means[count > 0, 2:]
