"""The section of sides of the tank that water passes at a given head."""

from collections.abc import Sequence
from typing import Literal

import numpy as np
import pydantic

from continuum_sph.scene.soil import SoilSection
from porescale.common.core.errors import Fault
from porescale.common.core.types import Floats
from porescale.common.schema.sections import Section, quantity


class FaceSection(Section):
    """A stretch of a side of the tank through which the water of the pores passes, at a constant head.

    ``start`` and ``end`` are places along the side, x of floor and lid, y of the others; left out, the stretch goes to
    the corner.  The ground is full of water, and none comes in anew: water may pass by half a spacing.  A head lies no
    lower than the face.
    """

    name: str = pydantic.Field("", description="name in the columns (default: its number)")
    side: Literal["left", "right", "floor", "lid"] = pydantic.Field(description="side of the tank")
    head: float = quantity("m", ge=0, le=1e5, help="head over the floor: water in a pipe there stands so high")
    start: float | None = quantity("m", None, ge=0, le=1e5, help="where it begins along the side")
    end: float | None = quantity("m", None, ge=0, le=1e5, help="where it ends along the side")

    def reach(self, width: float, height: float) -> tuple[float, float]:
        """Where it begins and ends along its side of a tank of ``width`` by ``height``, m."""
        along = width if self.side in ("floor", "lid") else height
        return self.start or 0.0, along if self.end is None else self.end

    def faults(self, key: str, width: float, height: float, spacing: float) -> list[Fault]:
        """What is wrong with it in a tank of ``width`` by ``height``, m, with particles of a ``spacing``, m."""
        start, end = self.reach(width, height)
        longest = width if self.side in ("floor", "lid") else height
        if end > longest * (1.0 + 1e-9):
            return [Fault(f"{key}.end", end, "lies beyond the side", "m", f"<= {longest:g}")]
        if end - start < 2.0 * spacing * (1.0 - 1e-9):
            return [Fault(f"{key}.end", end, "leaves fewer than 2 particles along it", "m",
                          f">= {start + 2.0 * spacing:g}")]  # fmt: skip
        highest = {"floor": 0.0, "lid": height}.get(self.side, end)
        if self.head < highest * (1.0 - 1e-9):
            return [Fault(f"{key}.head", self.head, "would have the water at the face pull", "m", f">= {highest:g}",
                          "raise it, or end the face below it")]  # fmt: skip
        return []

    def along(self, width: float, height: float, spacing: float) -> Floats:
        """Places (n, 2) m of the particles beside it in a tank of ``width`` by ``height``, m, of a ``spacing``, m."""
        start, end = self.reach(width, height)
        there = np.arange(start + 0.5 * spacing, end, spacing)
        at = {"left": 0.5 * spacing, "right": width - 0.5 * spacing, "floor": 0.5 * spacing,
              "lid": height - 0.5 * spacing}[self.side]  # fmt: skip
        across = np.full(len(there), at)
        return np.column_stack((there, across) if self.side in ("floor", "lid") else (across, there))


def face_faults(
    faces: Sequence[FaceSection], soil: SoilSection | None, lid: bool, size: tuple[float, float], spacing: float
) -> list[Fault]:
    """What is wrong with the faces of a tank of a ``size`` (width, height), m, with particles of a ``spacing``, m."""
    found = []
    for k, it in enumerate(faces):
        key = f"face[{k}]"
        wrong = it.faults(key, *size, spacing)
        found += wrong
        if soil is None or not soil.saturated:
            found.append(Fault(key, "given", "needs ground whose pores are full",
                               repair="add [soil] and soil.saturated = true"))  # fmt: skip
        elif not wrong and not np.any([body.holds(it.along(*size, spacing)) for body in soil.body], axis=0).all():
            found.append(Fault(key, it.side, "is not along ground all the way", repair="give start and end, or let "
                               "soil.body reach the side"))  # fmt: skip
        if it.side == "lid" and not lid:
            found.append(Fault(f"{key}.side", "lid", "is that of an open tank", repair="give tank.lid = true"))
        for j, other in enumerate(faces[:k]):
            (start, end), (begin, stop) = it.reach(*size), other.reach(*size)
            if other.side == it.side and min(end, stop) - max(start, begin) > 0.5 * spacing:
                found.append(Fault(key, it.side, f"overlaps face[{j}]", repair="move or shorten one of them"))
            if it.name and other.name == it.name:
                found.append(Fault(f"{key}.name", it.name, "is that of another face", repair="rename it"))
    return found
