"""The section of prescribed water levels."""

import math
from collections.abc import Sequence

import numpy as np
import pydantic

from continuum_sph.scene.bounds import WHOLE
from continuum_sph.scene.rise import Row, rise_faults, rows_of
from continuum_sph.scene.soil import SoilSection
from porescale.common.core.errors import Fault
from porescale.common.core.types import Floats
from porescale.common.schema.names import name_faults
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
    rise: tuple[Row, ...] = pydantic.Field(default=(), description="rows of time (s) and level (m)")

    @property
    def table(self) -> tuple[Row, ...]:
        """Rows of time (s) and level (m)."""
        return rows_of(self.level, self.rise)

    @property
    def highest(self) -> float:
        """Highest level of the table, m; 0 without one."""
        return max((level for _, level in self.table), default=0.0)

    def ground(self, soil: SoilSection, spacing: float, beside: float = 0.0) -> float:
        """Height (m) of the highest ``soil`` at the start above the strip's bottom, in it or ``beside`` it so far, m.

        Minus infinity where there is none; spacing : of the particles, m.
        """
        first, last = (round(it / spacing, 6) for it in (self.left - beside, self.right + beside))
        columns: Floats = (np.arange(math.floor(max(first, 0.0)), math.ceil(last), dtype=np.float64) + 0.5) * spacing
        top: Floats = np.max([body.top(columns) for body in soil.body], axis=0, initial=-np.inf)
        highest = float(top.max(initial=-np.inf))
        return highest if highest > self.bottom + (0.5 + WHOLE) * spacing else -np.inf

    def faults(self, key: str, width: float, height: float, spacing: float) -> list[Fault]:
        """What is wrong with it in a tank of ``width`` by ``height``, m, with particles of a ``spacing``, m."""
        found = rise_faults(key, "level", self.level, self.rise)
        if self.right - self.left < (2.0 - WHOLE) * spacing:
            found.append(Fault(f"{key}.right", self.right, "leaves fewer than 2 particles across", "m",
                               f">= {self.left + 2.0 * spacing:g}"))  # fmt: skip
        if self.right > width * (1.0 + 1e-9):
            found.append(Fault(f"{key}.right", self.right, "lies outside of the tank", "m", f"<= {width:g}"))
        given = "rise" if self.level is None else "level"
        for time, level in self.table:
            if not self.bottom <= level <= height:
                problem = f"at {time:g} s lies below its bottom or over the tank"
                found.append(Fault(f"{key}.{given}", level, problem, "m", f"{self.bottom:g} to {height:g}"))
        return found


def reservoir_faults(
    reservoirs: Sequence[ReservoirSection], soil: SoilSection | None, size: tuple[float, float], spacing: float
) -> list[Fault]:
    """What is wrong with the reservoirs of a tank of a ``size`` (width, height), m, with particles of a ``spacing``, m.

    With suction a strip may reach into ground: there are no particles of water in it.
    """
    found = name_faults("reservoir", reservoirs, "reservoir")
    for k, it in enumerate(reservoirs):
        key = f"reservoir[{k}]"
        wrong = it.faults(key, *size, spacing)
        found += wrong
        for j, other in enumerate(reservoirs[:k]):
            shared = min(it.right, other.right) - max(it.left, other.left)
            if shared > WHOLE * spacing:
                found.append(Fault(key, None, f"overlaps reservoir[{j}] by {shared:g} m",
                                   repair="move or narrow one of them"))  # fmt: skip
        if wrong or soil is None or soil.suction is not None:
            continue
        top = it.ground(soil, spacing)
        if top > it.bottom:
            problem = f"has ground in its strip, up to {top:g} m, and its water stands on what is open"
            found.append(Fault(f"{key}.bottom", it.bottom, problem, "m",
                               repair=f"move it off the ground, or give bottom = {top:g}"))  # fmt: skip
    return found
