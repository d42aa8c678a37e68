"""Bonds of a system: made at existing contacts, passed to kernels with the segments, and the fragments they form.

Bonds themselves, and the force they add: forces/bonds.py.
"""

from collections.abc import Iterable

import numpy as np
from numpy.typing import NDArray

from porescale.common.core.errors import Fault, InputError
from porescale.dem.contact.law import springs_of
from porescale.dem.forces.bonds import NO_BONDS, BondList, Bonds, pressing
from porescale.dem.forces.segment_list import no_segments
from porescale.dem.forces.segments import Segments
from porescale.dem.listing import current_pairs
from porescale.dem.motion.drivers import Clump
from porescale.dem.state import State
from porescale.dem.steering import steering_of

Index = NDArray[np.int64]


def segments_now(grains: State) -> Segments:
    """Segments as kernels take them; none where the system has none."""
    memory = springs_of(grains.contact)
    if grains.segments is None:
        return no_segments(grains.discs.count, memory)
    return grains.segments.now(grains.discs, memory, grains.pairs.builds)


def framed_parts(grains: State, seconds: float = 0.0, steps: int = 0) -> tuple[Segments, Bonds] | None:
    """Segments and bonds as kernels take them at a time, None where there is neither: always both, so that the loop
    over steps is not compiled for one alone."""
    if grains.segments is None and grains.bonds is None:
        return None
    bonds = NO_BONDS if grains.bonds is None else grains.bonds
    return segments_now(grains), bonds.now(seconds, steps)


def bond(grains: State, bodies: Iterable[int | Clump] | None = None) -> int:
    """Bond all contacts there are now between these bodies (discs and clumps; None: all); returns how many.

    Contacts that are bonded already stay as they are.  Raises InputError for a body that is not there, and in a cell
    that is strained.
    """
    if steering_of(grains).cell is not None:
        raise InputError(Fault("bonds", problem="are not made in a strained cell"))
    d, pairs = grains.discs, current_pairs(grains)
    first = np.repeat(np.arange(d.count), np.diff(pairs.start))
    rows = [np.column_stack((first, pairs.partner.astype(np.int64), np.zeros(len(first), np.int64)))]
    arrays = segments_now(grains)
    if grains.segments is not None:
        rows += [np.pad(arrays.corner, ((0, 0), (0, 1))), np.pad(arrays.near, ((0, 0), (0, 1)), constant_values=1)]
    ends = np.concatenate(rows)
    chosen = _chosen(grains, bodies)
    other = ends[:, 1].copy()
    if grains.segments is not None:
        sided = ends[:, 2] == 1
        other[sided] = grains.segments.ends[other[sided], 0]
    ends = ends[chosen[ends[:, 0]] & chosen[other]]
    if grains.bonds is not None:
        known = {tuple(row) for row in grains.bonds.ends[grains.bonds.whole != 0].tolist()}
        ends = ends[[tuple(row) not in known for row in ends.tolist()]] if len(ends) else ends
    back = np.zeros(len(ends))
    pressing(d.position, d.radius, grains.body_mass, grains.material, ends, arrays, grains.contact, grains.cell, back)
    made = BondList(np.ascontiguousarray(ends[back != 0.0]), back[back != 0.0])
    grains.bonds = made if grains.bonds is None else grains.bonds.joined(made)
    return made.count


def pieces(grains: State, whole: NDArray[np.uint8] | None = None) -> Index:
    """Piece that each disc (n,) belongs to: bodies that bonds hold together are one; 0 is the largest.

    whole : (m,) of the bonds, default: as they are.
    """
    from scipy.sparse import coo_array  # takes longer to import than a scene to be judged
    from scipy.sparse.csgraph import connected_components

    count, bonds = grains.discs.count, grains.bonds
    body = np.arange(count)
    if grains.drivers is not None:
        c = grains.drivers.clumps
        bound = c.group >= 0
        body[bound] = c.member[c.start[:-1]][c.group[bound]]
    held = np.zeros((0, 2), np.int64)
    if bonds is not None:
        held = bonds.partners(grains.segments)[((bonds.whole if whole is None else whole) != 0) & (bonds.back > 0.0)]
    one, other = body[held].T
    ends = np.append(one, body), np.append(other, np.arange(count))
    joined = coo_array((np.ones(len(one) + count), ends), shape=(count, count))
    number = connected_components(joined.tocsr(), directed=False)[1]
    return np.asarray(np.argsort(np.argsort(-np.bincount(number), kind="stable"))[number], np.int64)


def _chosen(grains: State, bodies: Iterable[int | Clump] | None) -> NDArray[np.bool_]:
    """Mask (n,) of the discs that belong to ``bodies``; all discs where it is None."""
    chosen = np.full(grains.discs.count, bodies is None)
    for body in () if bodies is None else bodies:
        if isinstance(body, Clump):
            if grains.drivers is None or not 0 <= body.number < grains.drivers.clumps.count:
                raise InputError(Fault("clump", body.number, "no such clump"))
            chosen[grains.drivers.clumps.discs_of(body.number)] = True
        elif 0 <= body < grains.discs.count:
            chosen[body] = True
        else:
            raise InputError(Fault("disc", body, "no such disc", allowed=f"0 to {grains.discs.count - 1}"))
    return chosen
