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
from porescale.dem.bodies.clumps import LEAST, shares
from porescale.dem.bodies.rigid import clumps_of
from porescale.dem.bodies.union import outline
from porescale.dem.grains import Grains


class Displaced(NamedTuple):
    """mass (n,) kg/m, inertia (n,) kg m²/m;  thinness (n,) 1/m: outline over area of the disc, or of its clump;
    0 of the corners of frames."""

    mass: Floats
    inertia: Floats
    thinness: Floats


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
        at = clumps.offset[clumps.start[c] : clumps.start[c + 1]]
        union = outline(at, radius[own])
        weight = radius[own] * np.maximum(union.exposed, LEAST * radius[own])
        from_centre = at - union.centroid
        share = shares(weight, from_centre, float(radius[own].max()))
        rest = 0.0
        if share is not None:
            rest = union.second_moment - union.area * float(share @ np.sum(from_centre**2, axis=1))
        if share is None or not rest > 0.0:
            raise InputError(Fault(f"clump[{c}]", None, "cannot displace fluid", repair="make it of other discs"))
        mass[own] = density * union.area * share
        inertia[own] = density * rest * weight * radius[own] / float(weight @ radius[own])
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
