"""Contacts with segments and corners, and bonds, as rows of the list of contacts; see contacts.py.

As there, each contact is passed alone to the kernel that the step uses: a disc and a segment, or two corners, that are
all there is.  A segment stands as the disc at its first end, which bears its forces.  Corners of negative weight and
bonds are rows of their own, with a normal force below zero.
"""

import numpy as np
from numpy.typing import NDArray

from porescale.common.core.types import Floats
from porescale.dem.bodies.bonding import segments_now
from porescale.dem.forces.bonds import BondList, pressing, touched
from porescale.dem.forces.segment_list import SegmentList
from porescale.dem.forces.segments import (
    OUTLINE,
    Segments,
    add_segment_forces,
    segment_contact,
    transfer_history,
    weight_of,
)
from porescale.dem.measures.contact_list import NOBODY, Bodies, Contacts, Places, between, listed, nearest_image
from porescale.dem.state import State

Index = NDArray[np.int64]


def segment_contacts(grains: State, own: SegmentList) -> list[Contacts]:
    """Contacts of discs and corners with segments, of corners of weight 1, and what others take off."""
    d, cell = grains.discs, grains.cell
    known = segments_now(grains)
    known = known._replace(corner_memory=known.corner_memory.copy(), near_memory=known.near_memory.copy())
    pairs = own.corner if known.rule == OUTLINE else own.corner[:0]
    way = nearest_image(d.position[pairs[:, 1]] - d.position[pairs[:, 0]], grains.period)
    near = np.hypot(*way.T) < d.radius[pairs].sum(axis=1)
    weight = np.zeros(len(pairs), np.int64)
    for k in np.flatnonzero(near):
        weight[k] = weight_of(pairs[k, 0], pairs[k, 1], way[k, 0], way[k, 1], d.position, known)
        transfer_history(int(k), int(weight[k]), known, d.position, grains.contact, cell)
    found = []
    once = np.flatnonzero(weight > 0)
    if len(once):
        found.append(_alone(grains, known, pairs[once], known.corner_memory[once], way[once]))
    fewer = np.flatnonzero(weight < 0)
    if len(fewer):
        found.append(_taken_off(grains, known, np.pad(pairs[fewer], ((0, 0), (0, 1))), None))
    rows = []
    for row, (i, e) in enumerate(own.near):
        a, b = own.ends[e]
        overlap, share, dx, dy = segment_contact(known.rule, i, a, b, d.radius, d.position, cell)
        if overlap > 0.0:
            rows.append((row, i, a, b, overlap, share, dx, dy))
    if rows:
        which, members = np.split(np.array([row[:4] for row in rows], np.int64), [1], axis=1)
        overlaps, shares, away = np.split(np.array([row[4:] for row in rows]), [1, 2], axis=1)
        memory = known.near_memory[which[:, 0]]
        found.append(_alone(grains, known, members, memory, away, overlaps[:, 0], shares[:, 0]))
    return found


def _alone(
    grains: State, known: Segments, members: Index, memory: Floats, way: Floats,
    overlap: Floats | None = None, share: Floats | None = None,
) -> Contacts:  # fmt: skip
    """Contacts of ``members`` (c, 2) corners, or (c, 3) disc and ends of a segment, each by itself.

    memory (c, k): springs, overwritten;  way (c, 2) m from the first to the touched point;  overlap (c,) m, share (c,)
    of the way along the segment.
    """
    d, (count, each) = grains.discs, members.shape
    rows = members.ravel()
    ends = np.zeros((0, 2), np.int64)
    pair = near = ends
    if each == 2:
        pair, corner_memory, near_memory = 2 * np.arange(count)[:, None] + (0, 1), memory, memory[:0]
    else:
        ends = 3 * np.arange(count)[:, None] + (1, 2)
        near, corner_memory, near_memory = np.column_stack((3 * np.arange(count), np.arange(count))), memory[:0], memory
    alone = Segments(
        known.rule, np.ascontiguousarray(ends), np.zeros(len(rows) + 1, np.int64), np.zeros(0, np.int64),
        np.ascontiguousarray(pair), corner_memory, np.zeros((len(pair), 0), np.int64),
        np.ascontiguousarray(near), near_memory,
    )  # fmt: skip
    found = grains.some_discs(rows)
    add_segment_forces(found, alone, grains.contact, grains.last_dt, grains.cell)
    i, a = members[:, 0], members[:, 1]
    branch = None if share is None else way - share[:, None] * (d.position[members[:, 2]] - d.position[a])
    loads = found.force[1::each], found.torque.reshape(-1, each)[:, :2], memory[:, 0]
    return between(grains, i, a, way, loads, branch, overlap)


def bond_contacts(grains: State, own: BondList) -> Contacts:
    """Bonds that hold, each with its back tension as a normal force below zero."""
    known = segments_now(grains)
    whole = own.whole != 0
    return _taken_off(grains, known, own.ends[whole], own.back[whole])


def _taken_off(grains: State, known: Segments, ends: Index, back: Floats | None) -> Contacts:
    """Rows of ``ends`` (c, 3), see Bonds, that press with -back (c,) N/m; None: with the elastic force by weight."""
    d, count = grains.discs, len(ends)
    if back is None:
        back = np.zeros(count)
        pressing(
            d.position, d.radius, grains.body_mass, grains.material, ends, known, grains.contact, grains.cell, back
        )
        back = -back
    way, far, other = np.zeros((count, 2)), np.zeros((count, 2)), np.zeros(count, np.int64)
    touched(d.position, ends, known, grains.cell, way, far, other)
    i, distance = ends[:, 0], np.hypot(*way.T)
    normal = way / distance[:, None]
    force = -back[:, None] * normal
    torque = np.column_stack((np.zeros(count), far[:, 0] * force[:, 1] - far[:, 1] * force[:, 0]))
    bodies = Bodies(i, other, np.full(count, NOBODY))
    at = Places(d.position[i] + 0.5 * way, normal, d.position[i], way - far, d.radius[i] + d.radius[other] - distance)
    return listed(bodies, at, force, torque, np.zeros(count), np.zeros(count))
