"""Time stepping: leap-frog kick and drift, several contact steps in one call, and how long a step may be.

Velocities live at half steps, positions at whole steps; forces are taken at whole-step positions with the
velocities of half a step before (lagged damping):
    v(n+1/2) = v(n-1/2) + dt F(x(n), v(n-1/2))/m,      x(n+1) = x(n) + dt v(n+1/2).
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np

from porescale.dem.cell import Still
from porescale.dem.contact.law import BEFORE_SPIN, BEFORE_X, BEFORE_Y, DRAG, EXTERNAL, HOLDERS, note_work
from porescale.dem.contact.linear import Linear
from porescale.dem.contact.materials import Law
from porescale.dem.rectangle import move_rectangles
from porescale.dem.sweep import BLOCK, Serial, Threads, sweep_pairs, sweep_surfaces
from porescale.dem.walls import move_plates
from porescale.ground.jit import by_law, inline, kernel, parallel_kernel, prange

NEIGHBOURS = 6
"""Most discs that touch a disc and are no smaller than it: the kissing number of the plane."""


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

    Overwrites position (n, 2) m, angle (n,) rad, velocity (n, 2) m/s, spin (n,) rad/s.  mass, inertia (n,) kg/m,
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
        w = (spin[i] * before + torque[i] * (dt / inertia[i])) * after
        velocity[i, 0], velocity[i, 1], spin[i] = vx, vy, w
        x, y = position[i, 0] + dt * vx, position[i, 1] + dt * vy
        position[i, 0], position[i, 1] = x, y
        angle[i] += dt * w
        dx, dy = x - anchor[i, 0], y - anchor[i, 1]
        if not (dx * dx + dy * dy <= limit_square):  # also true for nan
            moved = True
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
    position: Any, angle: Any, velocity: Any, spin: Any, mass: Any, inertia: Any, force: Any, torque: Any, anchor: Any,
    limit_square: Any, drag: Any, dt: Any, sweep: Any,
) -> Any:  # fmt: skip
    """As kick_drift, by as many threads as ``sweep`` says."""


@sweep_kick.of(Serial)
def _kick_serial(
    position, angle, velocity, spin, mass, inertia, force, torque, anchor, limit_square, drag, dt, sweep
):  # fmt: skip
    return kick_drift(position, angle, velocity, spin, mass, inertia, force, torque, anchor, limit_square, drag, dt)


@sweep_kick.of(Threads)
def _kick_threads(
    position, angle, velocity, spin, mass, inertia, force, torque, anchor, limit_square, drag, dt, sweep
):  # fmt: skip
    return kick_drift_threads(
        position, angle, velocity, spin, mass, inertia, force, torque, anchor, limit_square, drag, dt
    )


@kernel
def first_without_number(position, velocity, spin):
    """(disc, column) of the first disc with a position (column 0) that is not finite, or else a velocity (1), or a
    spin (2); (-1, -1) if all are.  position, velocity (n, 2) m, m/s;  spin (n,) rad/s.
    """
    for i in range(spin.shape[0]):
        if not (np.isfinite(position[i, 0]) and np.isfinite(position[i, 1])):
            return i, 0
    for i in range(spin.shape[0]):
        if not (np.isfinite(velocity[i, 0]) and np.isfinite(velocity[i, 1])):
            return i, 1
    for i in range(spin.shape[0]):
        if not np.isfinite(spin[i]):
            return i, 2
    return -1, -1


@kernel
def contact_steps(
    count, dt, drag, position, angle, velocity, spin, radius, mass, inertia, force, torque,
    external_force, external_torque, start, partner, carried, anchor, limit_square, period_x, period_y, law,
    walls, wall_laws, wall_spring, wall_force, plates, plate_laws, plate_spring, plate_force,
    rectangles, rectangle_laws, rectangle_spring, rectangle_force, held, withheld, first, sweep,
):  # fmt: skip
    """Up to ``count`` contact steps; returns (steps done, whether the pair list must be rebuilt first to
    go on).

    Arrays as in add_pair_forces and the like, withhold and kick_drift; external_force (n, 2)
    N/m and external_torque (n,) N m/m are the same over all steps.  first: withheld forces are summed anew.
    sweep: by one thread or several, see sweep.py.  Overwrites the state of discs, springs, plates, rectangles.
    """
    for step in range(count):
        sweep_pairs(
            position, velocity, spin, radius, force, torque, external_force, external_torque, start, partner, carried,
            law, dt, Still(period_x, period_y), sweep,
        )  # fmt: skip
        sweep_surfaces(
            position, velocity, spin, radius, force, torque, walls, wall_laws, wall_spring, wall_force,
            plates, plate_laws, plate_spring, plate_force,
            rectangles, rectangle_laws, rectangle_spring, rectangle_force, law, dt, sweep,
        )  # fmt: skip
        note_step(law.book, velocity, spin, mass, inertia, external_force, external_torque, drag, dt)
        withhold(held, withheld, velocity, spin, mass, inertia, force, torque, drag, first and step == 0, law.book, dt)
        moved = sweep_kick(
            position, angle, velocity, spin, mass, inertia, force, torque, anchor, limit_square, drag, dt, sweep
        )
        move_plates(plates, dt)
        move_rectangles(rectangles, dt)
        if moved:
            return step + 1, True
    return count, False


def packing_factor(normal: float, tangential: float, rolling: float = 0.0) -> float:
    """Largest eigenvalue bound, N/m: m w^2 of the stiffest motion in any packing of discs of mass >= m.

    Energy of a contact: k_n/2 (n.(u_i - u_j))^2 + k_t/2 (t.(u_i - u_j) + r_i q_i + r_j q_j)^2.  From
    (a - b)^2 <= 2 a^2 + 2 b^2 it is at most the sum over both ends of k_n (n.u)^2 + k_t (t.u + r q)^2, so
    w^2 is at most the largest eigenvalue of a single disc on contacts twice as stiff, held still at their
    other ends.  The smallest disc is the stiffest; it touches at most 6, and six contacts 60 degrees apart
    give
        translation: 2 * 3 (k_n + k_t)/m,      rotation: 2 * 6 k_t r^2/I = 24 k_t/m.
    Table 1 of Saito et al. (k_t = k_n/4): 7.5 k_n/m, dt = 2.2e-5 s; the infinite triangular lattice itself
    reaches 6.5 k_n/m, 2.3e-5 s (a zone-boundary wave), where one pair alone allows 4.2e-5 s.
    Rolling springs, k_r/2 R^2 (q_i - q_j)^2 with R <= r, add 24 k_r/m to rotation in the same way.
    """
    return max(NEIGHBOURS * (normal + tangential), 4.0 * NEIGHBOURS * (tangential + rolling))


def packing_limit(law: Law, mass: float, radius: float | None = None) -> float:
    """Stability limit (s) in any packing whose lightest disc has ``mass`` (kg/m), damping lagged half a
    step.  The law of Hertz also needs its ``radius`` (m), and takes the stiffness at its ``deepest`` overlap.

    A mode z = -1 needs dt^2 K + 2 dt C = 4 M; with bounds K/M = a, C/M = b: dt = 2 / (b/2 + sqrt(b^2/4 +
    a)), which is 2 (sqrt(1 + h^2) - h)/w for one pair.
    """
    law = _tangents(law, mass, radius)
    a = packing_factor(law.stiffness, law.tangential_stiffness, law.rolling_stiffness * law.rolls) / mass
    b = packing_factor(law.damping, law.tangential_damping, law.rolling_damping * law.rolls) / mass
    return 2.0 / (0.5 * b + math.sqrt(0.25 * b * b + a))


def _tangents(law: Law, mass: float, radius: float | None) -> Linear:
    """The linear law that is as stiff as ``law`` ever is for the lightest disc."""
    if isinstance(law, Linear):
        return law
    if radius is None:
        raise ValueError("the stable step of a law of Hertz depends on the radius")
    return law.stiffest(mass, radius)


def stable_step(
    laws: Law | Sequence[Law],
    mass: float,
    radius: float | None = None,
    *,
    safety: float = 0.8,
    steps_per_contact: float = 10.0,
) -> float:
    """A safe contact step (s) for discs whose lightest has ``mass`` (kg/m) and ``radius`` (m) under all of ``laws``.

    ``safety`` times the packing limit, and at least ``steps_per_contact`` steps in the shortest contact of
    two such discs (a free bounce errs by about a step in its duration; 0: stability alone decides).  Linear laws do
    without the radius; see packing_limit for that of Hertz.
    """
    steps = []
    for law in laws if isinstance(laws, Sequence) else [laws]:
        steps.append(safety * packing_limit(law, mass, radius))
        if steps_per_contact > 0.0:
            steps.append(law.shortest_contact(0.5 * mass, 0.5 * (radius or 0.0)) / steps_per_contact)
    return min(steps)
