"""Fluid that lies within discs and clumps, as shares of the discs.

Of a disc it is a disc of fluid.  Members of a clump share the mass of fluid within their union, and its moment of
inertia, as they share those of the clump itself (dem/bodies/clumps.py): sums over members of what is done to the
fluid inside each, m_f dU/dt of a member at its place, are then those of the rigid body, and its buoyancy acts where
it must.  Cells that two members cover belong to both by halves (load.py), so that their loads add up.
"""

from typing import NamedTuple

import numpy as np

from porescale.common.core.errors import Fault, InputError
from porescale.common.core.types import Floats
from porescale.dem.bodies.clumps import LEAST, drawn_in, shares
from porescale.dem.bodies.rigid import clumps_of
from porescale.dem.bodies.union import Outline, outline
from porescale.dem.grains import Grains


class Displaced(NamedTuple):
    """mass (n,) kg/m, inertia (n,) kg m²/m;  thinness (n,) 1/m: outline over area of the disc, or of its clump;
    0 of the corners of frames."""

    mass: Floats
    inertia: Floats
    thinness: Floats


class Inside(NamedTuple):
    """The union of the discs of a clump, and how they share it.

    share (k,): of its area, with the centre of the union;  rest : second moment (m^4) that this leaves the discs to
    turn with, more than none, shared by ``weight`` (k,) m² times radius.
    """

    union: Outline
    share: Floats
    weight: Floats
    rest: float


def inside_of(at: Floats, radius: Floats) -> Inside | None:
    """What discs at ``at`` (k, 2) m with ``radius`` (k,) m cover; None where no shares of it can be made."""
    union = outline(at, radius)
    weight = radius * np.maximum(union.exposed, LEAST * radius)
    from_centre = at - union.centroid
    share = shares(weight, from_centre, float(radius.max()))
    if share is None:
        return None
    share = drawn_in(share, weight, from_centre, radius, union.second_moment / union.area)
    rest = union.second_moment - union.area * float(share @ np.sum(from_centre**2, axis=1))
    return Inside(union, share, weight, rest) if rest > 0.0 else None


def undisplaced(number: int) -> Fault:
    """The fault of a clump whose discs, with their hydraulic radii, have no shares of the fluid in it."""
    repair = "make it of other discs, or raise grains.hydraulic_radius_ratio"
    return Fault(f"clump[{number}]", None, "cannot displace fluid", repair=repair)


def displaced(grains: Grains, radius: Floats, density: float) -> Displaced:
    """Fluid of ``density`` (kg/m³) within discs of ``radius`` (n,) m at the places of ``grains``.

    Corners of frames share what lies within the frame's outline as they share its mass, whatever their radius.
    Raises InputError at a clump of which no shares can be made.
    """
    mass = density * np.pi * radius**2
    inertia = 0.5 * mass * radius**2
    corner = np.zeros(len(radius), bool) if grains.segments is None else grains.segments.is_corner
    thinness = np.divide(2.0, radius, out=np.zeros(len(radius)), where=~corner)
    clumps = clumps_of(grains)
    for c in range(clumps.count if clumps else 0):
        assert clumps
        own = clumps.discs_of(c)
        if corner[own].any():
            lightness = density * clumps.area[c] / clumps.mass[c]
            mass[own] = lightness * grains.discs.mass[own]
            inertia[own] = lightness * grains.discs.inertia[own]
            continue
        found = inside_of(clumps.offset[clumps.start[c] : clumps.start[c + 1]], radius[own])
        if found is None:
            raise InputError(undisplaced(c))
        union, weight = found.union, found.weight
        mass[own] = density * union.area * found.share
        inertia[own] = density * found.rest * weight * radius[own] / float(weight @ radius[own])
        thinness[own] = float(union.exposed.sum()) / union.area
    return Displaced(mass, inertia, thinness)


def of_whole_bodies(grains: Grains, mass: Floats, inertia: Floats) -> tuple[Floats, Floats]:
    """Mass and moment of inertia about its centroid of the body of each disc, (n,), from shares of discs."""
    clumps = clumps_of(grains)
    if clumps is None:
        return mass, inertia
    numbers = np.repeat(np.arange(clumps.count), np.diff(clumps.start))
    total = np.bincount(numbers, mass[clumps.member])
    about = np.bincount(numbers, inertia[clumps.member] + mass[clumps.member] * np.sum(clumps.offset**2, axis=1))
    mass, inertia = mass.copy(), inertia.copy()
    mass[clumps.member], inertia[clumps.member] = total[numbers], about[numbers]
    return mass, inertia
