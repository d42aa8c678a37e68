"""What moves other than free discs: clumps, controlled bodies, walls.  Kernels, and the arrays that they share.

A system without any of these passes None for them, and the contact loop is compiled without.  Per contact step, after
the forces: forces of members are summed up, controls act, holders take their share, walls get their speed; and after
the discs have moved: clumps move and place their members, walls move.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from porescale.common.compiled.jit import kernel
from porescale.dem.bodies.clumps import gather, place_members
from porescale.dem.contact.law import EXTERNAL, HOLDERS, note_work
from porescale.dem.motion.affine_strain import affine_kick_drift, any_left, drift_of
from porescale.dem.motion.control import CLUMP, INDEX, KIND, PUSH, apply_control
from porescale.dem.motion.leapfrog import withhold
from porescale.dem.motion.servo import drive_walls, move_walls

Floats = NDArray[np.float64]
Integers = NDArray[np.int64]


class Arrays(NamedTuple):
    """clock (2,): seconds before the step last changed, and steps since;  schedules, points: of the cell's three, the
    controls' c and the drives' d;  the rest as in Clumps, control.py and servo.py."""

    clock: Floats
    schedules: Floats
    points: Floats
    start: Integers
    member: Integers
    offset: Floats
    arm: Floats
    turn: Floats
    body_position: Floats
    body_angle: Floats
    body_velocity: Floats
    body_spin: Floats
    body_mass: Floats
    body_inertia: Floats
    body_force: Floats
    body_torque: Floats
    body_held: NDArray[np.uint8]
    body_withheld: Floats
    control: Integers
    given: Floats
    watched: Integers
    watched_load: Floats
    drive: Integers
    servo: Floats


FIRST_CONTROL = 3
"""Row of the first control's schedule: after those of the cell."""


@kernel
def watch(a, force, torque, external_force, external_torque):
    """Add what contacts do to every watched body to ``a.watched_load``: all forces on it so far less the external."""
    for k in range(a.watched.shape[0]):
        i = a.watched[k, 1]
        if a.watched[k, 0]:
            x, y, moment = a.body_force[i, 0], a.body_force[i, 1], a.body_torque[i]
            for m in range(a.start[i], a.start[i + 1]):
                j = a.member[m]
                x -= external_force[j, 0]
                y -= external_force[j, 1]
                moment -= external_torque[j] + a.arm[m, 0] * external_force[j, 1] - a.arm[m, 1] * external_force[j, 0]
        else:
            x, y, moment = force[i, 0] - external_force[i, 0], force[i, 1] - external_force[i, 1], torque[i]
            moment -= external_torque[i]
        a.watched_load[k, 0] += x
        a.watched_load[k, 1] += y
        a.watched_load[k, 2] += moment


@kernel
def govern(
    a, walls, wall_force, position, velocity, spin, radius, mass, inertia, force, torque, external_force,
    external_torque, step, dt, drag, first, book,
):  # fmt: skip
    """Between forces and kick, step ``step`` of the call: see module.  ``a`` Arrays; the discs' arrays as elsewhere.

    first: sums over the steps of a call begin anew.  Overwrites velocities of what is moved as told, forces of what is
    pushed, velocities of walls (w, WALL), ``a``'s sums and, if there is one, the energy ``book`` (n, BOOK); what
    holders of discs do enters it in withhold.
    """
    time = a.clock[0] + (a.clock[1] + step) * dt
    gather(a.start, a.member, a.arm, a.body_force, a.body_torque, force, torque)
    if first:
        a.given[:, 0] = 0.0
        a.watched_load[:, :] = 0.0
    watch(a, force, torque, external_force, external_torque)
    schedules = a.schedules[FIRST_CONTROL:]
    for k in range(a.control.shape[0]):
        i, pushed = a.control[k, INDEX], a.control[k, KIND] == PUSH
        if a.control[k, CLUMP]:
            work = apply_control(
                a.control, a.given, k, schedules, a.points, a.body_velocity, a.body_spin, a.body_mass, a.body_inertia,
                a.body_force, a.body_torque, time, dt,
            )  # fmt: skip
            note_work(book, a.member[a.start[i]], EXTERNAL if pushed else HOLDERS, work / dt, dt)
        else:
            work = apply_control(
                a.control, a.given, k, schedules, a.points, velocity, spin, mass, inertia, force, torque, time, dt
            )
            if pushed:
                note_work(book, i, EXTERNAL, work / dt, dt)
    withhold(
        a.body_held, a.body_withheld, a.body_velocity, a.body_spin, a.body_mass, a.body_inertia, a.body_force,
        a.body_torque, drag, first, None, dt,
    )  # fmt: skip
    drive_walls(
        a.drive, a.servo, schedules, a.points, a.control.shape[0], walls, wall_force, position, radius, time, dt
    )


@kernel
def carry_bodies(a, walls, position, angle, velocity, spin, anchor, limit_square, drag, dt, moved, cell):
    """After the discs have moved: clumps and walls over ``dt`` (s).  Returns whether pairs must be listed anew.

    Overwrites the rows of members, which move_discs has moved as if they were free; ``moved``: what it said.
    """
    if a.body_mass.shape[0]:
        gxx, gxy, gyy = drift_of(cell)
        affine_kick_drift(
            a.body_position, a.body_angle, a.body_velocity, a.body_spin, a.body_mass, a.body_inertia, a.body_force,
            a.body_torque, gxx, gxy, gyy, drag, dt,
        )  # fmt: skip
        place_members(
            a.start, a.member, a.offset, a.arm, a.turn, a.body_position, a.body_angle, a.body_velocity, a.body_spin,
            position, angle, velocity, spin, gxx, gxy, gyy,
        )  # fmt: skip
        moved = any_left(position, anchor, limit_square, cell)
    move_walls(walls, dt)
    return moved
