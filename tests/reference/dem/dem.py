"""Discs in contact, slow and obvious, written from Cundall & Strack 1979: every pair, every step, plain
Python.

One dictionary holds the springs.  ``arms="radius"`` uses the radii as lever arms, as many codes do: the
twin that must lose angular momentum.
"""

import math
from dataclasses import dataclass, field


@dataclass
class Body:
    x: float
    y: float
    r: float
    m: float
    u: float = 0.0
    v: float = 0.0
    w: float = 0.0
    angle: float = 0.0

    @property
    def inertia(self) -> float:
        return 0.5 * self.m * self.r**2


@dataclass
class World:
    bodies: list[Body]
    k: float
    c: float
    kt: float
    ct: float
    mu: float
    pulls: bool = False  # contact kept to zero overlap
    walls: list[tuple[float, float, float, float]] = field(default_factory=list)  # point, inward normal
    plates: list[list[float]] = field(default_factory=list)  # x, low, high, speed, friction
    arms: str = "lever"
    springs: dict[tuple[str, int, int], float] = field(default_factory=dict)

    def law(self, key: tuple[str, int, int], overlap: float, closing: float, slip: float, dt: float, mu: float):
        """Normal and tangential force of one contact with its spring."""
        normal = self.k * overlap + self.c * closing
        if not self.pulls and normal < 0:
            normal = 0.0
        limit = mu * normal if normal > 0 else 0.0
        spring = self.springs.get(key, 0.0) + slip * dt
        if self.kt * abs(spring) > limit:
            spring = math.copysign(limit / self.kt, spring) if self.kt > 0 else 0.0
        self.springs[key] = spring
        tangential = self.kt * spring + self.ct * slip
        if abs(tangential) > limit:
            tangential = math.copysign(limit, tangential)
        return normal, -tangential

    def forces(self, dt: float) -> list[list[float]]:
        """Force x, y and torque of each body."""
        load = [[0.0, 0.0, 0.0] for _ in self.bodies]
        touching = set()
        for i, a in enumerate(self.bodies):
            for j in range(i + 1, len(self.bodies)):
                b = self.bodies[j]
                d = math.hypot(b.x - a.x, b.y - a.y)
                if d >= a.r + b.r:
                    continue
                touching.add(("pair", i, j))
                nx, ny = (b.x - a.x) / d, (b.y - a.y) / d
                tx, ty = -ny, nx
                arm_a = (d**2 + a.r**2 - b.r**2) / (2 * d) if self.arms == "lever" else a.r
                arm_b = d - arm_a if self.arms == "lever" else b.r
                closing = (a.u - b.u) * nx + (a.v - b.v) * ny
                slip = (a.u - b.u) * tx + (a.v - b.v) * ty + a.w * arm_a + b.w * arm_b
                normal, friction = self.law(("pair", i, j), a.r + b.r - d, closing, slip, dt, self.mu)
                fx, fy = -normal * nx + friction * tx, -normal * ny + friction * ty
                for n, sign, arm in ((i, 1, arm_a), (j, -1, arm_b)):
                    load[n][0] += sign * fx
                    load[n][1] += sign * fy
                    load[n][2] += friction * arm
            for kind, n, px, py, rise, mu in self.surfaces(a):
                dx, dy = px - a.x, py - a.y
                d = math.hypot(dx, dy)
                if kind == "wall" and dx * self.walls[n][2] + dy * self.walls[n][3] > 0:
                    raise AssertionError("the twin knows no disc whose centre is behind a wall")
                if d >= a.r:
                    continue
                touching.add((kind, i, n))
                nx, ny = dx / d, dy / d
                closing = a.u * nx + (a.v - rise) * ny
                slip = a.u * -ny + (a.v - rise) * nx + a.w * d
                normal, friction = self.law((kind, i, n), a.r - d, closing, slip, dt, mu)
                load[i][0] += -normal * nx - friction * ny
                load[i][1] += -normal * ny + friction * nx
                load[i][2] += friction * d
        for key in list(self.springs):
            if key not in touching:
                del self.springs[key]
        return load

    def surfaces(self, a: Body):
        """The closest point of every wall and plate to the centre of a body."""
        for n, (px, py, nx, ny) in enumerate(self.walls):
            d = (a.x - px) * nx + (a.y - py) * ny
            yield "wall", n, a.x - d * nx, a.y - d * ny, 0.0, self.mu
        for n, (x, low, high, rise, mu) in enumerate(self.plates):
            yield "plate", n, x, min(max(a.y, low), high), rise, mu

    def step(self, dt: float, external: list[tuple[float, float, float]]) -> None:
        """Force, kick, drift."""
        for a, f, e in zip(self.bodies, self.forces(dt), external, strict=True):
            a.u += dt * (f[0] + e[0]) / a.m
            a.v += dt * (f[1] + e[1]) / a.m
            a.w += dt * (f[2] + e[2]) / a.inertia
            a.x += dt * a.u
            a.y += dt * a.v
            a.angle += dt * a.w
        for plate in self.plates:
            plate[1] += plate[3] * dt
            plate[2] += plate[3] * dt
