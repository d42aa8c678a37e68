"""Partially saturated cells, slow and obvious, on the two-array lattice of tests/reference/lbm/lbm.py.

Dense coverage of every disc from the area a circle has in common with a square.  Solid operators "odd-SC1" and "SC1"
with weight B2, from Noble & Torczynski 1998: collision  f + (1 - B)(Omega^f + S) + B Omega^s;  loads
-sum B_n sum_i Omega^s_n c_i.  "exact-wall" with its own weight, radius and half-step correction, from the docstrings of
porescale/coupling/solid/exact_wall.py and psm.py.
The switches are the wrong ways that the tests must be able to tell from the right one.
"""

import itertools
import math
from dataclasses import dataclass

import numpy as np

from tests.reference.coupling import solid_operators as solid
from tests.reference.lbm.lbm import BACK, C, Lattice, W, equilibrium, guo, trt


def _under_edge(px, py, qx, qy, r):
    """Signed area that the triangle (0, p, q) has in common with the disc of radius r around 0."""
    dx, dy = qx - px, qy - py
    a, b, c = dx * dx + dy * dy, px * dx + py * dy, px * px + py * py - r * r
    cuts = [0.0, 1.0]
    if b * b > a * c:
        root = math.sqrt(b * b - a * c)
        cuts += [t for t in ((-b - root) / a, (-b + root) / a) if 0 < t < 1]
    cuts.sort()
    area = 0.0
    for s, t in itertools.pairwise(cuts):
        ax, ay, bx, by = px + s * dx, py + s * dy, px + t * dx, py + t * dy
        mx, my = (ax + bx) / 2, (ay + by) / 2
        cross = ax * by - ay * bx
        if mx * mx + my * my <= r * r:
            area += cross / 2
        else:
            area += r * r * math.atan2(cross, ax * bx + ay * by) / 2
    return area


def overlap(x, y, cx, cy, r):
    """Area of the unit square with lower left corner (x, y) inside the disc around (cx, cy)."""
    corner = [(x - cx, y - cy), (x + 1 - cx, y - cy), (x + 1 - cx, y + 1 - cy), (x - cx, y + 1 - cy)]
    return sum(_under_edge(*corner[k], *corner[(k + 1) % 4], r) for k in range(4))


def coverage(cx, cy, r, nx, ny, periodic=(False, False)):
    """Solid fraction of every cell, (ny, nx), and the vector from (cx, cy) to the centres of those it may cover."""
    e, rx, ry = np.zeros((3, ny, nx))
    for y in range(math.floor(cy - r), math.ceil(cy + r)):
        for x in range(math.floor(cx - r), math.ceil(cx + r)):
            at_x = x % nx if periodic[0] else x
            at_y = y % ny if periodic[1] else y
            if 0 <= at_x < nx and 0 <= at_y < ny:
                e[at_y, at_x] = max(0.0, overlap(x, y, cx, cy, r))
                rx[at_y, at_x], ry[at_y, at_x] = x + 0.5 - cx, y + 0.5 - cy
    return e, rx, ry


def weight(e, tau):
    """B2 of Noble & Torczynski 1998."""
    return e * (tau - 0.5) / ((1 - e) + (tau - 0.5))


@dataclass
class Disc:
    x: float
    y: float
    r: float
    u: float = 0.0
    v: float = 0.0
    w: float = 0.0


@dataclass
class SaturatedCells(Lattice):
    """The lattice with discs in it.

    forcing "inside" or "outside" of (1 - B);
    sharing "total": B(min(1, sum e)) in proportion to e;  "sum": the sum of every disc's own B(e);
    of the exact wall, low_pass: share of a step's load in the correction, 0 for none;  shift: of the radius, cells²;
    buoyant: whether the solid gets back the force on its part.
    """

    operator: str = "exact-wall"
    forcing: str = "inside"
    sharing: str = "total"
    low_pass: float = 0.1
    radius_shift: float = 0.28125
    buoyant: bool = True
    slow_load: np.ndarray | None = None
    correction: np.ndarray | None = None

    def split(self, discs):
        """Each disc's share of the weight (n, ny, nx) and its solid velocity at the cell centres."""
        periodic = self.side("left")[0] == "periodic", self.side("bottom")[0] == "periodic"
        parts = [coverage(d.x, d.y, d.r, self.nx, self.ny, periodic) for d in discs]
        e = np.array([part[0] for part in parts]).reshape(-1, self.ny, self.nx)
        if self.sharing == "sum":
            share = weight(e, self.tau)
        else:
            total = e.sum(0)
            share = weight(np.minimum(total, 1), self.tau) * e / np.where(total > 0, total, 1)
        speed = [(d.u - d.w * ry, d.v + d.w * rx) for d, (_, rx, ry) in zip(discs, parts, strict=True)]
        arm = [(rx, ry) for _, rx, ry in parts]
        return share, speed, arm

    def solid_operator(self, rho, ux, uy, sx, sy):
        """SC1 in every cell for a solid velocity s, or its odd half."""
        if self.operator == "SC1":
            return self.f[BACK] - self.f + equilibrium(rho, sx, sy) - equilibrium(rho, ux, uy)[BACK]
        out = [3 * w * rho * (cx * (sx + ux) + cy * (sy + uy)) for (cx, cy), w in zip(C, W, strict=True)]
        return self.f[BACK] - self.f + np.array(out)

    def step_with(self, discs):
        """One step; returns force (n, 2) and torque (n,) on the discs."""
        return self.exact_step(discs) if self.operator == "exact-wall" else self.printed_step(discs)

    def exact_step(self, discs):
        """One step with exact walls."""
        count, force = len(discs), np.array(self.force)
        if self.correction is None:
            self.slow_load, self.correction = np.zeros((count, 3)), np.zeros((count, 3))
        periodic = self.side("left")[0] == "periodic", self.side("bottom")[0] == "periodic"
        radius = [d.r + self.radius_shift / max(d.r, 1) for d in discs]
        parts = [coverage(d.x, d.y, r, self.nx, self.ny, periodic) for d, r in zip(discs, radius, strict=True)]
        e, arm = np.array([p[0] for p in parts]), np.array([p[1:] for p in parts])
        speed = [(d.u - d.w * ry, d.v + d.w * rx) for d, (rx, ry) in zip(discs, arm, strict=True)]
        extra = [(c[0] - c[2] * ry, c[1] + c[2] * rx) for c, (rx, ry) in zip(self.correction, arm, strict=True)]
        speed = np.array(speed) + e[:, None] * np.array(extra)
        total = e.sum(0)
        share = e / np.where(total > 0, total, 1)
        whole = np.minimum(total, 1)
        b = solid.wall_weight(whole, self.tau)
        rho, jx, jy = self.moments()
        j = np.array([jx, jy])
        hx, hy = force / 2
        ux, uy = (jx + hx) / rho, (jy + hy) / rho
        collided = trt(self.f, equilibrium(rho, ux, uy), self.even, self.odd)
        g = self.f + collided + guo(ux, uy, *force, self.even, self.odd)
        everywhere = force[:, None, None] * np.ones_like(rho)
        v = (share[:, None] * speed).sum(0)
        out = solid.exact_wall(self.f, g, rho, everywhere, v, whole, self.tau, self.odd)
        load = np.zeros((count, 3))
        for n in range(count):
            gain = share[n] * (b * (j + everywhere / 2 - rho * speed[n]) - self.buoyant * whole * everywhere)
            rx, ry = arm[n]
            load[n] = gain[0].sum(), gain[1].sum(), (rx * gain[1] - ry * gain[0]).sum()
            inside = share[n] * b * rho
            directly = np.append(-math.pi * radius[n] ** 2 * force, 0.0)
            self.slow_load[n] += self.low_pass * (load[n] - directly - self.slow_load[n])
            mass = inside.sum(), inside.sum(), (inside * (rx**2 + ry**2)).sum()
            self.correction[n] = -self.slow_load[n] / (2 * np.array(mass))
        self.stream(out)
        return load[:, :2], load[:, 2]

    def printed_step(self, discs):
        """One step with an operator of the literature."""
        share, speed, arm = self.split(discs)
        b = share.sum(0)
        rho, jx, jy = self.moments()
        fx, fy = self.force
        part = 1 - b if self.forcing == "inside" else 1.0
        ux, uy = (jx + part * fx / 2) / rho, (jy + part * fy / 2) / rho
        source = guo(ux, uy, fx, fy, self.even, self.odd)
        g = self.f + (1 - b) * trt(self.f, equilibrium(rho, ux, uy), self.even, self.odd) + part * source
        force, torque = np.zeros((len(discs), 2)), np.zeros(len(discs))
        cx, cy = np.array(C).T
        for n, ((sx, sy), (rx, ry)) in enumerate(zip(speed, arm, strict=True)):
            gain = share[n] * self.solid_operator(rho, ux, uy, sx, sy)
            g += gain
            px, py = -np.tensordot(cx, gain, 1), -np.tensordot(cy, gain, 1)
            force[n] = px.sum(), py.sum()
            torque[n] = (rx * py - ry * px).sum()
        self.stream(g)
        return force, torque
