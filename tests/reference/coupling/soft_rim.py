"""Soft rims, slow and obvious, from the docstring of porescale/coupling/coverage/soft_rim.py: cell by cell, no force.

Fractions of a disc lie in the whole periodic box, so that a filter is a mean of three, once along x and once along y.
"""

import math

import numpy as np

from tests.reference.coupling import solid_operators as solid
from tests.reference.coupling.psm import coverage
from tests.reference.lbm import lbm_operators
from tests.reference.lbm.lbm import Lattice

SLIP_FACTOR, SLIP_SHARE, LOW_PASS = 0.24, 0.02, 0.1


def blend(slip, radius, viscosity):
    """theta and theta2 of a disc."""
    q = (3.3 * slip * math.sqrt(2 * radius) / viscosity) ** (4 / 3)
    return q / (q + 4), q / (q + 36)


def covering(radius, theta, theta2, shift):
    """Radius of coverage, cells."""
    return radius - math.sqrt(radius) * (0.49 * theta + 0.25 * theta2) + shift / radius * (1 - theta)


def smeared(e, s):
    """Fractions (ny, nx) filtered by (s, 1 - 2 s, s) along x, then y."""
    for axis in (1, 0):
        out = np.zeros_like(e)
        for y, x in np.ndindex(e.shape):
            before, after = [y, x], [y, x]
            before[axis] -= 1
            after[axis] = (after[axis] + 1) % e.shape[axis]
            out[y, x] = s * (e[tuple(before)] + e[tuple(after)]) + (1 - 2 * s) * e[y, x]
        e = out
    return e


def cell(f, g, v, e, tau, third_order, theta):
    """One cell without force: populations after the step, (9,), weight b, and slip |v - u|; g: collided fluid."""
    rho, j = f.sum(), f @ solid.DIRECTIONS
    slip = math.hypot(*(v - j / rho))
    stiff = tau + SLIP_FACTOR * theta * slip
    b = solid.wall_weight(e, stiff)
    third, even_rate = (float(rate) for rate in solid.wall_rates(e, stiff, third_order))
    third += theta * ((1 - b) * third_order + 2 * b - third)
    even, _, rest = solid.halves(f)
    even_after, _, rest_after = solid.halves(g)
    after = j + b * (rho * v - j)
    carried = 3 * solid.WEIGHTS * (solid.DIRECTIONS @ after)
    # what the fluid operator adds to a plain rate, terms of third order in u, acts in the fluid's share
    rest = (1 - third) * rest + (1 - e) * (rest_after - (1 - third_order) * rest)
    return even + even_rate * tau * (even_after - even) + carried + rest, b, slip


class SoftBox:
    """Discs (psm.Disc) with soft rims in a periodic box of central moments.  slip (n,): low-passed, at their rims.

    wrong: what is left out, "filter", "radius", "stiffness" or "odd", to be told from the right one.
    """

    def __init__(self, nx, ny, tau, discs, slip, wrong=None):
        periodic = dict.fromkeys(("left", "right", "bottom", "top"), ("periodic", 0.0))
        self.lattice, self.tau, self.slip, self.wrong = Lattice(nx, ny, tau, sides=periodic), tau, list(slip), wrong
        self.slow, self.correction = np.zeros((2, len(discs), 3))

    def lay(self, disc, slip):
        """Fractions of a disc, the arms to its cells, and its theta."""
        nx, ny = self.lattice.nx, self.lattice.ny
        theta, theta2 = blend(slip, disc.r, (self.tau - 0.5) / 3)
        shift = 1.5 * (self.tau - 0.5) * 0.5  # third order of central moments: at rate 1
        radius = covering(disc.r, *((0.0, 0.0) if self.wrong == "radius" else (theta, theta2)), shift)
        e, _, _ = coverage(disc.x, disc.y, radius, nx, ny, (True, True))
        e[e < 1e-14] = 0.0  # round-off of areas, as in coverage.py: a trace of solid makes a cell stiff (k)
        if self.wrong != "filter":
            e = smeared(smeared(e, theta / 4), theta2 / 4)
        y, x = np.mgrid[:ny, :nx] + 0.5
        rx, ry = (x - disc.x + nx / 2) % nx - nx / 2, (y - disc.y + ny / 2) % ny - ny / 2
        return e, np.array([rx, ry]), theta

    def step(self, discs):
        """One step; returns force (n, 2) and torque (n,) on the discs."""
        f = self.lattice.f
        laid = [self.lay(disc, slip) for disc, slip in zip(discs, self.slip, strict=True)]
        g = lbm_operators.collided("central", f, self.tau, (0.0, 0.0), 3 / 16)
        after, load, inside = g.copy(), np.zeros((len(discs), 3)), np.zeros((len(discs), 3))
        rim = np.zeros((len(discs), 2))
        for at in np.ndindex(f.shape[1:]):
            here = (slice(None), *at)
            total = sum(e[at] for e, _, _ in laid)
            if total == 0:
                continue
            speeds = []
            for disc, (e, arm, _), (cx, cy, turn) in zip(discs, laid, self.correction, strict=True):
                rx, ry = arm[here]
                extra = e[at] * np.array([cx - turn * ry, cy + turn * rx])
                speeds.append(np.array([disc.u - disc.w * ry, disc.v + disc.w * rx]) + extra)
            v = sum(e[at] * speed for (e, _, _), speed in zip(laid, speeds, strict=True)) / total
            theta = sum(e[at] * theta for e, _, theta in laid) / total
            both = theta if self.wrong != "stiffness" else 0.0
            after[here], b, slip = cell(f[here], g[here], v, min(1.0, total), self.tau, 1.0, both)
            if self.wrong == "odd":
                after[here], _, _ = cell(f[here], g[here], v, min(1.0, total), self.tau, 0.9, both)
            rho, j = f[here].sum(), f[here] @ solid.DIRECTIONS
            for n, ((e, arm, _), speed) in enumerate(zip(laid, speeds, strict=True)):
                share = b * e[at] / total
                gain, (rx, ry) = share * (j - rho * speed), arm[here]
                load[n] += *gain, rx * gain[1] - ry * gain[0]
                inside[n] += share * rho, share * rho, share * rho * (rx * rx + ry * ry)
                rim[n] += e[at] * (1 - e[at]) * slip, e[at] * (1 - e[at])
        for n in range(len(discs)):
            self.slip[n] += SLIP_SHARE * (rim[n, 0] / rim[n, 1] - self.slip[n])
        self.slow += LOW_PASS * (load - self.slow)
        self.correction = -self.slow / (2 * inside)
        self.lattice.stream(after)
        return load[:, :2], load[:, 2]
