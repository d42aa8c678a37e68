"""[[rectangle]]: solid rectangles along the grid, fixed or moved."""

from collections.abc import Mapping
from typing import Any

import pydantic

from porescale.common.core.errors import Fault
from porescale.common.schema.sections import Section, quantity
from porescale.scene.ranges import PLACE, SPEED


class Rectangle(Section):
    """A solid rectangle along the grid: a gate of finite thickness, a piston, a step; fixed, or moved at a velocity.

    It may reach through the sides of the box, and leave through them or come in: the side moves with it there.  What
    fills it goes along; in a box without open sides the fluid's mass is made good, as if its level followed.
    """

    lower: tuple[float, float] = quantity("m", **PLACE, help="lower left corner at the start")
    upper: tuple[float, float] = quantity("m", **PLACE, help="upper right corner at the start")
    velocity: tuple[float, float] = quantity("m/s", (0.0, 0.0), **SPEED, help="velocity while it moves; [0, 0]: fixed")
    starts_at: float = quantity("s", 0.0, ge=0, le=1e9, help="time at which it starts to move")
    stops_at: float | None = quantity("s", None, ge=0, le=1e9, help="time at which it stops (default: never)")
    ramp: float = quantity(
        "s", 0.0, ge=0, le=1e9, help="time in which it comes to its velocity from starts_at on, and to rest at stops_at"
    )
    friction: float | None = quantity("", None, ge=0, le=1e3, help="friction with grains (default: that of walls)")
    make_good: bool | None = pydantic.Field(
        None, description="the fluid's mass is made good for what moves through sides (default: if no side is open)"
    )

    def _faults(self) -> list[Fault]:
        faults = []
        if not (self.lower[0] < self.upper[0] and self.lower[1] < self.upper[1]):
            faults.append(Fault("upper", str(self.upper), "does not lie right of and above lower", "m",
                                f"> {self.lower}", "exchange them"))  # fmt: skip
        if self.stops_at is not None and self.stops_at < self.starts_at:
            faults.append(Fault("stops_at", self.stops_at, "is before starts_at", "s", f">= {self.starts_at:g}"))
        elif self.stops_at is not None and 2 * self.ramp > self.stops_at - self.starts_at:
            most = 0.5 * (self.stops_at - self.starts_at)
            problem = "does not fit twice between starts_at and stops_at"
            faults.append(Fault("ramp", self.ramp, problem, "s", f"<= {most:g}", "shorten it, or stop later"))
        return faults

    @property
    def fastest(self) -> float:
        """Magnitude of the prescribed velocity, m/s."""
        return float((self.velocity[0] ** 2 + self.velocity[1] ** 2) ** 0.5)

    def travelled(self, time: float) -> tuple[float, float]:
        """How far it has gone at ``time`` (s), m."""
        return travelled(self.velocity, self.starts_at, self.stops_at, time, self.ramp)


def travelled(
    velocity: tuple[float, float], starts_at: float, stops_at: float | None, time: float, ramp: float = 0.0
) -> tuple[float, float]:
    """Way (m) until ``time`` of what moves at ``velocity`` (m/s) from starts_at to stops_at (s; None: for ever), evenly
    accelerated and slowed over a ``ramp`` (s)."""
    moving = max(0.0, (time if stops_at is None else min(time, stops_at)) - starts_at)
    if ramp:
        slow = 0.0 if stops_at is None else max(0.0, moving - (stops_at - starts_at - ramp))
        moving = (moving**2 / (2 * ramp) if moving < ramp else moving - ramp / 2) - slow**2 / (2 * ramp)
    return velocity[0] * moving, velocity[1] * moving


def outline(
    section: Mapping[str, Any], time: float, size: tuple[float, float]
) -> list[tuple[tuple[float, float], tuple[float, float]]]:
    """Edges, pairs of points (m), of a section as run cards keep it, at ``time`` (s) in a box of ``size`` (m)."""
    ramp = section.get("ramp", 0.0)  # cards of earlier versions have none
    gone = travelled(section["velocity"], section["starts_at"], section["stops_at"], time, ramp)
    (left, bottom), (right, top) = (
        tuple(at + by for at, by in zip(section[corner], gone, strict=True)) for corner in ("lower", "upper")
    )
    x0, x1, y0, y1 = max(left, 0.0), min(right, size[0]), max(bottom, 0.0), min(top, size[1])
    if x0 >= x1 or y0 >= y1:
        return []
    upright = [((x, y0), (x, y1)) for x in (left, right) if 0.0 < x < size[0]]
    return upright + [((x0, y), (x1, y)) for y in (bottom, top) if 0.0 < y < size[1]]
