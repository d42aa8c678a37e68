"""Time stepping: leap-frog kick and drift, several contact steps in one call, and how long a step may be.

Velocities live at half steps, positions at whole steps; forces are taken at whole-step positions with the
velocities of half a step before (lagged damping):
    v(n+1/2) = v(n-1/2) + dt F(x(n), v(n-1/2))/m,      x(n+1) = x(n) + dt v(n+1/2).
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from porescale.common.compiled.jit import kernel
from porescale.dem.contact.linear import Linear
from porescale.dem.contact.materials import Law
from porescale.dem.forces.bonds import pull_bonds
from porescale.dem.forces.rectangle import move_rectangles
from porescale.dem.forces.segments import add_segment_forces
from porescale.dem.forces.threads import sweep_pairs, sweep_surfaces
from porescale.dem.forces.walls import ask_near, move_plates
from porescale.dem.motion.affine_strain import at_present, move_discs, note_clumps, steer
from porescale.dem.motion.leapfrog import note_step, withhold
from porescale.dem.motion.rigid_and_driven import carry_bodies, govern

NEIGHBOURS = 6
"""Most discs that touch a disc and are no smaller than it: the kissing number of the plane."""
WAY = 2.01
"""How far a disc gets within a call, in lengths that the list allows from its mark: from one side of the mark to the
other, and for round-off 0.01 more, where the domain is less than 1e13 such lengths wide."""
ASK_AGAIN = 3
"""Steps of a call that pay for asking once which discs are near walls, which costs what walls do in a step."""


@kernel
def first_without_number(position, velocity, spin, angle):
    """(disc, column) of the first disc with a position (column 0) that is not finite, or else a velocity (1), a spin
    (2), or an angle (3); (-1, -1) if all are.  position, velocity (n, 2) m, m/s;  spin, angle (n,) rad/s, rad.
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
    for i in range(angle.shape[0]):
        if not np.isfinite(angle[i]):
            return i, 3
    return -1, -1


@kernel
def contact_steps(
    count, dt, drag, position, angle, velocity, spin, radius, mass, inertia, force, torque,
    external_force, external_torque, start, partner, carried, anchor, limit_square, law,
    walls, wall_laws, wall_spring, wall_force, plates, plate_laws, plate_spring, plate_force,
    rectangles, rectangle_laws, rectangle_spring, rectangle_force, held, withheld, first, sweep,
    motion, cell, segments, bonds,
):  # fmt: skip
    """Up to ``count`` contact steps; returns (steps done, whether the pair list must be rebuilt first to
    go on).

    Arrays as in add_pair_forces and the like, withhold and kick_drift; external_force (n, 2)
    N/m and external_torque (n,) N m/m are the same over all steps.  first: withheld forces are summed anew.
    sweep: by one thread or several, see sweep.py;  motion: of what is no free disc, None or motion.Arrays;  cell:
    cell.Still or strain.Deforming;  segments, bonds: None or segments.Segments and bonds.Bonds, in a cell that stands
    still.  Overwrites the state of discs, springs, plates, rectangles.
    """
    sweep.near[:] = 1
    for step in range(count):
        sweep_pairs(
            position, velocity, spin, radius, force, torque, external_force, external_torque, start, partner, carried,
            law, dt, at_present(cell), sweep,
        )  # fmt: skip
        sweep_surfaces(
            position, velocity, spin, radius, force, torque, walls, wall_laws, wall_spring, wall_force,
            plates, plate_laws, plate_spring, plate_force,
            rectangles, rectangle_laws, rectangle_spring, rectangle_force, law, dt, sweep,
        )  # fmt: skip
        if motion is None and step == 0 and count >= ASK_AGAIN:  # walls stand still; springs far from them are at rest
            ask_near(position, radius, walls, WAY * np.sqrt(limit_square), sweep.near)
        if segments is not None:
            add_segment_forces(position, velocity, spin, radius, force, torque, segments, law, dt, cell)
        if bonds is not None:
            pull_bonds(position, radius, force, torque, segments, bonds, step, dt, cell)
        note_step(law.book, velocity, spin, mass, inertia, external_force, external_torque, drag, dt)
        if motion is not None:
            govern(
                motion, walls, wall_force, position, velocity, spin, radius, mass, inertia, force, torque,
                external_force, external_torque, step, dt, drag, first and step == 0, law.book,
            )  # fmt: skip
            note_clumps(motion, velocity, mass, force, external_force, cell)
        withhold(held, withheld, velocity, spin, mass, inertia, force, torque, drag, first and step == 0, law.book, dt)
        steer(velocity, mass, step, dt, cell)
        moved = move_discs(
            position, angle, velocity, spin, mass, inertia, force, torque, anchor, limit_square, drag, dt, sweep, cell
        )
        if motion is not None:
            moved = carry_bodies(
                motion, walls, position, angle, velocity, spin, anchor, limit_square, drag, dt, moved, cell
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
