"""Contact forces of line segments with thickness, and of the corners that join them, on discs and on each other.

A segment is all that lies within its thickness t of the line between its ends.  Its ends are discs of radius t, rows
among the discs ("corners", members of a rigid body), so that all contacts are of a point with a radius, disc or corner,
against the closest point of a segment: overlap = r + t - distance.  Segment against segment are the four of their ends.

Rules for what counts, see RULES:
"outline": the segments of a body are one outline.  With f(overlap) the potential of a contact, each pair of bodies has
        U = sum over (point, segment) of f(r + t - distance)  -  sum over (point, corner) of (c - 1) f(r + t - distance)
    where c segments end at both of the pair: two at a corner of a polygon, one at the end of a chain, none at a disc.
    Distances to segments have continuous gradients outside them, so U and the forces are continuous; where the closest
    point of a segment is its end, its term and one of the corner's cancel.  What is left is computed: segments whose
    closest point lies between the ends, and corners with the weight
        1 - number of segments, at either point of the pair, on whose side the other point lies.
    So a disc that rolls round a corner always has one contact, corner against corner counts once, a straight side cut
    in two is as stiff as one, and faces that slide off each other lose their contacts gradually.
"each": every segment for itself, with its rounded ends: corners of polygons are twice as stiff, U as continuous.
"printed": equations 5 to 9 of the DEMseg tutorial, with the radius that (7) lacks: near an end the overlap falls to
    zero, past it it jumps, and energy cannot close.  For comparison.

A straight side is flat: what lies on it rolls at its own radius r, as on a wall, but the torque mu_r r N is at most
that of N at an end of the side, half its length L off its middle: r <= L/(2 mu_r).  At the ends the radius is the
reduced one of two round bodies.  Elastic forces of the law of Hertz have that everywhere, as they must go on there.

A negative weight takes elastic force off, nothing else: no dashpot, no friction.  Where a contact passes from segment
to corner or back its springs are transferred.

Sources: Matsushima, DEMseg tutorial II-2;  Alonso-Marroquin 2008, EPL 83, 14001 (spheropolygons: potentials of the
distances between vertices and edges, here with corners counted once by inclusion and exclusion).
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from porescale.common.compiled.jit import inline, kernel
from porescale.common.core.types import Floats
from porescale.dem.contact.budget import has_budget
from porescale.dem.contact.law import (
    MUR,
    has_history,
    load_history,
    material_of,
    stiffness,
    store_history,
    stored,
    stored_normal,
)
from porescale.dem.forces.pairs import Approach, contact_force, contact_kinematics, relative_velocity, release_contact
from porescale.dem.motion.periodic_cell import image

Index = NDArray[np.int64]

RULES = ("outline", "each", "printed")
OUTLINE, EACH, PRINTED = range(3)


class Segments(NamedTuple):
    """Segments as kernels take them.

    rule : index into RULES;  ends (s, 2): discs at the ends;  start (n + 1,), other (2 s,): discs at the other ends of
    the segments that end at disc i, ``other[start[i]:start[i + 1]]``;  corner (m, 2), lower first: pairs of discs of
    which at least one is a corner, with corner_memory (m, k) m, their springs;  near (l, 2): disc and segment, with
    near_memory (l, k) m;  beside (m, w): rows of ``near`` that share the points of a corner pair, -1 for none.
    """

    rule: int
    ends: Index
    start: Index
    other: Index
    corner: Index
    corner_memory: Floats
    beside: Index
    near: Index
    near_memory: Floats


@inline
def closest_point(i, a, b, position, cell):
    """(whether the point of segment a-b closest to disc i lies between the ends; its share of the way from a to b; the
    way to it from i, x, y m).
    """
    ex, ey = position[b, 0] - position[a, 0], position[b, 1] - position[a, 1]
    ax, ay = image(position[a, 0] - position[i, 0], position[a, 1] - position[i, 1], cell)
    bx, by = image(position[b, 0] - position[i, 0], position[b, 1] - position[i, 1], cell)
    before, after = -(ax * ex + ay * ey), bx * ex + by * ey
    if before <= 0.0:
        return False, 0.0, ax, ay
    if after <= 0.0:
        return False, 1.0, bx, by
    share = before / (before + after)
    return True, share, ax + share * ex, ay + share * ey


@inline
def printed(i, a, b, reach, position, cell):
    """(overlap m, share of the way, way to the touched point m) of disc i and segment a-b by equations 5 to 9 of
    the DEMseg tutorial;  reach (m): both radii together.
    """
    ex, ey = position[b, 0] - position[a, 0], position[b, 1] - position[a, 1]
    ax, ay = image(position[a, 0] - position[i, 0], position[a, 1] - position[i, 1], cell)
    length = np.sqrt(ex * ex + ey * ey)
    along, away = -(ax * ex + ay * ey) / length, abs(ax * ey - ay * ex) / length
    if away >= reach:
        return -1.0, 0.0, ax, ay
    half = np.sqrt(reach * reach - away * away)
    within = min(along, length - along)
    if within <= 0.0:
        share = 0.0 if along <= 0.0 else 1.0
        x, y = ax + share * ex, ay + share * ey
        return reach - np.sqrt(x * x + y * y), share, x, y
    share = along / length
    overlap = (reach - away) * min(within / half, 1.0)
    return overlap, share, ax + share * ex, ay + share * ey


@inline
def segment_contact(rule, i, a, b, radius, position, cell):
    """(overlap m, share of the way from a to b, way x, y m to the touched point) of disc i and segment a-b by ``rule``;
    an overlap <= 0 is none.
    """
    reach = radius[i] + radius[a]
    if rule == PRINTED:
        return printed(i, a, b, reach, position, cell)
    between, share, dx, dy = closest_point(i, a, b, position, cell)
    overlap = reach - np.sqrt(dx * dx + dy * dy)
    if rule == OUTLINE and not between:
        overlap = min(overlap, 0.0)
    return overlap, share, dx, dy


@inline
def on_side(way, share, radius, along, up, turn, friction):
    """``way`` as it is where the touched point, at ``share`` of a side that goes (along, up) m, lies between its ends:
    what has ``radius`` (m) rolls on a plane, see module;  turn (rad/s): of both against each other;  friction: of
    rolling."""
    if share <= 0.0 or share >= 1.0:
        return way
    at, half = radius, 0.5 * np.sqrt(along * along + up * up)
    if friction * at > half:
        at = half / friction
    return Approach(way.nx, way.ny, way.arm_i, way.arm_j, way.closing, way.slip, way.reduced, at * turn, at)


@inline
def above(i, dx, dy, position, start, other):
    """Number of segments that end at disc i on whose side a point lies that is (dx, dy) m from it."""
    count = 0
    for k in range(start[i], start[i + 1]):
        o = other[k]
        if dx * (position[o, 0] - position[i, 0]) + dy * (position[o, 1] - position[i, 1]) > 0.0:
            count += 1
    return count


@inline
def weight_of(i, j, dx, dy, position, segments):
    """How often the pair of corners i and j, (dx, dy) m apart, counts: see module."""
    seen = above(i, dx, dy, position, segments.start, segments.other)
    return 1 - seen - above(j, -dx, -dy, position, segments.start, segments.other)


@inline
def between_ends(segments, row, position, cell):
    """Whether the closest point of row ``row`` of ``segments.near`` lies between the ends."""
    e = segments.near[row, 1]
    return closest_point(segments.near[row, 0], segments.ends[e, 0], segments.ends[e, 1], position, cell)[0]


@kernel
def transfer_history(k, weight, segments, position, law, cell):
    """Springs of corner pair k (weight 1) from a segment that the contact has left, or to one that it has come to."""
    memory, own = segments.corner_memory, segments.near_memory
    if weight == 1 and not has_history(memory, k, law):
        for place in range(segments.beside.shape[1]):
            row = segments.beside[k, place]
            if row >= 0 and has_history(own, row, law) and not between_ends(segments, row, position, cell):
                spring, roll = load_history(own, row, law)
                store_history(memory, k, spring, roll, law)
                store_history(own, row, 0.0, 0.0, law)
                return
    if weight < 1 and has_history(memory, k, law):
        for place in range(segments.beside.shape[1]):
            row = segments.beside[k, place]
            if row >= 0 and not has_history(own, row, law) and between_ends(segments, row, position, cell):
                spring, roll = load_history(memory, k, law)
                store_history(own, row, spring, roll, law)
                store_history(memory, k, 0.0, 0.0, law)
                return


@kernel
def add_corner_forces(d, segments, law, dt, cell):
    """Add the contacts of all pairs with a corner, by their weights, see module; arguments as in add_segment_forces.

    Comes before the segments, whose springs it may take or fill.
    """
    memory, budget = segments.corner_memory, d.budget
    position, velocity, spin, force, torque = d.position, d.velocity, d.spin, d.force, d.torque
    for k in range(segments.corner.shape[0]):
        i, j = segments.corner[k, 0], segments.corner[k, 1]
        dx, dy = image(position[j, 0] - position[i, 0], position[j, 1] - position[i, 1], cell)
        ri, rj = d.radius[i], d.radius[j]
        overlap = ri + rj - np.sqrt(dx * dx + dy * dy)
        weight = weight_of(i, j, dx, dy, position, segments)
        if overlap > 0.0 and weight != 0:
            transfer_history(k, weight, segments, position, law, cell)
            mass = d.body_mass[i] * d.body_mass[j] / (d.body_mass[i] + d.body_mass[j])
            p = law.table[material_of(d.material, i), material_of(d.material, j)]
            if weight > 0:
                du, dv = relative_velocity(i, j, dx, dy, velocity, cell)
                way = contact_kinematics(dx, dy, du, dv, spin[i], spin[j], ri, rj)
                gx, gy, moment_i, moment_j = contact_force(i, k, overlap, way, mass, p, memory, budget, law, dt)
                torque[i] += moment_i
                torque[j] += moment_j
            else:
                elastic = weight * stiffness(overlap, ri * rj / (ri + rj), mass, p, law)[0]
                distance = ri + rj - overlap
                gx, gy = -elastic * dx / distance, -elastic * dy / distance
            force[i, 0] += gx
            force[i, 1] += gy
            force[j, 0] -= gx
            force[j, 1] -= gy
        elif overlap > 0.0:
            transfer_history(k, weight, segments, position, law, cell)
        if not (overlap > 0.0 and weight > 0) and has_history(memory, k, law):
            if has_budget(budget):
                du, dv = relative_velocity(i, j, dx, dy, velocity, cell)
                p = law.table[material_of(d.material, i), material_of(d.material, j)]
                way = contact_kinematics(dx, dy, du, dv, spin[i], spin[j], ri, rj)
                release_contact(i, k, min(overlap, 0.0), way, p, memory, budget, law, dt)
            store_history(memory, k, 0.0, 0.0, law)


@kernel
def add_segment_forces(d, segments, law, dt, cell):
    """Add the contacts of discs and corners with segments, and of corners; reset springs of those that do not touch.

    d: DiscArrays;  segments: Segments;  law see contact/law.py;  dt s;  cell Still.  Adds to ``d.force`` N/m and
    ``d.torque`` N m/m: at a segment all to the disc at its first end, with the
    moment that belongs to it.  Overwrites the springs in ``segments``.
    Not checked: a centre on the line of a segment gives nan, which Grains.check reports.
    """
    if segments.rule == OUTLINE:
        add_corner_forces(d, segments, law, dt, cell)
    memory, budget, radius = segments.near_memory, d.budget, d.radius
    position, velocity, spin, force, torque = d.position, d.velocity, d.spin, d.force, d.torque
    for k in range(segments.near.shape[0]):
        i, e = segments.near[k, 0], segments.near[k, 1]
        a, b = segments.ends[e, 0], segments.ends[e, 1]
        overlap, share, dx, dy = segment_contact(segments.rule, i, a, b, radius, position, cell)
        if overlap <= 0.0 and not (has_budget(budget) and has_history(memory, k, law)):
            store_history(memory, k, 0.0, 0.0, law)
            continue
        du = velocity[i, 0] - (1.0 - share) * velocity[a, 0] - share * velocity[b, 0]
        dv = velocity[i, 1] - (1.0 - share) * velocity[a, 1] - share * velocity[b, 1]
        p = law.table[material_of(d.material, i), material_of(d.material, a)]
        ex, ey = position[b, 0] - position[a, 0], position[b, 1] - position[a, 1]
        way = contact_kinematics(dx, dy, du, dv, spin[i], spin[a], radius[i], radius[a])
        way = on_side(way, share, radius[i], ex, ey, spin[i] - spin[a], p[MUR])
        if overlap <= 0.0:
            release_contact(i, k, overlap, way, p, memory, budget, law, dt)
            store_history(memory, k, 0.0, 0.0, law)
            continue
        mass = d.body_mass[i] * d.body_mass[a] / (d.body_mass[i] + d.body_mass[a])
        gx, gy, moment_i, moment_a = contact_force(i, k, overlap, way, mass, p, memory, budget, law, dt)
        sx, sy = share * ex, share * ey
        force[i, 0] += gx
        force[i, 1] += gy
        torque[i] += moment_i
        force[a, 0] -= gx
        force[a, 1] -= gy
        torque[a] += moment_a - (sx * gy - sy * gx)


@kernel
def survey_segments(position, radius, material, segments, law, cell):
    """(largest overlap over the reach, the sum of both radii; its disc; what it is pressed against: segment, or
    disc - n; elastic energy J/m, normal, tangential, rolling) of all contacts with segments and corners.  Arguments as
    in add_segment_forces.
    """
    worst, worst_i, worst_e, normal, tangential, rolling = 0.0, -1, 0, 0.0, 0.0, 0.0
    corners = segments.corner.shape[0] if segments.rule == OUTLINE else 0
    for k in range(corners):
        i, j = segments.corner[k, 0], segments.corner[k, 1]
        dx, dy = image(position[j, 0] - position[i, 0], position[j, 1] - position[i, 1], cell)
        overlap = radius[i] + radius[j] - np.sqrt(dx * dx + dy * dy)
        weight = weight_of(i, j, dx, dy, position, segments)
        if overlap <= 0.0 or weight == 0:
            continue
        p = law.table[material_of(material, i), material_of(material, j)]
        reduced = radius[i] * radius[j] / (radius[i] + radius[j])
        if weight > 0:
            spring, roll = load_history(segments.corner_memory, k, law)
            parts = stored(overlap, spring, roll, reduced, p, law)
            normal, tangential, rolling = normal + parts[0], tangential + parts[1], rolling + parts[2]
        else:
            normal += weight * stored_normal(overlap, reduced, p, law)
        share = overlap / (radius[i] + radius[j])
        if weight > 0 and share > worst:
            worst, worst_i, worst_e = share, i, j - radius.shape[0]
    for k in range(segments.near.shape[0]):
        i, e = segments.near[k, 0], segments.near[k, 1]
        a = segments.ends[e, 0]
        overlap, _, _, _ = segment_contact(segments.rule, i, a, segments.ends[e, 1], radius, position, cell)
        if overlap > 0.0:
            p = law.table[material_of(material, i), material_of(material, a)]
            spring, roll = load_history(segments.near_memory, k, law)
            parts = stored(overlap, spring, roll, radius[i] * radius[a] / (radius[i] + radius[a]), p, law)
            normal, tangential, rolling = normal + parts[0], tangential + parts[1], rolling + parts[2]
            share = overlap / (radius[i] + radius[a])
            if share > worst:
                worst, worst_i, worst_e = share, i, e
    return worst, worst_i, worst_e, normal, tangential, rolling
