"""Strain of a periodic cell, at given rates or so that the stress is as wanted, and the motion of discs within.

With c the velocity relative to the cell's affine motion G x (cell.py),
    x' = c + G x,     m c' = F - m G c     (SLLOD: what is affine stays so, whatever G does),
and the cell does the work  -A P : G,  P = (sum m c c - sum f d)/A  the pressure tensor, compression positive.
Of clumps c is the velocity and d reaches from the centroid: all of a clump goes with the strain there.
Source: Evans & Morriss, Statistical Mechanics of Nonequilibrium Liquids (1990), section 6.3.

A component under stress control has the rate  g = U + share (P - P_wanted)/(dt K + 2 C),  |g| <= limit, with K = k sum
d^2/A and C = c sum d^2/A over contacts, k and c the stiffness and dashpot of one: no less than the modulus against
affine strain, where k_t <= k; and U the mean of that rate, as of a servo's velocity.  Stable for share < 2 by the
argument of servo.py.
"""

from typing import NamedTuple

import numpy as np

from porescale.common.compiled.jit import kernel, law_function
from porescale.common.core.types import Floats
from porescale.dem.motion.leapfrog import move_free
from porescale.dem.motion.periodic_cell import (
    SQUARES,
    TURNING_XX,
    TURNING_XY,
    TURNING_YY,
    XX,
    XY,
    YX,
    YY,
    Still,
    Straining,
)
from porescale.dem.motion.servo import follow
from porescale.dem.motion.time_function import value_at

WIDTH, HEIGHT, TILT, GXX, GXY, GYY, WIDTH_THEN, HEIGHT_THEN, TILT_THEN, REACH, SKIN, WORK, AHEAD = range(13)
"""Columns of a strained cell's state: edges m and velocity gradient 1/s; edges when the pairs were listed, their
largest reach and skin (m); work done by the cell since it began, J/m; from the last on, mean rates of xx, yy, xy under
a stress (1/s)."""
SHEAR = AHEAD + 3
"""One more: the shear since it began, which the tilt is not, as that starts anew at half a width."""
STATE = SHEAR + 1
STRESS, SHARE, LIMIT, STIFFNESS, DAMPING = range(5)
"""Columns of the plan of xx, yy, xy: 1 for a wanted stress;  share -, limit 1/s;  of one contact N/m, N s/m."""


class Deforming(NamedTuple):
    """A strained cell over time: state (STATE,), load (LOAD,), plan (3, 5) with the first three schedules, and clock
    (2,) s, steps: see Motion."""

    state: Floats
    load: Floats
    plan: Floats
    schedules: Floats
    points: Floats
    clock: Floats


@law_function
def cell_now(cell):
    """The cell as used for pairs now; clears the load of a strained one."""


@cell_now.of(Still)
def present_still(cell):
    """A cell that stands still is the same at all times."""
    return cell


@cell_now.of(Deforming)
def present_deforming(cell):
    """The numbers of a strained cell now."""
    s = cell.state
    cell.load[:] = 0.0
    return Straining(s[WIDTH], s[HEIGHT], s[TILT], s[GXX], s[GXY], s[GYY], cell.load)


@law_function
def drift_of(cell):
    """Velocity gradient (gxx, gxy, gyy) 1/s of the step to come."""


@drift_of.of(Still)
def no_drift(cell):
    """Zero in a cell that stands still."""
    return 0.0, 0.0, 0.0


@drift_of.of(Deforming)
def drift_deforming(cell):
    """Velocity gradient (G_xx, G_xy, G_yy), 1/s, as computed by ``steer``."""
    return cell.state[GXX], cell.state[GXY], cell.state[GYY]


@law_function
def steer(velocity, mass, step, dt, cell):
    """Choose the velocity gradient for the step to come, from schedules and from the stress of this one, and add up the
    cell's work;  velocity (n, 2) m/s, mass (n,) kg/m;  step: number within the call;  dt s."""


@steer.of(Still)
def steer_still(velocity, mass, step, dt, cell):
    """A cell that stands still has no gradient to choose."""


@steer.of(Deforming)
def steer_deforming(velocity, mass, step, dt, cell):
    """Overwrites the gradient and the work in ``cell.state``."""
    s, time = cell.state, cell.clock[0] + (cell.clock[1] + step) * dt
    pxx, pxy, pyy = pressure(velocity, mass, cell.load, s[WIDTH] * s[HEIGHT])
    before = pxx * s[GXX] + pyy * s[GYY] + pxy * s[GXY]
    s[GXX] = prescribed_rate(pxx, 0, time, dt, cell)
    s[GYY] = prescribed_rate(pyy, 1, time, dt, cell)
    s[GXY] = prescribed_rate(pxy, 2, time, dt, cell)
    s[WORK] -= 0.5 * s[WIDTH] * s[HEIGHT] * dt * (before + pxx * s[GXX] + pyy * s[GYY] + pxy * s[GXY])


@law_function
def add_clump_terms(c, d, cell):
    """What clumps ``c``, ClumpArrays, change in the sums of a strained cell;  d: DiscArrays, before the kick."""


@add_clump_terms.of(Still)
def no_clump_terms(c, d, cell):
    """A cell that stands still has no sums."""


@add_clump_terms.of(Deforming)
def clump_terms_deforming(c, d, cell):
    """Overwrites ``cell.load``: X_j - X_i = d - o_j + o_i of centroids, so g d over contacts lacks g o over members."""
    load, force, external_force, velocity, mass = cell.load, d.force, d.external_force, d.velocity, d.mass
    for b in range(c.mass.shape[0]):
        for k in range(c.start[b], c.start[b + 1]):
            i = c.member[k]
            gx, gy = force[i, 0] - external_force[i, 0], force[i, 1] - external_force[i, 1]
            load[XX] += gx * c.arm[k, 0]
            load[XY] += gx * c.arm[k, 1]
            load[YX] += gy * c.arm[k, 0]
            load[YY] += gy * c.arm[k, 1]
            u, v, du, dv = velocity[i, 0], velocity[i, 1], c.velocity[b, 0], c.velocity[b, 1]
            load[TURNING_XX] += mass[i] * (u * u - du * du)
            load[TURNING_XY] += mass[i] * (u * v - du * dv)
            load[TURNING_YY] += mass[i] * (v * v - dv * dv)


@kernel
def pressure(velocity, mass, load, area):
    """Pressure tensor (xx, xy, yy), Pa, compression positive: of contacts, see ``note``, and of motion."""
    pxx, pxy, pyy = -load[XX] - load[TURNING_XX], -load[XY] - load[TURNING_XY], -load[YY] - load[TURNING_YY]
    for i in range(mass.shape[0]):
        pxx += mass[i] * velocity[i, 0] * velocity[i, 0]
        pxy += mass[i] * velocity[i, 0] * velocity[i, 1]
        pyy += mass[i] * velocity[i, 1] * velocity[i, 1]
    return pxx / area, pxy / area, pyy / area


@kernel
def prescribed_rate(found, k, time, dt, cell):
    """Rate (1/s) of component k (xx, yy, xy) of a Deforming cell at its pressure ``found`` (Pa); the stress that is
    wanted is a pressure for the first two and that which drives the shear, -P_xy, for the third.  Overwrites the mean
    rate in ``cell.state``."""
    value = value_at(cell.schedules, cell.points, k, time if cell.plan[k, STRESS] != 0.0 else time + 0.5 * dt)
    if cell.plan[k, STRESS] == 0.0:
        return value
    squares, area = cell.load[SQUARES], cell.state[WIDTH] * cell.state[HEIGHT]
    excess = found + value if k == 2 else found - value
    share, most, ahead = cell.plan[k, SHARE], cell.plan[k, LIMIT], cell.state[AHEAD + k]
    if squares == 0.0:
        cell.state[AHEAD + k] = 0.0
        return np.sign(excess) * most
    resist = (cell.plan[k, STIFFNESS] * dt + 2.0 * cell.plan[k, DAMPING]) * squares / area
    rate = min(max(ahead + share * excess / resist, -most), most)
    cell.state[AHEAD + k] += follow(cell.plan[k, STIFFNESS], cell.plan[k, DAMPING], share, dt) * (rate - ahead)
    return rate


@kernel
def room_square(state):
    """Square (m^2) of how far a disc may go from where the strain since the last listing would have carried it.

    Unlisted pairs were further apart than reach + skin; a strain F brings them no closer than its smallest singular
    value s times that: s (reach + skin) - 2 u >= reach holds for u <= (s skin - max(0, 1 - s) reach)/2.  Negative where
    there is no room.
    """
    f, h = state[WIDTH] / state[WIDTH_THEN], state[HEIGHT] / state[HEIGHT_THEN]
    slope = (state[TILT] - f * state[TILT_THEN]) / state[HEIGHT_THEN]
    total, area = f * f + h * h + slope * slope, f * h
    least = np.sqrt(0.5 * (total - np.sqrt(max(total * total - 4.0 * area * area, 0.0))))
    room = 0.5 * (least * state[SKIN] - max(0.0, 1.0 - least) * 2.0 * state[REACH])
    return room * room if room > 0.0 else -1.0


@law_function
def move_discs(d, pairs, drag, dt, sweep, cell):
    """As kick_drift, in ``cell``; a strained one is strained by the step, too.  d: DiscArrays;  pairs: Pairs."""


@move_discs.of(Still)
def move_still(d, pairs, drag, dt, sweep, cell):
    """Kick and drift of discs in a fixed cell, by one thread or several."""
    return move_free(d, pairs.checked_position, pairs.limit_square, drag, dt, sweep)


@move_discs.of(Deforming)
def move_deforming(d, pairs, drag, dt, sweep, cell):
    """Central in time in drag and G: (1 + dt/2 (drag + G)) c' = (1 - dt/2 (drag + G)) c + dt F/m, then
    x' = x + dt (c' + G x), which maps images onto images."""
    gxx, gxy, gyy = drift_of(cell)
    strain(cell.state, dt)
    limit = room_square(cell.state)
    affine_kick_drift(d, gxx, gxy, gyy, drag, dt)
    return left_affine(d.position, pairs.checked_position, limit, cell.state)


@kernel
def strain(state, dt):
    """Strain the edges in ``state`` (STATE,) by its gradient over ``dt`` (s), and add to its shear."""
    state[SHEAR] += dt * state[GXY]
    state[TILT] += dt * (state[GXX] * state[TILT] + state[GXY] * state[HEIGHT])
    state[WIDTH] += dt * state[GXX] * state[WIDTH]
    state[HEIGHT] += dt * state[GYY] * state[HEIGHT]


@kernel
def affine_kick_drift(d, gxx, gxy, gyy, drag, dt):
    """Kick and drift in a strained cell of gradient gxx, gxy, gyy 1/s, see move_deforming.

    d: DiscArrays or ClumpArrays; overwrites position, angle, velocity and spin.  drag 1/s;  dt s.
    """
    position, angle, velocity, spin, force, torque = d.position, d.angle, d.velocity, d.spin, d.force, d.torque
    mass, inertia = d.mass, d.inertia
    half = 0.5 * dt
    for i in range(mass.shape[0]):
        old_y = velocity[i, 1]
        vy = (old_y * (1.0 - half * (drag + gyy)) + force[i, 1] * dt / mass[i]) / (1.0 + half * (drag + gyy))
        vx = velocity[i, 0] * (1.0 - half * (drag + gxx)) - half * gxy * (old_y + vy) + force[i, 0] * dt / mass[i]
        vx /= 1.0 + half * (drag + gxx)
        w = (spin[i] * (1.0 - half * drag) + torque[i] * (dt / inertia[i])) / (1.0 + half * drag)
        velocity[i, 0], velocity[i, 1], spin[i] = vx, vy, w
        x, y = position[i, 0], position[i, 1]
        position[i, 0], position[i, 1] = x + dt * (vx + gxx * x + gxy * y), y + dt * (vy + gyy * y)
        angle[i] += dt * w


@kernel
def left_affine(position, checked_position, limit_square, state):
    """Whether some disc is further than allowed from where the strain has carried the place it was listed at."""
    f, h = state[WIDTH] / state[WIDTH_THEN], state[HEIGHT] / state[HEIGHT_THEN]
    slope = (state[TILT] - f * state[TILT_THEN]) / state[HEIGHT_THEN]
    moved = False
    for i in range(position.shape[0]):
        dx = position[i, 0] - f * checked_position[i, 0] - slope * checked_position[i, 1]
        dy = position[i, 1] - h * checked_position[i, 1]
        if not (dx * dx + dy * dy <= limit_square):  # also true for nan
            moved = True
    return moved


@law_function
def any_left(position, checked_position, limit_square, cell):
    """Whether some disc has gone further than allowed from where it was listed: the result of move_discs alone."""


@any_left.of(Still)
def left_still(position, checked_position, limit_square, cell):
    """Whether a disc has gone further than allowed, in a cell that does not deform."""
    moved = False
    for i in range(position.shape[0]):
        dx, dy = position[i, 0] - checked_position[i, 0], position[i, 1] - checked_position[i, 1]
        if not (dx * dx + dy * dy <= limit_square):
            moved = True
    return moved


@any_left.of(Deforming)
def left_deforming(position, checked_position, limit_square, cell):
    """Whether a disc has gone further than allowed, with the affine motion since the check taken off."""
    return left_affine(position, checked_position, room_square(cell.state), cell.state)
