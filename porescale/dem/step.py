"""Time stepping: leap-frog kick and drift, several contact steps in one call.

Velocities are defined at half steps, positions at whole steps; forces are taken at whole-step positions with the
velocities of half a step before (lagged damping):
    v(n+1/2) = v(n-1/2) + dt F(x(n), v(n-1/2))/m,      x(n+1) = x(n) + dt v(n+1/2).
"""

import numpy as np

from porescale.common.compiled.jit import kernel
from porescale.dem.arrays import DiscArrays, Pairs, Surfaces
from porescale.dem.forces.bonds import pull_bonds
from porescale.dem.forces.rectangle import move_rectangles
from porescale.dem.forces.segments import add_segment_forces
from porescale.dem.forces.threads import add_surface_forces, all_pair_forces
from porescale.dem.forces.walls import mark_near, move_plates
from porescale.dem.motion.affine_strain import add_clump_terms, cell_now, move_discs, steer
from porescale.dem.motion.leapfrog import add_step_work, withhold
from porescale.dem.motion.rigid_and_driven import apply_drivers, move_bodies, stands

WAY = 2.01
"""How far a disc gets within a call, in lengths that the list allows from where it was listed: from one side of that
place to the other, and for round-off 0.01 more, where the domain is less than 1e13 such lengths wide."""
MARK_AGAIN = 3
"""Steps of a call that pay for marking once which discs are near walls, which costs what walls do in a step."""


@kernel
def contact_steps(count, dt, drag, first, discs, pair_list, law, around, sweep, motion, cell, framed):
    """Up to ``count`` contact steps of ``dt`` (s); returns (steps done, whether the pair list must be rebuilt first to
    go on).

    drag 1/s: background damping;  first: withheld forces are summed anew;  discs, pair_list, around: the members of
    DiscArrays, Pairs and Surfaces as plain tuples;  law see contact/law.py;  sweep: by one thread or several, see
    forces/threads.py;  motion: of what is no free disc, None or DriverArrays;  cell: Still or Deforming;  framed: None
    or (Segments, Bonds), in a cell that stands still.  Overwrites the state of discs, springs, plates, rectangles.

    numba recognizes a NamedTuple more slowly: a call for one step of 100 discs takes 10.0 us with plain tuples, 12.1 us
    with NamedTuples, 9.6 us with each array an argument (a call for ten steps: 44.5, 46.8, 44.4 us).
    """
    d, pairs, surfaces = DiscArrays(*discs), Pairs(*pair_list), Surfaces(*around)
    sweep.near[:] = 1
    for step in range(count):
        all_pair_forces(d, pairs, law, dt, cell_now(cell), sweep)
        add_surface_forces(d, surfaces, law, dt, sweep)
        if step == 0 and count >= MARK_AGAIN and stands(surfaces.walls, motion):  # springs far from them are at rest
            mark_near(d.position, d.radius, surfaces.walls, WAY * np.sqrt(pairs.limit_square), sweep.near)
        if framed is not None:
            add_segment_forces(d, framed[0], law, dt, cell)
            pull_bonds(d.position, d.radius, d.force, d.torque, framed[0], framed[1], step, dt, cell)
        add_step_work(d.budget, d, drag, dt)
        if motion is not None:
            apply_drivers(motion, surfaces.walls, surfaces.wall_load, d, step, dt, drag, first and step == 0)
            add_clump_terms(motion.clumps, d, cell)
        withhold(d, drag, first and step == 0, d.budget, dt)
        steer(d.velocity, d.mass, step, dt, cell)
        moved = move_discs(d, pairs, drag, dt, sweep, cell)
        if motion is not None:
            moved = move_bodies(motion, d, surfaces.walls, pairs, drag, dt, moved, cell)
        move_plates(surfaces.plates, dt)
        move_rectangles(surfaces.rectangles, dt)
        if moved:
            return step + 1, True
    return count, False
