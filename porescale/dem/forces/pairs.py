"""Forces between discs: one pass over a half list of pairs.

With n = (x_j - x_i)/d and t = (-n_y, n_x) the slip v_t = (v_i - v_j).t + w_i a_i + w_j a_j does not change
when i and j swap, so the history of a contact is one number.  The lever arms a_i = (d^2 + r_i^2 -
r_j^2)/(2d), a_j = d - a_i reach to the chord of the overlap, where both bodies see the same force: angular
momentum is kept to round-off. With the radii in their place it leaks by overlap times friction.
"""

from __future__ import annotations

import numpy as np

from porescale.common.compiled.jit import inline, kernel
from porescale.dem.contact.law import (
    CN,
    CR,
    CT,
    KN,
    KR,
    KT,
    MU,
    MUR,
    RULE,
    RYIELD,
    YIELD,
    booked,
    contact,
    holds,
    moments,
    note_contact,
    note_parting,
    push,
    recall,
    remember,
)
from porescale.dem.motion.periodic_cell import Still, drift, image, note


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
def approach(dx, dy, du, dv, spin_i, spin_j, ri, rj):
    """Round bodies (dx, dy) m apart, from i to j, i moving at (du, dv) m/s relative to j: (distance m, normal, lever
    arms m, closing and slip speed m/s).
    """
    distance = np.sqrt(dx * dx + dy * dy)
    inverse = 1.0 / distance
    nx, ny = dx * inverse, dy * inverse
    arm_i = 0.5 * (distance + (ri - rj) * (ri + rj) * inverse)
    arm_j = distance - arm_i
    closing = du * nx + dv * ny
    slip = dv * nx - du * ny + spin_i * arm_i + spin_j * arm_j
    return distance, nx, ny, arm_i, arm_j, closing, slip


@inline
def passing(i, j, dx, dy, velocity, cell):
    """Velocity (m/s) of disc i relative to j, (dx, dy) m from it."""
    drift_x, drift_y = drift(dx, dy, cell)
    return velocity[i, 0] - velocity[j, 0] - drift_x, velocity[i, 1] - velocity[j, 1] - drift_y


@inline
def touch(i, k, overlap, dx, dy, du, dv, spin_i, spin_j, ri, rj, mass, p, memory, law, dt):
    """A contact of round bodies: force on the first along x, y (N/m), torques on both (N m/m).

    overlap (m) > 0;  mass (kg/m) reduced;  p (COLUMNS,) row of the law;  the rest as in approach.  Overwrites row k of
    ``memory``; the energy book, if any, has it at disc i.
    """
    _, nx, ny, arm_i, arm_j, closing, slip = approach(dx, dy, du, dv, spin_i, spin_j, ri, rj)
    reduced = ri * rj / (ri + rj)
    turning = reduced * (spin_i - spin_j)
    before, roll_before = recall(memory, k, law)
    normal, tangential, resisting, spring, roll = contact(
        overlap, closing, slip, turning, before, roll_before, reduced, mass, dt, p, law
    )
    remember(memory, k, spring, roll, law)
    note_contact(
        i, overlap, closing, slip, turning, before, roll_before, normal, tangential, resisting, spring, roll,
        reduced, mass, dt, p, law.book, law,
    )  # fmt: skip
    moment_i, moment_j = moments(tangential, resisting, arm_i, arm_j, reduced, law)
    fx, fy = push(normal, tangential, nx, ny, law)
    return fx, fy, moment_i, moment_j


@inline
def let_go(i, k, overlap, dx, dy, du, dv, spin_i, spin_j, ri, rj, p, memory, law, dt):
    """Enter into the energy book at disc i what the springs of row k of ``memory`` still held that touched a step ago.

    Arguments as in touch, overlap <= 0;  a system without a book has no use for it.
    """
    before, roll_before = recall(memory, k, law)
    _, _, _, _, _, closing, slip = approach(dx, dy, du, dv, spin_i, spin_j, ri, rj)
    reduced = ri * rj / (ri + rj)
    note_parting(
        i, overlap, closing, slip, reduced * (spin_i - spin_j), before, roll_before, reduced, dt, p, law.book, law
    )


@inline
def numbers_of(p):
    """A row of the law (COLUMNS,) as numbers."""
    return p[KN], p[CN], p[KT], p[CT], p[MU], p[RULE], p[YIELD], p[KR], p[CR], p[MUR], p[RYIELD]


@inline
def row_between(i, j, shared, table, material):
    """The law between discs i and j as numbers: ``shared`` where ``material`` is None.

    shared: those of table[0, 0], read once before a loop over pairs; within, the forces that are written might be the
    table's for all that the compiler knows.
    """
    if material is None:
        return shared
    return numbers_of(table[material[i], material[j]])


@inline
def leave_pair(i, j, k, dx, dy, velocity, spin, radius, carried, shared, law, dt, cell):
    """Enter into the book, if any, what the springs of a pair (dx, dy) m apart still held that touched a step ago."""
    if booked(law.book) and holds(carried, k, law):
        du, dv = passing(i, j, dx, dy, velocity, cell)
        p = row_between(i, j, shared, law.table, law.material)
        overlap = radius[i] + radius[j] - np.sqrt(dx * dx + dy * dy)
        let_go(i, k, overlap, dx, dy, du, dv, spin[i], spin[j], radius[i], radius[j], p, carried, law, dt)


@inline
def pair_contact(i, j, k, position, velocity, spin, radius, carried, shared, law, dt, cell):
    """Listed pair k of discs i and j: (whether they touch, force on i along x, y N/m, torques on i, j N m/m).

    Arguments as in pair_forces and row_between; overwrites row k of ``carried`` and adds to the load of ``cell``.
    """
    ri, rj = radius[i], radius[j]
    dx, dy = image(position[j, 0] - position[i, 0], position[j, 1] - position[i, 1], cell)
    square = dx * dx + dy * dy
    if square >= (ri + rj) * (ri + rj):
        leave_pair(i, j, k, dx, dy, velocity, spin, radius, carried, shared, law, dt, cell)
        remember(carried, k, 0.0, 0.0, law)
        return False, 0.0, 0.0, 0.0, 0.0
    du, dv = passing(i, j, dx, dy, velocity, cell)
    mass = law.mass[i] * law.mass[j] / (law.mass[i] + law.mass[j])
    p = row_between(i, j, shared, law.table, law.material)
    overlap = ri + rj - np.sqrt(square)
    gx, gy, moment_i, moment_j = touch(
        i, k, overlap, dx, dy, du, dv, spin[i], spin[j], ri, rj, mass, p, carried, law, dt
    )
    note(gx, gy, dx, dy, cell)
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
    shared = numbers_of(law.table[0, 0])
    for i in range(radius.shape[0]):
        fx, fy, moment = 0.0, 0.0, 0.0
        for k in range(start[i], start[i + 1]):
            j = partner[k]
            met, gx, gy, moment_i, moment_j = pair_contact(
                i, j, k, position, velocity, spin, radius, carried, shared, law, dt, cell
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
