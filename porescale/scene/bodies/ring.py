"""[ring]: a concave wall, everything outside a circle."""

from porescale.common.schema.sections import Section, quantity
from porescale.scene.ranges import LENGTH, PLACE


class Ring(Section):
    """All that lies outside a circle is solid: the outer cylinder of a Couette cell, a drum; held, or turning.

    For fluid and held discs.
    """

    x: float = quantity("m", **PLACE, help="centre")
    y: float = quantity("m", **PLACE, help="centre")
    diameter: float = quantity("m", **LENGTH, help="diameter of the hole, in which the fluid is")
    spin: float = quantity("rad/s", 0.0, ge=-1e7, le=1e7, help="angular velocity, counter-clockwise")
