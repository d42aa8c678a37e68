"""Cost of polygons beside discs: hexagons that touch all round, by their sides, and as densely packed discs."""

import math
from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from porescale.common.core.errors import Fault, InputError
from porescale.common.evidence.benchmarks import PLAIN, Benchmarks, Dtype, Work
from porescale.dem.bodies.frames import framed, polygon
from porescale.dem.contact.linear import Linear
from porescale.dem.discs import make_discs
from porescale.dem.forces.walls import Box
from porescale.dem.grains import Grains

BENCHMARKS = Benchmarks()

SIZE = 6000  # sides
SIDES = 6
RADIUS = 1e-3  # m, of discs and from the middle of a hexagon to its corners
THICKNESS = 0.05 * RADIUS
PRESSED = 5e-4  # of the distance of neighbours: their overlap
DENSITY = 2500.0  # kg/m^3
LAW = Linear(5e5, 2.0, 1.25e5, 1.0, 0.5)
STEPS = 200
STEP = 1e-9  # s: nothing moves far enough to part, or to be listed anew


def lattice(count: int, apart: float) -> NDArray[np.float64]:
    """About ``count`` places (m) of a triangular lattice, ``apart`` (m), as wide as high."""
    side = max(round(math.sqrt(count)), 2)
    places = [(apart * (i + 0.5 * (j % 2)), math.sqrt(0.75) * apart * j) for j in range(side) for i in range(side)]
    return np.array(places)


def around(places: NDArray[np.float64]) -> Box:
    """An open box around ``places`` (n, 2) m."""
    low, high = places.min(axis=0) - 2.0 * RADIUS, places.max(axis=0) + 2.0 * RADIUS
    return Box((float(low[0]), float(low[1])), (float(high[0]), float(high[1])), "open", "open", "open", "open")


def hexagons(count: int) -> Grains:
    """About ``count`` hexagons, each with a side pressed into a side of each neighbour."""
    places = lattice(count, (2.0 * RADIUS * math.sqrt(0.75) + 2.0 * THICKNESS) * (1.0 - PRESSED))
    turns = math.pi / SIDES * (1.0 + 2.0 * np.arange(SIDES))
    corners = RADIUS * np.column_stack((np.cos(turns), np.sin(turns)))
    return framed(None, [polygon(at + corners, THICKNESS, DENSITY) for at in places], LAW, around(places))


def packed_discs(count: int) -> Grains:
    """About ``count`` discs, each pressed into six neighbours."""
    places = lattice(count, 2.0 * RADIUS * (1.0 - PRESSED))
    return Grains(make_discs(places, RADIUS, DENSITY), LAW, around(places))


def stepping(grains: Grains) -> Callable[[], None]:
    """STEPS contact steps of ``grains`` at a call, prepared."""
    grains.step(STEP)
    return lambda: grains.step(STEP, count=STEPS)


@BENCHMARKS.row("polygons")
def bench_polygons(size: int | None, threads: int, dtype: Dtype) -> list[Work]:
    """Contact steps of hexagons by their sides, and of as many discs; one thread.  Raises InputError for float32."""
    if dtype != "float64":
        raise InputError(Fault("--dtype", dtype, "overlaps are 1e-3 of positions and less", allowed="float64 for dem"))
    wanted = SIZE if size is None else size
    frames, discs = hexagons(max(wanted // SIDES, 1)), packed_discs(wanted)
    assert frames.segments is not None
    sides, count = len(frames.segments.ends), discs.discs.count
    return [
        Work(stepping(frames), float(STEPS * sides), "sides/s", sides, variant="sides"),
        Work(stepping(discs), float(STEPS * count), "discs/s", count, variant=PLAIN, yardstick=True),
    ]
