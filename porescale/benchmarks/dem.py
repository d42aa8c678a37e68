"""Rate of the contact loop on a settled pile: friction with history, three walls, one list rebuild in 500
steps.
"""

import numpy as np

from porescale.common.core.constants import GRAVITY
from porescale.common.core.errors import Fault, InputError
from porescale.common.evidence.benchmarks import Benchmarks, Dtype, Work
from porescale.dem.contact.linear import Linear
from porescale.dem.discs import Discs, make_discs
from porescale.dem.forces.walls import Box
from porescale.dem.grains import Grains
from porescale.dem.prepare.settle import Pile, come_to_rest, prepare, weights_of

BENCHMARKS = Benchmarks()

SIZE = 10_000  # discs
TILE = 1000  # most discs that are settled; larger piles are rows of copies, which must settle at their ends only
LAYERS = 20  # height of the pile in diameters
DIAMETER = 1.5e-3  # m, mean; radii 1:2
DENSITY = 2500.0  # kg/m^3
LAW = Linear(5e5, 2.0, 1.25e5, 1.0, 0.5)
STEPS = 500


def settled_pile(size: int) -> Grains:
    """About ``size`` discs at rest in a wide tray, under gravity."""
    tiles = -(-size // TILE)
    count = -(-size // tiles)
    width = max(count / LAYERS, 8.0) * DIAMETER
    pile = Pile((0.0, 0.0), width, count, DIAMETER, DENSITY, spread=1.0 / 3.0)
    high = pile.top() + 10.0 * DIAMETER
    tray = Box((0.0, 0.0), (width, high), left="periodic", right="periodic", top="open")
    one = prepare(pile, tray, LAW).discs
    at = one.position.copy()
    at[:, 0] %= width
    where = np.concatenate([at + np.array([k * width, 0.0]) for k in range(tiles)])
    radius = np.tile(one.radius, tiles)
    edge = 2.0 / 3.0 * DIAMETER  # the largest radius: discs on the seam stay inside the end walls
    box = Box((-edge, 0.0), (tiles * width + edge, high), top="open")
    grains = Grains(ordered(make_discs(where, radius, DENSITY)), LAW, box)
    come_to_rest(grains, weights_of(grains.discs, DENSITY), GRAVITY, energy=1e-4, balance=0.1)
    return grains


def ordered(discs: Discs) -> Discs:
    """The same discs numbered column by column."""
    order = np.lexsort((discs.position[:, 1], np.floor(discs.position[:, 0] / (2.0 * DIAMETER))))
    return make_discs(discs.position[order], discs.radius[order], DENSITY)


def float64_only(dtype: Dtype) -> None:
    """InputError for float32, in which an overlap has few digits."""
    if dtype != "float64":
        raise InputError(Fault("--dtype", dtype, "overlaps are 1e-3 of positions and less", allowed="float64 for dem"))


@BENCHMARKS.row("dem")
def bench_dem(size: int | None, threads: int, dtype: Dtype) -> Work:
    """Contact steps of a settled pile; ``threads`` share it where it is large enough, see sweep.py.  Raises InputError
    for float32.
    """
    float64_only(dtype)
    grains = settled_pile(SIZE if size is None else size)
    weights = weights_of(grains.discs, DENSITY)
    dt = grains.stable_step()

    def run() -> None:
        """The steps, with a new list of neighbours midway."""
        grains.step(dt, weights, count=STEPS // 2)
        grains.pairs.build(grains.discs.position, grains.discs.radius)
        grains.step(dt, weights, count=STEPS // 2)

    return Work(run, float(STEPS * grains.discs.count), "discs/s", grains.discs.count)
