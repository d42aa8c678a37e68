"""The smallest kernels that do the job of dry discs: one linear law as numbers, walls, a half list; nothing is chosen.

They are what `study parts` holds scenes of grains against, with friction and without: without friction discs do not
turn, and contacts have no history.  Law and step as in contact/law.py and kick.py; releases at zero force.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from porescale.common.compiled.jit import kernel
from porescale.common.core.types import Floats
from porescale.common.neighbors.pair_list import PairList
from porescale.dem.contact.linear import Linear
from porescale.dem.grains import Grains


class Springs(NamedTuple):
    """A linear law: k, kt N/m and c, ct N s/m along and across the normal; mu."""

    k: float
    c: float
    kt: float
    ct: float
    mu: float


class State(NamedTuple):
    """Discs, as `Discs.state` has them: position (n, 2) m, angle (n,), velocity m/s, spin rad/s, radius m, mass kg/m,
    inertia kg m²/m, force N/m, torque N m/m."""

    position: Floats
    angle: Floats
    velocity: Floats
    spin: Floats
    radius: Floats
    mass: Floats
    inertia: Floats
    force: Floats
    torque: Floats


class Near(NamedTuple):
    """A half list of pairs: start (n + 1,), partner (p,), carried (p, 1) m, the springs; list_position (n, 2) m, where
    discs were when it was made, and limit m², the square of how far they may go."""

    start: NDArray[np.int64]
    partner: NDArray[np.int32]
    carried: Floats
    list_position: Floats
    limit: float


@kernel
def smooth_steps(count, dt, law, discs, weight, near, walls):
    """Steps without friction; stops after one in which a disc left the list.  Returns steps done.

    law: Springs;  discs: State, of which position, velocity and force are overwritten;  weight (n, 2) N/m;  near: Near;
    walls (w, 4) or wider: point and unit normal.
    """
    position, velocity, radius, mass, force = discs.position, discs.velocity, discs.radius, discs.mass, discs.force
    start, partner, list_position, limit, k, c = near.start, near.partner, near.list_position, near.limit, law.k, law.c
    for step in range(count):
        force[:, :] = weight
        for i in range(radius.shape[0]):
            fx, fy = 0.0, 0.0
            for n in range(start[i], start[i + 1]):
                j = partner[n]
                dx, dy = position[j, 0] - position[i, 0], position[j, 1] - position[i, 1]
                square, reach = dx * dx + dy * dy, radius[i] + radius[j]
                if square < reach * reach:
                    distance = np.sqrt(square)
                    nx, ny = dx / distance, dy / distance
                    closing = (velocity[i, 0] - velocity[j, 0]) * nx + (velocity[i, 1] - velocity[j, 1]) * ny
                    push = max(k * (reach - distance) + c * closing, 0.0)
                    fx -= push * nx
                    fy -= push * ny
                    force[j, 0] += push * nx
                    force[j, 1] += push * ny
            force[i, 0] += fx
            force[i, 1] += fy
        for w in range(walls.shape[0]):
            px, py, nx, ny = walls[w, 0], walls[w, 1], walls[w, 2], walls[w, 3]
            for i in range(radius.shape[0]):
                distance = (position[i, 0] - px) * nx + (position[i, 1] - py) * ny
                if distance < radius[i]:
                    push = k * (radius[i] - distance) - c * (velocity[i, 0] * nx + velocity[i, 1] * ny)
                    push = max(push, 0.0)
                    force[i, 0] += push * nx
                    force[i, 1] += push * ny
        left = False
        for i in range(radius.shape[0]):
            velocity[i, 0] += dt * force[i, 0] / mass[i]
            velocity[i, 1] += dt * force[i, 1] / mass[i]
            position[i, 0] += dt * velocity[i, 0]
            position[i, 1] += dt * velocity[i, 1]
            dx, dy = position[i, 0] - list_position[i, 0], position[i, 1] - list_position[i, 1]
            if not dx * dx + dy * dy <= limit:
                left = True
        if left:
            return step + 1
    return count


@kernel
def rub(push, slip, spring, dt, law):
    """Spring, slider and dashpot: (force N/m, new spring m) at normal force ``push`` N/m and ``slip`` m/s."""
    kt, ct, mu = law.kt, law.ct, law.mu
    reach = mu * push / kt
    spring = min(max(spring + slip * dt, -reach), reach)
    return min(max(-kt * spring - ct * slip, -mu * push), mu * push), spring


@kernel
def rough_steps(count, dt, law, discs, weight, turning, near, walls, wall_spring):
    """Steps with friction; stops after one in which a disc left the list.  Returns steps done.

    turning (n,) N m/m from outside;  wall_spring (w, n, 1) m;  the rest as in smooth_steps.  Overwrites the state of
    discs and springs.
    """
    position, velocity, radius, mass, force = discs.position, discs.velocity, discs.radius, discs.mass, discs.force
    angle, spin, inertia, torque = discs.angle, discs.spin, discs.inertia, discs.torque
    start, partner, carried = near.start, near.partner, near.carried
    list_position, limit, k, c = near.list_position, near.limit, law.k, law.c
    for step in range(count):
        force[:, :] = weight
        torque[:] = turning
        for i in range(radius.shape[0]):
            fx, fy, moment = 0.0, 0.0, 0.0
            for n in range(start[i], start[i + 1]):
                j = partner[n]
                dx, dy = position[j, 0] - position[i, 0], position[j, 1] - position[i, 1]
                square, reach = dx * dx + dy * dy, radius[i] + radius[j]
                if square >= reach * reach:
                    carried[n, 0] = 0.0
                    continue
                distance = np.sqrt(square)
                nx, ny = dx / distance, dy / distance
                arm = 0.5 * (distance + (radius[i] - radius[j]) * reach / distance)
                du, dv = velocity[i, 0] - velocity[j, 0], velocity[i, 1] - velocity[j, 1]
                slip = dv * nx - du * ny + spin[i] * arm + spin[j] * (distance - arm)
                push = max(k * (reach - distance) + c * (du * nx + dv * ny), 0.0)
                along, carried[n, 0] = rub(push, slip, carried[n, 0], dt, law)
                gx, gy = -push * nx - along * ny, -push * ny + along * nx
                fx += gx
                fy += gy
                moment += along * arm
                force[j, 0] -= gx
                force[j, 1] -= gy
                torque[j] += along * (distance - arm)
            force[i, 0] += fx
            force[i, 1] += fy
            torque[i] += moment
        for w in range(walls.shape[0]):
            px, py, nx, ny = walls[w, 0], walls[w, 1], -walls[w, 2], -walls[w, 3]
            for i in range(radius.shape[0]):
                distance = (px - position[i, 0]) * nx + (py - position[i, 1]) * ny
                if distance >= radius[i]:
                    wall_spring[w, i, 0] = 0.0
                    continue
                slip = velocity[i, 1] * nx - velocity[i, 0] * ny + spin[i] * distance
                push = max(k * (radius[i] - distance) + c * (velocity[i, 0] * nx + velocity[i, 1] * ny), 0.0)
                along, wall_spring[w, i, 0] = rub(push, slip, wall_spring[w, i, 0], dt, law)
                force[i, 0] -= push * nx + along * ny
                force[i, 1] -= push * ny - along * nx
                torque[i] += along * distance
        left = False
        for i in range(radius.shape[0]):
            velocity[i, 0] += dt * force[i, 0] / mass[i]
            velocity[i, 1] += dt * force[i, 1] / mass[i]
            spin[i] += dt * torque[i] / inertia[i]
            position[i, 0] += dt * velocity[i, 0]
            position[i, 1] += dt * velocity[i, 1]
            angle[i] += dt * spin[i]
            dx, dy = position[i, 0] - list_position[i, 0], position[i, 1] - list_position[i, 1]
            if not dx * dx + dy * dy <= limit:
                left = True
        if left:
            return step + 1
    return count


class PlainDiscs:
    """The discs of ``grains`` under ``weight`` (n, 2) N/m in steps of ``dt`` (s), by the smallest kernel for their law.

    They go on from where they are now, with a list of their own; ``grains`` stays as it is.  discs: as Discs.state;
    turning (n,) N m/m: from outside, where there is friction; both loads may be overwritten between steps.
    """

    def __init__(self, grains: Grains, weight: Floats, dt: float) -> None:
        assert isinstance(grains.law, Linear)
        assert grains.material is None
        self.discs, self.weight, self._dt, self._walls = grains.discs.state(), weight, dt, grains.walls.copy()
        self.turning = np.zeros(grains.discs.count)
        self._law = Springs(*(float(value) for value in grains.contact.table[0, 0, :5]))
        self._state = State(*(self.discs[name] for name in State._fields))
        own, box = grains.current_pairs(), grains.box
        self.pairs = PairList(grains.discs.count, own.skin, box.lower, box.upper, carried=1)
        self.pairs.restore(own.state())
        self._spring, self._limit = grains.wall_spring.copy(), (0.5 * own.skin) ** 2

    def advance(self, count: int) -> None:
        """Advance the discs by ``count`` contact steps."""
        while count > 0:
            count -= self._some(count)
            if count > 0:
                self.pairs.build(self.discs["position"], self.discs["radius"])

    def _some(self, count: int) -> int:
        """Steps until the list must be made anew, ``count`` at most."""
        near = Near(self.pairs.start, self.pairs.partner, self.pairs.carried, self.pairs.list_position, self._limit)
        if self._law.mu > 0.0:
            return int(rough_steps(
                count, self._dt, self._law, self._state, self.weight, self.turning, near, self._walls, self._spring
            ))  # fmt: skip
        return int(smooth_steps(count, self._dt, self._law, self._state, self.weight, near, self._walls))
