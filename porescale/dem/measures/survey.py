"""Numbers about a packing: energies, momenta, overlaps, contacts.  Nothing here changes the state.

Speeds are those of half a step ago, positions those of now; energies therefore err by a step's work.
"""

from typing import NamedTuple

import numpy as np

from porescale.common.compiled.jit import inline, kernel
from porescale.common.core.types import Floats
from porescale.dem.bodies.bonding import segments_now
from porescale.dem.bodies.rigid import clumps_of
from porescale.dem.contact.law import load_history, material_of, stored
from porescale.dem.discs import Discs
from porescale.dem.forces.rectangle import BOTTOM, LEFT, RIGHT, TOP, nearest_face
from porescale.dem.forces.segments import survey_segments
from porescale.dem.forces.walls import HIGH, LOW, NX, NY, PRESENT, PX, PY, X
from porescale.dem.motion.periodic_cell import image
from porescale.dem.state import State


@kernel
def survey_pairs(d, pairs, cell, law, touching):
    """(largest overlap over the smaller radius, its i, its j, elastic energy J/m) over the listed pairs.

    d: DiscArrays;  pairs: Pairs.  Overwrites touching (n,): number of discs that touch each disc.
    """
    touching[:] = 0
    position, radius, material = d.position, d.radius, d.material
    start, partner, history = pairs.start, pairs.partner, pairs.history
    worst, worst_i, worst_j, energy = 0.0, -1, -1, 0.0
    for i in range(radius.shape[0]):
        for k in range(start[i], start[i + 1]):
            j = partner[k]
            dx, dy = image(position[j, 0] - position[i, 0], position[j, 1] - position[i, 1], cell)
            overlap = radius[i] + radius[j] - np.sqrt(dx * dx + dy * dy)
            if overlap > 0.0:
                touching[i] += 1
                touching[j] += 1
                p = law.table[material_of(material, i), material_of(material, j)]
                spring, roll = load_history(history, k, law)
                reduced = radius[i] * radius[j] / (radius[i] + radius[j])
                normal, tangential, rolling = stored(overlap, spring, roll, reduced, p, law)
                energy += normal + tangential + rolling
                share = overlap / min(radius[i], radius[j])
                if share > worst:
                    worst, worst_i, worst_j = share, i, j
    return worst, worst_i, worst_j, energy


@inline
def stored_at_surface(i, overlap, radius, material, memory, laws, law):
    """Elastic energy (J/m) of disc i against a surface; arguments as in walls.surface_contact."""
    spring, roll = load_history(memory, i, law)
    normal, tangential, rolling = stored(overlap, spring, roll, radius, laws[material_of(material, i)], law)
    return normal + tangential + rolling


@kernel
def survey_walls(d, walls, laws, spring, law):
    """(largest overlap over the radius, its disc, its wall, elastic energy J/m) over walls (w, 4)."""
    position, radius, material = d.position, d.radius, d.material
    worst, worst_i, worst_w, energy = 0.0, -1, -1, 0.0
    for w in range(walls.shape[0]):
        for i in range(radius.shape[0]):
            distance = (position[i, 0] - walls[w, PX]) * walls[w, NX]
            distance += (position[i, 1] - walls[w, PY]) * walls[w, NY]
            overlap = radius[i] - distance
            if overlap > 0.0:
                energy += stored_at_surface(i, overlap, radius[i], material, spring[w], laws[w], law)
                if overlap / radius[i] > worst:
                    worst, worst_i, worst_w = overlap / radius[i], i, w
    return worst, worst_i, worst_w, energy


@kernel
def survey_plates(d, plates, laws, spring, law):
    """(largest overlap over the radius, its disc, its plate, elastic energy J/m) over the plates (p, 5) present."""
    position, radius, material = d.position, d.radius, d.material
    worst, worst_i, worst_w, energy = 0.0, -1, -1, 0.0
    for w in range(plates.shape[0]):
        if plates[w, PRESENT] != 0.0:
            for i in range(radius.shape[0]):
                dx = plates[w, X] - position[i, 0]
                dy = min(max(position[i, 1], plates[w, LOW]), plates[w, HIGH]) - position[i, 1]
                overlap = radius[i] - np.sqrt(dx * dx + dy * dy)
                if overlap > 0.0:
                    energy += stored_at_surface(i, overlap, radius[i], material, spring[w], laws[w], law)
                    if overlap / radius[i] > worst:
                        worst, worst_i, worst_w = overlap / radius[i], i, w
    return worst, worst_i, worst_w, energy


@kernel
def survey_rectangles(d, rectangles, laws, spring, law):
    """(largest overlap over the radius, its disc, its rectangle, elastic energy J/m) over the rectangles (k, 6)."""
    position, radius, material = d.position, d.radius, d.material
    worst, worst_i, worst_w, energy = 0.0, -1, -1, 0.0
    for w in range(rectangles.shape[0]):
        left, bottom = rectangles[w, LEFT], rectangles[w, BOTTOM]
        right, top = rectangles[w, RIGHT], rectangles[w, TOP]
        for i in range(radius.shape[0]):
            dx = min(max(position[i, 0], left), right) - position[i, 0]
            dy = min(max(position[i, 1], bottom), top) - position[i, 1]
            distance = np.sqrt(dx * dx + dy * dy)
            if distance == 0.0:
                distance = -nearest_face(position[i, 0], position[i, 1], left, bottom, right, top)[2]
            overlap = radius[i] - distance
            if overlap > 0.0:
                energy += stored_at_surface(i, overlap, radius[i], material, spring[w], laws[w], law)
                if overlap / radius[i] > worst:
                    worst, worst_i, worst_w = overlap / radius[i], i, w
    return worst, worst_i, worst_w, energy


Found = tuple[float, int, int, float]
"""Deepest overlap over the (smaller) radius, its disc, the disc or surface that it touches, elastic energy J/m."""


class Overlap(NamedTuple):
    """The deepest contact: overlap over the (smaller) radius, the disc, and what it is pressed against; ``other``: that
    disc, -1 where it is none."""

    share: float
    disc: int
    against: str
    other: int = -1


def kinetic_energy(discs: Discs) -> float:
    """Kinetic energy of translation and rotation, J/m."""
    moving = float(np.sum(discs.mass * np.sum(discs.velocity**2, axis=1)))
    return 0.5 * (moving + float(np.sum(discs.inertia * discs.spin**2)))


def elastic_energy(grains: State) -> float:
    """Stored in the normal and tangential springs of pairs, walls, plates, rectangles and segments, J/m."""
    surfaces = sum(found[3] for found in _survey_surfaces(grains))
    return float(_survey(grains)[3] + surfaces + sum(_survey_segments(grains)[3:]))


def momentum(discs: Discs) -> Floats:
    """Sum of m v, (2,) kg m/s per metre."""
    total: Floats = (discs.mass[:, None] * discs.velocity).sum(axis=0)
    return total


def angular_momentum(discs: Discs) -> float:
    """Sum of m x cross v + I w about the origin, kg m^2/s per metre (x at the whole, v at the half step)."""
    x, v = discs.position, discs.velocity
    orbital = discs.mass * (x[:, 0] * v[:, 1] - x[:, 1] * v[:, 0])
    return float(np.sum(orbital + discs.inertia * discs.spin))


def centre_of_mass(discs: Discs) -> Floats:
    """Centre of mass of all discs, (2,) m."""
    centre: Floats = (discs.mass[:, None] * discs.position).sum(axis=0) / discs.mass.sum()
    return centre


def max_overlap(grains: State) -> Overlap:
    """The deepest overlap of all pairs, walls, plates, rectangles and segments, as a share of the (smaller) radius; at
    segments and corners of the sum of radius and thickness, where a disc would go through.
    """
    share, i, j, _ = _survey(grains)
    found = [(share, i, name_of(grains, j), j)]
    walls, plates = [f"the {name} wall" for name in grains.wall_names], [f"the {name}" for name in grains.plate_names]
    names = walls, plates, [f"rectangle {k}" for k in range(len(grains.rectangles))]
    for (share, i, w, _), own in zip(_survey_surfaces(grains), names, strict=True):
        found.append((share, i, own[w] if own else "", -1))
    share, i, e, *_ = _survey_segments(grains)
    found.append((share, i, f"segment {e}" if e >= 0 else f"corner {e + grains.discs.count}", -1))
    share, i, against, j = max(found, key=lambda each: each[0])  # the first of the deepest
    return Overlap(float(share), int(i), against, int(j))


def name_of(grains: State, disc: int) -> str:
    """A disc in words: "held disc k", the k-th of those with all components held, or "grain i", its number."""
    if disc < 0 or disc >= len(grains.held) or not grains.held[disc].all():
        return f"grain {disc}"
    return f"held disc {int(np.count_nonzero(grains.held[:disc].all(axis=1)))}"


def coordination(grains: State) -> float:
    """Mean number of contacts of a disc or clump with others (walls are not counted)."""
    _survey(grains)
    bodies = grains.discs.count
    if (clumps := clumps_of(grains)) is not None:
        bodies += clumps.count - len(clumps.member)
    return float(grains.touching.sum()) / bodies if bodies else 0.0


def unbalanced(grains: State, free: int | None = None) -> float:
    """Mean net force on a disc over mean weight-like external force of the last step; 0 in equilibrium.

    free : of so many first discs, where the others are held (None: of all).
    """
    net = np.hypot(grains.discs.force[:free, 0], grains.discs.force[:free, 1]).mean()
    load = np.hypot(grains.external_force[:free, 0], grains.external_force[:free, 1]).mean()
    return float(net / load) if load > 0.0 else 0.0


def _survey(grains: State) -> Found:
    """Result of survey_pairs for ``grains``; overwrites ``grains.touching``."""
    result: Found = survey_pairs(
        grains.disc_arrays(), grains.pair_arrays(), grains.cell, grains.contact, grains.touching
    )
    return result


def _survey_surfaces(grains: State) -> list[Found]:
    """What is found at walls, plates and rectangles, nothing where there is none; corners of segments at walls by their
    own measure."""
    d, found = grains.discs, list[Found]()
    for kind, survey in (("wall", survey_walls), ("plate", survey_plates), ("rectangle", survey_rectangles)):
        table, laws, spring, _ = grains.surface(kind)
        none = 0.0, -1, -1, 0.0
        found.append(survey(grains.disc_arrays(), table, laws, spring, grains.contact) if len(table) else none)
    if grains.segments is not None and len(grains.walls):
        # Corners may be points: what they go into a wall is held against their segments.
        away = np.einsum("nwk,wk->wn", d.position[:, None] - grains.walls[:, PX : PY + 1], grains.walls[:, NX : NY + 1])
        share = (d.radius - away) / np.maximum(d.radius, grains.segments.beside_corner)
        w, i = np.unravel_index(share.argmax(), share.shape)
        found[0] = float(share[w, i]), int(i), int(w), found[0][3]
    return found


def _survey_segments(grains: State) -> tuple[float, int, int, float, float, float]:
    d = grains.discs
    if grains.segments is None:
        return 0.0, -1, 0, 0.0, 0.0, 0.0
    result: tuple[float, int, int, float, float, float] = survey_segments(
        d.position, d.radius, grains.material, segments_now(grains), grains.contact, grains.cell
    )
    return result
