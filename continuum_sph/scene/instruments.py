"""The sections of what is measured in a tank."""

import pydantic

from porescale.common.core.errors import Fault
from porescale.common.schema.sections import Section, quantity


class ProbeSection(Section):
    """A point where pressure and velocity of the water are recorded over time: probes.csv.

    With width and height a rectangle about it, in which their means over the water are: the mean pore pressure.
    """

    name: str = pydantic.Field("", description="name in the columns (default: its number)")
    x: float = quantity("m", ge=0, le=1e5, help="place, or centre")
    y: float = quantity("m", ge=0, le=1e5, help="place, or centre")
    width: float | None = quantity("m", None, ge=1e-6, le=1e5, help="width of a rectangle to take the mean over")
    height: float | None = quantity("m", None, ge=1e-6, le=1e5, help="height of a rectangle to take the mean over")

    def _faults(self) -> list[Fault]:
        if (self.width is None) != (self.height is None):
            key = "width" if self.width is None else "height"
            return [Fault(key, None, "a rectangle needs both", "m", repair="give width and height, or neither")]
        return []

    def unfilled(self, key: str, tank: tuple[float, float], spacing: float) -> list[Fault]:
        """What is wrong with a rectangle in a ``tank`` (width, height) m of particles a ``spacing`` (m) apart: sides
        that reach out of it, or between which there may be no particle."""
        if self.width is None or self.height is None:
            return []
        found, slack, move = [], 1e-9 * max(tank), "narrow it, or move its middle in"
        sides = ("width", self.x, self.width, tank[0]), ("height", self.y, self.height, tank[1])
        for name, middle, side, length in sides:
            room = 2.0 * min(middle, length - middle)
            if side > room + slack:
                found.append(Fault(f"{key}.{name}", side, "reaches out of the tank", "m", f"<= {room:g}", move))
            elif side < spacing - slack:
                problem = "is less than a spacing, so that no particle may be there"
                found.append(Fault(f"{key}.{name}", side, problem, "m", f">= {spacing:g}"))
        return found


class LevelSection(Section):
    """A strip in which the height of the free surface is recorded over time: levels.csv."""

    name: str = pydantic.Field("", description="name in the columns (default: its number)")
    x: float = quantity("m", ge=0, le=1e5, help="middle of the strip")
    breadth: float | None = quantity("m", None, ge=1e-6, le=1e5, help="breadth of the strip (default: 4 spacings)")
