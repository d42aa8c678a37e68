"""Walls: the straight sides of the domain, and plates, which are upright line segments that can move.

A wall is a point and a normal that points into the domain; behind it is solid without end.  A plate has no
thickness and takes contacts on both sides and at its ends, by its closest point: rectangle.py.  Both use the contact
law of pairs: the limit r_j -> infinity of the pair's lever arm is the distance to the wall, that of the reduced
radius r_i.
Every disc keeps its springs per wall and per plate, zero while they do not touch.
"""

import math
from dataclasses import dataclass

import numpy as np

from porescale.common.compiled.jit import inline, kernel
from porescale.common.core.errors import Fault, InputError
from porescale.common.core.ranges import Range, numbers
from porescale.common.core.types import Floats
from porescale.dem.contact.budget import SURFACES, add_losses, add_release_losses, add_work, has_budget, losses_if
from porescale.dem.contact.law import (
    Relative,
    contact,
    force_components,
    has_history,
    load_history,
    material_of,
    moments,
    store_history,
)

SIDES = ("left", "right", "bottom", "top")
KINDS = ("solid", "periodic", "open")
PX, PY, NX, NY, VX, VY, TURN = range(7)
"""Columns of the wall table: a point (m) and the unit normal; velocity of that point (m/s) and rotation about it
(rad/s), as used in contacts.
"""
WALL = 7
X, LOW, HIGH, VELOCITY, PRESENT = range(5)
"""Columns of the plate table: x, lower and upper end (m), upward velocity (m/s), 1 while it is there."""
RUN = 16
"""Discs that are tested together for being near a wall: in a pile settled from left to right 3 % of runs touch a
side and 26 % the floor; 14 % with runs of 8, but twice as many flags to read."""


@inline
def runs_of(count):
    """Number of runs that ``count`` discs make; the last one may be shorter."""
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
        lower, upper = (numbers(f"box.{key}", getattr(self, key), (2,), Range("m")) for key in ("lower", "upper"))
        if not (lower < upper).all():
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

    def walls(self) -> tuple[list[str], Floats]:
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

    def row(self) -> Floats:
        """The plate as kernels read it, (5,): columns X, LOW, HIGH, VELOCITY, PRESENT."""
        return np.array([self.x, self.y_low, self.y_high, self.velocity, 1.0])


@inline
def surface_contact(i, nx, ny, distance, vx, vy, turn, d, memory, dt, laws, law):
    """Disc i against a surface: (force x, force y N/m, torque N m/m) on the disc, and what resists rolling turns the
    surface with (N m/m), about the point of contact.

    (nx, ny) unit vector from the disc to the surface;  distance centre to surface (m) < radius, the lever arm;
    (vx, vy) velocity of the surface (m/s), turn its rotation (rad/s);  d: DiscArrays;  dt (s);  laws (m, COLUMNS) of
    the surface with each material;  law see contact/law.py.  Overwrites row i of memory (n, 1 or 2), springs in m.
    """
    radius, spin = d.radius[i], d.spin[i]
    overlap, arm = radius - distance, max(distance, 0.0)
    vx, vy = d.velocity[i, 0] - vx, d.velocity[i, 1] - vy
    seen = Relative(overlap, vx * nx + vy * ny, vy * nx - vx * ny + spin * arm, (spin - turn) * radius, radius)
    p, mass = laws[material_of(d.material, i)], d.body_mass[i]
    spring, roll = load_history(memory, i, law)
    found = contact(seen, spring, roll, mass, dt, p, law)
    store_history(memory, i, found.spring, found.roll, law)
    add_losses(d.budget, i, losses_if(d.budget, seen, spring, roll, found, mass, dt, p, law), law.rolling)
    moment, other = moments(found, arm, 0.0, radius, law)
    fx, fy = force_components(found, nx, ny, law)
    return fx, fy, moment, other


@kernel
def add_leaving_losses(i, dx, dy, vx, vy, turn, d, memory, dt, laws, law):
    """Add to the energy budget, if any, what the springs of disc i still held when it left a surface.

    (dx, dy) m from its centre to the nearest point of the surface;  (vx, vy) velocity relative to it (m/s); the rest as
    in surface_contact.  A function of its own, and called seldom: merged into the loops over all discs it makes them
    count references at every disc.
    """
    radius, spin = d.radius[i], d.spin[i]
    spring, roll = load_history(memory, i, law)
    distance = np.sqrt(dx * dx + dy * dy)
    nx, ny = dx / distance, dy / distance
    slip = vy * nx - vx * ny + spin * distance
    seen = Relative(radius - distance, vx * nx + vy * ny, slip, (spin - turn) * radius, radius)
    add_release_losses(i, seen, spring, roll, dt, laws[material_of(d.material, i)], d.budget, law)


@kernel
def add_wall_forces(d, walls, laws, spring, load, law, dt):
    """Add the contacts of all discs with all walls; reset the springs of those that do not touch.

    d: DiscArrays;  walls (w, WALL);  laws (w, m, COLUMNS) with each material;  law see contact/law.py;
    dt s.  Adds to ``d.force`` N/m and ``d.torque`` N m/m; overwrites spring (w, n, 1 or 2) m and load (w, 2 or 3) N/m,
    N m/m, the force of the discs on each wall, summed in the order of discs, and its moment about the wall's point.
    """
    near = np.ones((walls.shape[0], runs_of(d.radius.shape[0])), np.uint8)
    add_near_walls(d, walls, laws, spring, load, np.int64(0), near, np.int64(0), d.radius.shape[0], law, dt)


@kernel
def add_near_walls(d, walls, laws, spring, load, row, near, first, last, law, dt):
    """As add_wall_forces, for discs first to last in runs that are near a wall; near (w or more, runs): see mark_near.

    ``first`` begins a run.  Discs of other runs must touch nothing and have springs at rest.  Overwrites rows of
    ``load`` from ``row`` on.
    """
    for w in range(walls.shape[0]):
        px, py, nx, ny = walls[w, PX], walls[w, PY], walls[w, NX], walls[w, NY]
        wall_x, wall_y, turn = walls[w, VX], walls[w, VY], walls[w, TURN]
        memory, own = spring[w], laws[w]
        sum_x, sum_y, moments_sum = 0.0, 0.0, 0.0
        for run in range(first // RUN, runs_of(last)):
            if not near[w, run]:
                continue
            for i in range(run * RUN, min((run + 1) * RUN, last)):
                distance = (d.position[i, 0] - px) * nx + (d.position[i, 1] - py) * ny
                if d.radius[i] - distance > 0.0:
                    along = (d.position[i, 1] - py) * nx - (d.position[i, 0] - px) * ny
                    at_x, at_y = wall_x - turn * along * nx, wall_y - turn * along * ny
                    fx, fy, moment, other = surface_contact(
                        i, -nx, -ny, distance, at_x, at_y, turn, d, memory, dt, own, law
                    )
                    d.force[i, 0] += fx
                    d.force[i, 1] += fy
                    d.torque[i] += moment
                    sum_x -= fx
                    sum_y -= fy
                    moments_sum += along * (ny * fy + nx * fx) + other
                    add_work(d.budget, i, SURFACES, fx * at_x + fy * at_y - other * turn, dt)
                else:
                    if has_budget(d.budget) and has_history(memory, i, law):
                        along = (d.position[i, 1] - py) * nx - (d.position[i, 0] - px) * ny
                        vx = d.velocity[i, 0] - wall_x + turn * along * nx
                        vy = d.velocity[i, 1] - wall_y + turn * along * ny
                        add_leaving_losses(i, -distance * nx, -distance * ny, vx, vy, turn, d, memory, dt, own, law)
                    store_history(memory, i, 0.0, 0.0, law)
        load[row + w, 0] = sum_x
        load[row + w, 1] = sum_y
        if load.shape[1] > 2:
            load[row + w, 2] = moments_sum


@kernel
def mark_near(position, radius, walls, way, near):
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


@inline
def move_plates(plates, dt):
    """Raise every present plate (p, 5) by its velocity over ``dt`` (s); overwrites LOW and HIGH."""
    for w in range(plates.shape[0]):
        rise = plates[w, VELOCITY] * plates[w, PRESENT] * dt
        plates[w, LOW] += rise
        plates[w, HIGH] += rise
