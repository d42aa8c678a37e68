"""Walls of dry grains: sides that move, and free walls."""

import math
from collections.abc import Sequence
from typing import Any

from porescale.builders.initial.time_functions import schedule_of, schedule_or_zero
from porescale.common.compiled.own import OwnLaw
from porescale.common.schema.names import names_of
from porescale.dem.forces.walls import NX, NY, PX, PY
from porescale.dem.grains import Grains
from porescale.scene.bodies.wall import Wall
from porescale.scene.domain import SIDES, Domain
from porescale.scene.servo import Pressed

ACROSS = {"left": ("bottom", "top"), "right": ("bottom", "top"), "bottom": ("left", "right"), "top": ("left", "right")}
"""The two sides between which a stress on a side acts."""


def moving_sides(domain: Domain) -> list[str]:
    """Sides that move, at a velocity or by a servo."""
    return [name for name, it in domain.sides.items()
            if it.boundary.movable and (it.velocity is not None or it.stress or it.force)]  # fmt: skip


def add_walls(domain: Domain, walls: Sequence[Wall], grains: Grains) -> None:
    """Put the free walls there and set all in motion that move."""
    for name, it in zip(names_of(walls, "wall"), walls, strict=True):
        grains.add_wall(name, (it.x, it.y), it.normal, it.friction)
        if it.moves:
            grains.steering.move_wall(
                name, schedule_or_zero(it.velocity_x), schedule_or_zero(it.velocity_y), schedule_or_zero(it.turning)
            )
        _press(grains, name, it, {"length": it.length} if it.stress else {})
    for name in moving_sides(domain):
        side = domain.sides[name]
        if side.velocity is not None and not isinstance(side.velocity, OwnLaw):
            grains.steering.move_wall(name, *side.velocity)
        width = domain.width if name in ("bottom", "top") else domain.height
        ends = ACROSS[name]
        _press(grains, name, side, {"between": ends} if set(ends) <= set(grains.wall_names) else {"length": width})


def _press(grains: Grains, name: str, it: Pressed, over: dict[str, Any]) -> None:
    """Give a wall its servo, if it has one; over: what a stress acts over."""
    if it.stress:
        grains.steering.servo_wall(name, stress=schedule_of(it.stress), speed=it.fastest or 0.0, **over)
    elif it.force:
        grains.steering.servo_wall(name, force=schedule_of(it.force), speed=it.fastest or 0.0)


def middles(grains: Grains) -> list[tuple[float, float]]:
    """Points about which the moments on walls are given, where they are now, m: the middle of a side, the point of a
    free wall."""
    (left, bottom), (right, top) = grains.box.lower, grains.box.upper
    x, y = 0.5 * (left + right), 0.5 * (bottom + top)
    points = []
    for name, row in zip(grains.wall_names, grains.walls, strict=True):
        px, py = float(row[PX]), float(row[PY])
        points.append({"left": (px, y), "right": (px, y), "bottom": (x, py), "top": (x, py)}.get(name, (px, py)))
    return points


class WallPlaces:
    """Positions of the moving walls of a scene: columns of forces.csv."""

    def __init__(self, domain: Domain, walls: Sequence[Wall]) -> None:
        self.sides, self.walls = moving_sides(domain), dict(zip(names_of(walls, "wall"), walls, strict=True))

    def row(self, grains: Grains) -> dict[str, float]:
        """Places, m, and the direction of those that turn, rad.

        NAME x (m) : where the moving wall is
        NAME y (m) : where the moving wall is
        NAME direction of normal (rad) : of a wall that turns, from the x axis
        """
        row: dict[str, float] = {}
        for name, wall in zip(grains.wall_names, grains.walls, strict=True):
            it = self.walls.get(name)
            if name in self.sides or (it and (it.moves or it.stress or it.force)):
                shown = f"{name} wall" if name in SIDES else name
                row |= {f"{shown} x (m)": float(wall[PX]), f"{shown} y (m)": float(wall[PY])}
                if it and it.turning:
                    row[f"{shown} direction of normal (rad)"] = math.atan2(float(wall[NY]), float(wall[NX]))
        return row
