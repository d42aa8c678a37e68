"""Walls that move: with a given velocity, or so that the discs press on them as wanted.

A servo wall moves along its normal with  V = U + g (F_wanted - F),  F the force of the discs against it:
    g = share/(K dt + 2 C),   K = N k,   C = N c,   N the number of discs it touches,   |V| <= speed,
k and c (N/m, N s/m) stiffness and dashpot of one contact.  The second part alone is PFC's servo, which lags: on discs
that give way at V it is V/g off, half of the load in a biaxial test of ordinary speed.  So the mean of the wall's own
velocity goes ahead:  U' = U + a (V - U),  a = g K dt/(4 (1 + g C)),  and no offset remains.

For discs that stay, F' = K x + C V of the step before, so that (z - 1)^2 z + g (z - 1 + a)(K dt z + C (z - 1)) = 0, and
at z = -1 g (2 - a)(K dt + 2 C) < 4: stable for share < 2, as without U (without dashpots: < 4).  The slow roots,
z = 1 - s with s^2 (1 + g C) - s g (K dt + a C) + a g K dt = 0, are then real: the wall goes past its load at most once.
Discs with a stiffness as small as x K let it swing, damped by sqrt(x) of critical.  While the wall touches nothing it
goes at ``speed``.
Sources: Itasca, PFC2D 3.1 theory and background (2004), section 3.5: numerical servo-control; Astrom & Murray, Feedback
Systems (2008), chapter 10: integral action, and why U follows the velocity that the wall really had.
"""

import numpy as np

from porescale.common.compiled.jit import kernel
from porescale.dem.forces.walls import NX, NY, PX, PY, TURN, VX, VY
from porescale.dem.motion.time_function import value_at

GIVEN_X, GIVEN_Y, GIVEN_TURN, BY_FORCE, BY_STRESS = range(5)
"""Modes of a drive: one component of the velocity, or a servo."""
WALL, MODE, LOW, HIGH = range(4)
"""Columns of a drive: its wall, its mode, and the two walls between which the stress acts, -1: over a fixed length."""
STIFFNESS, DAMPING, SHARE, SPEED, LENGTH, AHEAD = range(6)
"""Columns of a servo's numbers: of one contact N/m, N s/m;  -;  m/s;  m;  m/s, U, the only one that changes."""
QUARTER = 0.25
"""Of gK dt/(1 + gC), with which U follows: the most that leaves the slow roots real, see above."""


@kernel
def count_touching(walls, w, position, radius):
    """Number of discs, position (n, 2) m, radius (n,) m, that touch wall w of walls (w, WALL)."""
    found = 0
    for i in range(radius.shape[0]):
        distance = (position[i, 0] - walls[w, PX]) * walls[w, NX] + (position[i, 1] - walls[w, PY]) * walls[w, NY]
        found += radius[i] > distance
    return found


@kernel
def follow(stiffness, damping, share, dt):
    """Share a of the way that U goes in a step ``dt`` (s); stiffness N/m and dashpot N s/m of one contact."""
    whole = stiffness * dt + 2.0 * damping
    return QUARTER * share * stiffness * dt / (whole + share * damping)


@kernel
def servo_velocity(force, wanted, touching, numbers, dt):
    """Velocity (m/s) along the inward normal for the ``force`` (N/m) of ``touching`` discs against a wall; overwrites
    numbers[AHEAD]."""
    if touching == 0:
        numbers[AHEAD] = 0.0
        return numbers[SPEED] if wanted > 0.0 else 0.0
    resist = touching * (numbers[STIFFNESS] * dt + 2.0 * numbers[DAMPING])
    velocity = numbers[AHEAD] + numbers[SHARE] / resist * (wanted - force)
    velocity = min(max(velocity, -numbers[SPEED]), numbers[SPEED])
    numbers[AHEAD] += follow(numbers[STIFFNESS], numbers[DAMPING], numbers[SHARE], dt) * (velocity - numbers[AHEAD])
    return velocity


@kernel
def drive_walls(drive, numbers, schedules, points, offset, walls, wall_force, position, radius, time, dt):
    """Velocities of driven walls for the step from ``time`` to ``time + dt`` (s): overwrites VX, VY, TURN of walls, and
    what goes ahead in ``numbers``.

    drive (d, 4), numbers (d, 6): columns above, walls (w, WALL), wall_force (w, 3) N/m, N m/m of this step;  schedules
    and points: row ``offset`` + k is that of drive k.
    """
    for k in range(drive.shape[0]):
        w, mode = drive[k, WALL], drive[k, MODE]
        if mode < BY_FORCE:
            walls[w, VX + mode] = value_at(schedules, points, offset + k, time + 0.5 * dt)
            continue
        nx, ny = walls[w, NX], walls[w, NY]
        wanted = value_at(schedules, points, offset + k, time)
        if mode == BY_STRESS:
            length = numbers[k, LENGTH]
            low, high = drive[k, LOW], drive[k, HIGH]
            if low >= 0:
                length = abs(
                    (walls[high, PX] - walls[low, PX]) * walls[low, NX]
                    + (walls[high, PY] - walls[low, PY]) * walls[low, NY]
                )
            wanted *= length
        touching = count_touching(walls, w, position, radius)
        force = -(wall_force[w, 0] * nx + wall_force[w, 1] * ny)
        velocity = servo_velocity(force, wanted, touching, numbers[k], dt)
        walls[w, VX], walls[w, VY] = velocity * nx, velocity * ny


@kernel
def move_walls(walls, dt):
    """Move every wall (w, WALL) by its velocity over ``dt`` (s) and turn it about its point; overwrites where it is."""
    for w in range(walls.shape[0]):
        walls[w, PX] += dt * walls[w, VX]
        walls[w, PY] += dt * walls[w, VY]
        if walls[w, TURN] != 0.0:
            cosine, sine = np.cos(dt * walls[w, TURN]), np.sin(dt * walls[w, TURN])
            nx, ny = walls[w, NX], walls[w, NY]
            walls[w, NX], walls[w, NY] = cosine * nx - sine * ny, sine * nx + cosine * ny
