"""Sweeps over discs and contacts, by one thread or by several, with the same bits.

Discs are cut into blocks of BLOCK by their numbers.  In a half list a pair belongs to its lower disc, and the force on
a disc is summed over lower partners first, in their order, then over its own row.  Threads keep to that order:
1. every block works out its pairs with discs of later blocks ("far") and puts the results down, one place each;
2. every block adds, for its discs, what earlier blocks put down for them, then its pairs within, then its own far ones.
No two blocks write to one place, and each sum is that of the single thread, to the bit, at any number of threads and in
any numbering of the discs; far pairs, which cost twice the memory traffic, are few where neighbours have near numbers.
Forces on walls and the like are summed block by block, by a single thread, too.

Where a book of energy is kept, systems that are large enough for threads take this way with one thread as well: entries
of far pairs come first in it.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from porescale.common.compiled.jit import by_law, inline, kernel, parallel_kernel, prange, threads
from porescale.common.neighbors.pair_list import PairList
from porescale.dem.contact.law import HertzRolling, HertzSliding, LinearRolling, LinearSliding, LinearSmooth
from porescale.dem.forces.pairs import numbers_of, pair_contact, pair_forces, start_forces
from porescale.dem.forces.rectangle import add_rectangle_forces
from porescale.dem.forces.walls import RUN, add_near_walls, add_plate_forces, runs_of

Array = NDArray[np.float64]
Index = NDArray[np.int64]

BLOCK = 1024
"""Discs, in whole runs of walls.RUN: their state stays in a core's own memory; a settled pile has some hundredths of
its pairs across blocks."""
SERIAL_BELOW = 20_000  # discs; fewer cost less in one thread than barriers cost (spec: "below about 2e4")
NOTHING = np.nan
"""Put down for a far pair that does not touch: adding a zero could turn -0.0 into 0.0."""


class Serial(NamedTuple):
    """One thread.

    partial (blocks, surfaces, 3) N/m, N m/m: forces on walls, plates and rectangles by block;  near (surfaces, runs):
    which runs of discs are near each wall, see walls.ask_near; rows of other surfaces are not read.
    """

    partial: Array
    near: NDArray[np.uint8]


class Threads(NamedTuple):
    """Several threads.

    partial, near : as in Serial;  far_start (n + 1,): far pairs of each disc are the last of its row and have the
    places far_start[i]:far_start[i + 1];  incoming (f,): places of the far pairs that end at disc j, by rising lower
    disc, incoming_start[j]:incoming_start[j + 1];  far (f, 4): force on i N/m, torques on i and j N m/m.
    """

    partial: Array
    near: NDArray[np.uint8]
    far_start: Index
    incoming_start: Index
    incoming: Index
    far: Array


Sweep = Serial | Threads


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
def far_forces(position, velocity, spin, radius, start, partner, carried, law, dt, cell, far_start, far):
    """Contacts of pairs across blocks: overwrites far (f, 4) and their springs.  Arguments as in pair_forces."""
    count, shared = radius.shape[0], numbers_of(law.table[0, 0])
    for b in prange((count + BLOCK - 1) // BLOCK):
        for i in range(b * BLOCK, min((b + 1) * BLOCK, count)):
            q = far_start[i]
            for k in range(start[i + 1] - (far_start[i + 1] - q), start[i + 1]):
                met, gx, gy, moment_i, moment_j = pair_contact(
                    i, partner[k], k, position, velocity, spin, radius, carried, shared, law, dt, cell
                )
                far[q, 0] = gx if met else NOTHING
                far[q, 1], far[q, 2], far[q, 3] = gy, moment_i, moment_j
                q += 1


@parallel_kernel
def near_forces(
    position, velocity, spin, radius, force, torque, external_force, external_torque, start, partner, carried, law, dt,
    cell, far_start, incoming_start, incoming, far,
):  # fmt: skip
    """All forces between discs, those across blocks from ``far``: overwrites force (n, 2), torque (n,) and springs."""
    count, shared = radius.shape[0], numbers_of(law.table[0, 0])
    for b in prange((count + BLOCK - 1) // BLOCK):
        first, last = b * BLOCK, min((b + 1) * BLOCK, count)
        for j in range(first, last):
            fx, fy, moment = external_force[j, 0], external_force[j, 1], external_torque[j]
            for place in range(incoming_start[j], incoming_start[j + 1]):
                q = incoming[place]
                if far[q, 0] == far[q, 0]:
                    fx -= far[q, 0]
                    fy -= far[q, 1]
                    moment += far[q, 3]
            force[j, 0], force[j, 1], torque[j] = fx, fy, moment
        for i in range(first, last):
            fx, fy, moment = 0.0, 0.0, 0.0
            for k in range(start[i], start[i + 1] - (far_start[i + 1] - far_start[i])):
                j = partner[k]
                met, gx, gy, moment_i, moment_j = pair_contact(
                    i, j, k, position, velocity, spin, radius, carried, shared, law, dt, cell
                )
                if met:
                    fx += gx
                    fy += gy
                    moment += moment_i
                    force[j, 0] -= gx
                    force[j, 1] -= gy
                    torque[j] += moment_j
            for q in range(far_start[i], far_start[i + 1]):
                if far[q, 0] == far[q, 0]:
                    fx += far[q, 0]
                    fy += far[q, 1]
                    moment += far[q, 2]
            force[i, 0] += fx
            force[i, 1] += fy
            torque[i] += moment


@by_law
def sweep_pairs(
    position, velocity, spin, radius, force, torque, external_force, external_torque, start, partner, carried, law,
    dt, cell, sweep,
):  # fmt: skip
    """Overwrite force (n, 2) N/m and torque (n,) N m/m with the external ones and those between discs."""


@sweep_pairs.of(Serial)
def _pairs_serial(
    position, velocity, spin, radius, force, torque, external_force, external_torque, start, partner, carried, law, dt,
    cell, sweep,
):  # fmt: skip
    """One loop over the list."""
    start_forces(force, torque, external_force, external_torque)
    pair_forces(position, velocity, spin, radius, force, torque, start, partner, carried, law, dt, cell)


@sweep_pairs.of(Threads)
def _pairs_threads(
    position, velocity, spin, radius, force, torque, external_force, external_torque, start, partner, carried, law, dt,
    cell, sweep,
):  # fmt: skip
    """Pairs across blocks first, then block by block."""
    far_forces(position, velocity, spin, radius, start, partner, carried, law, dt, cell, sweep.far_start, sweep.far)
    near_forces(
        position, velocity, spin, radius, force, torque, external_force, external_torque, start, partner, carried, law,
        dt, cell, sweep.far_start, sweep.incoming_start, sweep.incoming, sweep.far,
    )  # fmt: skip


@inline
def cut(array, first, last):
    """Rows first to last of an array, or None of None."""
    if array is None:
        return None
    return array[first:last]


@by_law
def law_of_block(first, last, law):
    """The law of discs first to last."""


@law_of_block.of(LinearSliding)
def _linear_sliding(first, last, law):
    """Of its kind."""
    return LinearSliding(law.table, cut(law.material, first, last), law.mass[first:last], cut(law.book, first, last))


@law_of_block.of(LinearSmooth)
def _linear_smooth(first, last, law):
    """Of its kind."""
    return LinearSmooth(law.table, cut(law.material, first, last), law.mass[first:last], cut(law.book, first, last))


@law_of_block.of(LinearRolling)
def _linear_rolling(first, last, law):
    """Of its kind."""
    return LinearRolling(law.table, cut(law.material, first, last), law.mass[first:last], cut(law.book, first, last))


@law_of_block.of(HertzSliding)
def _hertz_sliding(first, last, law):
    """Of its kind."""
    return HertzSliding(law.table, cut(law.material, first, last), law.mass[first:last], cut(law.book, first, last))


@law_of_block.of(HertzRolling)
def _hertz_rolling(first, last, law):
    """Of its kind."""
    return HertzRolling(law.table, cut(law.material, first, last), law.mass[first:last], cut(law.book, first, last))


@inline
def surfaces_of_block(
    b, position, velocity, spin, radius, force, torque, walls, wall_laws, wall_spring, plates, plate_laws, plate_spring,
    rectangles, rectangle_laws, rectangle_spring, law, dt, partial, near,
):  # fmt: skip
    """Contacts of the discs of block b with all surfaces; overwrites partial[b]."""
    first, last = b * BLOCK, min((b + 1) * BLOCK, radius.shape[0])
    own = law_of_block(first, last, law)
    x, v, w, r = position[first:last], velocity[first:last], spin[first:last], radius[first:last]
    f, t = force[first:last], torque[first:last]
    to_plates = walls.shape[0]
    to_rectangles = to_plates + plates.shape[0]
    add_near_walls(
        x, v, w, r, f, t, walls, wall_laws, wall_spring[:, first:last], partial[b, :to_plates],
        near[:, first // RUN : runs_of(last)], own, dt,
    )  # fmt: skip
    if plates.shape[0] > 0:
        add_plate_forces(
            x, v, w, r, f, t, plates, plate_laws, plate_spring[:, first:last], partial[b, to_plates:to_rectangles], own,
            dt,
        )  # fmt: skip
    if rectangles.shape[0] > 0:
        add_rectangle_forces(
            x, v, w, r, f, t, rectangles, rectangle_laws, rectangle_spring[:, first:last], partial[b, to_rectangles:],
            own, dt,
        )  # fmt: skip


@parallel_kernel
def surfaces_threads(
    position, velocity, spin, radius, force, torque, walls, wall_laws, wall_spring, plates, plate_laws, plate_spring,
    rectangles, rectangle_laws, rectangle_spring, law, dt, partial, near,
):  # fmt: skip
    """Contacts with all surfaces, block by block: adds to force and torque, overwrites springs and partial."""
    for b in prange(partial.shape[0]):
        surfaces_of_block(
            b, position, velocity, spin, radius, force, torque, walls, wall_laws, wall_spring, plates, plate_laws,
            plate_spring, rectangles, rectangle_laws, rectangle_spring, law, dt, partial, near,
        )  # fmt: skip


@by_law
def sweep_blocks(
    position, velocity, spin, radius, force, torque, walls, wall_laws, wall_spring, plates, plate_laws,
    plate_spring, rectangles, rectangle_laws, rectangle_spring, law, dt, sweep,
):  # fmt: skip
    """As surfaces_threads, by as many threads as ``sweep`` says."""


@sweep_blocks.of(Serial)
def _blocks_serial(
    position, velocity, spin, radius, force, torque, walls, wall_laws, wall_spring, plates, plate_laws, plate_spring,
    rectangles, rectangle_laws, rectangle_spring, law, dt, sweep,
):  # fmt: skip
    """One block after another."""
    for b in range(sweep.partial.shape[0]):
        surfaces_of_block(
            b, position, velocity, spin, radius, force, torque, walls, wall_laws, wall_spring, plates, plate_laws,
            plate_spring, rectangles, rectangle_laws, rectangle_spring, law, dt, sweep.partial, sweep.near,
        )  # fmt: skip


@sweep_blocks.of(Threads)
def _blocks_threads(
    position, velocity, spin, radius, force, torque, walls, wall_laws, wall_spring, plates, plate_laws, plate_spring,
    rectangles, rectangle_laws, rectangle_spring, law, dt, sweep,
):  # fmt: skip
    """Blocks by threads."""
    surfaces_threads(
        position, velocity, spin, radius, force, torque, walls, wall_laws, wall_spring, plates, plate_laws,
        plate_spring, rectangles, rectangle_laws, rectangle_spring, law, dt, sweep.partial, sweep.near,
    )  # fmt: skip


@inline
def add_up(partial, first, total):
    """Overwrite total (s, 2 or 3) with the sums over blocks of partial (blocks, surfaces, 3) from surface ``first``."""
    for s in range(total.shape[0]):
        for c in range(total.shape[1]):
            value = 0.0
            for b in range(partial.shape[0]):
                value += partial[b, first + s, c]
            total[s, c] = value


@kernel
def sweep_surfaces(
    position, velocity, spin, radius, force, torque, walls, wall_laws, wall_spring, wall_force, plates, plate_laws,
    plate_spring, plate_force, rectangles, rectangle_laws, rectangle_spring, rectangle_force, law, dt, sweep,
):  # fmt: skip
    """Add the contacts with walls, plates and rectangles; arguments as in the kernels of each.

    Overwrites springs and the forces on each surface, summed over discs block by block.
    """
    sweep_blocks(
        position, velocity, spin, radius, force, torque, walls, wall_laws, wall_spring, plates, plate_laws,
        plate_spring, rectangles, rectangle_laws, rectangle_spring, law, dt, sweep,
    )  # fmt: skip
    add_up(sweep.partial, 0, wall_force)
    add_up(sweep.partial, walls.shape[0], plate_force)
    add_up(sweep.partial, walls.shape[0] + plates.shape[0], rectangle_force)


def serial(count: int, surfaces: int) -> Serial:
    """One thread over so many discs and surfaces; all discs count as near."""
    blocks = max(1, -(-count // BLOCK))
    return Serial(np.zeros((blocks, surfaces, 3)), np.ones((surfaces, -(-count // RUN)), np.uint8))


class Sweeps:
    """What sweeps need beside the system: made once, renewed when the pair list is.

    ``now`` chooses: threads where there are several, and enough discs to pay for their barriers.
    """

    def __init__(self, count: int) -> None:
        self.count = count
        self._room_for(0)
        self.far_start, self.incoming_start = np.zeros(count + 1, np.int64), np.zeros(count + 1, np.int64)
        self.incoming, self.far = np.zeros(0, np.int64), np.zeros((0, 4))
        self._builds = -1

    def now(self, pairs: PairList, surfaces: int, booked: bool, alone: bool = False) -> Sweep:
        """How to sweep over the system with this list and number of ``surfaces``.

        booked : an energy book is kept;  alone : something in the step allows one thread only.
        """
        if self.partial.shape[1] != surfaces:
            self._room_for(surfaces)
        if alone or self.count < SERIAL_BELOW or (threads() == 1 and not booked):
            return Serial(self.partial, self.near)
        if self._builds != pairs.builds:
            self._renew(pairs)
        return Threads(self.partial, self.near, self.far_start, self.incoming_start, self.incoming, self.far)

    def _room_for(self, surfaces: int) -> None:
        """Arrays for so many surfaces."""
        self.partial, self.near = serial(self.count, surfaces)

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
