"""Slow flow past discs that repeat with a lattice: point forces inside every disc, no slip by least squares.

Cell: rows of period L along x, the next row H higher and shifted by `shift` (H = L: square; H = sqrt(3)/2 L with
shift L/2: hexagonal; several discs in a cell: any packing).  A row of unit point forces has a closed form, with
A = ln(2 cosh(2 pi y/L) - 2 cos(2 pi x/L))/2, the sum of ln r over the row (Pozrikidis 1992, ch. 3), times 1/(4 pi mu):
    S_xx = -A - y A_y,   S_xy = y A_x,   S_yy = -A + y A_y.
Of S_xx the mean over x, -2 pi |y|/L, adds up over all rows and the pressure gradient that holds them to the periodic
parabola -2 pi |y|/L + 2 pi y^2/(L H) + pi H/(3 L), |y| <= H/2; what is left of a row falls off as exp(-2 pi |y|/L).
Every such flow carries nothing through the cell, so the uniform flow U added to it *is* the superficial velocity.

Loads are those of the true pressure, its mean gradient G included: sum of all forces = G x cell area, and
K = mu U/G.  Where G is a body force on the fluid and pressure periodic, a disc bears its own area x G less.
The solution is exact but for the number of point forces: the error falls geometrically with it; the slip left between
the points where it was asked to vanish measures it.  Digits of the square array agree with table 1 of Sangani &
Acrivos 1982 but at fractions 0.3 (they print 102.90, here 102.8813) and 0.75 (1.263e5, here 1.2753e5), and the dilute
constants with Hasimoto 1959 and Drummond & Tahir 1984 to all of theirs.
"""

import math
from dataclasses import dataclass

import numpy as np


def periodic_point_forces(x, y, length, height, shift=0.0):
    """4 pi mu velocity at (x, y) from a unit force at 0 and its images: S_xx, S_xy, S_yy, shapes of x and y."""
    row = np.rint(y / height)
    x, y = x - row * shift, y - row * height
    xx = 2 * np.pi / length * (y * y / height - np.abs(y)) + np.pi * height / (3 * length)
    xy, yy = np.zeros_like(x), np.zeros_like(x)
    # |y| >= (rows - 1/2) height in the first row left out: exp(-37) = 1e-16
    rows = math.ceil(37 * length / (2 * np.pi * height) + 0.5)
    for m in range(-rows, rows + 1):
        away, angle = y - m * height, 2 * np.pi / length * (x - m * shift)
        e = np.exp(-2 * np.pi / length * np.abs(away))
        d = (1 - e) ** 2 + 4 * e * np.sin(angle / 2) ** 2  # 1 - 2 e cos + e^2 without cancelling
        log, slope = 0.5 * np.log(d), 2 * np.pi / length * e / d
        xx -= log + np.abs(away) * slope * (np.cos(angle) - e)
        yy -= log - np.abs(away) * slope * (np.cos(angle) - e)
        xy += away * slope * np.sin(angle)
    return xx, xy, yy


def rings(centres, radii, share, points):
    """Points of circles of `share` radii in every disc, (n * points, 2), and their arms from the centres."""
    angle = 2 * np.pi * (np.arange(points) + 0.5) / points
    arm = share * radii[:, None, None] * np.stack([np.cos(angle), np.sin(angle)], -1)
    return (centres[:, None] + arm).reshape(-1, 2), arm.reshape(-1, 2)


@dataclass(frozen=True)
class Array:
    """Discs in one cell: centres (n, 2), radii (n,).

    forces: point forces in a disc;  inner: the circle they sit on, in radii of the disc (outside the images of the
    neighbours: (d/2 - sqrt(d^2/4 - r^2))/r at centre distance d).
    """

    centres: np.ndarray
    radii: np.ndarray
    length: float = 1.0
    height: float = 1.0
    shift: float = 0.0
    forces: int = 80
    inner: float = 0.7

    @property
    def fraction(self):
        """Share of the cell that is solid."""
        return np.pi * (self.radii**2).sum() / (self.length * self.height)

    def influence(self, at, sources):
        """Velocity (2 n_at) per force (2 n_sources), mu = 1."""
        gap = at[:, None] - sources
        xx, xy, yy = periodic_point_forces(gap[..., 0], gap[..., 1], self.length, self.height, self.shift)
        return np.block([[xx, xy], [xy, yy]]) / (4 * np.pi)

    def loads(self, flow, velocity=None, spin=None):
        """Force (n, 2) and torque (n,) of the fluid on every disc, per mu, and the largest slip left over.

        flow: superficial velocity;  velocity (n, 2), spin (n,): of the discs, 0 unless given.
        """
        n = len(self.radii)
        velocity = np.zeros((n, 2)) if velocity is None else np.asarray(velocity, float)
        spin = np.zeros(n) if spin is None else np.asarray(spin, float)
        sources, lever = rings(self.centres, self.radii, self.inner, self.forces)

        def demanded(arm, points):
            turn = np.repeat(spin, points)
            moving = np.repeat(velocity, points, 0) + np.stack([-turn * arm[:, 1], turn * arm[:, 0]], -1)
            return (moving - flow).T.ravel()

        wall, arm = rings(self.centres, self.radii, 1.0, 2 * self.forces)
        push = np.linalg.lstsq(self.influence(wall, sources), demanded(arm, 2 * self.forces), rcond=1e-15)[0]
        # between the points that were asked
        other, arm = rings(self.centres, self.radii, 1.0, 3 * self.forces)
        slip = np.abs(self.influence(other, sources) @ push - demanded(arm, 3 * self.forces)).max()
        push = push.reshape(2, n, self.forces)
        lever = lever.reshape(n, self.forces, 2)
        torque = (lever[..., 0] * push[1] - lever[..., 1] * push[0]).sum(-1)
        return -push.sum(-1).T, -torque, slip

    def permeability(self):
        """Tensor (2, 2): superficial velocity per pressure gradient, mu = 1."""
        area = self.length * self.height
        gradient = np.stack([self.loads(np.eye(2)[k])[0].sum(0) / area for k in (0, 1)], 1)
        return np.linalg.inv(gradient)


def square(fraction, **options):
    """One disc in a unit square."""
    return Array(np.zeros((1, 2)), np.array([math.sqrt(fraction / np.pi)]), **options)


def hexagonal(fraction, **options):
    """One disc in the cell of a hexagonal lattice of unit distance."""
    height = math.sqrt(3) / 2
    radius = math.sqrt(fraction * height / np.pi)
    return Array(np.zeros((1, 2)), np.array([radius]), height=height, shift=0.5, **options)
