"""Walls: the straight sides of the domain, and plates, which are upright line segments that can move.

A wall is a point and a normal that points into the domain; behind it is solid without end.  A plate has no
thickness and takes contacts on both sides and at its ends, by its closest point.  Both use the contact law
of pairs: the limit r_j -> infinity of the pair's lever arm is the distance to the wall, that of the reduced radius r_i.
Every disc keeps its springs per wall and per plate, zero while they do not touch.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from porescale.common.compiled.jit import inline, kernel
from porescale.common.core.errors import Fault, InputError
from porescale.dem.contact.law import (
    SURFACES,
    booked,
    contact,
    holds,
    material_of,
    moments,
    note_contact,
    note_parting,
    note_work,
    push,
    recall,
    remember,
)

Array = NDArray[np.float64]

SIDES = ("left", "right", "bottom", "top")
KINDS = ("solid", "periodic", "open")
PX, PY, NX, NY, VX, VY, TURN = range(7)
"""Columns of the wall table: a point (m) and the unit normal; velocity of that point (m/s) and rotation about it
(rad/s), as the contacts feel it.
"""
WALL = 7
X, LOW, HIGH, VELOCITY, PRESENT = range(5)
"""Columns of the plate table: x, lower and upper end (m), upward velocity (m/s), 1 while it is there."""
RUN = 16
"""Discs that are asked together whether any is near a wall: in a pile settled from left to right 3 % of runs touch a
side and 26 % the floor; 14 % with runs of 8, but twice as many flags to read."""


@inline
def runs_of(count):
    """Runs of so many discs."""
    return (count + RUN - 1) // RUN


@dataclass(frozen=True)
class Box:
    """The domain: corners in m, and what each side is: "solid", "periodic" (opposite sides both) or
    "open".
    """

    lower: tuple[float, float]
    upper: tuple[float, float]
    left: str = "solid"
    right: str = "solid"
    bottom: str = "solid"
    top: str = "solid"

    def __post_init__(self) -> None:
        faults = [
            Fault(f"box.{side}", getattr(self, side), "unknown kind of side", allowed=" or ".join(KINDS))
            for side in SIDES
            if getattr(self, side) not in KINDS
        ]
        for one, other in (("left", "right"), ("bottom", "top")):
            if (getattr(self, one) == "periodic") != (getattr(self, other) == "periodic"):
                faults.append(
                    Fault(f"box.{one}", getattr(self, one), f"the {other} side is {getattr(self, other)}",
                          repair="make both sides periodic, or neither")
                )  # fmt: skip
        if not (self.lower[0] < self.upper[0] and self.lower[1] < self.upper[1]):
            faults.append(
                Fault("box.upper", self.upper, "must lie right of and above box.lower", "m", f"> {self.lower}")
            )
        if faults:
            raise InputError(faults)

    @property
    def periodic(self) -> tuple[bool, bool]:
        """Whether x and y are periodic."""
        return self.left == "periodic", self.bottom == "periodic"

    @property
    def period(self) -> tuple[float, float]:
        """Length of the period along x and y, m; 0 where not periodic."""
        return (
            self.upper[0] - self.lower[0] if self.periodic[0] else 0.0,
            self.upper[1] - self.lower[1] if self.periodic[1] else 0.0,
        )

    def walls(self) -> tuple[list[str], Array]:
        """Names of the solid sides and their wall table (w, WALL), in the order of SIDES; they stand still."""
        table = {
            "left": (*self.lower, 1.0, 0.0),
            "right": (*self.upper, -1.0, 0.0),
            "bottom": (*self.lower, 0.0, 1.0),
            "top": (*self.upper, 0.0, -1.0),
        }
        names = [side for side in SIDES if getattr(self, side) == "solid"]
        return names, np.array([(*table[name], 0.0, 0.0, 0.0) for name in names]).reshape(-1, WALL)


@dataclass(frozen=True)
class Plate:
    """An upright plate without thickness: x, ends (m), upward velocity (m/s), friction (None: that of the
    walls).
    """

    x: float
    y_low: float
    y_high: float
    velocity: float = 0.0
    friction: float | None = None
    name: str = "plate"

    def __post_init__(self) -> None:
        numbers = (self.x, self.y_low, self.y_high, self.velocity)
        if not all(math.isfinite(value) for value in numbers) or self.y_low >= self.y_high:
            raise InputError(Fault(f"{self.name}.y_high", self.y_high, "must lie above y_low", "m", f"> {self.y_low}"))
        if self.friction is not None and not self.friction >= 0.0:
            raise InputError(Fault(f"{self.name}.friction", self.friction, allowed=">= 0"))

    def row(self) -> Array:
        """The plate as kernels read it, (5,): columns X, LOW, HIGH, VELOCITY, PRESENT."""
        return np.array([self.x, self.y_low, self.y_high, self.velocity, 1.0])


@inline
def surface_contact(i, nx, ny, distance, radius, vx, vy, spin, turn, memory, dt, laws, law):
    """Disc i against a surface: (force x, force y N/m, torque N m/m) on the disc, and what resists rolling turns the
    surface with (N m/m), about the point of contact.

    (nx, ny) unit vector from the disc to the surface;  distance centre to surface (m) < radius, the lever arm;
    (vx, vy) velocity relative to the surface (m/s);  spin and that of the surface, turn (rad/s);  dt (s);  laws (m,
    COLUMNS) of the surface with each material;  law see contact/law.py.  Overwrites row i of memory (n, 1 or 2),
    springs in m.
    """
    overlap, arm = radius - distance, max(distance, 0.0)
    closing = vx * nx + vy * ny
    slip = vy * nx - vx * ny + spin * arm
    turning = (spin - turn) * radius
    p, mass = laws[material_of(law.material, i)], law.mass[i]
    before, roll_before = recall(memory, i, law)
    normal, tangential, resisting, spring, roll = contact(
        overlap, closing, slip, turning, before, roll_before, radius, mass, dt, p, law
    )
    remember(memory, i, spring, roll, law)
    note_contact(
        i, overlap, closing, slip, turning, before, roll_before, normal, tangential, resisting, spring, roll,
        radius, mass, dt, p, law.book, law,
    )  # fmt: skip
    moment, other = moments(tangential, resisting, arm, 0.0, radius, law)
    fx, fy = push(normal, tangential, nx, ny, law)
    return fx, fy, moment, other


@kernel
def note_leaving(i, dx, dy, radius, vx, vy, spin, turn, memory, dt, laws, book, law):
    """Enter into ``book``, if any, what the springs of disc i still held when it left a surface.

    (dx, dy) m from its centre to the nearest point of the surface; the rest as in surface_contact.  A function of its
    own, and called seldom: merged into the loops over all discs it makes them count references at every disc.
    """
    before, roll_before = recall(memory, i, law)
    distance = np.sqrt(dx * dx + dy * dy)
    nx, ny = dx / distance, dy / distance
    note_parting(
        i, radius - distance, vx * nx + vy * ny, vy * nx - vx * ny + spin * distance, (spin - turn) * radius,
        before, roll_before, radius, dt, laws[material_of(law.material, i)], book, law,
    )  # fmt: skip


@kernel
def add_wall_forces(
    position, velocity, spin, radius, force, torque, walls, laws, spring, wall_force, law, dt
):  # fmt: skip
    """Add the contacts of all discs with all walls; reset the springs of those that do not touch.

    position, velocity (n, 2) m, m/s;  spin, radius (n,) rad/s, m;  walls (w, WALL);  laws (w, m, COLUMNS) with each
    material;  law see contact/law.py;  dt s.  Adds to force (n, 2) N/m and torque (n,) N m/m; overwrites spring
    (w, n, 1 or 2) m and wall_force (w, 2 or 3) N/m, N m/m, the force of the discs on each wall, summed in the order of
    discs, and its moment about the wall's point.
    """
    near = np.ones((walls.shape[0], runs_of(radius.shape[0])), np.uint8)
    add_near_walls(position, velocity, spin, radius, force, torque, walls, laws, spring, wall_force, near, law, dt)


@kernel
def add_near_walls(
    position, velocity, spin, radius, force, torque, walls, laws, spring, wall_force, near, law, dt
):  # fmt: skip
    """As add_wall_forces, for discs of runs that are near a wall; near (w or more, runs): see ask_near.

    Discs of other runs must touch nothing and have springs at rest.
    """
    for w in range(walls.shape[0]):
        px, py, nx, ny = walls[w, PX], walls[w, PY], walls[w, NX], walls[w, NY]
        wall_x, wall_y, turn = walls[w, VX], walls[w, VY], walls[w, TURN]
        memory, own, book = spring[w], laws[w], law.book
        sum_x, sum_y, moments_sum = 0.0, 0.0, 0.0
        for run in range(near.shape[1]):
            if not near[w, run]:
                continue
            for i in range(run * RUN, min((run + 1) * RUN, radius.shape[0])):
                distance = (position[i, 0] - px) * nx + (position[i, 1] - py) * ny
                if radius[i] - distance > 0.0:
                    along = (position[i, 1] - py) * nx - (position[i, 0] - px) * ny
                    at_x, at_y = wall_x - turn * along * nx, wall_y - turn * along * ny
                    fx, fy, moment, other = surface_contact(
                        i, -nx, -ny, distance, radius[i], velocity[i, 0] - at_x, velocity[i, 1] - at_y, spin[i], turn,
                        memory, dt, own, law,
                    )  # fmt: skip
                    force[i, 0] += fx
                    force[i, 1] += fy
                    torque[i] += moment
                    sum_x -= fx
                    sum_y -= fy
                    moments_sum += along * (ny * fy + nx * fx) + other
                    note_work(book, i, SURFACES, fx * at_x + fy * at_y - other * turn, dt)
                else:
                    if booked(book) and holds(memory, i, law):
                        along = (position[i, 1] - py) * nx - (position[i, 0] - px) * ny
                        note_leaving(
                            i, -distance * nx, -distance * ny, radius[i], velocity[i, 0] - wall_x + turn * along * nx,
                            velocity[i, 1] - wall_y + turn * along * ny, spin[i], turn, memory, dt, own, book, law,
                        )  # fmt: skip
                    remember(memory, i, 0.0, 0.0, law)
        wall_force[w, 0] = sum_x
        wall_force[w, 1] = sum_y
        if wall_force.shape[1] > 2:
            wall_force[w, 2] = moments_sum


@kernel
def ask_near(position, radius, walls, way, near):
    """Overwrite near (w or more, runs): whether a disc of each RUN discs is within ``way`` (m) of touching each wall.

    position (n, 2) m;  radius (n,) m;  walls (w, WALL).  A disc that is no number anywhere counts as near.
    """
    for w in range(walls.shape[0]):
        px, py, nx, ny = walls[w, PX], walls[w, PY], walls[w, NX], walls[w, NY]
        for run in range(near.shape[1]):
            found = False
            for i in range(run * RUN, min((run + 1) * RUN, radius.shape[0])):
                if not (position[i, 0] - px) * nx + (position[i, 1] - py) * ny > radius[i] + way:
                    found = True
                    break
            near[w, run] = found


@kernel
def add_plate_forces(
    position, velocity, spin, radius, force, torque, plates, laws, spring, plate_force, law, dt
):  # fmt: skip
    """Add the contacts of all discs with all plates that are present; reset the springs of those that do
    not touch.

    plates (p, 5);  laws (p, m, COLUMNS);  spring (p, n, 1 or 2) m;  plate_force (p, 2) N/m, force of the discs on each
    plate.  The rest as in add_wall_forces.
    """
    for w in range(plates.shape[0]):
        sum_x, sum_y = 0.0, 0.0
        if plates[w, PRESENT] != 0.0:
            x, low, high, rise = plates[w, X], plates[w, LOW], plates[w, HIGH], plates[w, VELOCITY]
            memory, own, book = spring[w], laws[w], law.book
            for i in range(radius.shape[0]):
                dx = x - position[i, 0]
                dy = min(max(position[i, 1], low), high) - position[i, 1]
                square = dx * dx + dy * dy
                if square < radius[i] * radius[i]:
                    distance = np.sqrt(square)
                    fx, fy, moment, _ = surface_contact(
                        i, dx / distance, dy / distance, distance, radius[i],
                        velocity[i, 0], velocity[i, 1] - rise, spin[i], 0.0, memory, dt, own, law,
                    )  # fmt: skip
                    force[i, 0] += fx
                    force[i, 1] += fy
                    torque[i] += moment
                    sum_x -= fx
                    sum_y -= fy
                    note_work(book, i, SURFACES, fy * rise, dt)
                else:
                    if booked(book) and holds(memory, i, law):
                        note_leaving(
                            i, dx, dy, radius[i], velocity[i, 0], velocity[i, 1] - rise, spin[i], 0.0, memory, dt, own,
                            book, law,
                        )  # fmt: skip
                    remember(memory, i, 0.0, 0.0, law)
        plate_force[w, 0] = sum_x
        plate_force[w, 1] = sum_y


@inline
def move_plates(plates, dt):
    """Raise every present plate (p, 5) by its velocity over ``dt`` (s); overwrites LOW and HIGH."""
    for w in range(plates.shape[0]):
        rise = plates[w, VELOCITY] * plates[w, PRESENT] * dt
        plates[w, LOW] += rise
        plates[w, HIGH] += rise
