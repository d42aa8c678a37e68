"""Rigid clumps, slow and obvious: forces of pairs of discs by tests/reference/dem/dem.py, summed about the centroid.

Members of a clump are not kept apart there: what they do to each other cancels in the sums.  Also the union of discs by
lines across it, and pairs in a tilted cell by every image.
"""

import math
from dataclasses import dataclass

import numpy as np

from tests.reference.dem.dem import World


@dataclass
class Rigid:
    """A clump of bodies of a World, by their numbers; mass, centroid and inertia as given."""

    members: list[int]
    m: float
    inertia: float
    x: float
    y: float
    u: float = 0.0
    v: float = 0.0
    w: float = 0.0


def step(world: World, clumps: list[Rigid], dt: float) -> None:
    """Force, kick, drift of free discs and clumps."""
    load = world.forces(dt)
    free = set(range(len(world.bodies))) - {i for clump in clumps for i in clump.members}
    for i in free:
        a = world.bodies[i]
        a.u, a.v, a.w = a.u + dt * load[i][0] / a.m, a.v + dt * load[i][1] / a.m, a.w + dt * load[i][2] / a.inertia
        a.x, a.y, a.angle = a.x + dt * a.u, a.y + dt * a.v, a.angle + dt * a.w
    for c in clumps:
        fx = sum(load[i][0] for i in c.members)
        fy = sum(load[i][1] for i in c.members)
        moment = sum(
            load[i][2] + (world.bodies[i].x - c.x) * load[i][1] - (world.bodies[i].y - c.y) * load[i][0]
            for i in c.members
        )
        c.u, c.v, c.w = c.u + dt * fx / c.m, c.v + dt * fy / c.m, c.w + dt * moment / c.inertia
        turn = dt * c.w
        for i in c.members:
            a = world.bodies[i]
            ox, oy = a.x - c.x, a.y - c.y
            ox, oy = math.cos(turn) * ox - math.sin(turn) * oy, math.sin(turn) * ox + math.cos(turn) * oy
            a.x, a.y = c.x + dt * c.u + ox, c.y + dt * c.v + oy
            a.u, a.v, a.w, a.angle = c.u - c.w * oy, c.v + c.w * ox, c.w, a.angle + turn
        c.x, c.y = c.x + dt * c.u, c.y + dt * c.v


def union_by_lines(position, radius, lines=20001):
    """Area, centroid, polar second moment of a union of discs from intervals on lines of equal y (midpoint rule)."""
    low, high = (position[:, 1] - radius).min(), (position[:, 1] + radius).max()
    step = (high - low) / lines
    area, mx, my, second = 0.0, 0.0, 0.0, 0.0
    for y in low + step * (np.arange(lines) + 0.5):
        half = radius**2 - (position[:, 1] - y) ** 2
        cut = np.sqrt(half[half > 0])
        parts = sorted(zip(position[half > 0, 0] - cut, position[half > 0, 0] + cut, strict=True))
        reached = -np.inf
        for a, b in parts:
            a = max(a, reached)
            if b > a:
                area += step * (b - a)
                mx += step * (b**2 - a**2) / 2
                my += step * (b - a) * y
                second += step * ((b**3 - a**3) / 3 + (b - a) * y**2)
                reached = b
    cx, cy = mx / area, my / area
    return area, np.array([cx, cy]), second - area * (cx**2 + cy**2)


def tilted_neighbours(x, reach, skin, width, height, tilt, turns=3):
    """Half rows of partners in a cell with edges (width, 0) and (tilt, height): the nearest of many images."""
    rows = []
    for i in range(len(x)):
        row = []
        for j in range(i + 1, len(x)):
            nearest = min(
                math.hypot(x[j, 0] - x[i, 0] + a * width + b * tilt, x[j, 1] - x[i, 1] + b * height)
                for b in range(-turns, turns + 1)
                for a in range(-turns - 4, turns + 5)
            )
            if nearest < reach[i] + reach[j] + skin:
                row.append(j)
        rows.append(row)
    return rows
