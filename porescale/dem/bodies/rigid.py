"""What discs are of: a free disc is its own body, members of a clump are one.  For measures; nothing is changed."""

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from porescale.common.core.types import Floats
from porescale.dem.bodies.clumps import Clumps
from porescale.dem.discs import Discs
from porescale.dem.state import State


def clumps_of(grains: State) -> Clumps | None:
    """The clumps of ``grains``, None where there is none."""
    return grains.drivers.clumps if grains.drivers is not None and grains.drivers.clumps.count else None


def body_of(grains: State) -> NDArray[np.int64]:
    """Number of a disc for each disc's body, (n,): itself, or the first member of its clump."""
    bodies, clumps = np.arange(grains.discs.count), clumps_of(grains)
    if clumps is not None:
        bodies[clumps.member] = np.repeat(clumps.member[clumps.start[:-1]], np.diff(clumps.start))
    return bodies


def arms(grains: State) -> Floats:
    """Way from the centroid of each disc's body to its centre, (n, 2) m."""
    way, clumps = np.zeros((grains.discs.count, 2)), clumps_of(grains)
    if clumps is not None:
        way[clumps.member] = clumps.arm
    return way


def areas(grains: State) -> Floats:
    """Area that each disc stands for, (n,) m^2: members share that of their body in proportion to their own area, or to
    their mass where they are points."""
    area, clumps = np.array(grains.discs.area), clumps_of(grains)
    if clumps is not None:
        own, numbers = area[clumps.member], np.repeat(np.arange(clumps.count), np.diff(clumps.start))
        points = np.bincount(numbers, own, clumps.count) == 0.0
        own = np.where(points[numbers], grains.discs.mass[clumps.member], own)
        area[clumps.member] = own * (clumps.area / np.bincount(numbers, own, clumps.count))[numbers]
    return area


def masses(grains: State) -> Floats:
    """Mass of each disc's body, (n,) kg/m: what a contact with it moves; the discs' own where there is no clump."""
    mass, clumps = grains.discs.mass, clumps_of(grains)
    if clumps is not None:
        mass = mass.copy()
        mass[clumps.member] = np.repeat(clumps.mass, np.diff(clumps.start))
    return mass


def as_bodies(grains: State) -> Discs:
    """The discs, members of clumps at the place and with the velocity of their body, and with their share of its mass:
    sums over them of mass and momentum are those of bodies, without what turns within."""
    discs, clumps = grains.discs, clumps_of(grains)
    if clumps is None:
        return discs
    position, velocity = discs.position.copy(), discs.velocity.copy()
    numbers = np.repeat(np.arange(clumps.count), np.diff(clumps.start))
    position[clumps.member], velocity[clumps.member] = clumps.position[numbers], clumps.velocity[numbers]
    return replace(discs, position=position, velocity=velocity)
