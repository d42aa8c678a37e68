"""What moves other than free discs: clumps, controlled bodies, walls.  Kernels, and the arrays that they share.

A system without any of these passes None for them, and the contact loop is compiled without.  Per contact step, after
the forces: forces of members are summed up, controls act, holders take their share, walls get their speed; and after
the discs have moved: clumps move and place their members, walls move.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from porescale.common.compiled.jit import inline, kernel
from porescale.common.core.types import Floats
from porescale.dem.bodies.clumps import ClumpArrays, gather, place_members
from porescale.dem.contact.budget import EXTERNAL, HOLDERS, add_work
from porescale.dem.forces.walls import TURN, VX, VY
from porescale.dem.motion.affine_strain import affine_kick_drift, any_left, drift_of
from porescale.dem.motion.control import CLUMP, INDEX, KIND, PUSH, apply_control
from porescale.dem.motion.leapfrog import withhold
from porescale.dem.motion.servo import drive_walls, move_walls

Integers = NDArray[np.int64]


class DriverArrays(NamedTuple):
    """clock (2,): seconds before the step last changed, and steps since;  schedules, points: of the cell's three, the
    controls' c and the drives' d;  clumps: ClumpArrays;  the rest as in control.py, servo.py and drivers.py."""

    clock: Floats
    schedules: Floats
    points: Floats
    clumps: ClumpArrays
    control: Integers
    given: Floats
    watched: Integers
    watched_load: Floats
    drive: Integers
    servo: Floats


FIRST_CONTROL = 3
"""Row of the first control's schedule: after those of the cell."""


@inline
def stands(walls, a):
    """Whether all walls (w, WALL) stand still during a call;  a: DriverArrays, or None."""
    if a is None:
        return True
    still = a.drive.shape[0] == 0
    for w in range(walls.shape[0]):
        still = still and walls[w, VX] == 0.0 and walls[w, VY] == 0.0 and walls[w, TURN] == 0.0
    return still


@kernel
def record_loads(a, d):
    """Add the contact force on every recorded body to ``a.watched_load``: all forces on it so far less the external."""
    c, force, torque, external_force, external_torque = a.clumps, d.force, d.torque, d.external_force, d.external_torque
    for k in range(a.watched.shape[0]):
        i = a.watched[k, 1]
        if a.watched[k, 0]:
            x, y, moment = c.force[i, 0], c.force[i, 1], c.torque[i]
            for m in range(c.start[i], c.start[i + 1]):
                j = c.member[m]
                x -= external_force[j, 0]
                y -= external_force[j, 1]
                moment -= external_torque[j] + c.arm[m, 0] * external_force[j, 1] - c.arm[m, 1] * external_force[j, 0]
        else:
            x, y, moment = force[i, 0] - external_force[i, 0], force[i, 1] - external_force[i, 1], torque[i]
            moment -= external_torque[i]
        a.watched_load[k, 0] += x
        a.watched_load[k, 1] += y
        a.watched_load[k, 2] += moment


@kernel
def apply_drivers(a, walls, wall_load, d, step, dt, drag, first):
    """Between forces and kick, step ``step`` of the call: see module.  a: DriverArrays;  d: DiscArrays.

    first: sums over the steps of a call begin anew.  Overwrites velocities of what has a prescribed one, forces of what
    is pushed, velocities of walls (w, WALL), the sums in ``a`` and, if there is one, the energy budget; what holders of
    discs do is added by withhold.  wall_load (w, 3) N/m, N m/m.
    """
    time = a.clock[0] + (a.clock[1] + step) * dt
    c, budget = a.clumps, d.budget
    gather(c, d.force, d.torque)
    if first:
        a.given[:, 0] = 0.0
        a.watched_load[:, :] = 0.0
    record_loads(a, d)
    schedules = a.schedules[FIRST_CONTROL:]
    for k in range(a.control.shape[0]):
        i, pushed = a.control[k, INDEX], a.control[k, KIND] == PUSH
        if a.control[k, CLUMP]:
            work = apply_control(a.control, a.given, k, schedules, a.points, c, time, dt)
            add_work(budget, c.member[c.start[i]], EXTERNAL if pushed else HOLDERS, work / dt, dt)
        else:
            work = apply_control(a.control, a.given, k, schedules, a.points, d, time, dt)
            if pushed:
                add_work(budget, i, EXTERNAL, work / dt, dt)
    withhold(c, drag, first, None, dt)
    drive_walls(
        a.drive, a.servo, schedules, a.points, a.control.shape[0], walls, wall_load, d.position, d.radius, time, dt
    )


@kernel
def move_bodies(a, d, walls, pairs, drag, dt, moved, cell):
    """After the discs have moved: clumps and walls over ``dt`` (s).  Returns whether pairs must be listed anew.

    Overwrites the rows of members, which move_discs has moved as if they were free;  moved: its result.
    """
    c = a.clumps
    if c.mass.shape[0]:
        gxx, gxy, gyy = drift_of(cell)
        affine_kick_drift(c, gxx, gxy, gyy, drag, dt)
        place_members(c, d, gxx, gxy, gyy)
        moved = any_left(d.position, pairs.checked_position, pairs.limit_square, cell)
    move_walls(walls, dt)
    return moved
