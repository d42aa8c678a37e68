"""A run as something to film: its velocity and its solids at any place and time between snapshots."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import map_coordinates, spline_filter
from scipy.spatial import cKDTree

from porescale.common.core.errors import Fault, InputError
from porescale.common.core.types import Floats
from porescale.common.record.model import Cloud, Grid, Snapshot
from porescale.common.record.open_run import Run
from porescale.piv.images.flows import NO_DISCS, Discs

SOLID = 0.5
"""Solid fraction from which a place is solid."""


@dataclass(frozen=True)
class Instant:
    """One snapshot, made ready.

    velocity : spline coefficients of u, v (2, ny, nx), m/s;  solid : solid fraction (ny, nx) of what is no grain;
    grains : discs, m;  motion : their velocities (n, 2) m/s;
    origin, spacing : of the cells, m;  time : s.
    """

    time: float
    velocity: Floats
    solid: Floats
    grains: Discs
    motion: Floats
    origin: tuple[float, float]
    spacing: tuple[float, float]

    def places(self, x: Floats, y: Floats) -> Floats:
        """Rows and columns, in cells, of points in metres."""
        (left, low), (dx, dy) = self.origin, self.spacing
        return np.stack([(y - low) / dy - 0.5, (x - left) / dx - 0.5])

    def flow(self, x: Floats, y: Floats) -> tuple[Floats, Floats]:
        """Velocity, m/s, by cubic splines through the cells' centres."""
        at = self.places(x, y)
        u, v = (map_coordinates(it, at, order=3, prefilter=False, mode="nearest") for it in self.velocity)
        return u, v

    def solid_at(self, x: Floats, y: Floats) -> NDArray[np.bool_]:
        """Whether points lie in solids that are no grains: where their fraction is above one half."""
        return np.asarray(map_coordinates(self.solid, self.places(x, y), order=1, mode="nearest") > SOLID)


class Between:
    """Two snapshots and what is between them, straight in time: velocity, and grains on their way.

    A grain whose way fits the mean of its two velocities better if it is a whole picture longer or shorter has crossed
    a periodic side: it leaves at one side and comes in at the other.
    """

    def __init__(self, first: Instant, second: Instant) -> None:
        self.first, self.second = first, second
        self.same = len(first.grains.x) == len(second.grains.x)
        self._way, self._round = ways(first, second) if self.same else (np.zeros((0, 2)), np.zeros((0, 2)))
        self._crossing = np.flatnonzero(self._round.any(axis=1))

    def share(self, time: float) -> float:
        """How far ``time`` is from the first to the second, 0 to 1."""
        span = self.second.time - self.first.time
        return min(1.0, max(0.0, (time - self.first.time) / span)) if span > 0 else 0.0

    def flow(self, x: Floats, y: Floats, time: float) -> tuple[Floats, Floats]:
        """Velocity at points and a time, m/s."""
        s = self.share(time)
        (a, b), (c, d) = self.first.flow(x, y), self.second.flow(x, y)
        return a + s * (c - a), b + s * (d - b)

    def grains(self, time: float) -> Discs:
        """The grains at a time, m."""
        s = self.share(time)
        if not self.same:
            return (self.first if s < 0.5 else self.second).grains
        one, over = self.first.grains, self._crossing
        x, y = one.x + s * self._way[:, 0], one.y + s * self._way[:, 1]
        if not len(over):
            return Discs(x, y, one.radius)
        again = self._round[over]
        return Discs(
            np.r_[x, x[over] - again[:, 0]], np.r_[y, y[over] - again[:, 1]], np.r_[one.radius, one.radius[over]]
        )

    def solid_at(self, x: Floats, y: Floats, time: float) -> NDArray[np.bool_]:
        """Whether points lie in grains, or in other solids of the nearer snapshot."""
        near = self.first if self.share(time) < 0.5 else self.second
        found = near.solid_at(x, y)
        grains = self.grains(time)
        if len(grains.x) and x.size:
            far, which = nearest(x.ravel(), y.ravel(), grains)
            found = found | (far < grains.radius[which]).reshape(x.shape)
        return found

    def carried(self, x: Floats, y: Floats, start: float, end: float) -> tuple[Floats, Floats]:
        """Positions at ``end`` s of points at ``start`` s: Runge-Kutta of fourth order, half a cell a step, out of
        grains.
        """
        u, v = self.flow(x, y, start)
        fastest = float(np.hypot(u, v).max(initial=0.0))
        steps = max(1, int(np.ceil(2 * fastest * (end - start) / min(self.first.spacing))))
        h = (end - start) / steps
        for k in range(steps):
            t = start + k * h
            u1, v1 = self.flow(x, y, t)
            u2, v2 = self.flow(x + h / 2 * u1, y + h / 2 * v1, t + h / 2)
            u3, v3 = self.flow(x + h / 2 * u2, y + h / 2 * v2, t + h / 2)
            u4, v4 = self.flow(x + h * u3, y + h * v3, t + h)
            x = x + h / 6 * (u1 + 2 * u2 + 2 * u3 + u4)
            y = y + h / 6 * (v1 + 2 * v2 + 2 * v3 + v4)
            x, y = pushed_out(x, y, self.grains(t + h))
        return x, y


def ways(first: Instant, second: Instant) -> tuple[Floats, Floats]:
    """How far each grain goes from one snapshot to the next (n, 2) m, and what of it is a whole picture (n, 2) m."""
    one, two = first.grains, second.grains
    straight = np.column_stack([two.x - one.x, two.y - one.y])
    expected = 0.5 * (first.motion + second.motion) * (second.time - first.time)
    rows, columns = first.solid.shape
    picture = np.array([columns * first.spacing[0], rows * first.spacing[1]])
    crossed = np.clip(np.rint((expected - straight) / picture), -1, 1) * picture
    return straight + crossed, crossed


def instant(snapshot: Snapshot, folder: str) -> Instant:
    """A snapshot made ready; InputError for a run without a fluid."""
    grid = velocity_grid(snapshot, folder)
    velocity = np.asarray(grid.cells["velocity"], float)
    filtered = np.stack([spline_filter(velocity[..., k], 3, mode="nearest") for k in (0, 1)])
    solid = np.array(grid.cells.get("solid_fraction", np.zeros(grid.shape)), float)
    grains, motion = grains_of(snapshot), motion_of(snapshot)
    rows, columns = np.nonzero(solid > 0)
    if len(rows) and len(grains.x):
        x = np.asarray(grid.origin[0] + (columns + 0.5) * grid.spacing[0], float)
        y = np.asarray(grid.origin[1] + (rows + 0.5) * grid.spacing[1], float)
        far, which = nearest(x, y, grains)
        own = far < grains.radius[which] + 1.5 * max(grid.spacing)
        solid[rows[own], columns[own]] = 0
    return Instant(snapshot.time, filtered, solid, grains, motion, grid.origin, grid.spacing)


def grains_of(snapshot: Snapshot) -> Discs:
    """The discs of a snapshot, m."""
    for cloud in _discs_of(snapshot):
        at = np.asarray(cloud.position, float)
        return Discs(at[:, 0].copy(), at[:, 1].copy(), np.asarray(cloud.data["radius"], float))
    return NO_DISCS


def motion_of(snapshot: Snapshot) -> Floats:
    """Velocities (n, 2) m/s of the discs of a snapshot, 0 where it has none."""
    for cloud in _discs_of(snapshot):
        if "velocity" in cloud.data:
            return np.array(cloud.data["velocity"], float)[:, :2]
        return np.zeros((len(cloud.position), 2))
    return np.zeros((0, 2))


def _discs_of(snapshot: Snapshot) -> list[Cloud]:
    """The clouds of a snapshot that are discs; the first counts."""
    return [cloud for cloud in snapshot.clouds.values() if "radius" in cloud.data]


def pushed_out(x: Floats, y: Floats, grains: Discs) -> tuple[Floats, Floats]:
    """Points inside grains moved to the nearest rim; others as they are."""
    if not len(grains.x) or not len(x):
        return x, y
    near, which = nearest(x, y, grains)
    inside = np.nonzero(near < grains.radius[which])[0]
    if not len(inside):
        return x, y
    x, y = x.copy(), y.copy()
    disc = which[inside]
    dx, dy = x[inside] - grains.x[disc], y[inside] - grains.y[disc]
    scale = grains.radius[disc] / np.maximum(np.hypot(dx, dy), 1e-300)
    x[inside], y[inside] = grains.x[disc] + scale * dx, grains.y[disc] + scale * dy
    return x, y


def nearest(x: Floats, y: Floats, grains: Discs) -> tuple[Floats, NDArray[np.int64]]:
    """Distance to the centre, and the number, of the grain whose rim is nearest to each point, of its four nearest."""
    tree = cKDTree(np.column_stack([grains.x, grains.y]))
    count = min(4, len(grains.x))
    far, which = tree.query(np.column_stack([x, y]), k=count)
    far, which = far.reshape(len(x), count), which.reshape(len(x), count)
    best = np.argmin(far - grains.radius[which], 1)
    rows = np.arange(len(x))
    return far[rows, best], which[rows, best]


def grid_of(run: Run) -> Grid:
    """The grid of a run's first snapshot that carries a velocity.  InputError if there is none."""
    run.require_snapshots()
    return velocity_grid(run.snapshot(0, ("velocity",)), str(run.folder))


def velocity_grid(snapshot: Snapshot, folder: str) -> Grid:
    """The grid of a snapshot that carries a velocity.  InputError if there is none."""
    for grid in snapshot.grids.values():
        if "velocity" in grid.cells:
            return grid
    raise InputError(Fault("run folder", folder, "has no velocity of a fluid: there is no flow to film or to compare"))
