"""Numbers about a packing: energies, momenta, overlaps, contacts.  Nothing here changes the state.

Speeds are those of half a step ago, positions those of now; energies therefore err by a step's work.
"""

from typing import NamedTuple

import numpy as np

from porescale.common.compiled.jit import kernel
from porescale.common.core.types import Floats
from porescale.dem.bodies.bonding import segments_now
from porescale.dem.bodies.rigid import clumps_of
from porescale.dem.discs import Discs
from porescale.dem.forces.rectangle import BOTTOM, LEFT, RIGHT, TOP
from porescale.dem.forces.segments import survey_segments
from porescale.dem.forces.walls import HIGH, LOW, NX, NY, PRESENT, PX, PY, X
from porescale.dem.motion.periodic_cell import image
from porescale.dem.state import State


@kernel
def survey_pairs(position, radius, pairs, cell, touching):
    """(largest overlap over the smaller radius, its i, its j) over the listed pairs.

    position (n, 2), radius (n,) m;  pairs: Pairs.  Overwrites touching (n,): number of discs that touch each disc.
    """
    touching[:] = 0
    start, partner = pairs.start, pairs.partner
    worst, worst_i, worst_j = 0.0, -1, -1
    for i in range(radius.shape[0]):
        for k in range(start[i], start[i + 1]):
            j = partner[k]
            dx, dy = image(position[j, 0] - position[i, 0], position[j, 1] - position[i, 1], cell)
            overlap = radius[i] + radius[j] - np.sqrt(dx * dx + dy * dy)
            if overlap > 0.0:
                touching[i] += 1
                touching[j] += 1
                share = overlap / min(radius[i], radius[j])
                if share > worst:
                    worst, worst_i, worst_j = share, i, j
    return worst, worst_i, worst_j


Found = tuple[float, int, int]
"""Deepest overlap over the (smaller) radius, its disc, the disc or surface that it touches; 0, -1, -1 for none."""


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


def max_overlap(grains: State, free: int | None = None) -> Overlap:
    """The deepest overlap of all pairs, walls, plates, rectangles and segments, as a share of the (smaller) radius; at
    segments and corners of the sum of radius and thickness, where a disc would go through.

    free : how many discs are grains, the first ones; what the others have with walls, plates and rectangles is left out
    then (None: all are).
    """
    share, i, j = _survey(grains)
    found = [(share, i, name_of(grains, j), j)]
    walls, plates = [f"the {name} wall" for name in grains.wall_names], [f"the {name}" for name in grains.plate_names]
    names = walls, plates, [f"rectangle {k}" for k in range(len(grains.rectangles))]
    for (share, i, w), own in zip(_survey_surfaces(grains, free), names, strict=True):
        found.append((share, i, own[w] if own else "", -1))
    share, i, e = _survey_segments(grains)
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
    d = grains.discs
    result: Found = survey_pairs(d.position, d.radius, grains.pair_arrays(), grains.cell, grains.touching)
    return result


def _survey_surfaces(grains: State, free: int | None = None) -> list[Found]:
    """What is found at walls, plates and rectangles; corners of segments at walls by their own measure."""
    d, walls = grains.discs, grains.walls
    found = [_deepest((d.radius - away)[:, :free], d.radius[:free]) for away in distances(grains)]
    if grains.segments is not None and len(walls):
        # Corners may be points: what they go into a wall is held against their segments.
        away = np.einsum("nwk,wk->wn", d.position[:, None] - walls[:, PX : PY + 1], walls[:, NX : NY + 1])
        reach = np.maximum(d.radius, grains.segments.beside_corner)
        found[0] = _deepest((d.radius - away)[:, :free], reach[:free])
    return found


def distances(grains: State) -> tuple[Floats, Floats, Floats]:
    """Distances of all centres (n,) from walls, plates and rectangles, (surfaces, n) m each.

    Below zero behind walls and inside of rectangles, infinite from plates that are gone.
    """
    x, y = grains.discs.position.T
    walls, plates, rectangles = (table[:, :, None] for table in (grains.walls, grains.plates, grains.rectangles))
    behind = (x - walls[:, PX]) * walls[:, NX] + (y - walls[:, PY]) * walls[:, NY]
    dx, dy = plates[:, X] - x, np.clip(y, plates[:, LOW], plates[:, HIGH]) - y
    beside = np.where(plates[:, PRESENT] != 0.0, np.sqrt(dx * dx + dy * dy), np.inf)
    left, bottom, right, top = (rectangles[:, side] for side in (LEFT, BOTTOM, RIGHT, TOP))
    dx, dy = np.clip(x, left, right) - x, np.clip(y, bottom, top) - y
    outside = np.sqrt(dx * dx + dy * dy)
    inside = np.minimum(np.minimum(x - left, right - x), np.minimum(y - bottom, top - y))
    return behind, beside, np.where(outside == 0.0, -inside, outside)


def _deepest(overlap: Floats, reach: Floats) -> Found:
    """The first of the deepest of ``overlap`` (surfaces, n) m over ``reach`` (n,) m."""
    with np.errstate(divide="ignore"):  # corners that are points
        share = np.divide(overlap, reach, out=np.zeros_like(overlap), where=overlap > 0.0)
    if not share.any():
        return 0.0, -1, -1
    surface, disc = np.unravel_index(share.argmax(), share.shape)
    return float(share[surface, disc]), int(disc), int(surface)


def _survey_segments(grains: State) -> Found:
    """The deepest contact with a segment, -1 for one of two corners, see segments.survey_segments."""
    d = grains.discs
    if grains.segments is None:
        return 0.0, -1, 0
    share, i, e = survey_segments(
        d.position, d.radius, grains.material, segments_now(grains), grains.contact, grains.cell
    )[:3]
    return share, i, e
