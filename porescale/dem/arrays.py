"""Arrays as kernels take them: flat NamedTuples, which loops over threads take as well."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


class DiscArrays(NamedTuple):
    """n discs and what acts on them; an array that a kernel does not use may be empty.

    position (n, 2) m, angle (n,) rad at whole steps, angle (0,) where nothing turns;  velocity (n, 2) m/s, spin (n,)
    rad/s at half steps;  radius (n,) m;  mass, inertia (n,) kg/m, kg m^2/m;  force (n, 2) N/m, torque (n,) N m/m: of
    the last contact step;  external_force (n, 2) N/m, external_torque (n,) N m/m: the same over all steps of a call;
    held (n, 3): not 0 where x, y, rotation is held, (0, 3) if none is;  withheld (n, 3) N/m, N/m, N m/m: what held
    components did not follow;  body_mass (n,) kg/m: of a disc, or of the clump that it belongs to;  material (n,)
    uint8, or None where there is one;  budget (n, BUDGET): energy budget, at the lower disc of a pair, or None.
    """

    position: Array
    angle: Array
    velocity: Array
    spin: Array
    radius: Array
    mass: Array
    inertia: Array
    force: Array
    torque: Array
    external_force: Array
    external_torque: Array
    held: NDArray[np.uint8]
    withheld: Array
    body_mass: Array
    material: NDArray[np.uint8] | None
    budget: Array | None


class Pairs(NamedTuple):
    """A half list of pairs in CSR: partners of disc i are ``partner[start[i]:start[i + 1]]``.

    start (n + 1,), partner (m,);  history (m, 1 or 2) m: springs, tangential and rolling;  checked_position
    (n, 2) m: of discs at the last check;  limit_square m^2: of how far they may go from there.
    """

    start: NDArray[np.int64]
    partner: NDArray[np.int32]
    history: Array
    checked_position: Array
    limit_square: float


Surface = tuple[Array, Array, Array, Array]
"""Walls, plates or rectangles: table (s, columns), see each;  laws (s, m, COLUMNS): with each material of discs;
spring (s, n, 1 or 2) m;  load (s, 2 or 3) N/m, N m/m: force of the discs on each, and moment about its point."""


class Surfaces(NamedTuple):
    """Walls, plates and rectangles: the parts of Surface of each, side by side."""

    walls: Array
    wall_laws: Array
    wall_spring: Array
    wall_load: Array
    plates: Array
    plate_laws: Array
    plate_spring: Array
    plate_force: Array
    rectangles: Array
    rectangle_laws: Array
    rectangle_spring: Array
    rectangle_force: Array


def contact_arrays(
    position: Array, velocity: Array, spin: Array, radius: Array, body_mass: Array,
    material: NDArray[np.uint8] | None = None, budget: Array | None = None,
) -> DiscArrays:  # fmt: skip
    """Discs as contact kernels take them, with forces and torques zero and no external load."""
    count, none, pair = len(radius), np.zeros(0), np.zeros((0, 2))
    return DiscArrays(
        position, none, velocity, spin, radius, none, none, np.zeros((count, 2)), np.zeros(count), pair, none,
        np.zeros((0, 3), np.uint8), np.zeros((0, 3)), body_mass, material, budget,
    )  # fmt: skip
