"""The virtual camera: tracers carried by a run's flow, filmed like those of a laboratory."""

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from porescale.common.core.errors import Fault, InputError
from porescale.common.core.ranges import Range
from porescale.common.core.types import Floats
from porescale.common.record.open_run import Run
from porescale.piv import given
from porescale.piv.images.flows import Discs
from porescale.piv.images.moving import Between, Instant, grid_of, instant
from porescale.piv.images.spots import add_spots, coverage
from porescale.piv.images.synth import Camera, Picture

BIN = 16
"""px: where fewer tracers than half the due number are in a square of this side it is filled up, a third over:
thinned.
"""
THIN, THICK = 0.5, 1.5
"""Shares of the due number of tracers below and above which a square is filled up and thinned out."""
GREYS = {"bright": 180.0, "dark": 4.0}
"""Grey levels of solids."""
SIDE = 1024
"""px of the longer side of a picture, where nothing else is given."""
LARGEST = 4096
"""px a side, at most."""
LONGEST = 100_000
"""Frames of a film, at most."""
ROUNDING = 1e-9
"""Share of an interval by which rounding may move the last frame beyond the end."""


@dataclass(frozen=True)
class Shooting:
    """How a run is filmed.

    camera : how tracers and grains look; its size follows from the run;  scale : m a pixel;  interval : s between
    frames; start, end : s, of the run;  exposure : share of the interval that the shutter is open;  seed.
    """

    camera: Camera
    scale: float
    interval: float
    start: float
    end: float
    exposure: float = 0.0
    seed: int = 0


@dataclass(frozen=True)
class Frame:
    """A frame: its time, s, the picture and where it is solid, (rows, columns), row 0 on top."""

    time: float
    picture: Picture
    solid: NDArray[np.bool_]


def fastest(run: Run, start: float, end: float) -> tuple[float, float]:
    """A pixel's length, m, that makes the longer side SIDE px, and the fluid's largest speed from start to end, m/s.

    InputError where the fluid is at rest all the time.
    """
    grid = grid_of(run)
    longer = max(side * step for side, step in zip(grid.shape[::-1], grid.spacing, strict=True))
    speed = 0.0
    for k in np.nonzero((run.times >= start) & (run.times <= end))[0]:
        for it in run.snapshot(int(k), ("velocity",)).grids.values():
            if "velocity" in it.cells:
                speed = max(speed, float(np.hypot(it.cells["velocity"][..., 0], it.cells["velocity"][..., 1]).max()))
    if speed <= 0:
        raise InputError(Fault("run folder", str(run.folder), "the fluid is at rest: there is no flow to film"))
    return longer / SIDE, speed


def shot_of(
    run: Run,
    camera: Camera,
    *,
    scale: float | None = None,
    interval: float | None = None,
    start: float | None = None,
    end: float | None = None,
    exposure: float = 0.0,
    seed: int = 0,
) -> Shooting:
    """How a run is filmed where not all is given: the whole run, SIDE px the longer side, 4 px of the fastest flow
    between frames, the whole time if that is less.  InputError where the times are not within the run, or there is
    nothing to film.
    """
    first, last = (float(it) for it in run.times[[0, -1]]) if len(run) else (0.0, 0.0)
    begin, stop = first if start is None else start, last if end is None else end
    if not first <= begin < stop <= last:
        text = f"{begin:g} to {stop:g}"
        raise InputError(Fault("--start, --end", text, "is not within the run", "s", f"{first:g} to {last:g}"))
    pixel, speed = fastest(run, begin, stop)
    pixel = pixel if scale is None else scale
    pause = min(4 * pixel / speed, stop - begin) if interval is None else interval
    return shooting(run, Shooting(camera, pixel, pause, begin, stop, exposure, seed))


def shooting(run: Run, shot: Shooting) -> Shooting:
    """``shot`` with the picture's size from the run's domain.  InputError where there is nothing to film."""
    grid = grid_of(run)
    (dx, dy), (ny, nx) = grid.spacing, grid.shape
    most = 1e9 * shot.scale  # far out of bounds, but a whole number of pixels
    size = tuple(round(min(side, most) / shot.scale) if shot.scale > 0 else 0 for side in (ny * dy, nx * dx))
    faults = []
    if min(size) < 32 or max(size) > LARGEST:
        sides = f"gives pictures of {size[1]} x {size[0]} px, and 32 to {LARGEST} a side are allowed"
        longer, shorter = max(ny * dy, nx * dx), min(ny * dy, nx * dx)
        least, most = longer / LARGEST, shorter / 32
        faults.append(Fault("--scale", shot.scale, sides, "m", f"{least:.3g} to {most:.3g}" if least <= most else ""))
    span = shot.end - shot.start
    if not 0 < shot.interval <= span * (1 + ROUNDING):
        problem = "leaves fewer than two frames between --start and --end"
        faults.append(Fault("--interval", shot.interval, problem, "s", f"above 0 to {span:.6g}"))
    elif span / shot.interval > LONGEST:
        problem = f"makes more than {LONGEST} frames between --start and --end"
        faults.append(Fault("--interval", shot.interval, problem, "s", "", "take a longer one"))
    given.refuse(
        faults,
        given.within("--exposure", shot.exposure, Range(ge=0, le=1)),
        given.within("--seed", shot.seed, Range(ge=0, whole=True)),
    )
    camera = replace(shot.camera, size=(size[0], size[1]))
    camera.check()
    return replace(shot, camera=camera)


def frames(run: Run, shot: Shooting) -> Iterator[Frame]:
    """The film, a frame at a time; no more than two snapshots are in memory.

    ``shot`` : of ``shooting``.  Tracers follow the flow between snapshots, straight in time; they leave the picture
    and come in at its edges by filling up, never lie in grains, and are as dense everywhere, within THIN and THICK.
    """
    random = np.random.default_rng(shot.seed)
    times = run.times
    index = int(np.clip(np.searchsorted(times, shot.start, side="right") - 1, 0, max(0, len(times) - 2)))
    pair = _pair(run, index)
    tracers = _Tracers(pair.first, shot, random)
    count = int(np.floor((shot.end - shot.start) / shot.interval + ROUNDING)) + 1
    now = shot.start
    tracers.even(pair, now)
    for number in range(count):
        due = shot.start + number * shot.interval
        while now < due:
            if now >= pair.second.time and index + 2 < len(times):
                index += 1
                pair = Between(pair.second, _instant(run, index + 1))
            stop = min(due, pair.second.time) if index + 2 < len(times) else due
            tracers.x, tracers.y = pair.carried(tracers.x, tracers.y, now, stop)
            now = stop
        tracers.even(pair, now)
        picture, solid = tracers.exposed(pair, now)
        yield Frame(now, picture, solid)


def _pair(run: Run, index: int) -> Between:
    """Snapshot ``index`` and the next one (itself where there is none)."""
    first = _instant(run, index)
    return Between(first, _instant(run, index + 1) if index + 1 < len(run) else first)


def _instant(run: Run, index: int) -> Instant:
    return instant(run.snapshot(index), str(run.folder))


class _Tracers:
    """Tracers of a film: x, y (n,) m, light (n,) grey levels."""

    def __init__(self, first: Instant, shot: Shooting, random: np.random.Generator) -> None:
        self.shot, self.random, self.origin = shot, random, first.origin
        self.x, self.y, self.light = np.empty(0), np.empty(0), np.empty(0)

    def pixels(self, x: Floats, y: Floats) -> tuple[Floats, Floats]:
        """Columns and rows, px, of points in metres."""
        (left, low), scale = self.origin, self.shot.scale
        return (x - left) / scale - 0.5, self.shot.camera.size[0] - 0.5 - (y - low) / scale

    def even(self, pair: Between, time: float) -> None:
        """Drop what left the picture, fill thin squares up and thin thick ones out, at random."""
        camera, scale = self.shot.camera, self.shot.scale
        rows, columns = camera.size
        column, row = self.pixels(self.x, self.y)
        kept = (column > -0.5) & (column < columns - 0.5) & (row > -0.5) & (row < rows - 0.5)
        self._keep(kept)
        down, across = -(-rows // BIN), -(-columns // BIN)
        free_share = self._open(pair, time)
        due = camera.density * BIN * BIN * free_share
        column, row = self.pixels(self.x, self.y)
        box = (row + 0.5).astype(int) // BIN * across + (column + 0.5).astype(int) // BIN
        counts = np.bincount(box, minlength=down * across)
        chance = np.where(counts > THICK * due, due / np.maximum(counts, 1), 1.0)
        self._keep(self.random.uniform(size=len(box)) < chance[box])
        # What is seeded in a solid is lost, so that more is thrown into squares that solids share.
        missing = np.where(counts < THIN * due, (due - counts) / np.maximum(free_share, 1 / 9), 0.0)
        number = self.random.poisson(np.maximum(missing, 0.0))
        where = np.repeat(np.arange(down * across), number)
        column = (where % across + self.random.uniform(size=len(where))) * BIN - 0.5
        row = (where // across + self.random.uniform(size=len(where))) * BIN - 0.5
        x = self.origin[0] + (column + 0.5) * scale
        y = self.origin[1] + (rows - 0.5 - row) * scale
        free = (column < columns - 0.5) & (row < rows - 0.5) & ~pair.solid_at(x, y, time)
        self.x, self.y = np.r_[self.x, x[free]], np.r_[self.y, y[free]]
        fall = np.exp(-camera.sheet * self.random.uniform(-1, 1, int(free.sum())) ** 2)
        self.light = np.r_[self.light, camera.peak * fall]

    def _open(self, pair: Between, time: float) -> Floats:
        """Share of each square, by rows, that is free of solids: nine points of it."""
        rows, columns = self.shot.camera.size
        down, across = -(-rows // BIN), -(-columns // BIN)
        part = (np.arange(3) + 0.5) / 3 * BIN
        row = (np.arange(down)[:, None] * BIN + part).ravel()
        column = (np.arange(across)[:, None] * BIN + part).ravel()
        x = self.origin[0] + column * self.shot.scale
        y = self.origin[1] + (rows - row) * self.shot.scale
        x, y = np.meshgrid(x, y)
        solid = pair.solid_at(x, y, time)
        solid |= (row > rows)[:, None] | (column > columns)
        return np.asarray(1 - solid.reshape(down, 3, across, 3).mean((1, 3)).ravel())

    def _keep(self, kept: NDArray[np.bool_]) -> None:
        self.x, self.y, self.light = self.x[kept], self.y[kept], self.light[kept]

    def exposed(self, pair: Between, time: float) -> tuple[Picture, NDArray[np.bool_]]:
        """The picture and its solid pixels; tracers move while the shutter is open."""
        shot, camera = self.shot, self.shot.camera
        image = np.full(camera.size, camera.background)
        open_ = shot.exposure * shot.interval
        u, v = pair.flow(self.x, self.y, time)
        streak = float(np.hypot(u, v).max(initial=0.0)) * open_ / shot.scale
        parts = max(1, int(np.ceil(2 * streak)))  # half a pixel apart
        for k in range(parts):
            away = ((k + 0.5) / parts - 0.5) * open_
            add_spots(
                *self.pixels(self.x + away * u, self.y + away * v), self.light / parts, camera.diameter / 4, image
            )
        share = np.zeros(camera.size)
        grains = pair.grains(time)
        at = self.pixels(grains.x, grains.y)
        coverage(Discs(*at, grains.radius / shot.scale), share)
        np.maximum(share, self._others(pair, time), out=share)
        image = image * (1 - share) + camera.disc * share + self.random.normal(0.0, camera.noise, camera.size)
        return np.clip(np.rint(image), 0, 255).astype(np.uint8), share > 0.5

    def _others(self, pair: Between, time: float) -> Floats:
        """1 in pixels of solids that are no grains."""
        rows, columns = self.shot.camera.size
        x = self.origin[0] + (np.arange(columns) + 0.5) * self.shot.scale
        y = self.origin[1] + (rows - 0.5 - np.arange(rows)) * self.shot.scale
        x, y = np.meshgrid(x, y)
        near = pair.first if pair.share(time) < 0.5 else pair.second
        return np.asarray(near.solid_at(x, y), float)
