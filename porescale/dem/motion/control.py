"""Control of bodies: each of x, y, rotation free, with a prescribed velocity, or with a force added; and its work.

A controlled component is one row.  By displacement: the velocity over a step is the schedule's at its middle, or the
difference of two positions of it over the step, so that positions are reached to round-off, whatever the
forces, and the control supplies  m (v' - v)/dt - F.  By force: the schedule's value at the whole step is added to F.
Work is that supply times the mean of the velocities before and after, which is what the kick changes the kinetic energy
by.  Source: Matsushima, DEMseg tutorial I-3.
"""

from dataclasses import dataclass

from porescale.common.compiled.jit import inline, kernel
from porescale.dem.motion.time_function import Schedule, value_at

VELOCITY, PLACE, PUSH = range(3)
"""Kinds of control: prescribed velocity, prescribed displacement, added force or moment."""
CLUMP, INDEX, AXIS, KIND = range(4)
"""Columns of a control: 1 for a clump, its number or the disc's, 0 x 1 y 2 rotation, kind."""
SUPPLY, WORK = range(2)
"""Columns of what a control gives: sum of N/m or N m/m over the steps of a call;  J/m since it began."""


@dataclass(frozen=True)
class Moved:
    """A component with a given velocity, m/s or rad/s, over time in s."""

    velocity: Schedule = 0.0


@dataclass(frozen=True)
class Placed:
    """A component with a given displacement, m or rad, over time in s; only its changes matter."""

    displacement: Schedule


@dataclass(frozen=True)
class Pushed:
    """A component with a given force added, N/m or N m/m, over time in s; negative to the left, down, clockwise."""

    force: Schedule


Control = Moved | Placed | Pushed
KINDS = {Moved: VELOCITY, Placed: PLACE, Pushed: PUSH}


def schedule_of(control: Control) -> Schedule:
    """The time function of a control."""
    if isinstance(control, Moved):
        return control.velocity
    return control.displacement if isinstance(control, Placed) else control.force


@inline
def prescribed_velocity(kind, schedules, points, which, time, dt):
    """Velocity (m/s, rad/s) over the step from ``time`` to ``time + dt`` (s) of a control by displacement."""
    if kind == VELOCITY:
        return value_at(schedules, points, which, time + 0.5 * dt)
    return (value_at(schedules, points, which, time + dt) - value_at(schedules, points, which, time)) / dt


@kernel
def apply_control(control, given, k, schedules, points, d, time, dt):
    """Row k of control (c, 4) on the bodies ``d``, DiscArrays or ClumpArrays, before they are kicked; returns its work
    over the step.

    Overwrites velocity (n, 2) m/s or spin (n,) rad/s where moved (held components, see withhold, keep it), force
    (n, 2) N/m or torque (n,) N m/m where pushed, and row k of given (c, 2).
    """
    velocity, spin, force, torque = d.velocity, d.spin, d.force, d.torque
    i, axis, kind = control[k, INDEX], control[k, AXIS], control[k, KIND]
    old = spin[i] if axis == 2 else velocity[i, axis]
    size = d.inertia[i] if axis == 2 else d.mass[i]
    load = torque[i] if axis == 2 else force[i, axis]
    if kind == PUSH:
        supply = value_at(schedules, points, k, time)
        new = old + (load + supply) * dt / size
        if axis == 2:
            torque[i] += supply
        else:
            force[i, axis] += supply
    else:
        new = prescribed_velocity(kind, schedules, points, k, time, dt)
        supply = size * (new - old) / dt - load
        if axis == 2:
            spin[i] = new
        else:
            velocity[i, axis] = new
    work = 0.5 * supply * (old + new) * dt
    given[k, SUPPLY] += supply
    given[k, WORK] += work
    return work
