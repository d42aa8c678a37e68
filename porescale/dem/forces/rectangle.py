"""Rectangles with a prescribed velocity: gates of finite thickness, pistons, steps.  A plate is one without thickness.

A disc touches a rectangle at its closest point, on a face or a corner, by the contact law of walls; a centre that got
inside (which a stiff law never lets happen) is pushed out through the nearest face.  Every disc keeps its springs per
rectangle, zero while they do not touch.
"""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from porescale.common.compiled.jit import inline, kernel
from porescale.common.core.errors import Fault, InputError
from porescale.dem.contact.budget import SURFACES, add_work, has_budget
from porescale.dem.contact.law import has_history, store_history
from porescale.dem.forces.walls import HIGH, LOW, PRESENT, VELOCITY, X, add_leaving_losses, surface_contact

LEFT, BOTTOM, RIGHT, TOP, VELOCITY_X, VELOCITY_Y = range(6)
"""Columns of the rectangle table: faces (m) and velocity (m/s)."""


@dataclass(frozen=True)
class Rectangle:
    """Corners (m), velocity (m/s), friction (None: that of the walls)."""

    lower: tuple[float, float]
    upper: tuple[float, float]
    velocity: tuple[float, float] = (0.0, 0.0)
    friction: float | None = None
    name: str = "rectangle"

    def __post_init__(self) -> None:
        numbers = (*self.lower, *self.upper, *self.velocity)
        if not all(math.isfinite(value) for value in numbers) or not (
            self.lower[0] < self.upper[0] and self.lower[1] < self.upper[1]
        ):
            problem = "must lie right of and above the lower corner"
            raise InputError(Fault(f"{self.name}.upper", str(self.upper), problem, "m", f"> {self.lower}"))
        if self.friction is not None and not self.friction >= 0.0:
            raise InputError(Fault(f"{self.name}.friction", self.friction, allowed=">= 0"))

    def row(self) -> NDArray[np.float64]:
        """The rectangle as kernels read it, (6,)."""
        return np.array([*self.lower, *self.upper, *self.velocity], float)


@inline
def nearest_face(x, y, left, bottom, right, top):
    """Unit vector from a centre (x, y) inside to the face nearest to it, turned inwards, and the depth below it: a disc
    there touches a surface behind it."""
    depth, nx, ny = x - left, 1.0, 0.0
    if right - x < depth:
        depth, nx = right - x, -1.0
    if y - bottom < depth:
        depth, nx, ny = y - bottom, 0.0, 1.0
    if top - y < depth:
        depth, nx, ny = top - y, 0.0, -1.0
    return nx, ny, depth


@inline
def edges(table, w):
    """Row ``w`` of a table of rectangles or of plates: left, bottom, right and top (m), velocity (m/s), whether it is
    there."""
    if table.shape[1] > PRESENT + 1:
        at, to = (table[w, LEFT], table[w, BOTTOM]), (table[w, RIGHT], table[w, TOP])
        return at[0], at[1], to[0], to[1], table[w, VELOCITY_X], table[w, VELOCITY_Y], True
    x = table[w, X]
    return x, table[w, LOW], x, table[w, HIGH], 0.0, table[w, VELOCITY], table[w, PRESENT] != 0.0


@kernel
def add_rectangle_forces(d, table, laws, spring, load, row, first, last, law, dt):
    """Add the contacts of discs first to last with all rectangles, or with all plates that are present; reset the
    springs of those that do not touch.

    table (k, 6) of rectangles or (k, 5) of plates: one kernel is compiled once for both;  overwrites rows of load (k or
    more, 2 or 3) N/m from ``row`` on.  The rest as in walls.py.
    """
    for w in range(table.shape[0]):
        left, bottom, right, top, across, up, present = edges(table, w)
        memory, own = spring[w], laws[w]
        sum_x, sum_y = 0.0, 0.0
        for i in range(first, last if present else first):
            x, y = d.position[i, 0], d.position[i, 1]
            dx = min(max(x, left), right) - x
            dy = min(max(y, bottom), top) - y
            square = dx * dx + dy * dy
            if square < d.radius[i] * d.radius[i]:
                if square > 0.0:
                    distance = np.sqrt(square)
                    nx, ny = dx / distance, dy / distance
                else:
                    nx, ny, depth = nearest_face(x, y, left, bottom, right, top)
                    distance = -depth
                fx, fy, moment, _ = surface_contact(i, nx, ny, distance, across, up, 0.0, d, memory, dt, own, law)
                d.force[i, 0] += fx
                d.force[i, 1] += fy
                d.torque[i] += moment
                sum_x -= fx
                sum_y -= fy
                add_work(d.budget, i, SURFACES, fx * across + fy * up, dt)
            else:
                if has_budget(d.budget) and has_history(memory, i, law):
                    vx, vy = d.velocity[i, 0] - across, d.velocity[i, 1] - up
                    add_leaving_losses(i, dx, dy, vx, vy, 0.0, d, memory, dt, own, law)
                store_history(memory, i, 0.0, 0.0, law)
        load[row + w, 0] = sum_x
        load[row + w, 1] = sum_y


@inline
def move_rectangles(rectangles, dt):
    """Move every rectangle (m, 6) by its velocity over ``dt`` (s); overwrites the faces."""
    for w in range(rectangles.shape[0]):
        for a in range(2):
            by = rectangles[w, VELOCITY_X + a] * dt
            rectangles[w, LEFT + a] += by
            rectangles[w, RIGHT + a] += by
