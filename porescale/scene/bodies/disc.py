"""[[disc]]: discs that are held, or move at a given velocity."""

import pydantic

from porescale.common.schema.sections import Section, quantity
from porescale.scene.ranges import LENGTH, PLACE, SPEED


class Disc(Section):
    """A disc that is held: fixed where it is, or towed with a velocity and a spin that nothing changes.

    In the fluid it has its full radius.  It pushes grains and is not pushed.
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
