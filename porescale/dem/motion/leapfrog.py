"""One step of motion: what held components do not follow, the kick and the drift, by one thread or several."""

from typing import NamedTuple

from porescale.common.compiled.jit import inline, law_function, parallel_kernel, prange
from porescale.common.core.types import Floats
from porescale.dem.contact.budget import BEFORE_SPIN, BEFORE_X, BEFORE_Y, DRAG, EXTERNAL, HOLDERS, add_work
from porescale.dem.forces.threads import BLOCK, Serial, Threads


class Moving(NamedTuple):
    """What kick_drift takes of discs: fields as in arrays.DiscArrays."""

    position: Floats
    angle: Floats
    velocity: Floats
    spin: Floats
    mass: Floats
    inertia: Floats
    force: Floats
    torque: Floats


@inline
def withhold(d, drag, first, budget, dt):
    """Take the force from held components, so that kick_drift leaves their velocity as it is.

    d: DiscArrays or ClumpArrays.  Adds what the holder bears to d.withheld (n, 3) N/m, N/m, N m/m, after clearing it if
    ``first``.  Overwrites force (n, 2) and torque (n,) there with what balances the background damping ``drag`` (1/s),
    0 without.  The holder's work over ``dt`` (s) is added to ``budget``, if any.
    """
    for i in range(d.held.shape[0]):
        if first:
            d.withheld[i, 0], d.withheld[i, 1], d.withheld[i, 2] = 0.0, 0.0, 0.0
        for a in range(2):
            if d.held[i, a]:
                d.withheld[i, a] += d.force[i, a]
                add_work(budget, i, HOLDERS, -d.force[i, a] * d.velocity[i, a], dt)
                d.force[i, a] = drag * d.mass[i] * d.velocity[i, a]
        if d.held[i, 2]:
            d.withheld[i, 2] += d.torque[i]
            add_work(budget, i, HOLDERS, -d.torque[i] * d.spin[i], dt)
            d.torque[i] = drag * d.inertia[i] * d.spin[i]


@inline
def add_step_work(budget, d, drag, dt):
    """Add the work of the external forces on DiscArrays ``d`` and of the drag (1/s) over ``dt`` (s) to ``budget``
    (n, BUDGET), and keep the velocities before the kick in it; nothing where it is None.
    """
    if budget is None:
        return
    velocity, spin, mass, inertia = d.velocity, d.spin, d.mass, d.inertia
    external_force, external_torque = d.external_force, d.external_torque
    for i in range(mass.shape[0]):
        u, v, w = velocity[i, 0], velocity[i, 1], spin[i]
        budget[i, EXTERNAL] += (external_force[i, 0] * u + external_force[i, 1] * v + external_torque[i] * w) * dt
        budget[i, DRAG] += drag * (mass[i] * (u * u + v * v) + inertia[i] * w * w) * dt
        budget[i, BEFORE_X], budget[i, BEFORE_Y], budget[i, BEFORE_SPIN] = u, v, w


@inline
def kick_drift(d, checked_position, limit_square, drag, dt):
    """Move all discs one step; True when one has gone further than allowed from where it was listed (or is no number).

    d: DiscArrays or Moving.  Overwrites position, angle, velocity and spin; with an angle (0,) nothing turns and spin
    is left as it is.  checked_position (n, 2) m, limit_square m^2: the list's skin test;  drag 1/s: background damping
    -drag m v and -drag I w, central in time (0: none, to the bit);  dt s.
    """
    before = 1.0 - 0.5 * drag * dt
    after = 1.0 / (1.0 + 0.5 * drag * dt)
    moved = False
    for i in range(d.mass.shape[0]):
        per_mass = dt / d.mass[i]
        vx = (d.velocity[i, 0] * before + d.force[i, 0] * per_mass) * after
        vy = (d.velocity[i, 1] * before + d.force[i, 1] * per_mass) * after
        d.velocity[i, 0], d.velocity[i, 1] = vx, vy
        x, y = d.position[i, 0] + dt * vx, d.position[i, 1] + dt * vy
        d.position[i, 0], d.position[i, 1] = x, y
        dx, dy = x - checked_position[i, 0], y - checked_position[i, 1]
        if not (dx * dx + dy * dy <= limit_square):  # also true for nan
            moved = True
    for i in range(d.angle.shape[0]):
        w = (d.spin[i] * before + d.torque[i] * (dt / d.inertia[i])) * after
        d.spin[i] = w
        d.angle[i] += dt * w
    return moved


@parallel_kernel
def kick_drift_threads(d, checked_position, limit_square, drag, dt):
    """Kick and drift as kick_drift, block by block in several threads; returns whether a disc left its skin."""
    count = d.mass.shape[0]
    moved = 0
    for b in prange((count + BLOCK - 1) // BLOCK):
        first, last = b * BLOCK, min((b + 1) * BLOCK, count)
        own = Moving(
            d.position[first:last], d.angle[first:last], d.velocity[first:last], d.spin[first:last],
            d.mass[first:last], d.inertia[first:last], d.force[first:last], d.torque[first:last],
        )  # fmt: skip
        moved += kick_drift(own, checked_position[first:last], limit_square, drag, dt)
    return moved > 0


@law_function
def move_free(d, checked_position, limit_square, drag, dt, sweep):
    """As kick_drift, by as many threads as ``sweep`` says."""


@move_free.of(Serial)
def _move_serial(d, checked_position, limit_square, drag, dt, sweep):
    """One thread: a single loop over all discs."""
    return kick_drift(d, checked_position, limit_square, drag, dt)


@move_free.of(Threads)
def _move_threads(d, checked_position, limit_square, drag, dt, sweep):
    """Several threads: blocks of discs side by side."""
    return kick_drift_threads(d, checked_position, limit_square, drag, dt)
