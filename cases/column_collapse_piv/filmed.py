"""Runs of the tank and the box filmed at 60 frames a second, measured, and held against the lattice's own velocity."""

from collections.abc import Iterator
from dataclasses import dataclass, replace
from itertools import pairwise
from pathlib import Path

import numpy as np

from porescale import Floats, Run, open_run
from porescale.piv.estimate import Settings, measure
from porescale.piv.fields import Field, Vortex, field_of_run, in_metres, in_pixels, vortices
from porescale.piv.images import Camera, Shooting, frames, shooting

RATE = 60.0
"""Frames a second, as in the experiment."""
ACROSS = 800
"""px of the width of a picture."""
SETTINGS = Settings(window=16, search=32)
STIRS, FLOWS = 0.01, 0.05
"""m/s: mean speeds of the water left of the column from which it is said to move, and to go with the column."""
CALM = 0.2
"""Share of the strongest vortex below which others are not looked at."""


@dataclass(frozen=True)
class Place:
    """Where to look in a box.  strip : left, right, m, of the water left of the column;  opens : s, of the gate."""

    strip: tuple[float, float]
    top: float
    opens: float


TANK = Place((0.12, 0.145), 0.12, 0.05)
BOX = Place((0.07, 0.09), 0.072, 0.0)


def film(
    run: Run, start: float, end: float, rate: float = RATE, camera: Camera | None = None
) -> Iterator[tuple[float, Field]]:
    """Mid time and measured field of every pair of frames, m and m/s, one pair in memory at a time."""
    scale = run.card["scene"]["domain"]["width"] / ACROSS
    shot = shooting(run, Shooting(camera or Camera(), scale, 1 / rate, start, end))
    for first, second in pairwise(frames(run, shot)):
        vectors = measure(first.picture, second.picture, (first.solid, second.solid), SETTINGS)
        yield 0.5 * (first.time + second.time), in_metres(in_pixels(vectors), shot.camera.size[0], scale, 1 / rate)


def lattice(folder: Path, time: float, like: Field | None = None, step: float = 2e-3) -> Field:
    """The lattice's velocity at a time, means over squares as wide as vectors are apart (m): cells are finer."""
    field = field_of_run(folder, time)
    apart = step if like is None else float(like.x[1] - like.x[0])
    n = max(1, round(apart / (field.x[1] - field.x[0])))
    ny, nx = (side // n for side in field.u.shape)
    rows = slice(field.u.shape[0] - ny * n, None)

    def mean(values: Floats) -> Floats:
        """Means over the cells of each square."""
        return np.asarray(values[rows, : nx * n].reshape(ny, n, nx, n).mean((1, 3)))

    share = mean((~field.solid).astype(float))
    solid = share < 0.5
    u, v = (np.where(solid, np.nan, mean(np.where(field.solid, 0.0, it)) / np.maximum(share, 0.5)) for it in
            (field.u, field.v))  # fmt: skip
    x = field.x[: nx * n].reshape(nx, n).mean(1)
    y = field.y[rows].reshape(ny, n).mean(1)
    none = np.zeros_like(u)
    return replace(field, x=x, y=y, u=u, v=v, valid=~solid, replaced=none > 0, solid=solid, correlation=none,
                   uncertainty=none)  # fmt: skip


def speed_beside(field: Field, place: Place) -> float:
    """Mean speed of the fluid left of the column, m/s."""
    part = np.ix_(field.y < place.top, (field.x > place.strip[0]) & (field.x < place.strip[1]))
    return float(np.nanmean(np.hypot(field.u, field.v)[part]))


def reaches(speed: float, times: list[float], speeds: list[float], place: Place) -> float:
    """Time after the gate opens, until then all is at rest, at which ``speeds`` come to ``speed``, s, or nan."""
    late = [(place.opens, 0.0), *((t, s) for t, s in zip(times, speeds, strict=True) if t > place.opens)]
    for (t0, s0), (t1, s1) in pairwise(late):
        if s1 >= speed:
            return t0 + (speed - s0) / (s1 - s0) * (t1 - t0) - place.opens
    return float("nan")


def named(field: Field, size: tuple[float, float]) -> dict[str, Vortex | None]:
    """The strongest vortices of the lower left quarter and of the upper middle.

    Upper middle: the upper half, a quarter of the width and more from both sides.  Weaker ones than CALM of the
    strongest of all count as none.
    """
    width, height = size
    found = vortices(field)
    found = [it for it in found if abs(it.circulation) >= CALM * abs(found[0].circulation)]
    low = (it for it in found if it.x < width / 2 and it.y < height / 2)
    high = (it for it in found if width / 4 < it.x < 3 * width / 4 and it.y > height / 2)
    return {"lower left": next(low, None), "upper middle": next(high, None)}


def size_of(folder: Path) -> tuple[float, float]:
    """Width and height of a run's box, m."""
    domain = open_run(folder).card["scene"]["domain"]
    return float(domain["width"]), float(domain["height"])
