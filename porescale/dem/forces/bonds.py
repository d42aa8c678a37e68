"""Bonds by back tension: contacts whose compressive force at a moment is cancelled from then on, until pulled apart.

The force of a bonded contact is that of its law less the constant elastic force b that it bore at overlap d0 when it
was bonded, so the body stands without confinement.  The law itself is untouched: friction has the limit mu F of the
contact as if it were still pressed.  A bond breaks when the overlap is gone: pulled by  b = k d0  under a linear law.
Nothing is stored by the break: the energy k d^2/2 - b d of both together goes to zero with the overlap d.
Bonds are between bodies (discs, clumps, frames), never with walls.  At the end of a segment a bond holds on to the end;
corners that count negatively (segments.py) take their part of the back tension off.

Source: Matsushima, DEMseg tutorial II-3.
"""

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from porescale.common.compiled.jit import inline, kernel
from porescale.common.core.types import Floats
from porescale.dem.contact.law import material_of, stiffness
from porescale.dem.forces.segment_list import SegmentList, refuse_beyond
from porescale.dem.forces.segments import OUTLINE, closest_point, segment_contact, weight_of
from porescale.dem.motion.periodic_cell import image

Index = NDArray[np.int64]

STATE = ("ends", "back", "whole", "broken")
"""Names of the arrays of :class:`BondList`."""


class Bonds(NamedTuple):
    """Bonds as kernels take them: arrays as in BondList, and the clock (2,): seconds before the step last changed, and
    steps since."""

    ends: Index
    back: Floats
    whole: NDArray[np.uint8]
    broken: Floats
    clock: Floats


class Break(NamedTuple):
    """A bond that broke: when (s), where (m), between which discs (a segment stands for the disc at its first end)."""

    time: float
    place: tuple[float, float]
    discs: tuple[int, int]


@inline
def way_between(ends, k, position, segments, cell):
    """(way x, y m from the first disc of bond k to the touched point; disc there, or at the first end of the segment
    there; share of the way along that segment; its other end).
    """
    i, j = ends[k, 0], ends[k, 1]
    if ends[k, 2] == 1:
        a, b = segments.ends[j, 0], segments.ends[j, 1]
        _, share, dx, dy = closest_point(i, a, b, position, cell)
        return dx, dy, a, share, b
    dx, dy = image(position[j, 0] - position[i, 0], position[j, 1] - position[i, 1], cell)
    return dx, dy, j, 0.0, j


@kernel
def pull_bonds(position, radius, force, torque, segments, bonds, step, dt, cell):
    """Add the back tension of all bonds that hold; those whose overlap is gone break.

    Arrays as in segments.add_segment_forces;  step: number within the call;  dt s.  Adds
    to force (n, 2) N/m and torque (n,) N m/m; overwrites ``whole`` and ``broken``.
    """
    for k in range(bonds.back.shape[0]):
        if bonds.whole[k] == 0:
            continue
        i = bonds.ends[k, 0]
        dx, dy, a, share, b = way_between(bonds.ends, k, position, segments, cell)
        distance = np.sqrt(dx * dx + dy * dy)
        if radius[i] + radius[a] - distance <= 0.0:
            bonds.whole[k] = 0
            bonds.broken[k, 0] = bonds.clock[0] + (bonds.clock[1] + step) * dt
            bonds.broken[k, 1], bonds.broken[k, 2] = position[i, 0] + 0.5 * dx, position[i, 1] + 0.5 * dy
            continue
        gx, gy = bonds.back[k] * dx / distance, bonds.back[k] * dy / distance
        sx, sy = share * (position[b, 0] - position[a, 0]), share * (position[b, 1] - position[a, 1])
        force[i, 0] += gx
        force[i, 1] += gy
        force[a, 0] -= gx
        force[a, 1] -= gy
        torque[a] -= sx * gy - sy * gx


@kernel
def stored_in_bonds(position, radius, segments, bonds, cell):
    """Energy of the back tension of all bonds that hold, J/m: the sum of -b d; arguments as in pull_bonds."""
    energy = 0.0
    for k in range(bonds.back.shape[0]):
        if bonds.whole[k] != 0:
            dx, dy, a, _, _ = way_between(bonds.ends, k, position, segments, cell)
            overlap = radius[bonds.ends[k, 0]] + radius[a] - np.sqrt(dx * dx + dy * dy)
            energy -= bonds.back[k] * max(overlap, 0.0)
    return energy


@kernel
def pressing(position, radius, body_mass, material, ends, segments, law, cell, back):
    """Overwrite back (m,) N/m with the elastic normal force at each of ``ends`` (m, 3), see Bonds, 0 where apart.

    Arrays as in DiscArrays;  law see contact/law.py.  Corners by weight.
    """
    for k in range(ends.shape[0]):
        i, j = ends[k, 0], ends[k, 1]
        dx, dy, a, _, b = way_between(ends, k, position, segments, cell)
        overlap, weight = radius[i] + radius[a] - np.sqrt(dx * dx + dy * dy), 1
        if ends[k, 2] == 1:
            overlap = segment_contact(segments.rule, i, a, b, radius, position, cell)[0]
        elif segments.start[i] < segments.start[i + 1] or segments.start[j] < segments.start[j + 1]:
            weight = weight_of(i, j, dx, dy, position, segments) if segments.rule == OUTLINE else 0
        back[k] = 0.0
        if overlap > 0.0:
            p = law.table[material_of(material, i), material_of(material, a)]
            reduced = radius[i] * radius[a] / (radius[i] + radius[a])
            both = body_mass[i] * body_mass[a] / (body_mass[i] + body_mass[a])
            back[k] = weight * stiffness(overlap, reduced, both, p, law)[0]


@kernel
def touched(position, ends, segments, cell, way, far, other):
    """Where bonds ``ends`` (m, 3) touch: overwrites way (m, 2) m, from the first disc to the touched point, other (m,),
    the disc there or at the first end of the segment there, and far (m, 2) m, from that disc to the point.
    """
    for k in range(ends.shape[0]):
        dx, dy, a, share, b = way_between(ends, k, position, segments, cell)
        way[k, 0], way[k, 1], other[k] = dx, dy, a
        far[k, 0], far[k, 1] = share * (position[b, 0] - position[a, 0]), share * (position[b, 1] - position[a, 1])


class BondList:
    """m bonds, broken ones included, in the order in which they were made.

    ends (m, 3): disc, disc or segment, 1 where it is a segment;  back (m,) N/m: back tension, below zero where a
    corner takes some off;  whole (m,): 1 while it holds;  broken (m, 3): s, m, m, when and where it broke, nan before.
    """

    def __init__(self, ends: Index, back: Floats) -> None:
        self.ends, self.back = ends, back
        self.whole = np.ones(len(back), np.uint8)
        self.broken = np.full((len(back), 3), np.nan)
        self._clock = np.zeros(2)

    @property
    def count(self) -> int:
        """Number of bonds that hold; those that only take some off are not counted."""
        return int(np.sum((self.whole != 0) & (self.back > 0.0)))

    def now(self, seconds: float, steps: int) -> Bonds:
        """The bonds as kernels take them, at this time."""
        self._clock[:] = seconds, steps
        return Bonds(self.ends, self.back, self.whole, self.broken, self._clock)

    def breaks(self, segments: SegmentList | None) -> list[Break]:
        """Bonds that broke so far, by time: the acoustic emissions;  segments : of the system."""
        gone = np.flatnonzero((self.whole == 0) & (self.back > 0.0))
        rows = gone[np.argsort(self.broken[gone, 0], kind="stable")]
        other = self.partners(segments)[:, 1]
        return [
            Break(
                float(self.broken[k, 0]), (float(self.broken[k, 1]), float(self.broken[k, 2])),
                (int(self.ends[k, 0]), int(other[k])),
            )
            for k in rows
        ]  # fmt: skip

    def partners(self, segments: SegmentList | None) -> Index:
        """Discs (m, 2) that each bond holds together; one of ``segments`` stands for the disc at its first end."""
        both = self.ends[:, :2].copy()
        sided = self.ends[:, 2] == 1
        if segments is not None:
            both[sided, 1] = segments.ends[both[sided, 1], 0]
        return both

    def joined(self, more: "BondList") -> "BondList":
        """These bonds and ``more``."""
        both = BondList(np.concatenate((self.ends, more.ends)), np.concatenate((self.back, more.back)))
        both.whole[:] = np.concatenate((self.whole, more.whole))
        both.broken[:] = np.concatenate((self.broken, more.broken))
        return both

    def state(self) -> dict[str, Any]:
        """Copies of all arrays."""
        return {name: getattr(self, name).copy() for name in STATE}

    @staticmethod
    def restored(state: dict[str, Any], discs: int, segments: int) -> "BondList":
        """The bonds of ``state()`` of so many discs and segments; InputError where one is between others."""
        made = BondList(np.array(state["ends"], np.int64).reshape(-1, 3), np.array(state["back"], float))
        for sided, count in enumerate((discs, segments)):
            refuse_beyond("bonds.ends", made.ends[made.ends[:, 2] == sided], discs, count)
        made.whole[:] = state["whole"]
        made.broken[:] = np.reshape(state["broken"], (-1, 3))
        return made


NO_BONDS = BondList(np.zeros((0, 3), np.int64), np.zeros(0))
