"""The section of sides of the tank that water passes at a given head."""

from collections.abc import Sequence
from typing import Literal

import numpy as np
import pydantic

from continuum_sph.scene.bounds import WHOLE
from continuum_sph.scene.rise import Row, rise_faults, rows_of
from continuum_sph.scene.soil import SoilSection
from porescale.common.core.errors import Fault
from porescale.common.core.types import Floats
from porescale.common.schema.names import name_faults
from porescale.common.schema.sections import Section, quantity

Size = tuple[float, float]


class FaceSection(Section):
    """A stretch of a side of the tank through which the water of the pores passes, at a given head.

    ``start`` and ``end`` are places along the side, x of floor and lid, y of the others; left out, the stretch goes to
    the corner.  It takes the rows of particles whose middles lie in it.  The ground is full of water, and none comes in
    anew: water may pass by half a spacing.  A head lies no lower than the face.  It stands at ``head`` for ever, or
    follows ``rise``, as the level of a reservoir does.
    """

    name: str = pydantic.Field("", description="name in the columns (default: its number)")
    side: Literal["left", "right", "floor", "lid"] = pydantic.Field(description="side of the tank")
    head: float | None = quantity("m", None, ge=0, le=1e5, help="head over the floor: water in a pipe stands so high")
    rise: tuple[Row, ...] = pydantic.Field(default=(), description="rows of time (s) and head (m), in place of head")
    start: float | None = quantity("m", None, ge=0, le=1e5, help="start along the side")
    end: float | None = quantity("m", None, ge=0, le=1e5, help="end along the side")

    @property
    def table(self) -> tuple[Row, ...]:
        """Rows of time (s) and head (m)."""
        return rows_of(self.head, self.rise)

    @property
    def highest(self) -> float:
        """Highest head of the table, m; 0 without one."""
        return max((head for _, head in self.table), default=0.0)

    def heads(self, time: Floats) -> Floats:
        """Heads (n,) m at times (n,) s: straight lines between the rows of its table, constant before and after."""
        times, heads = zip(*self.table, strict=True)
        found: Floats = np.interp(time, times, heads)
        return found

    @property
    def axis(self) -> int:
        """Axis along which the side runs: 0 of floor and lid, 1 of left and right."""
        return 0 if self.side in ("floor", "lid") else 1

    def across(self, size: Size) -> tuple[float, float]:
        """(Where the side of a tank of a ``size`` (width, height), m, stands on the other axis, m;  which way into the
        tank, 1 or -1)."""
        return (size[1 - self.axis], -1.0) if self.side in ("right", "lid") else (0.0, 1.0)

    def reach(self, size: Size) -> tuple[float, float]:
        """Where it begins and ends along its side of a tank of a ``size`` (width, height), m."""
        return self.start or 0.0, size[self.axis] if self.end is None else self.end

    def along(self, size: Size, spacing: float) -> Floats:
        """Places (n, 2) m of the particles of a ``spacing`` (m) beside it in a tank of a ``size``, m."""
        (start, end), (at, inward) = self.reach(size), self.across(size)
        middles = (np.arange(round(size[self.axis] / spacing)) + 0.5) * spacing
        there = middles[(middles > start) & (middles < end)]
        beside = np.full(len(there), at + 0.5 * inward * spacing)
        return np.column_stack((there, beside) if self.axis == 0 else (beside, there))

    def faults(self, key: str, size: Size, spacing: float) -> list[Fault]:
        """What is wrong with it in a tank of a ``size``, m, with particles of a ``spacing``, m."""
        if wrong := rise_faults(key, "head", self.head, self.rise):
            return wrong
        (start, end), longest = self.reach(size), size[self.axis]
        for name, value in (("start", start), ("end", end)):
            if value > longest * (1.0 + 1e-9):
                return [Fault(f"{key}.{name}", value, "lies beyond the side", "m", f"<= {longest:g}")]
        if len(self.along(size, spacing)) < 2:
            if longest < (2.0 - WHOLE) * spacing:
                return [Fault("numerics.spacing", spacing, f"leaves {key} fewer than 2 rows of particles", "m",
                              f"<= {0.5 * longest:g}")]  # fmt: skip
            few = "leaves fewer than 2 rows of particles"
            if self.end is None or start + 2.0 * spacing > longest:
                return [Fault(f"{key}.start", start, few, "m", f"<= {longest - 2.0 * spacing:g}")]
            return [Fault(f"{key}.end", end, few, "m", f">= {start + 2.0 * spacing:g}")]
        highest = end if self.axis else self.across(size)[0]
        lowest = min(head for _, head in self.table)
        if lowest < highest * (1.0 - 1e-9):
            given = "rise" if self.head is None else "head"
            return [Fault(f"{key}.{given}", lowest, "makes the pressure at its upper end negative", "m",
                          f">= {highest:g}", "raise it, or end the face below it")]  # fmt: skip
        return []


def face_faults(
    faces: Sequence[FaceSection], soil: SoilSection | None, lid: bool, size: Size, spacing: float
) -> list[Fault]:
    """What is wrong with the faces of a tank of a ``size`` (width, height), m, with particles of a ``spacing``, m."""
    found = []
    full = soil.body if soil is not None and soil.saturated else ()
    if faces and not full and (soil is None or soil.suction is None):  # with suction faces are refused themselves
        repair = "give soil.saturated = true" if soil else "add [soil] and soil.saturated = true"
        found.append(Fault("face", "given", "needs ground whose pores are full", repair=repair))
    for k, it in enumerate(faces):
        key = f"face[{k}]"
        wrong = it.faults(key, size, spacing)
        found += wrong
        if full and not wrong and not np.any([body.holds(it.along(size, spacing)) for body in full], axis=0).all():
            found.append(Fault(key, it.side, "is not along ground all the way", repair="give start and end, or let "
                               "soil.body reach the side"))  # fmt: skip
        if it.side == "lid" and not lid:
            found.append(Fault(f"{key}.side", "lid", "is that of an open tank", repair="give tank.lid = true"))
        for j, other in enumerate(faces[:k]):
            (start, end), (begin, stop) = it.reach(size), other.reach(size)
            if other.side == it.side and min(end, stop) - max(start, begin) > 0.5 * spacing:
                found.append(Fault(key, it.side, f"overlaps face[{j}]", repair="move or shorten one of them"))
    return found + name_faults("face", faces, "face")
