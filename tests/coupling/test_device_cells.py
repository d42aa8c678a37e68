"""Bodies in a fluid on a device beside the CPU's: the same bits, in numba's simulator and on a GPU.

Both round after every operation, as the CPU's code does, with ``fma`` where it says so, and every sum over cells or
bodies has the CPU's order: the bound on the difference is zero.
"""

from itertools import pairwise

import numpy as np
import pytest

from porescale.common.compiled.cuda import simulated
from porescale.coupling.coverage.polygon import Polygons
from porescale.coupling.coverage.rectangle import Rectangle
from porescale.coupling.device import bodies as device_bodies
from porescale.coupling.device.bodies import grouped
from porescale.coupling.device.cells import DeviceSaturatedCells
from porescale.coupling.device.tiles import list_tiles, tiles_of
from porescale.coupling.psm import SaturatedCells
from porescale.coupling.solid.choose import SOLID_OPERATORS
from porescale.coupling.weighting.choose import fitting_weights
from porescale.lbm.boundary.sides import Sides
from porescale.lbm.device import fluid as device_fluid
from porescale.lbm.device.fluid import DeviceFluid
from porescale.lbm.fluid import Fluid

NX, NY = 38, 14
PERIODIC = Sides("periodic", "periodic", "periodic", "periodic")
WALLS = Sides(left="wall", right="wall", bottom="wall", top="slip")
PLACES = np.array([[9.2, 6.1], [13.9, 7.3], [37.3, 13.2]])  # two that overlap, one across the corner of a periodic box
ROW = np.array([[9.0, 6.0], [13.0, 7.0], [17.0, 6.0]])  # of which the middle one overlaps both
VELOCITY = np.array([[0.02, 0.01], [-0.03, 0.02], [0.01, 0.04]])
SPIN = np.array([0.01, -0.02, 0.003])
FORCE, NO_FORCE = (2e-4, -1e-4), (0.0, 0.0)
"""On the fluid.  Without one it has a kernel of its own: each of both where tests of the CPU compile it, too."""


def started(*, device, dtype=np.float64, sides=None, force=FORCE, polygons=None, size=(NX, NY), **options):
    """A random flow, of 38 by 14 cells, two tiles along each axis, and three discs in it."""
    fluid = (DeviceFluid if device else Fluid)(*size, 0.7, force=force, dtype=dtype, sides=sides)
    random, shape = np.random.default_rng(1), size[::-1]
    fluid.set_flow(*(0.05 * random.uniform(-1, 1, (2, *shape))), 1 + 0.01 * random.uniform(-1, 1, shape))
    kind = DeviceSaturatedCells if device else SaturatedCells
    return fluid, kind(fluid, [3.3, 3.1, 2.2], polygons=polygons, **options)


def gone(fluid, cells, steps=2, *, moving=True, turn=None, places=PLACES):
    """Loads of each step and the populations after them."""
    found, places, velocity, spin = [], np.array(places, float), VELOCITY.copy(), SPIN.copy()
    for k in range(steps):
        cells.advance(fluid, places, velocity, spin)
        found += [cells._load.copy(), cells._entrained.copy(), cells.push.copy(), cells._shift.copy()]
        if moving:
            places, velocity, spin = places + 10 * velocity, velocity + 0.01 * cells.force, spin + 0.01 * cells.torque
        if turn:
            turn(k)
    return [*found, fluid.state()["populations"].copy()]


def same(found, expected):
    """Whether two lists of arrays are the same to the bit."""
    return all(np.array_equal(one, other) for one, other in zip(found, expected, strict=True))


def both_same(**options):
    """Whether device and CPU give the same bits, and whether there was anything to compare."""
    expected = gone(*started(device=False, **options))
    assert np.abs(expected[0]).min() > 0
    return same(gone(*started(device=True, **options)), expected)


@pytest.mark.parametrize("sides", [PERIODIC, WALLS], ids=["periodic", "walls"])
@pytest.mark.parametrize(("dtype", "force"), [(np.float32, NO_FORCE), (np.float64, FORCE)], ids=["float32", "float64"])
def test_exact_walls_give_the_cpus_bits(dtype, force, sides):
    assert both_same(dtype=dtype, sides=sides, force=force)


@pytest.mark.parametrize(
    ("solid", "weight"),
    [(solid, weight) for solid in SOLID_OPERATORS if solid != "exact-wall" for weight in fitting_weights(solid)],
)
def test_every_operator_and_weight_is_the_cpus(solid, weight):
    undriven = (solid, weight) == ("odd-SC1", "B2")  # with discs in undriven fluid: test_coupling_push.py
    assert both_same(solid_operator=solid, weighting=weight, force=NO_FORCE if undriven else FORCE)


@pytest.mark.parametrize("dtype", [np.float32, np.float64])
def test_soft_rims_give_the_cpus_bits(dtype):
    """With slips from the start, so that every rim is soft in the first step."""
    found = []
    for device in (False, True):
        fluid, cells = started(device=device, dtype=dtype, soft_rim=True)
        cells.soft_rim.slip[:] = [0.03, 0.01, 0.0]
        found.append([*gone(fluid, cells), cells.soft_rim.slip])
    assert same(*found)
    assert 0.01 < found[0][-1][0] != 0.03


def test_another_weight_gives_other_bits():
    """The check that must fail."""
    expected = gone(*started(device=False, solid_operator="SC2", weighting="B1"))
    assert not same(gone(*started(device=True, solid_operator="SC2", weighting="B2")), expected)


def test_discs_that_stand_are_sent_once(monkeypatch):
    fluid, cells = started(device=True)
    covered = []
    monkeypatch.setattr(device_bodies.DeviceBodies, "_cover", _counted(device_bodies.DeviceBodies._cover, covered))
    found = gone(fluid, cells, moving=False)
    assert len(covered) == 1
    assert same(found, gone(*started(device=False), moving=False))


def _counted(function, calls):
    def counted(*arguments):
        calls.append(arguments)
        return function(*arguments)

    return counted


def test_members_of_a_clump_that_overlap_hold_their_union():
    """Three discs in a row, of which the middle one overlaps both: pairs have an order."""
    found = []
    for device in (False, True):
        fluid, cells = started(device=device)
        cells.pairs = np.array([[0, 1], [1, 2]])
        found.append(gone(fluid, cells, 1, places=ROW))
    assert same(*found)
    assert not same(found[1], gone(*started(device=True), 1, places=ROW))


@pytest.mark.parametrize("dtype", [np.float32, np.float64])
@pytest.mark.parametrize("sides", [PERIODIC, WALLS], ids=["periodic", "walls"])
def test_cells_that_two_bodies_share_stay_open(dtype, sides):
    """One of the discs meets another across a periodic corner."""
    found, places = [], [[9.2, 6.1], [15.4, 7.3], [4.6, 9.4]]
    for body in (np.arange(3), None):
        for device in (False, True):
            fluid, cells = started(device=device, dtype=dtype, sides=sides)
            cells.body = body
            found.append(gone(fluid, cells, places=places))
    assert same(*found[:2])
    assert same(*found[2:])
    assert not same(found[0], found[2])


@pytest.mark.parametrize("body", [None, np.arange(3)], ids=["filled", "open"])
def test_a_body_as_wide_as_a_periodic_box_meets_itself(body):
    """Its patch is wider than the box, so that it has a cell at its side twice."""
    found = []
    for device in (False, True):
        fluid, cells = started(device=device, sides=PERIODIC, size=(7, 7))
        cells.body = body
        found.append(gone(fluid, cells))
    assert same(*found)
    assert cells._patches.height[0] > 7


def test_a_disc_that_meets_its_image_alone_is_the_cpus():
    found = []
    for kind, cells_of in ((Fluid, SaturatedCells), (DeviceFluid, DeviceSaturatedCells)):
        for body in (np.arange(1), None):
            fluid = kind(7, 7, 0.7, force=FORCE, sides=PERIODIC)
            cells = cells_of(fluid, [3.5])
            cells.body = body
            cells.advance(fluid, np.array([[3.7, 3.6]]), VELOCITY[:1], SPIN[:1])
            found.append([cells._load.copy(), fluid.state()["populations"].copy()])
    assert same(found[0], found[2])
    assert same(found[1], found[3])
    assert not same(found[0], found[1])


@pytest.mark.parametrize(
    "place",
    [(0.4, 5.7), (25.0, 3.0), (-9.0, -9.0), (np.nan, 3.0)],
    ids=["partly beyond walls", "beyond a wall", "beyond a corner", "nowhere"],
)
def test_a_box_of_less_than_a_tile_and_a_disc_at_its_edge(place):
    """Discs that cover nothing have no load; the others are as without them."""
    found = []
    for device in (False, True):
        fluid, cells = started(device=device, sides=WALLS, size=(20, 6))
        found.append(gone(fluid, cells, 1, places=[[6.2, 3.1], [12.9, 2.3], place], moving=False))
    assert same(*found)
    load = found[1][0]
    assert np.abs(load[:2]).min() > 0
    assert bool(load[2].any()) == (place == (0.4, 5.7))


@pytest.mark.parametrize("seed", range(5))
def test_groups_of_random_pairs_are_those_of_merging_one_pair_after_the_other(seed):
    """The order of the groups themselves does not matter; pairs within one keep theirs."""
    pairs = np.random.default_rng(seed).integers(0, 40, (25, 2))
    order, begin = grouped(pairs, 40)
    found = [order[a:b].tolist() for a, b in pairwise(begin)]
    assert sorted(found) == sorted(merged(pairs.tolist()))
    assert sorted(found) != sorted(merged(pairs[:-1].tolist()))  # the check that must fail


def merged(pairs):
    """Groups of pairs that share a disc, one pair after the other."""
    group = list(range(40))
    for n, m in pairs:
        group = [group[n] if it == group[m] else it for it in group]
    own = {}
    for n, m in pairs:
        own.setdefault(group[n], []).append([n, m])
    return list(own.values())


def test_no_pairs_are_no_groups():
    order, begin = grouped(np.zeros((0, 2), np.int64), 3)
    assert (len(order), begin.tolist()) == (0, [0])


def in_order(calls):
    """Whether work of the stream 0 lies between the other tiles of a step and what is sent for the next, and is what
    comes last before loads are fetched: it waits for what was asked for before, and later work for it."""
    waited, previous = True, None
    for what, stream in calls:
        if what == "fetch" and previous != ("add_bodies", 0):
            return False
        if what == "send lists" and not waited:
            return False
        waited = stream != "beside" and (waited or stream == 0)
        previous = what, stream
    return True


def test_the_stream_0_keeps_the_steps_apart(monkeypatch):
    """What was asked for, without doing it."""
    fluid, cells = started(device=True, sides=WALLS)
    there, calls = cells._there, []
    names = {id(0): 0, id(there._beside): "beside", id(there._copies): "copies"}

    def launched(compiled, count, block, *arguments, stream=0):
        if count > 0:
            calls.append((getattr(compiled, "fn" if simulated() else "py_func").__name__, names[id(stream)]))

    def sent(mirror, count, stream):
        calls.append(("send lists" if mirror is there._lists else "send", names[id(stream)]))

    monkeypatch.setattr(device_bodies, "launch", launched)
    monkeypatch.setattr(device_fluid, "launch", launched)
    monkeypatch.setattr(device_bodies.Mirror, "send", sent)
    monkeypatch.setattr(
        device_bodies.Mirror, "fetch", lambda _, count, stream: calls.append(("fetch", names[id(stream)]))
    )
    for shift in (0.0, 0.1):
        cells.advance(fluid, ROW + shift, VELOCITY, SPIN)
    assert calls.count(("sweep_tiles", "beside")) == calls.count(("send lists", "copies")) == 2
    assert in_order(calls)
    assert not in_order([it for it in calls if it[0] != "pass_on_links"])  # what ends ``DeviceFluid.advance``
    assert not in_order([it for it in calls if it[0] != "add_bodies"])


def test_pairs_that_share_a_disc_are_of_one_group():
    pairs = np.array([[0, 1], [3, 4], [1, 2], [3, 5], [6, 7]])
    order, begin = grouped(pairs, 8)
    groups = [order[a:b].tolist() for a, b in pairwise(begin)]
    assert groups == [[[0, 1], [1, 2]], [[3, 4], [3, 5]], [[6, 7]]]


def test_polygons_are_sent_as_the_cpu_fills_them():
    found = []
    for device in (False, True):
        polygons = Polygons([[[-2.5, -2.0], [2.5, -2.0], [0.0, 3.0]]])
        fluid, cells = started(device=device, polygons=polygons)
        polygons.centre[:], polygons.velocity[:], polygons.spin[:] = [24.3, 7.2], [0.01, 0.02], 0.01

        def turn(_, polygons=polygons):
            polygons.angle += 0.3
            polygons.centre += 0.4

        found.append(gone(fluid, cells, turn=turn))
    assert same(*found)


def test_rectangles_and_rings_are_refused():
    with pytest.raises(ValueError, match="no rectangles and no rings"):
        DeviceSaturatedCells(DeviceFluid(NX, NY, 0.7), [], rectangles=[Rectangle((3.0, 3.0), (6.0, 6.0))])


def test_what_is_read_between_steps_is_that_of_the_cpu_and_changes_nothing():
    expected, found = started(device=False), started(device=True)
    motion = PLACES + 0.3, VELOCITY, SPIN
    for fluid, cells in (expected, found):
        gone(fluid, cells, 1)
        cells.cover(*motion)
    assert same(found[1].flow(found[0], *motion), expected[1].flow(expected[0], *motion))
    assert same([found[1].solid, found[1].weights()], [expected[1].solid, expected[1].weights()])
    assert same(gone(*found, 1), gone(*started_and_gone(), 1))


def started_and_gone():
    """The CPU's, one step on, without a look."""
    fluid, cells = started(device=False)
    gone(fluid, cells, 1)
    return fluid, cells


class Backwards:
    """numpy, as the simulator takes it, that counts the blocks of a kernel from the last to the first."""

    def __init__(self):
        self.most = 0

    def __getattr__(self, name):
        return getattr(np, name)

    def ndindex(self, *shape):
        blocks = list(np.ndindex(*shape))
        self.most = max(self.most, len(blocks))
        return reversed(blocks)


def test_no_order_of_threads_and_of_kernels_matters(monkeypatch):
    """Blocks from the last to the first, their threads all at once, in the simulator, and cells without bodies before
    those near them."""
    expected, backwards = gone(*started(device=False)), Backwards()
    if simulated():
        from tests import simulator

        monkeypatch.setattr("numba.cuda.simulator.kernel.BlockManager.run", simulator.THREADS)
        monkeypatch.setattr("numba.cuda.simulator.kernel.np", backwards)
    sweep = device_bodies.DeviceBodies._sweep_part
    waiting = []

    def plain_first(self, part, *more):
        if part[0] == 0:
            waiting.append(part)
            sweep(self, (part[1], self._tiles - part[1]), *more)
            sweep(self, part, *more)

    monkeypatch.setattr(device_bodies.DeviceBodies, "_sweep_part", plain_first)
    assert same(gone(*started(device=True)), expected)
    assert len(waiting) == 2
    assert backwards.most > 4 or not simulated()


def test_every_cell_finds_the_bodies_that_reach_into_it():
    """Beside a search over all cells and images."""
    fluid, cells = started(device=True)
    cells.advance(fluid, PLACES, VELOCITY, SPIN)
    patches, box = cells._patches, (NX, NY, True, True)
    wide, high = tiles_of(NX, NY)
    start, order, body = np.zeros(wide * high + 1, int), np.zeros(wide * high, int), np.zeros(99, int)
    covered = list_tiles(patches, box, start, order, body, np.zeros(wide * high, int))
    expected = []
    for t in range(wide * high):
        x, y = t % wide * 32, t // wide * 8
        inside = {(a, b) for a in range(x, min(x + 32, NX)) for b in range(y, min(y + 8, NY))}
        expected.append([n for n in range(3) if inside & _cells_of(patches, n)])
    assert [body[a:b].tolist() for a, b in pairwise(start)] == expected
    assert sorted(order.tolist()) == list(range(wide * high))
    assert all(expected[t] for t in order[:covered])


def _cells_of(patches, n):
    """Cells of a patch in a periodic box."""
    x, y = patches.corner[n]
    return {((x + a) % NX, (y + b) % NY) for a in range(int(patches.stride[n])) for b in range(int(patches.height[n]))}
