"""Walls that move, for dry grains: sides of the box, and free straight walls without end."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any, ClassVar, Protocol

import numpy as np
import pydantic

from porescale.common.core.errors import Fault
from porescale.common.schema.sections import Refused, Section, quantity
from porescale.dem.forces.walls import NX, NY, PX, PY
from porescale.dem.grains import Grains
from porescale.dem.motion.time_function import Schedule
from porescale.scene.time_function import Course, with_courses

if TYPE_CHECKING:
    from porescale.scene.sections import Scene

SIDES = ("left", "right", "bottom", "top")
ACROSS = {"left": ("bottom", "top"), "right": ("bottom", "top"), "bottom": ("left", "right"), "top": ("left", "right")}
"""The two sides between which a stress on a side acts."""
SERVO = {"stress": ("Pa", "stress on the wall"), "force": ("N/m", "force on the wall")}


class Pressed(Protocol):
    """What a servo-controlled wall says, side or not."""

    @property
    def stress(self) -> Course | None:
        """Pa."""

    @property
    def force(self) -> Course | None:
        """N/m."""

    @property
    def fastest(self) -> float | None:
        """m/s."""


def judge_servo(it: Pressed, moves: bool) -> list[Fault]:
    """What is wrong with the stress or force of a wall; ``moves``: it has a velocity, too."""
    given = [key for key in SERVO if getattr(it, key) is not None]
    faults = []
    if len(given) + moves > 1:
        problem = "a wall has one of velocity, stress and force"
        faults.append(Fault(given[-1], None, problem, repair="leave the others out"))
    if given and it.fastest is None:
        problem = "is missing: the largest speed of the wall"
        faults.append(Fault("fastest", None, problem, "m/s", "> 0", "add it, some diameters a second"))
    if it.fastest is not None and not given:
        problem = "belongs to a wall with stress or force"
        faults.append(Fault("fastest", it.fastest, problem, "m/s", repair="leave it out"))
    return faults


class Wall(Section):
    """A straight wall without end, solid behind: it stands, moves and turns as told, or is pressed on by the grains.

    stress, force : it moves along its normal, no faster than ``fastest``, so that the grains press on it so, > 0 for
    compression.  Dry scenes only.
    """

    name: str = pydantic.Field("", description="name in the columns (default: wall and its number)")
    x: float = quantity("m", ge=-1e3, le=1e3, help="a point of the wall, about which it turns")
    y: float = quantity("m", ge=-1e3, le=1e3, help="a point of the wall, about which it turns")
    normal: tuple[float, float] = quantity("", ge=-1e6, le=1e6, help="direction towards the grains, of any length")
    friction: float | None = quantity("", None, ge=0, le=1e3, help="friction coefficient (default: that of the sides)")
    velocity_x: Course | None = None
    velocity_y: Course | None = None
    turning: Course | None = None
    stress: Course | None = None
    force: Course | None = None
    fastest: float | None = quantity("m/s", None, gt=0, le=1e4, help="largest speed under stress or force")
    length: float | None = quantity("m", None, ge=1e-9, le=1e3, help="length over which a stress acts")

    UNITS: ClassVar[dict[str, tuple[str, str]]] = {
        "velocity_x": ("m/s", "velocity"), "velocity_y": ("m/s", "velocity"), "turning": ("rad/s", "rotation"), **SERVO,
    }  # fmt: skip

    @pydantic.model_validator(mode="before")
    @classmethod
    def _courses(cls, table: Any) -> Any:
        return with_courses(table, cls.UNITS)

    @pydantic.model_validator(mode="after")
    def _sensible(self) -> Wall:
        faults = judge_servo(self, self.moves)
        if not math.hypot(*self.normal) > 0.0:
            faults.append(Fault("normal", "(0, 0)", "has no length", repair="point it towards the grains"))
        if (self.stress is None) != (self.length is None):
            problem = "is needed for a stress" if self.stress else "belongs to a wall with stress"
            faults.append(Fault("length", self.length, problem, "m", repair="give both, or neither"))
        if faults:
            raise Refused(*faults)
        return self

    @property
    def moves(self) -> bool:
        """Whether it has a velocity."""
        return any(it is not None for it in (self.velocity_x, self.velocity_y, self.turning))


def wall_names(scene: Scene) -> list[str]:
    """Names of the free walls."""
    return [it.name or f"wall {k}" for k, it in enumerate(scene.wall)]


def moving_sides(scene: Scene) -> list[str]:
    """Sides that move, as told or by a servo."""
    return [name for name, it in scene.domain.sides.items()
            if it.kind == "wall" and (it.velocity is not None or it.stress or it.force)]  # fmt: skip


def judge_walls(scene: Scene) -> list[Fault]:
    """What is wrong with walls beside the rest of a scene."""
    faults = []
    moving = [*(f"domain.{name}" for name in moving_sides(scene)), *(f"wall[{k}]" for k in range(len(scene.wall)))]
    if moving and (scene.fluid or scene.grains is None):
        problem = "is for dry grains"
        repair = "leave [fluid] or it out" if scene.fluid else "add [grains] or leave it out"
        faults += [Fault(key, None, problem, repair=repair) for key in moving]
    names = wall_names(scene)
    faults += [
        Fault(f"wall[{k}].name", name, "is taken", repair="give each its own")
        for k, name in enumerate(names)
        if name in SIDES or name in names[:k]
    ]
    return faults


def across_walls(
    scene: Scene, x: np.ndarray[Any, Any], r: np.ndarray[Any, Any], names: list[str], touch: float
) -> list[Fault]:
    """The first of what is placed, x (n, 2) m, r (n,) m, that stands across each free wall; packings by corners."""
    faults = []
    packing = scene.grains.packing if scene.grains else None
    for k, it in enumerate(scene.wall):
        normal = np.array(it.normal) / math.hypot(*it.normal)
        behind = (x - np.array([it.x, it.y])) @ normal < r * (1 - touch)
        if behind.any():
            i = int(behind.argmax())
            where = f"({x[i, 0]:g}, {x[i, 1]:g})"
            faults.append(Fault(names[i], where, f"stands across or behind wall[{k}]", "m", repair="move one of them"))
        if packing:
            ends = (packing.left, packing.left + packing.width), (packing.bottom, packing.bottom + packing.height)
            corners = np.array([(a, b) for a in ends[0] for b in ends[1]])
            deepest = float(((corners - np.array([it.x, it.y])) @ normal).min())
            if deepest < -1e-9 * scene.domain.width:
                problem = f"reaches {-deepest:.3g} m behind wall[{k}]"
                faults.append(Fault("grains.packing", None, problem, "m", repair="move one of them"))
    return faults


def add_walls(scene: Scene, grains: Grains) -> None:
    """Put the free walls there and set all in motion that move."""
    for name, it in zip(wall_names(scene), scene.wall, strict=True):
        grains.add_wall(name, (it.x, it.y), it.normal, it.friction)
        if it.moves:
            grains.steering.move_wall(name, told(it.velocity_x), told(it.velocity_y), told(it.turning))
        _press(grains, name, it, {"length": it.length} if it.stress else {})
    for name in moving_sides(scene):
        side = scene.domain.sides[name]
        if side.velocity is not None:
            grains.steering.move_wall(name, *side.velocity)
        width = scene.domain.width if name in ("bottom", "top") else scene.domain.height
        ends = ACROSS[name]
        _press(grains, name, side, {"between": ends} if set(ends) <= set(grains.wall_names) else {"length": width})


def told(course: Course | None) -> Schedule:
    """The schedule of a course, zero of None."""
    return course.schedule if course else 0.0


def _press(grains: Grains, name: str, it: Pressed, over: dict[str, Any]) -> None:
    """Give a wall its servo, if it has one; over: what a stress acts over."""
    if it.stress:
        grains.steering.servo_wall(name, stress=it.stress.schedule, speed=it.fastest or 0.0, **over)
    elif it.force:
        grains.steering.servo_wall(name, force=it.force.schedule, speed=it.fastest or 0.0)


def middles(grains: Grains) -> list[tuple[float, float]]:
    """Points about which the moments on walls are said, where they are now, m: the middle of a side, the point of a
    free wall."""
    (left, bottom), (right, top) = grains.box.lower, grains.box.upper
    x, y = 0.5 * (left + right), 0.5 * (bottom + top)
    points = []
    for name, row in zip(grains.wall_names, grains.walls, strict=True):
        px, py = float(row[PX]), float(row[PY])
        points.append({"left": (px, y), "right": (px, y), "bottom": (x, py), "top": (x, py)}.get(name, (px, py)))
    return points


def places(scene: Scene, grains: Grains) -> dict[str, float]:
    """Columns of forces.csv: where the walls that move are, m, and the direction of those that turn, rad."""
    row: dict[str, float] = {}
    moving = moving_sides(scene)
    turning = dict(zip(wall_names(scene), scene.wall, strict=True))
    for name, wall in zip(grains.wall_names, grains.walls, strict=True):
        it = turning.get(name)
        if name in moving or (it and (it.moves or it.stress or it.force)):
            shown = f"{name} wall" if name in SIDES else name
            row |= {f"{shown} x (m)": float(wall[PX]), f"{shown} y (m)": float(wall[PY])}
            if it and it.turning:
                row[f"{shown} direction of normal (rad)"] = math.atan2(float(wall[NY]), float(wall[NX]))
    return row
