"""Bodies on the device: what is sent there and what comes back, once a step, and the kernels between.

    up      places and motion of every body, 120 bytes, or 64 where none has moved; where one has, the lists of tiles,
            4 bytes an entry; patches of polygons, which the CPU fills
    back    load and inside mass of every body, 40 bytes; 8 more for what a body force does to it, 16 for its rim

Both lie in pinned memory, each in one piece, and are copied in a stream of their own.  Cells without bodies have no
part in the loads: they are stepped last, while loads come back and the CPU goes on with them.
"""

from collections.abc import Sequence
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from porescale.common.compiled.cuda import (
    device_kernel,
    empty_on_device,
    launch,
    new_stream,
    pinned_array,
    to_device,
)
from porescale.common.core.types import Integers, Reals
from porescale.coupling.coverage.rows import BLOCK, Motion, Patches, whole_blocks
from porescale.coupling.coverage.soft_rim import MARGIN, SoftRim
from porescale.coupling.device import cover, loads, sweeps
from porescale.coupling.device.layout import Box, DevicePatches, Owners, Tiles
from porescale.coupling.device.tiles import TILE_HEIGHT, TILE_WIDTH, TileLists, list_tiles, most_entries, tiles_of
from porescale.lbm.fluid import Fluid

THREADS = 128
"""Of a block, but for cells; not tuned."""
SENT_ALWAYS, SENT = 8, 15
"""Numbers a body that are sent up in every step, and where one has moved."""


class Mirror:
    """An array of the device with one in pinned memory of the host, both in pieces of the same shapes."""

    def __init__(self, shapes: Sequence[tuple[int, ...]], dtype: Any) -> None:
        sizes = [int(np.prod(shape)) for shape in shapes]
        self.ends = np.cumsum(sizes)
        size = max(int(self.ends[-1]), 1)
        self.host, self.device = pinned_array(size, dtype), empty_on_device(size, dtype)
        starts = self.ends - sizes
        self.here = [self.host[a:b].reshape(it) for a, b, it in zip(starts, self.ends, shapes, strict=True)]
        self.there = [self.device[a:b].reshape(it) for a, b, it in zip(starts, self.ends, shapes, strict=True)]

    def send(self, count: int, stream: Any) -> None:
        """Copy the first ``count`` numbers to the device, in a stream."""
        if count:
            self.device[:count].copy_to_device(self.host[:count], stream=stream)

    def fetch(self, count: int, stream: Any) -> None:
        """Copy the first ``count`` numbers from the device, in a stream."""
        if count:
            self.device[:count].copy_to_host(self.host[:count], stream=stream)


class DeviceBodies:
    """Bodies with the patches of ``patches``, of which the first ``discs`` are discs, in a fluid on the device.

    laws: of weight and solid operator;  row_numbers: of a row's load, 5, or 7 where rims are soft.
    """

    def __init__(self, fluid: Fluid, patches: Patches, discs: int, laws: tuple[Any, Any], row_numbers: int) -> None:
        count, real = len(patches.height), fluid.populations.dtype
        self.patches, self.discs, self.laws, self.soft = patches, discs, laws, row_numbers > 5
        self.box = Box(fluid.nx, fluid.ny, *fluid.sides.periodic)
        self._real, self._bodies = real.type, count
        self._copies, self._beside = new_stream(), new_stream()
        one, two, three, four = (count,), (count, 2), (count, 3), (count, 4)
        self._up = Mirror([two, two, one, three, one, one, one, four], np.float64)
        self._back = Mirror([three, two, one, (discs, 2)], np.float64)
        tiles = int(np.prod(tiles_of(fluid.nx, fluid.ny)))
        entries = most_entries(patches.height, patches.stride, fluid.nx, fluid.ny)
        self._lists = Mirror([(tiles + 1,), (tiles,), (entries,)], np.int32)
        self._seen, self._tiles, self._covered = np.zeros(tiles, np.int64), tiles, 0
        self.moved, self._areas = False, 0
        begins = np.append(patches.start, len(patches.fraction)).astype(np.int64)
        self._disc_cells = int(begins[discs])
        self._others = Mirror([(len(patches.fraction) - self._disc_cells,)], real)
        rows = patches.height.copy()
        lines = patches.stride[:discs]
        self._owners = Owners(
            _repeated(np.diff(begins) // BLOCK), _repeated(rows), to_device(np.cumsum(rows) - rows),
            _repeated(lines // BLOCK), to_device(np.cumsum(lines) - lines),
        )  # fmt: skip
        self._rows, self._lines_of_discs = int(rows.sum()), int(lines.sum())
        self._lines = empty_on_device((2, 3, max(self._lines_of_discs, 1)), np.float64)
        centre, velocity, spin, shift, theta, self._theta2, self._radius, self._places = self._up.there
        self._motion = Motion(centre, velocity, spin, shift, theta)
        blocks = empty_on_device((max(len(patches.fraction) // BLOCK, 1), 8), real)
        corner, height, stride, start, fraction = (to_device(it) for it in patches)
        self._there = DevicePatches(corner, height, stride, start, fraction, blocks, theta)
        gained = empty_on_device((4 if self.soft else 3, fluid.ny, fluid.nx), real)
        begin, order, body = self._lists.there
        self._cells = Tiles(begin, order, body, empty_on_device((fluid.ny, 2), np.int32), gained)
        self._row_load = to_device(np.zeros((count, int(rows.max(initial=0)), row_numbers)))
        self._pairs: tuple[Any, int, Any] | None = None
        self._body: Any = None
        self._law: Any = None

    def set_pairs(self, pairs: Integers) -> None:
        """Discs that overlap, (p, 2), see ``SaturatedCells``."""
        order, begin = grouped(pairs, self.discs)
        heights = [int(self.patches.height[np.unique(order[a:b])].sum()) for a, b in pairwise(begin)]
        self._pairs = (to_device(begin), max(heights), to_device(order)) if heights else None

    def set_body(self, body: Integers) -> None:
        """The first disc of each disc's rigid body, (n,): cells that two share stay open, see ``SaturatedCells``."""
        self._body = to_device(body)

    def send(self, motion: Motion, radius: Reals, softness: SoftRim | None, *, moved: bool) -> None:
        """Send places, where one has moved, and motion, and have the patches filled there.

        ``patches`` has the corners of all bodies, and all else of those that are no discs;  radius: of the discs.
        """
        # Copies here do not overwrite what the last step's sweep of the other tiles reads: they wait for the launch in
        # the stream 0 that ends ``DeviceFluid.advance``, and that one waits for the sweep.
        for there, here in zip(self._up.here, motion, strict=False):
            there[...] = here
        if moved:
            self._list(radius, softness)
        self._up.send((SENT if moved else SENT_ALWAYS) * self._bodies, self._copies)
        self.moved = moved
        if moved:
            self._cover()
        self._run(sweeps.move_blocks, len(self.patches.fraction) // BLOCK, self._motion, self._there, self._owners)

    def _list(self, radius: Reals, softness: SoftRim | None) -> None:
        """Places of the bodies, and their tiles; patches that the CPU has filled are sent."""
        patches, (theta2, radii, places) = self.patches, self._up.here[5:]
        radii[: self.discs] = radius
        if softness:
            theta2[: self.discs] = softness.theta2
        places[:, :2], places[:, 2], places[:, 3] = patches.corner, patches.height, patches.stride
        lists = TileLists(*self._lists.here)
        self._covered = list_tiles(patches, tuple(self.box), *lists, self._seen)
        self._lists.send(2 * self._tiles + 1 + int(lists.start[-1]), self._copies)
        if len(self._others.here[0]):
            self._others.here[0][...] = patches.fraction[self._disc_cells :]
            self._there.fraction[self._disc_cells :].copy_to_device(self._others.here[0], stream=self._copies)

    def _cover(self) -> None:
        """Fill the patches of the discs and find the rows' saturated cells."""
        there, owners, radius = self._there, self._owners, self._radius
        self._run(cover.place_patches, self._bodies, self._places, there.corner, there.height, there.stride)
        lines = self._lines_of_discs
        self._run(cover.mark_discs, lines, self._motion.centre, radius, there, owners, self._lines)
        self._run(cover.cover_discs, self._disc_cells, radius, there, owners, self._lines, self._disc_cells)
        if self._pairs:
            begin, rows, pairs = self._pairs
            count = (len(begin) - 1) * rows
            self._run(cover.subtract_pairs, count, (begin, rows), pairs, self._motion, radius, there)
        for theta in (self._motion.theta, self._theta2) if self.soft else ():
            self._run(cover.filter_rows, self._rows, theta, there, owners)
            self._run(cover.filter_columns, lines, theta, there, owners)
        if self._body is not None:
            cells = self._covered * TILE_WIDTH * TILE_HEIGHT
            self._run(cover.keep_open, cells, self._covered, self.box, self._cells, self._body, there)
        self._run(sweeps.find_extents, self.box.ny, self.box, self._cells, there)

    def sweep(self, f: Any, parity: int, law: Any) -> None:
        """The step of ``DeviceSweep``: cells near bodies, loads, their way back, the other cells."""
        self._law = law
        laws = (*self.laws, law)
        self._sweep_part((0, self._covered), f, parity, laws, 0)
        self._sum_loads()
        self._sweep_part((self._covered, self._tiles - self._covered), f, parity, laws, self._beside)

    def _sweep_part(self, part: tuple[int, int], f: Any, parity: int, laws: Any, stream: Any) -> None:
        """The cells of a part of the tiles in their order."""
        cells = TILE_WIDTH * TILE_HEIGHT
        launch(
            self._kernel(sweeps.sweep_tiles), part[1] * cells, cells, f, parity, part, self.box, self._cells,
            self._there, laws, stream=stream,
        )  # fmt: skip

    def _sum_loads(self) -> None:
        """Sum the loads of all bodies and let them come back."""
        box, there, row_load = self.box, self._there, self._row_load
        load, inside, _, rim = self._back.there
        self._run(loads.load_rows, self._rows, box, self._cells, there, self._owners, row_load)
        self._run(loads.add_bodies, self._bodies, box, there, row_load, load, inside)
        numbers = 5 * self._bodies + self._areas
        if self.soft:
            self._run(loads.rim_rows, self._rows, box, self._cells, there, self._owners, row_load)
            self._run(loads.add_rims, self.discs, box, there, row_load, rim)
            numbers = 6 * self._bodies + 2 * self.discs
        self._back.fetch(numbers, self._copies)

    def find_areas(self, half_rate: float | None) -> None:
        """Have the areas that a body force pushes summed as well, where bodies have moved.

        half_rate: of ``held_area``, None where the force acts everywhere.
        """
        self._areas = self._bodies if self.moved else 0
        if not self.moved:
            return
        where = self._there, (self.box.periodic_x, self.box.periodic_y), (self.box.ny, self.box.nx)
        area = self._back.there[2]
        if half_rate is None:
            self._run(cover.covered_areas, self._bodies, *where, area)
        else:
            self._run(cover.held_areas, self._bodies, *where, half_rate, self.laws[0], area)

    def receive(self) -> list[NDArray[np.float64]]:
        """Load (n, 3), inside mass and inertia (n, 2), area (n,) and rim slip (discs, 2) of the step; waits for it."""
        self._copies.synchronize()
        return self._back.here

    def _kernel(self, function: Any) -> Any:
        """A kernel for the laws and the precision in use."""
        return device_kernel(function, tuple(type(it) for it in (self._law, *self.laws[::-1])), self._real)

    def _run(self, function: Any, count: int, *arguments: Any) -> None:
        """Run a kernel that knows no law of the fluid with ``count`` threads."""
        laws = tuple(type(it) for it in self.laws[::-1])
        launch(device_kernel(function, laws, self._real), count, THREADS, *arguments)


def bytes_needed(nx: int, ny: int, real_bytes: int, rows: Integers, polygons: int = 0, *, soft: bool = False) -> int:
    """Device memory of bodies, beside that of the fluid; pairs of clumps are not counted.

    rows (n,): of the patch of every body, without what soft rims add;  polygons: how many, the last ones.

    Of every cell what loads are made of, of every tile its place in the lists, of every body its patch with the motion
    of its blocks, its rows, loads and places in lists, of a disc its grid lines.
    """
    wide, high = tiles_of(nx, ny)
    height = np.asarray(rows, np.int64) + MARGIN * soft
    stride, discs = whole_blocks(height + 1), len(rows) - polygons
    cells = height * stride
    patches = int(cells.sum()) * (real_bytes * (1 + 8 / BLOCK) + 4 / BLOCK) + int(cells[discs:].sum()) * real_bytes
    lines = int(stride[:discs].sum()) * (48 + 4 / BLOCK)
    loads = 4 * int(height.sum()) + 8 * (7 if soft else 5) * len(rows) * int(height.max(initial=0))
    bodies = 8 * (SENT + 8 + 7) * len(rows) + 4 * most_entries(height, stride, nx, ny)  # 8 come back, 7 say where
    return int((3 + soft) * nx * ny * real_bytes + 8 * (wide * high + ny + 1) + patches + lines + loads + bodies)


def _repeated(counts: Any) -> Any:
    """Numbers 0, 1, ... each as often as ``counts`` says, on the device; of 32 bits."""
    made = np.repeat(np.arange(len(counts), dtype=np.int32), counts)
    return to_device(made if len(made) else np.zeros(1, np.int32))


def grouped(pairs: Integers, discs: int) -> tuple[Integers, Integers]:
    """Pairs (p, 2) in groups that share no disc, in their order within each, and where each group begins, (g + 1,).

    The order of groups does not matter: a pair reads and writes patches of its own discs alone.
    """
    joined = coo_array((np.ones(len(pairs), np.int8), pairs.T), shape=(discs, discs))
    group = connected_components(joined, directed=False)[1]
    own = group[pairs[:, 0]]
    order = np.argsort(own, kind="stable")
    begin = np.flatnonzero(np.diff(own[order], prepend=-1))
    return np.ascontiguousarray(pairs[order]), np.append(begin, len(pairs)).astype(np.int64)
