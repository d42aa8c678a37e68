"""Arrays as kernels take them: flat NamedTuples, which loops over threads take as well."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from porescale.common.core.types import Floats


class DiscArrays(NamedTuple):
    """n discs and what acts on them; an array that a kernel does not use may be empty.

    position (n, 2) m, angle (n,) rad at whole steps, angle (0,) where nothing turns;  velocity (n, 2) m/s, spin (n,)
    rad/s at half steps;  radius (n,) m;  mass, inertia (n,) kg/m, kg m^2/m;  force (n, 2) N/m, torque (n,) N m/m: of
    the last contact step;  external_force (n, 2) N/m, external_torque (n,) N m/m: the same over all steps of a call;
    held (n, 3): not 0 where x, y, rotation is held, (0, 3) if none is;  withheld (n, 3) N/m, N/m, N m/m: what held
    components did not follow;  body_mass (n,) kg/m: of a disc, or of the clump that it belongs to;  material (n,)
    uint8, or None where there is one;  budget (n, BUDGET): energy budget, at the lower disc of a pair, or None.
    """

    position: Floats
    angle: Floats
    velocity: Floats
    spin: Floats
    radius: Floats
    mass: Floats
    inertia: Floats
    force: Floats
    torque: Floats
    external_force: Floats
    external_torque: Floats
    held: NDArray[np.uint8]
    withheld: Floats
    body_mass: Floats
    material: NDArray[np.uint8] | None
    budget: Floats | None


class Pairs(NamedTuple):
    """A half list of pairs in CSR: partners of disc i are ``partner[start[i]:start[i + 1]]``.

    start (n + 1,), partner (m,);  history (m, 1 or 2) m: springs, tangential and rolling;  checked_position
    (n, 2) m: of discs at the last check;  limit_square m^2: of how far they may go from there.
    """

    start: NDArray[np.int64]
    partner: NDArray[np.int32]
    history: Floats
    checked_position: Floats
    limit_square: float


Surface = tuple[Floats, Floats, Floats, Floats]
"""Walls, plates or rectangles: table (s, columns), see each;  laws (s, m, COLUMNS): with each material of discs;
spring (s, n, 1 or 2) m;  load (s, 2 or 3) N/m, N m/m: force of the discs on each, and moment about its point."""


class Surfaces(NamedTuple):
    """Walls, plates and rectangles: the parts of Surface of each, side by side."""

    walls: Floats
    wall_laws: Floats
    wall_spring: Floats
    wall_load: Floats
    plates: Floats
    plate_laws: Floats
    plate_spring: Floats
    plate_force: Floats
    rectangles: Floats
    rectangle_laws: Floats
    rectangle_spring: Floats
    rectangle_force: Floats


def contact_arrays(
    position: Floats, velocity: Floats, spin: Floats, radius: Floats, body_mass: Floats,
    material: NDArray[np.uint8] | None = None, budget: Floats | None = None,
) -> DiscArrays:  # fmt: skip
    """Discs as contact kernels take them, with forces and torques zero and no external load."""
    count, none, pair = len(radius), np.zeros(0), np.zeros((0, 2))
    return DiscArrays(
        position, none, velocity, spin, radius, none, none, np.zeros((count, 2)), np.zeros(count), pair, none,
        np.zeros((0, 3), np.uint8), np.zeros((0, 3)), body_mass, material, budget,
    )  # fmt: skip
