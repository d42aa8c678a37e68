"""[[probe]]: points and rectangles where the fluid is recorded."""

import pydantic

from porescale.common.core.errors import Fault
from porescale.common.schema.sections import Section, quantity
from porescale.scene.ranges import LENGTH, PLACE


class Probe(Section):
    """A point where pressure and velocity are recorded over time: probes.csv.

    With width and height a rectangle about it, in which their means over the fluid are: the mean pore pressure.
    """

    name: str = pydantic.Field("", description="name in the columns (default: its number)")
    x: float = quantity("m", **PLACE, help="place, or centre")
    y: float = quantity("m", **PLACE, help="place, or centre")
    width: float | None = quantity("m", None, **LENGTH, help="width of a rectangle to take the mean over")
    height: float | None = quantity("m", None, **LENGTH, help="height of a rectangle to take the mean over")

    def _faults(self) -> list[Fault]:
        if (self.width is None) != (self.height is None):
            key = "width" if self.width is None else "height"
            return [Fault(key, None, "a rectangle needs both", "m", repair="give width and height, or neither")]
        return []

    @property
    def corners(self) -> tuple[tuple[float, float], tuple[float, float]] | None:
        """Lower left and upper right corner of the rectangle, m; None of a point."""
        if self.width is None or self.height is None:
            return None
        w, h = 0.5 * self.width, 0.5 * self.height
        return (self.x - w, self.y - h), (self.x + w, self.y + h)
