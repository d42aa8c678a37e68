"""Slow flow of discs in a box or a round vessel at rest: point forces inside the discs and behind the wall.

The free-space point force (times 1/(4 pi mu)), S_ij = -ln r delta_ij + x_i x_j/r^2, on a ring inside every disc and on
the wall moved outwards; velocities are met at twice as many points of discs and wall by least squares.  Forces and
torques are sums over the rings.  The slip left between those points measures the error.
"""

from dataclasses import dataclass

import numpy as np

from tests.reference.coupling.stokes_array import rings


def point_forces(at, sources):
    """4 pi mu velocity (2 n_at) per force (2 n_sources)."""
    x, y = np.moveaxis(at[:, None] - sources, -1, 0)
    r2 = x * x + y * y
    log = -0.5 * np.log(r2)
    return np.block([[log + x * x / r2, x * y / r2], [x * y / r2, log + y * y / r2]])


@dataclass(frozen=True)
class Vessel:
    """Round wall of radius `radius` around 0; forces on a circle wider by `behind` radii."""

    radius: float
    behind: float = 0.3

    def points(self, count, moved):
        """`count` points on the wall, or on the wall moved outwards."""
        angle = 2 * np.pi * (np.arange(count) + 0.5) / count
        return self.radius * (1 + self.behind * moved) * np.stack([np.cos(angle), np.sin(angle)], -1)


@dataclass(frozen=True)
class Box:
    """Walls |x| = half_length and |y| = half_height; forces `behind` half heights outside."""

    half_length: float
    half_height: float
    behind: float = 0.3

    def points(self, count, moved):
        """About `count` points, spaced evenly round the box and clear of its corners."""
        a, b = (half + self.behind * self.half_height * moved for half in (self.half_length, self.half_height))
        along, across = (max(2, round(count * side / (2 * (a + b)))) for side in (a, b))
        x = a * (2 * (np.arange(along) + 0.5) / along - 1)
        y = b * (2 * (np.arange(across) + 0.5) / across - 1)
        sides = [(x, np.full(along, -b)), (x, np.full(along, b)), (np.full(across, -a), y), (np.full(across, a), y)]
        return np.concatenate([np.stack(side, -1) for side in sides])


@dataclass(frozen=True)
class Enclosed:
    """Discs (centres (n, 2), radii (n,)) in a wall; forces: on every disc;  wall_forces: behind the wall."""

    wall: Vessel | Box
    centres: np.ndarray
    radii: np.ndarray
    forces: int = 80
    wall_forces: int = 160
    inner: float = 0.7

    def loads(self, velocity, spin):
        """Force (n, 2), torque (n,) per mu on discs with velocity (n, 2) and spin (n,), and the slip left."""
        return self.several([(velocity, spin)])[0]

    def several(self, motions):
        """`loads` of each of some motions (velocity, spin), all from one solution of the equations."""
        n = len(self.radii)
        inside, lever = rings(self.centres, self.radii, self.inner, self.forces)
        sources = np.concatenate([inside, self.wall.points(self.wall_forces, True)])
        lever = lever.reshape(n, self.forces, 2)

        def equations(times):
            disc, arm = rings(self.centres, self.radii, 1.0, times * self.forces)
            wall = self.wall.points(times * self.wall_forces, False)
            speeds = []
            for velocity, spin in motions:
                turn = np.repeat(np.asarray(spin, float), times * self.forces)[:, None] * arm
                speed = np.repeat(np.asarray(velocity, float), times * self.forces, 0)
                speed = np.concatenate([speed + np.stack([-turn[:, 1], turn[:, 0]], -1), np.zeros_like(wall)])
                speeds.append(speed.T.ravel())
            return point_forces(np.concatenate([disc, wall]), sources) / (4 * np.pi), np.stack(speeds, 1)

        matrix, speeds = equations(2)
        pushes = np.linalg.lstsq(matrix, speeds, rcond=1e-15)[0]
        matrix, speeds = equations(3)
        slips = np.abs(matrix @ pushes - speeds).max(0)
        found = []
        for push, slip in zip(pushes.T, slips, strict=True):
            push = push.reshape(2, -1)[:, : n * self.forces].reshape(2, n, self.forces)
            torque = (lever[..., 0] * push[1] - lever[..., 1] * push[0]).sum(-1)
            found.append((-push.sum(-1).T, -torque, slip))
        return found
