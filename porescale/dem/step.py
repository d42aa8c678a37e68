"""Time stepping: leap-frog kick and drift, several contact steps in one call.

Velocities live at half steps, positions at whole steps; forces are taken at whole-step positions with the
velocities of half a step before (lagged damping):
    v(n+1/2) = v(n-1/2) + dt F(x(n), v(n-1/2))/m,      x(n+1) = x(n) + dt v(n+1/2).
"""

from __future__ import annotations

import numpy as np

from porescale.common.compiled.jit import kernel
from porescale.dem.forces.bonds import pull_bonds
from porescale.dem.forces.rectangle import move_rectangles
from porescale.dem.forces.segments import add_segment_forces
from porescale.dem.forces.threads import sweep_pairs, sweep_surfaces
from porescale.dem.forces.walls import ask_near, move_plates
from porescale.dem.motion.affine_strain import at_present, move_discs, note_clumps, steer
from porescale.dem.motion.leapfrog import note_step, withhold
from porescale.dem.motion.rigid_and_driven import carry_bodies, govern

WAY = 2.01
"""How far a disc gets within a call, in lengths that the list allows from its mark: from one side of the mark to the
other, and for round-off 0.01 more, where the domain is less than 1e13 such lengths wide."""
ASK_AGAIN = 3
"""Steps of a call that pay for asking once which discs are near walls, which costs what walls do in a step."""


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
