"""[[region]]: rectangles in which grains are recorded."""

import pydantic

from porescale.common.core.errors import Fault
from porescale.common.schema.sections import Section, quantity
from porescale.scene.ranges import PLACE


class Region(Section):
    """A rectangle in which porosity, stress, fabric and motion of the grains are recorded over time: regions.csv.

    Compression is positive.  In a periodic box it may reach over the sides.
    """

    name: str = pydantic.Field("", description="name in the columns (default: its number)")
    lower: tuple[float, float] = quantity("m", **PLACE, help="lower left corner")
    upper: tuple[float, float] = quantity("m", **PLACE, help="upper right corner")

    def _faults(self) -> list[Fault]:
        if not (self.lower[0] < self.upper[0] and self.lower[1] < self.upper[1]):
            problem = "must lie right of and above the lower corner"
            given, allowed = f"({self.upper[0]:g}, {self.upper[1]:g})", f"> ({self.lower[0]:g}, {self.lower[1]:g})"
            return [Fault("upper", given, problem, "m", allowed, "swap or move the corners")]
        return []
