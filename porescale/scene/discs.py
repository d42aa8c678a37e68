"""Bodies that move as they are told, as sections: single discs; and the films between grains."""

from __future__ import annotations

from typing import Any

import pydantic

from porescale.common.schema.sections import Section, quantity

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
    material: str = pydantic.Field("", description="name of its material (default: that of the walls)")

    @property
    def fastest(self) -> float:
        """Largest speed of its rim, m/s."""
        return float((self.velocity[0] ** 2 + self.velocity[1] ** 2) ** 0.5) + abs(self.spin) * self.diameter / 2


class Lubrication(Section):
    """Squeeze films between grains, and at walls, that are too thin for the lattice: their normal force is added.

    The gap is that between the radii that the fluid sees.
    """

    gap: float = quantity("", 1.0, gt=0, le=10, help="gap in cells below which films are corrected")
