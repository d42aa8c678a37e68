"""A list of contacts with their forces, one row each."""

from dataclasses import dataclass, fields, replace
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from porescale.common.core.types import Floats
from porescale.dem.contact.law import MU
from porescale.dem.state import State

Index = NDArray[np.int64]

AT_LIMIT = 1.0 - 1e-9
"""Share of the friction limit from which a contact counts as sliding: the law cuts to the limit, within round-off."""
NOBODY = -1


@dataclass(frozen=True)
class Contacts:
    """c contacts, pairs first in the order of the pair list, then walls, plates and rectangles, then segments and bonds
    (contacts_segments.py); SI per metre of depth.

    first (c,) disc i;  second (c,) disc j, or -1 at a surface;  surface (c,) index into ``names``, or -1 for a pair;
    point (c, 2) m, where the force acts on both bodies, beside disc i (a periodic image of it may lie elsewhere);
    normal (c, 2) unit vector from i outwards;  start (c, 2) m, the centroid of the body of i, its clump or itself;
    branch (c, 2) m, from there to the centroid of the nearest image of the body of j, or to the point at a surface;
    overlap (c,) m;  normal_force (c,) N/m, > 0 pushes apart;  tangential_force (c,) N/m, that on i along
    t = (-n_y, n_x);  force (c, 2) N/m, of i on the other;  torque (c, 2) N m/m, on i and on j (of a surface, about
    the point: what resists rolling);  spring (c,) m, after the step's slip;  sliding (c,) bool: friction is at its
    limit.
    """

    first: Index
    second: Index
    surface: Index
    names: tuple[str, ...]
    point: Floats
    normal: Floats
    start: Floats
    branch: Floats
    overlap: Floats
    normal_force: Floats
    tangential_force: Floats
    force: Floats
    torque: Floats
    spring: Floats
    sliding: NDArray[np.bool_]

    @property
    def count(self) -> int:
        """Number of contacts in the list."""
        return len(self.first)

    @property
    def pairs(self) -> NDArray[np.bool_]:
        """Which contacts are between two discs, (c,) bool."""
        return np.not_equal(self.second, NOBODY)

    def of(self, name: str) -> "Contacts":
        """The contacts with one surface."""
        return self.chosen(self.surface == self.names.index(name))

    def chosen(self, which: NDArray[Any]) -> "Contacts":
        """Some of the contacts, by mask or index."""
        parts = {it.name: getattr(self, it.name) for it in fields(self)}
        return Contacts(**{name: part if name == "names" else part[which] for name, part in parts.items()})

    def of_bodies(self, bodies: Index) -> "Contacts":
        """The same between bodies: ``bodies`` (n,) is the number of a disc that stands for each disc's body."""
        second = np.where(self.pairs, bodies[self.second], NOBODY)
        return replace(self, first=bodies[self.first], second=second)

    def resultants(self, count: int) -> tuple[Floats, Floats]:
        """Contact force (count, 2) N/m and torque (count,) N m/m on each of ``count`` discs."""
        force, torque = np.zeros((count, 2)), np.zeros(count)
        np.subtract.at(force, self.first, self.force)
        np.add.at(torque, self.first, self.torque[:, 0])
        np.add.at(force, self.second[self.pairs], self.force[self.pairs])
        np.add.at(torque, self.second[self.pairs], self.torque[self.pairs, 1])
        return force, torque


def nearest_image(difference: Floats, period: tuple[float, float, float]) -> Floats:
    """Differences (n, 2) m between nearest periodic images, as cells.tilted_image; ``period``: see Grains.period."""
    near = np.array(difference, dtype=np.float64)
    width, height, tilt = period
    if tilt != 0.0:
        near[:, 0] -= tilt * np.rint(near[:, 1] * (1.0 / height))
    for axis, length in enumerate((width, height)):
        if length > 0.0:
            near[:, axis] -= length * np.rint(near[:, axis] * (1.0 / length))
    return near


class Bodies(NamedTuple):
    """Which bodies c contacts are between: first, second, surface (c,), as in Contacts."""

    first: Index
    second: Index
    surface: Index


class Places(NamedTuple):
    """Where c contacts are: point, normal, start, branch (c, 2), overlap (c,), as in Contacts."""

    point: Floats
    normal: Floats
    start: Floats
    branch: Floats
    overlap: Floats


def listed(bodies: Bodies, at: Places, force: Floats, torque: Floats, spring: Floats, friction: Floats) -> Contacts:
    """Contacts with their forces resolved along normal and tangent; ``friction`` (c,): coefficient."""
    pushing = np.sum(force * at.normal, axis=1)
    # The force on i is -force, and t = (-n_y, n_x).
    along = force[:, 0] * at.normal[:, 1] - force[:, 1] * at.normal[:, 0]
    limit = friction * np.maximum(pushing, 0.0)
    return Contacts(
        *bodies, (), *at, pushing, along, force, torque, spring, (limit > 0.0) & (np.abs(along) >= AT_LIMIT * limit)
    )


def material_of(grains: State, discs: Index) -> NDArray[Any]:
    """Numbers of the materials of some discs."""
    return np.zeros(len(discs), np.uint8) if grains.material is None else grains.material[discs]


def between(
    grains: State, i: Index, j: Index, way: Floats, loads: tuple[Floats, Floats, Floats],
    branch: Floats | None = None, overlap: Floats | None = None,
) -> Contacts:  # fmt: skip
    """Contacts of discs i with discs j (c,), at the common chord of their circles; way (c, 2) m from i to j.

    loads: force (c, 2), torque (c, 2), spring (c,);  branch, overlap: as in Contacts, left out: those of two circles.
    """
    d = grains.discs
    distance = np.hypot(*way.T)
    normal = way / distance[:, None]
    arm = 0.5 * (distance + (d.radius[i] ** 2 - d.radius[j] ** 2) / distance)
    at = Places(
        d.position[i] + arm[:, None] * normal,
        normal,
        d.position[i],
        way if branch is None else branch,
        d.radius[i] + d.radius[j] - distance if overlap is None else overlap,
    )
    friction = grains.contact.table[material_of(grains, i), material_of(grains, j), MU]
    return listed(Bodies(i, j, np.full(len(i), NOBODY)), at, *loads, friction)
