"""The section of prescribed water levels."""

import pydantic

from porescale.common.core.errors import Fault
from porescale.common.schema.sections import Section, quantity


class ReservoirSection(Section):
    """A strip of open water kept at a level, by water let in or out over its surface; both are recorded.

    The water may stand at ``level`` for ever, or follow ``rise``, a table of (time s, level m), straight lines between
    its rows: two rows close in time are a sudden rise.  A level at ``bottom`` takes out whatever comes.  The strip
    should hold open water down to its bottom; 6 spacings of it or more, 3 from soil.
    """

    name: str = pydantic.Field("", description="name in the columns (default: its number)")
    left: float = quantity("m", ge=0, le=1e5, help="left end of the strip")
    right: float = quantity("m", ge=0, le=1e5, help="right end of the strip")
    bottom: float = quantity("m", 0.0, ge=0, le=1e5, help="height of the ground below it")
    level: float | None = quantity("m", None, ge=0, le=1e5, help="level, for ever")
    rise: tuple[tuple[float, float], ...] = pydantic.Field(default=(), description="rows of time (s) and level (m)")

    @property
    def table(self) -> tuple[tuple[float, float], ...]:
        """Rows of time (s) and level (m)."""
        return self.rise if self.level is None else ((0.0, self.level),)

    @property
    def highest(self) -> float:
        """Highest level of the table, m; 0 without one."""
        return max((level for _, level in self.table), default=0.0)

    def faults(self, key: str, width: float, height: float, spacing: float) -> list[Fault]:
        """What is wrong with it in a tank of ``width`` by ``height``, m, with particles of a ``spacing``, m."""
        found = []
        if (self.level is None) == (not self.rise):
            found.append(Fault(key, None, "needs a level or a rise, and not both", repair="give one of them"))
        if self.right - self.left < 2.0 * spacing:
            found.append(Fault(f"{key}.right", self.right, "leaves fewer than 2 particles across", "m",
                               f">= {self.left + 2.0 * spacing:g}"))  # fmt: skip
        if self.right > width * (1.0 + 1e-9):
            found.append(Fault(f"{key}.right", self.right, "lies outside of the tank", "m", f"<= {width:g}"))
        if any(later <= earlier for (earlier, _), (later, _) in zip(self.rise, self.rise[1:], strict=False)):
            found.append(Fault(f"{key}.rise", [time for time, _ in self.rise], "has times that do not rise", "s"))
        for time, level in self.table:
            if not self.bottom <= level <= height:
                found.append(Fault(f"{key}.level", level, f"at {time:g} s lies below its bottom or over the tank", "m",
                                   f"{self.bottom:g} to {height:g}"))  # fmt: skip
        return found
