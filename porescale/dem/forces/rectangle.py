"""Rectangles that move as they are told: gates of finite thickness, pistons, steps.

A disc touches a rectangle at its closest point, on a face or a corner, by the contact law of walls; a centre that got
inside (which a stiff law never lets happen) is pushed out through the nearest face.  Every disc keeps its springs per
rectangle, zero while they do not touch.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from porescale.common.compiled.jit import inline, kernel
from porescale.common.core.errors import Fault, InputError
from porescale.dem.contact.law import SURFACES, booked, holds, note_work, remember
from porescale.dem.forces.walls import note_leaving, surface_contact

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


@kernel
def add_rectangle_forces(
    position, velocity, spin, radius, force, torque, rectangles, laws, spring, rectangle_force, law, dt
):  # fmt: skip
    """Add the contacts of all discs with all rectangles; reset the springs of those that do not touch.

    rectangles (k, 6);  laws (k, m, COLUMNS);  spring (k, n, 1 or 2) m;  rectangle_force (k, 2) N/m, force of the discs
    on each.  The rest as in walls.add_wall_forces.
    """
    for w in range(rectangles.shape[0]):
        left, bottom, right, top = (
            rectangles[w, LEFT],
            rectangles[w, BOTTOM],
            rectangles[w, RIGHT],
            rectangles[w, TOP],
        )
        memory, own, book = spring[w], laws[w], law.book
        sum_x, sum_y = 0.0, 0.0
        for i in range(radius.shape[0]):
            x, y = position[i, 0], position[i, 1]
            dx = min(max(x, left), right) - x
            dy = min(max(y, bottom), top) - y
            square = dx * dx + dy * dy
            if square < radius[i] * radius[i]:
                if square > 0.0:
                    distance = np.sqrt(square)
                    nx, ny = dx / distance, dy / distance
                else:
                    nx, ny, depth = nearest_face(x, y, left, bottom, right, top)
                    distance = -depth
                across, up = rectangles[w, VELOCITY_X], rectangles[w, VELOCITY_Y]
                fx, fy, moment, _ = surface_contact(
                    i, nx, ny, distance, radius[i], velocity[i, 0] - across, velocity[i, 1] - up, spin[i], 0.0, memory,
                    dt, own, law,
                )  # fmt: skip
                force[i, 0] += fx
                force[i, 1] += fy
                torque[i] += moment
                sum_x -= fx
                sum_y -= fy
                note_work(book, i, SURFACES, fx * across + fy * up, dt)
            else:
                if booked(book) and holds(memory, i, law):
                    note_leaving(
                        i, dx, dy, radius[i], velocity[i, 0] - rectangles[w, VELOCITY_X],
                        velocity[i, 1] - rectangles[w, VELOCITY_Y], spin[i], 0.0, memory, dt, own, book, law,
                    )  # fmt: skip
                remember(memory, i, 0.0, 0.0, law)
        rectangle_force[w, 0] = sum_x
        rectangle_force[w, 1] = sum_y


@inline
def move_rectangles(rectangles, dt):
    """Move every rectangle (m, 6) by its velocity over ``dt`` (s); overwrites the faces."""
    for w in range(rectangles.shape[0]):
        for a in range(2):
            by = rectangles[w, VELOCITY_X + a] * dt
            rectangles[w, LEFT + a] += by
            rectangles[w, RIGHT + a] += by
