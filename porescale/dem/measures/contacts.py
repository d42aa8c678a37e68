"""Every contact of a system with its force: between discs, and of discs with walls, plates, rectangles, segments.

Forces are not computed by formulas of their own: each contact is passed alone to the kernel that the step uses, with
copies of what it carries.  So the list says what the next contact step will use, to the bit, springs included; a
list taken between two steps sums to ``discs.force`` after the second.  Nothing of the system is changed.
"""

from collections.abc import Callable
from dataclasses import fields
from typing import Any

import numpy as np
from numpy.typing import NDArray

from porescale.common.core.types import Floats
from porescale.dem.arrays import DiscArrays, Pairs, Surface
from porescale.dem.bodies.rigid import arms, clumps_of
from porescale.dem.contact.law import MU, springs_of
from porescale.dem.forces.batch import pair_forces, scratch
from porescale.dem.forces.rectangle import BOTTOM, LEFT, RIGHT, TOP, add_rectangle_forces, nearest_face
from porescale.dem.forces.walls import HIGH, LOW, NX, PRESENT, PX, X, add_wall_forces
from porescale.dem.listing import current_pairs
from porescale.dem.measures.contact_list import (
    NOBODY,
    Bodies,
    Contacts,
    Places,
    between,
    listed,
    material_of,
    nearest_image,
)
from porescale.dem.measures.contacts_segments import bond_contacts, segment_contacts
from porescale.dem.state import State

Index = NDArray[np.int64]


def contacts(grains: State) -> Contacts:
    """All contacts of ``grains`` now, with the step that was last used (before the first step: none passes)."""
    names = (*grains.wall_names, *grains.plate_names, *(f"rectangle {k}" for k in range(len(grains.rectangles))))
    parts = [_pairs(grains)]
    first = 0
    for kind in (_wall, _plate, _rectangle):
        surfaces = kind(grains)
        parts += [_surface(grains, first + w, *each) for w, each in enumerate(surfaces)]
        first += len(surfaces)
    if grains.segments is not None:
        parts += segment_contacts(grains, grains.segments)
    if grains.bonds is not None:
        parts.append(bond_contacts(grains, grains.bonds))
    joined = {
        it.name: np.concatenate([getattr(part, it.name) for part in parts])
        for it in fields(Contacts)
        if it.name != "names"
    }
    if clumps_of(grains) is not None:
        arm, one, other = arms(grains), joined["first"], joined["second"]
        joined["start"] -= arm[one]
        joined["branch"] += arm[one] - np.where(other[:, None] == NOBODY, 0.0, arm[other])
    return Contacts(names=names, **joined)


def _pairs(grains: State) -> Contacts:
    """Contacts between discs: the pair list as one where every pair has two discs of its own."""
    pairs, d = current_pairs(grains), grains.discs
    i = np.repeat(np.arange(d.count), np.diff(pairs.start))
    j = pairs.partner.astype(np.int64)
    apart = nearest_image(d.position[j] - d.position[i], grains.period)
    near = np.sum(apart**2, axis=1) < (d.radius[i] + d.radius[j]) ** 2
    i, j, apart = i[near], j[near], apart[near]
    count = len(i)
    both = grains.some_discs(np.column_stack((i, j)).ravel())
    start = np.repeat(np.arange(count + 1), 2)[1:]  # discs 2k have one partner, 2k + 1 none
    carried = pairs.carried[near].copy()
    alone = Pairs(start, (2 * np.arange(count) + 1).astype(np.int32), carried, both.position, 0.0)
    numbers, which = scratch(1)
    pair_forces(both, alone, grains.contact, grains.last_dt, grains.cell, numbers[0], which[0])
    return between(grains, i, j, apart, (both.force[1::2], both.torque.reshape(-1, 2), carried[:, 0]))


Forces = Callable[[Index], tuple[DiscArrays, Floats]]
Touched = tuple[Floats, Floats, Forces, Floats]
"""Closest point (n, 2) m and signed distance (n,) m of every disc; the step's forces on some; friction by material."""


def _surface(
    grains: State, number: int, nearest: Floats, distance: Floats, forces: Forces, friction: Floats
) -> Contacts:
    """The contacts of one surface."""
    d = grains.discs
    i = np.flatnonzero(distance < d.radius)
    found, spring = forces(i)
    force, torque = found.force, found.torque
    branch = nearest[i] - d.position[i]
    depth = distance[i]
    # From inside of a rectangle the surface is behind the disc: the normal points away from it.
    normal = np.where(depth[:, None] > 0.0, 1.0, -1.0) * branch / np.where(depth == 0.0, 1.0, np.abs(depth))[:, None]
    count, other = len(i), np.zeros(len(i))
    if springs_of(grains.contact) > 1:  # what is not the tangential force on its arm resists rolling
        other = np.maximum(depth, 0.0) * (force[:, 1] * normal[:, 0] - force[:, 0] * normal[:, 1]) - torque
    bodies = Bodies(i, np.full(count, NOBODY), np.full(count, number))
    at = Places(nearest[i], normal, d.position[i], branch, d.radius[i] - depth)
    return listed(bodies, at, -force, np.column_stack((torque, other)), spring, friction[material_of(grains, i)])


def _wall(grains: State) -> list[Touched]:
    """Contacts of the discs with each straight wall; one entry per wall."""
    d = grains.discs
    made: list[Touched] = []
    for w, row in enumerate(grains.walls):
        inward = row[NX : NX + 2]
        distance = (d.position - row[PX : PX + 2]) @ inward
        forces = _single(grains, add_wall_forces, grains.surface("wall"), w)
        made.append((d.position - distance[:, None] * inward, distance, forces, grains.wall_laws[w, :, MU]))
    return made


def _plate(grains: State) -> list[Touched]:
    """Contacts of the discs with each upright plate; none with a plate that was removed."""
    x, y = grains.discs.position.T
    made: list[Touched] = []
    for w, row in enumerate(grains.plates):
        nearest = np.column_stack((np.full_like(x, row[X]), np.clip(y, row[LOW], row[HIGH])))
        distance = np.hypot(nearest[:, 0] - x, nearest[:, 1] - y)
        distance = distance if row[PRESENT] else np.full_like(distance, np.inf)
        forces = _single(grains, add_rectangle_forces, grains.surface("plate"), w)
        made.append((nearest, distance, forces, grains.plate_laws[w, :, MU]))
    return made


def _rectangle(grains: State) -> list[Touched]:
    """Rectangles, from outside, or from inside through the nearest face."""
    made: list[Touched] = []
    at = grains.discs.position
    for w, row in enumerate(grains.rectangles):
        nearest = np.clip(at, row[[LEFT, BOTTOM]], row[[RIGHT, TOP]])
        distance = np.hypot(*(nearest - at).T)
        for i in np.flatnonzero(distance == 0.0):
            nx, ny, depth = nearest_face(*at[i], *row[[LEFT, BOTTOM, RIGHT, TOP]])
            nearest[i], distance[i] = at[i] - depth * np.array([nx, ny]), -depth
        forces = _single(grains, add_rectangle_forces, grains.surface("rectangle"), w)
        made.append((nearest, distance, forces, grains.rectangle_laws[w, :, MU]))
    return made


def _single(grains: State, kernel: Any, surface: Surface, w: int) -> Forces:
    """The forces of row ``w`` of a surface on discs by index, and the springs (c,) m that result."""

    def forces(i: Index) -> tuple[DiscArrays, Floats]:
        """The discs ``i`` (c,) with the forces on them, and their springs (c,) m."""
        found, row = grains.some_discs(i), slice(w, w + 1)
        spring, total = surface[2][row, i].copy(), np.zeros((1, 2))
        where = () if kernel is add_wall_forces else (0, 0, len(i))  # rows of the load, first and last disc
        kernel(found, surface[0][row], surface[1][row], spring, total, *where, grains.contact, grains.last_dt)
        spent: Floats = spring[0, :, 0]
        return found, spent

    return forces
