"""Bodies that move as they are told, as sections: single discs, upright rectangles; and the films between grains."""

from __future__ import annotations

import itertools
from typing import Any

import pydantic

from porescale.ground.check import Fault
from porescale.workbench.sections import Refused, Section, quantity

PLACE: Any = {"ge": -1e3, "le": 1e3}
LENGTH: Any = {"ge": 1e-9, "le": 1e3}
SPEED: Any = {"ge": -1e4, "le": 1e4}


class Disc(Section):
    """A disc that is held: fixed where it is, or towed with a velocity and a spin that nothing changes.

    The fluid sees it at its full radius.  It pushes grains and is not pushed.
    """

    x: float = quantity("m", **PLACE, help="centre at the start")
    y: float = quantity("m", **PLACE, help="centre at the start")
    diameter: float = quantity("m", **LENGTH, help="diameter")
    velocity: tuple[float, float] = quantity("m/s", (0.0, 0.0), **SPEED, help="velocity; [0, 0] is a fixed disc")
    spin: float = quantity("rad/s", 0.0, ge=-1e7, le=1e7, help="angular velocity, counter-clockwise")

    @property
    def fastest(self) -> float:
        """Largest speed of its rim, m/s."""
        return float((self.velocity[0] ** 2 + self.velocity[1] ** 2) ** 0.5) + abs(self.spin) * self.diameter / 2


class Rectangle(Section):
    """An upright solid rectangle: a gate of finite thickness, a piston, a block.  It moves as told.

    velocity : from the start on;  or motion : rows of (time, velocity along x, along y): each velocity holds from its
    time until the next row's.
    """

    lower: tuple[float, float] = quantity("m", **PLACE, help="lower left corner at the start")
    upper: tuple[float, float] = quantity("m", **PLACE, help="upper right corner at the start")
    velocity: tuple[float, float] = quantity("m/s", (0.0, 0.0), **SPEED, help="velocity")
    motion: tuple[tuple[float, float, float], ...] = pydantic.Field(
        (), description="rows of time (s) and velocity along x and y (m/s), instead of velocity"
    )
    friction: float = quantity("", 0.0, ge=0, le=1e3, help="friction coefficient with grains")

    @pydantic.model_validator(mode="after")
    def _sound(self) -> Rectangle:
        faults = []
        if not (self.lower[0] < self.upper[0] and self.lower[1] < self.upper[1]):
            faults.append(Fault("upper", str(list(self.upper)), "is not right of and above lower", "m",
                                repair="swap or correct the corners"))  # fmt: skip
        times = [row[0] for row in self.motion]
        if any(later <= earlier for earlier, later in itertools.pairwise(times)) or min(times, default=0) < 0:
            faults.append(Fault("motion", None, "times must start at 0 or later and grow", "s", repair="sort the rows"))
        if self.motion and self.velocity != (0.0, 0.0):
            faults.append(Fault("velocity", None, "and motion are both given", repair="give one of them"))
        if faults:
            raise Refused(*faults)
        return self

    @property
    def fastest(self) -> float:
        """Largest speed, m/s."""
        return max(float((x**2 + y**2) ** 0.5) for x, y in (self.velocity, *(row[1:] for row in self.motion)))

    def velocity_at(self, time: float) -> tuple[float, float]:
        """Velocity (m/s) from ``time`` (s) on."""
        now = self.velocity
        for begins, x, y in self.motion:
            if begins <= time:
                now = (x, y)
        return now


class Lubrication(Section):
    """Squeeze films between grains, and at walls, that are too thin for the lattice: their normal force is added.

    The gap is that between the radii that the fluid sees.
    """

    gap: float = quantity("", 1.0, gt=0, le=10, help="gap in cells below which films are corrected")
