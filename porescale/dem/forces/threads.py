"""Loops over discs and contacts, by one thread or by several, with the same bits.

Discs are cut into blocks of BLOCK by their numbers.  In a half list a pair belongs to its lower disc, and the force on
a disc is summed over lower partners first, in their order, then over its own row.  Threads keep to that order:
1. every block works out its pairs with discs of later blocks ("far") and puts the results down, one place each;
2. every block adds, for its discs, what earlier blocks put down for them, then its pairs within, then its own far ones.
No two blocks write to one place, and each sum is that of the single thread, to the bit, at any number of threads and in
any numbering of the discs; far pairs, which cost twice the memory traffic, are few where neighbours have near numbers.
Forces on walls and the like are summed block by block, by a single thread, too.

Where an energy budget is kept, systems that are large enough for threads take this way with one thread as well: entries
of far pairs come first in it.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from porescale.common.compiled.jit import (
    inline,
    kernel,
    law_function,
    most_threads,
    parallel_kernel,
    prange,
    thread,
    threads,
)
from porescale.common.core.types import Floats
from porescale.common.neighbors.pair_list import PairList
from porescale.dem.forces.batch import block_far_forces, block_forces, pair_forces, scratch
from porescale.dem.forces.pairs import start_forces
from porescale.dem.forces.rectangle import add_rectangle_forces
from porescale.dem.forces.walls import RUN, add_near_walls

Index = NDArray[np.int64]

BLOCK = 1024
"""Discs, in whole runs of walls.RUN: their state stays in a core's own memory; a settled pile has some hundredths of
its pairs across blocks."""
SERIAL_BELOW = 20_000  # discs; fewer cost less in one thread than barriers cost (spec: "below about 2e4")


class Serial(NamedTuple):
    """One thread.

    partial (blocks, surfaces, 3) N/m, N m/m: forces on walls, plates and rectangles by block;  near (surfaces, runs):
    which runs of discs are near each wall, see walls.mark_near; rows of other surfaces are not read;  numbers, which:
    ``scratch`` of batch.py.
    """

    partial: Floats
    near: NDArray[np.uint8]
    numbers: Floats
    which: Index


class Threads(NamedTuple):
    """Several threads.

    partial, near, numbers, which : as in Serial;  far_start (n + 1,): far pairs of each disc are the last of its row
    and have the places far_start[i]:far_start[i + 1];  incoming (f,): places of the far pairs that end at disc j, by
    rising lower disc, incoming_start[j]:incoming_start[j + 1];  far (f, 4): force on i N/m, torques on i and j N m/m.
    """

    partial: Floats
    near: NDArray[np.uint8]
    numbers: Floats
    which: Index
    far_start: Index
    incoming_start: Index
    incoming: Index
    far: Floats


Threading = Serial | Threads


@kernel
def list_far(start, partner, far_start, incoming_start, incoming):
    """Number the far pairs of a half list in CSR; returns how many.  Overwrites the index arrays of Threads.

    Where ``incoming`` is shorter than that it is left as it is: give more room and call again.
    """
    count = start.shape[0] - 1
    incoming_start[:] = 0
    far_start[0] = 0
    for i in range(count):
        end = (i // BLOCK + 1) * BLOCK
        k = start[i + 1]
        while k > start[i] and partner[k - 1] >= end:
            k -= 1
            incoming_start[partner[k] + 1] += 1
        far_start[i + 1] = far_start[i] + start[i + 1] - k
    total = far_start[count]
    if total > incoming.shape[0]:
        return total
    for j in range(count):
        incoming_start[j + 1] += incoming_start[j]
    for i in range(count):  # incoming_start[j] now walks to the first place of j + 1 ...
        split = start[i + 1] - (far_start[i + 1] - far_start[i])
        for k in range(split, start[i + 1]):
            j = partner[k]
            incoming[incoming_start[j]] = far_start[i] + k - split
            incoming_start[j] += 1
    for j in range(count, 0, -1):  # ... and is shifted back
        incoming_start[j] = incoming_start[j - 1]
    incoming_start[0] = 0
    return total


@parallel_kernel
def far_forces(d, pairs, law, dt, cell, sweep):
    """Contacts of pairs across blocks: overwrites sweep.far (f, 4) and their springs.  Arguments as in pair_forces."""
    count, far_start, far, numbers, which = d.radius.shape[0], sweep.far_start, sweep.far, sweep.numbers, sweep.which
    for b in prange((count + BLOCK - 1) // BLOCK):
        first, last, own = b * BLOCK, min((b + 1) * BLOCK, count), thread()
        block_far_forces(first, last, far_start, far, d, pairs, law, dt, cell, numbers[own], which[own])


@parallel_kernel
def near_forces(d, pairs, law, dt, cell, sweep):
    """All forces between discs, those across blocks from ``sweep.far``: overwrites force, torque and springs."""
    count, far_start, far, numbers, which = d.radius.shape[0], sweep.far_start, sweep.far, sweep.numbers, sweep.which
    incoming_start, incoming = sweep.incoming_start, sweep.incoming
    force, torque, external_force, external_torque = d.force, d.torque, d.external_force, d.external_torque
    for b in prange((count + BLOCK - 1) // BLOCK):
        first, last, own = b * BLOCK, min((b + 1) * BLOCK, count), thread()
        for j in range(first, last):
            fx, fy, moment = external_force[j, 0], external_force[j, 1], external_torque[j]
            for place in range(incoming_start[j], incoming_start[j + 1]):
                q = incoming[place]
                if far[q, 0] == far[q, 0]:
                    fx -= far[q, 0]
                    fy -= far[q, 1]
                    moment += far[q, 3]
            force[j, 0], force[j, 1], torque[j] = fx, fy, moment
        block_forces(first, last, far_start, far, d, pairs, law, dt, cell, numbers[own], which[own])


@law_function
def all_pair_forces(d, pairs, law, dt, cell, sweep):
    """Overwrite force (n, 2) N/m and torque (n,) N m/m with the external ones and those between discs."""


@all_pair_forces.of(Serial)
def _pairs_serial(d, pairs, law, dt, cell, sweep):
    """One thread: a single loop over the whole pair list."""
    start_forces(d)
    pair_forces(d, pairs, law, dt, cell, sweep.numbers[0], sweep.which[0])


@all_pair_forces.of(Threads)
def _pairs_threads(d, pairs, law, dt, cell, sweep):
    """Pairs across blocks first, then block by block."""
    far_forces(d, pairs, law, dt, cell, sweep)
    near_forces(d, pairs, law, dt, cell, sweep)


@inline
def surfaces_of_block(b, d, s, law, dt, sweep):
    """Contacts of the discs of block b with all surfaces ``s``, Surfaces; overwrites sweep.partial[b]."""
    first, last = b * BLOCK, min((b + 1) * BLOCK, d.radius.shape[0])
    load, walls, plates = sweep.partial[b], s.walls.shape[0], s.plates.shape[0]
    add_near_walls(d, s.walls, s.wall_laws, s.wall_spring, load, np.int64(0), sweep.near, first, last, law, dt)
    if plates > 0:
        add_rectangle_forces(d, s.plates, s.plate_laws, s.plate_spring, load, walls, first, last, law, dt)
    if s.rectangles.shape[0] > 0:
        add_rectangle_forces(
            d, s.rectangles, s.rectangle_laws, s.rectangle_spring, load, walls + plates, first, last, law, dt
        )


@parallel_kernel
def surfaces_threads(d, surfaces, law, dt, sweep):
    """Contacts with all surfaces, block by block: adds to force and torque, overwrites springs and sweep.partial."""
    for b in prange(sweep.partial.shape[0]):
        surfaces_of_block(np.int64(b), d, surfaces, law, dt, sweep)


@law_function
def blocks_of_surfaces(d, surfaces, law, dt, sweep):
    """As surfaces_threads, by as many threads as ``sweep`` says."""


@blocks_of_surfaces.of(Serial)
def _blocks_serial(d, surfaces, law, dt, sweep):
    """One thread: blocks of discs one after another."""
    for b in range(sweep.partial.shape[0]):
        surfaces_of_block(b, d, surfaces, law, dt, sweep)


@blocks_of_surfaces.of(Threads)
def _blocks_threads(d, surfaces, law, dt, sweep):
    """Several threads: blocks of discs side by side."""
    surfaces_threads(d, surfaces, law, dt, sweep)


@inline
def add_up(partial, first, total):
    """Overwrite total (s, 2 or 3) with the sums over blocks of partial (blocks, surfaces, 3) from surface ``first``."""
    for s in range(total.shape[0]):
        for c in range(total.shape[1]):
            value = 0.0
            for b in range(partial.shape[0]):
                value += partial[b, first + s, c]
            total[s, c] = value


@inline
def add_surface_forces(d, surfaces, law, dt, sweep):
    """Add the contacts with walls, plates and rectangles; arguments as in the kernels of each.

    Overwrites springs and the forces on each surface, summed over discs block by block.
    """
    blocks_of_surfaces(d, surfaces, law, dt, sweep)
    to_plates = surfaces.walls.shape[0]
    add_up(sweep.partial, np.int64(0), surfaces.wall_load)
    add_up(sweep.partial, to_plates, surfaces.plate_force)
    add_up(sweep.partial, to_plates + surfaces.plates.shape[0], surfaces.rectangle_force)


def serial(count: int, surfaces: int, budget: bool) -> Serial:
    """One thread over so many discs and surfaces, with or without an energy ``budget``; all discs count as near."""
    blocks = max(1, -(-count // BLOCK))
    near = np.ones((surfaces, -(-count // RUN)), np.uint8)
    return Serial(np.zeros((blocks, surfaces, 3)), near, *scratch(1, budget))


class ThreadChoice:
    """What sweeps need beside the system: made once, renewed when the pair list is.

    ``now`` chooses: threads where there are several, and enough discs to pay for their barriers.
    """

    def __init__(self, count: int) -> None:
        self.count, self.budget = count, False
        self.one = serial(count, 0, self.budget)
        self.far_start, self.incoming_start = np.zeros(count + 1, np.int64), np.zeros(count + 1, np.int64)
        self.incoming, self.far = np.zeros(0, np.int64), np.zeros((0, 4))
        self.columns = scratch(0)
        self._builds = -1

    def now(self, pairs: PairList, surfaces: int, budget: bool, alone: bool = False) -> Threading:
        """How to sweep over the system with this list and number of ``surfaces``.

        budget : an energy budget is kept;  alone : something in the step allows one thread only.
        """
        if (self.one.partial.shape[1], self.budget) != (surfaces, budget):
            self.one, self.columns, self.budget = serial(self.count, surfaces, budget), scratch(0), budget
        if alone or self.count < SERIAL_BELOW or (threads() == 1 and not budget):
            return self.one
        if self._builds != pairs.builds:
            self._renew(pairs)
        if len(self.columns[0]) != most_threads():
            self.columns = scratch(most_threads(), budget)
        return Threads(*self.one[:2], *self.columns, self.far_start, self.incoming_start, self.incoming, self.far)

    def _renew(self, pairs: PairList) -> None:
        """Number the far pairs of the list as it is now."""
        while True:
            total = list_far(pairs.start, pairs.partner, self.far_start, self.incoming_start, self.incoming)
            if total <= len(self.incoming):
                break
            self.incoming, self.far = np.zeros(total * 3 // 2, np.int64), np.zeros((total * 3 // 2, 4))
        self._builds = pairs.builds

    def forget(self) -> None:
        """The pair list was replaced from outside."""
        self._builds = -1
