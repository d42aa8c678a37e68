"""Forces between discs: one pass over a half list of pairs.

With n = (x_j - x_i)/d and t = (-n_y, n_x) the slip v_t = (v_i - v_j).t + w_i a_i + w_j a_j does not change
when i and j swap, so the history of a contact is one number.  The lever arms a_i = (d^2 + r_i^2 -
r_j^2)/(2d), a_j = d - a_i reach to the chord of the overlap, where both bodies see the same force: angular
momentum is kept to round-off. With the radii in their place it leaks by overlap times friction.
"""

from __future__ import annotations

import numpy as np

from porescale.dem.cell import Still, drift, image, note
from porescale.dem.contact.law import (
    contact,
    holds,
    material_of,
    moments,
    note_contact,
    note_parting,
    recall,
    remember,
)
from porescale.ground.jit import inline, kernel


@kernel
def start_forces(force, torque, external_force, external_torque):
    """Overwrite force (n, 2) N/m and torque (n,) N m/m with the external ones."""
    for i in range(torque.shape[0]):
        force[i, 0] = external_force[i, 0]
        force[i, 1] = external_force[i, 1]
        torque[i] = external_torque[i]


@kernel
def add_pair_forces(
    position, velocity, spin, radius, force, torque, start, partner, carried, period_x, period_y, law, dt
):  # fmt: skip
    """Add the contacts of all listed pairs in a cell of period_x, period_y m, 0 where not periodic: see pair_forces."""
    cell = Still(period_x, period_y)
    pair_forces(position, velocity, spin, radius, force, torque, start, partner, carried, law, dt, cell)


@inline
def approach(i, j, dx, dy, velocity, spin, radius, cell):
    """Discs i and j, (dx, dy) m apart: (distance m, normal, lever arms m, closing and slip speed m/s)."""
    ri, rj = radius[i], radius[j]
    distance = np.sqrt(dx * dx + dy * dy)
    inverse = 1.0 / distance
    nx, ny = dx * inverse, dy * inverse
    arm_i = 0.5 * (distance + (ri - rj) * (ri + rj) * inverse)
    arm_j = distance - arm_i
    drift_x, drift_y = drift(dx, dy, cell)
    du = velocity[i, 0] - velocity[j, 0] - drift_x
    dv = velocity[i, 1] - velocity[j, 1] - drift_y
    closing = du * nx + dv * ny
    slip = dv * nx - du * ny + spin[i] * arm_i + spin[j] * arm_j
    return distance, nx, ny, arm_i, arm_j, closing, slip


@inline
def leave_pair(i, j, k, dx, dy, velocity, spin, radius, carried, book, law, dt, cell):
    """Enter into ``book``, if any, what the springs of a pair (dx, dy) m apart still held that touched a step ago."""
    if book is None:
        return
    if holds(carried, k, law):
        before, roll_before = recall(carried, k, law)
        distance, _, _, _, _, closing, slip = approach(i, j, dx, dy, velocity, spin, radius, cell)
        reduced = radius[i] * radius[j] / (radius[i] + radius[j])
        p = law.table[material_of(law.material, i), material_of(law.material, j)]
        note_parting(
            i, radius[i] + radius[j] - distance, closing, slip, reduced * (spin[i] - spin[j]), before, roll_before,
            reduced, dt, p, book, law,
        )  # fmt: skip


@inline
def pair_contact(i, j, k, position, velocity, spin, radius, carried, law, dt, cell):
    """Listed pair k of discs i and j: (whether they touch, force on i along x, y N/m, torques on i, j N m/m).

    Arguments as in pair_forces; overwrites row k of ``carried`` and adds to the load of ``cell``.
    """
    ri, rj = radius[i], radius[j]
    dx, dy = image(position[j, 0] - position[i, 0], position[j, 1] - position[i, 1], cell)
    square = dx * dx + dy * dy
    if square >= (ri + rj) * (ri + rj):
        leave_pair(i, j, k, dx, dy, velocity, spin, radius, carried, law.book, law, dt, cell)
        remember(carried, k, 0.0, 0.0, law)
        return False, 0.0, 0.0, 0.0, 0.0
    distance, nx, ny, arm_i, arm_j, closing, slip = approach(i, j, dx, dy, velocity, spin, radius, cell)
    overlap, reduced = ri + rj - distance, ri * rj / (ri + rj)
    turning = reduced * (spin[i] - spin[j])
    mass = law.mass[i] * law.mass[j] / (law.mass[i] + law.mass[j])
    p = law.table[material_of(law.material, i), material_of(law.material, j)]
    before, roll_before = recall(carried, k, law)
    normal, tangential, resisting, spring, roll = contact(
        overlap, closing, slip, turning, before, roll_before, reduced, mass, dt, p, law
    )
    remember(carried, k, spring, roll, law)
    note_contact(
        i, overlap, closing, slip, turning, before, roll_before, normal, tangential, resisting, spring, roll,
        reduced, mass, dt, p, law.book, law,
    )  # fmt: skip
    gx = -normal * nx - tangential * ny
    gy = -normal * ny + tangential * nx
    note(gx, gy, dx, dy, cell)
    moment_i, moment_j = moments(tangential, resisting, arm_i, arm_j, reduced, law)
    return True, gx, gy, moment_i, moment_j


@kernel
def pair_forces(
    position, velocity, spin, radius, force, torque, start, partner, carried, law, dt, cell
):  # fmt: skip
    """Add the contacts of all listed pairs; reset the springs of those that do not touch.

    position, velocity (n, 2) m, m/s;  spin, radius (n,) rad/s, m;  start (n + 1,), partner (m,) half list in CSR;
    law see contact/law.py;  dt s;  cell Still or Straining, whose load is added to.  Adds to force (n, 2) N/m and
    torque (n,) N m/m in the order of the list; overwrites carried (m, 1 or 2): springs, tangential and rolling, m.
    Not checked: two centres in one place give nan, which Grains.check reports.
    """
    for i in range(radius.shape[0]):
        fx, fy, moment = 0.0, 0.0, 0.0
        for k in range(start[i], start[i + 1]):
            j = partner[k]
            met, gx, gy, moment_i, moment_j = pair_contact(
                i, j, k, position, velocity, spin, radius, carried, law, dt, cell
            )
            if met:
                fx += gx
                fy += gy
                moment += moment_i
                force[j, 0] -= gx
                force[j, 1] -= gy
                torque[j] += moment_j
        force[i, 0] += fx
        force[i, 1] += fy
        torque[i] += moment
