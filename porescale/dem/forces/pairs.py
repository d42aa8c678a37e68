"""The contact of two round bodies: how they approach each other, and what each gets of it.

With n = (x_j - x_i)/d and t = (-n_y, n_x) the slip v_t = (v_i - v_j).t + w_i a_i + w_j a_j does not change
when i and j swap, so the history of a contact is one number.  The lever arms a_i = (d^2 + r_i^2 -
r_j^2)/(2d), a_j = d - a_i reach to the chord of the overlap, where the same force acts on both bodies: angular
momentum is kept to round-off. With the radii in their place it leaks by overlap times friction.
"""

from typing import NamedTuple

import numpy as np

from porescale.common.compiled.jit import inline
from porescale.dem.contact.budget import add_losses, add_release_losses, losses_if
from porescale.dem.contact.law import (
    Relative,
    contact,
    force_components,
    load_history,
    moments,
    row_numbers,
    store_history,
)
from porescale.dem.motion.periodic_cell import affine_velocity


class Approach(NamedTuple):
    """Relative motion of two round bodies: unit vector from the first to the second, lever arms m, closing and slip
    speed m/s, reduced radius m, rolling speed m/s, and the radius at which they roll, m."""

    nx: float
    ny: float
    arm_i: float
    arm_j: float
    closing: float
    slip: float
    reduced: float
    rolling: float
    rolls_at: float


@inline
def start_forces(d):
    """Overwrite force (n, 2) N/m and torque (n,) N m/m of the DiscArrays ``d`` with the external ones."""
    for i in range(d.torque.shape[0]):
        d.force[i, 0] = d.external_force[i, 0]
        d.force[i, 1] = d.external_force[i, 1]
        d.torque[i] = d.external_torque[i]


@inline
def contact_kinematics(dx, dy, du, dv, spin_i, spin_j, ri, rj):
    """The Approach of round bodies (dx, dy) m apart, from i to j, i moving at (du, dv) m/s relative to j, with spins
    (rad/s) and radii (m)."""
    distance = np.sqrt(dx * dx + dy * dy)
    inverse = 1.0 / distance
    nx, ny = dx * inverse, dy * inverse
    arm_i = 0.5 * (distance + (ri - rj) * (ri + rj) * inverse)
    arm_j = distance - arm_i
    closing = du * nx + dv * ny
    slip = dv * nx - du * ny + spin_i * arm_i + spin_j * arm_j
    reduced = ri * rj / (ri + rj)
    return Approach(nx, ny, arm_i, arm_j, closing, slip, reduced, reduced * (spin_i - spin_j), reduced)


@inline
def relative_velocity(i, j, dx, dy, velocity, cell):
    """Velocity (m/s) of disc i relative to j, (dx, dy) m from it."""
    drift_x, drift_y = affine_velocity(dx, dy, cell)
    return velocity[i, 0] - velocity[j, 0] - drift_x, velocity[i, 1] - velocity[j, 1] - drift_y


@inline
def answer_contact(overlap, way, mass, p, springs, budget, law, dt):
    """A contact of round bodies: force on the first along x, y (N/m), torques on both (N m/m); then its springs (m),
    and what it lost (J/m), see budget.losses_if.

    overlap (m) > 0;  way: their Approach;  mass (kg/m) reduced;  p (COLUMNS,) row of the law;  springs m before.
    """
    seen = Relative(overlap, way.closing, way.slip, way.rolling, way.reduced)
    spring, roll = springs
    found = contact(seen, spring, roll, mass, dt, p, law)
    lost = losses_if(budget, seen, spring, roll, found, mass, dt, p, law)
    moment_i, moment_j = moments(found, way.arm_i, way.arm_j, way.rolls_at, law)
    fx, fy = force_components(found, way.nx, way.ny, law)
    return (fx, fy, moment_i, moment_j), (found.spring, found.roll), lost


@inline
def contact_force(i, k, overlap, way, mass, p, history, budget, law, dt):
    """``answer_contact`` for row k of ``history``, overwritten: force (N/m) and torques (N m/m).  The energy budget, if
    any, has the losses at disc i."""
    springs = load_history(history, k, law)
    answered, (spring, roll), lost = answer_contact(overlap, way, mass, p, springs, budget, law, dt)
    store_history(history, k, spring, roll, law)
    add_losses(budget, i, lost, law.rolling)
    return answered


@inline
def release_contact(i, k, overlap, way, p, history, budget, law, dt):
    """Add to the energy budget at disc i what the springs of row k of ``history`` still held that touched a step ago.

    Arguments as in contact_force, overlap <= 0;  without a budget there is nothing to do.
    """
    spring, roll = load_history(history, k, law)
    seen = Relative(overlap, way.closing, way.slip, way.rolling, way.reduced)
    add_release_losses(i, seen, spring, roll, dt, p, budget, law)


@inline
def row_between(i, j, shared, law, material):
    """The law between discs i and j as numbers: ``shared`` where ``material`` is None.

    shared: those of law.table[0, 0], read once before a loop over pairs; within, the compiler must assume that the
    forces that are written might be the table's.
    """
    if material is None:
        return shared
    return row_numbers(law.table[material[i], material[j]], law)


@inline
def leave_pair(i, j, k, dx, dy, d, history, law, dt, cell):
    """Add to the budget, which there is, what the springs of a pair (dx, dy) m apart hold that touched a step ago."""
    du, dv = relative_velocity(i, j, dx, dy, d.velocity, cell)
    p = row_between(i, j, row_numbers(law.table[0, 0], law), law, d.material)
    overlap = d.radius[i] + d.radius[j] - np.sqrt(dx * dx + dy * dy)
    way = contact_kinematics(dx, dy, du, dv, d.spin[i], d.spin[j], d.radius[i], d.radius[j])
    release_contact(i, k, overlap, way, p, history, d.budget, law, dt)
