"""One step of motion: what held components do not follow, the kick and the drift, by one thread or several."""

from __future__ import annotations

from porescale.common.compiled.jit import by_law, inline, kernel, parallel_kernel, prange
from porescale.dem.contact.law import BEFORE_SPIN, BEFORE_X, BEFORE_Y, DRAG, EXTERNAL, HOLDERS, note_work
from porescale.dem.forces.threads import BLOCK, Serial, Threads


@kernel
def withhold(held, withheld, velocity, spin, mass, inertia, force, torque, drag, first, book, dt):
    """Take the force from held components, so that kick_drift leaves their velocity as it is.

    held (n, 3): not 0 where x, y, rotation is held; (0, 3) if none is.  Adds what the holder bears to withheld (n, 3)
    N/m, N/m, N m/m, after clearing it if ``first``.  Overwrites force (n, 2) and torque (n,) there with what balances
    the background damping ``drag`` (1/s), 0 without.  The holder's work over ``dt`` (s) goes into ``book``, if any.
    """
    for i in range(held.shape[0]):
        if first:
            withheld[i, 0], withheld[i, 1], withheld[i, 2] = 0.0, 0.0, 0.0
        for a in range(2):
            if held[i, a]:
                withheld[i, a] += force[i, a]
                note_work(book, i, HOLDERS, -force[i, a] * velocity[i, a], dt)
                force[i, a] = drag * mass[i] * velocity[i, a]
        if held[i, 2]:
            withheld[i, 2] += torque[i]
            note_work(book, i, HOLDERS, -torque[i] * spin[i], dt)
            torque[i] = drag * inertia[i] * spin[i]


@inline
def note_step(book, velocity, spin, mass, inertia, external_force, external_torque, drag, dt):
    """Enter the work of external forces (n, 2) N/m and torques (n,) N m/m and of the drag (1/s) over ``dt`` (s) into
    ``book`` (n, BOOK), and the velocities before the kick; nothing where it is None.
    """
    if book is None:
        return
    for i in range(mass.shape[0]):
        u, v, w = velocity[i, 0], velocity[i, 1], spin[i]
        book[i, EXTERNAL] += (external_force[i, 0] * u + external_force[i, 1] * v + external_torque[i] * w) * dt
        book[i, DRAG] += drag * (mass[i] * (u * u + v * v) + inertia[i] * w * w) * dt
        book[i, BEFORE_X], book[i, BEFORE_Y], book[i, BEFORE_SPIN] = u, v, w


@kernel
def kick_drift(
    position, angle, velocity, spin, mass, inertia, force, torque, anchor, limit_square, drag, dt
):  # fmt: skip
    """Move all discs one step; True when one has gone further than allowed from its anchor (or is no
    number).

    Overwrites position (n, 2) m, angle (n,) rad, velocity (n, 2) m/s, spin (n,) rad/s; with an angle (0,) nothing turns
    and spin is left as it is.  mass, inertia (n,) kg/m,
    kg m^2/m;  force (n, 2) N/m, torque (n,) N m/m;  anchor (n, 2) m, limit_square m^2: the list's skin test;
    drag 1/s: background damping -drag m v and -drag I w, central in time (0: none, to the bit);  dt s.
    """
    before = 1.0 - 0.5 * drag * dt
    after = 1.0 / (1.0 + 0.5 * drag * dt)
    moved = False
    for i in range(mass.shape[0]):
        per_mass = dt / mass[i]
        vx = (velocity[i, 0] * before + force[i, 0] * per_mass) * after
        vy = (velocity[i, 1] * before + force[i, 1] * per_mass) * after
        velocity[i, 0], velocity[i, 1] = vx, vy
        x, y = position[i, 0] + dt * vx, position[i, 1] + dt * vy
        position[i, 0], position[i, 1] = x, y
        dx, dy = x - anchor[i, 0], y - anchor[i, 1]
        if not (dx * dx + dy * dy <= limit_square):  # also true for nan
            moved = True
    for i in range(angle.shape[0]):
        w = (spin[i] * before + torque[i] * (dt / inertia[i])) * after
        spin[i] = w
        angle[i] += dt * w
    return moved


@parallel_kernel
def kick_drift_threads(
    position, angle, velocity, spin, mass, inertia, force, torque, anchor, limit_square, drag, dt
):  # fmt: skip
    """As kick_drift, block by block."""
    count = mass.shape[0]
    moved = 0
    for b in prange((count + BLOCK - 1) // BLOCK):
        first, last = b * BLOCK, min((b + 1) * BLOCK, count)
        moved += kick_drift(
            position[first:last], angle[first:last], velocity[first:last], spin[first:last], mass[first:last],
            inertia[first:last], force[first:last], torque[first:last], anchor[first:last], limit_square, drag, dt,
        )  # fmt: skip
    return moved > 0


@by_law
def sweep_kick(
    position, angle, velocity, spin, mass, inertia, force, torque, anchor,
    limit_square, drag, dt, sweep,
):  # fmt: skip
    """As kick_drift, by as many threads as ``sweep`` says."""


@sweep_kick.of(Serial)
def _kick_serial(
    position, angle, velocity, spin, mass, inertia, force, torque, anchor, limit_square, drag, dt, sweep
):  # fmt: skip
    """One loop."""
    return kick_drift(position, angle, velocity, spin, mass, inertia, force, torque, anchor, limit_square, drag, dt)


@sweep_kick.of(Threads)
def _kick_threads(
    position, angle, velocity, spin, mass, inertia, force, torque, anchor, limit_square, drag, dt, sweep
):  # fmt: skip
    """Blocks."""
    return kick_drift_threads(
        position, angle, velocity, spin, mass, inertia, force, torque, anchor, limit_square, drag, dt
    )
