"""[[control]]: components of a body that move, or are pushed, as prescribed."""

import pydantic

from porescale.common.core.errors import Fault
from porescale.common.schema.sections import Section
from porescale.scene.time_function import Component, Turning

BODIES = ("grain", "clump", "segment", "polygon")
"""What can be controlled."""


class Controlled(Section):
    """Control of one body: each of x, y, rotation "free", or with a prescribed velocity, displacement or force.

    A body with a prescribed velocity or displacement in all three is none of the grains that series.csv, regions and
    coarse graining are of, as a held disc is none; it is solid.
    record = true: force and displacement in control.csv; what a control gives is what contacts, weight and fluid take.
    """

    grain: int | None = pydantic.Field(None, ge=0, description="number of the grain: packing first, then by hand")
    clump: int | None = pydantic.Field(None, ge=0, description="number of the clump, copies one after the other")
    segment: int | None = pydantic.Field(None, ge=0, description="number of the body of segments, likewise")
    polygon: int | None = pydantic.Field(None, ge=0, description="number of the polygon, likewise")
    name: str = pydantic.Field("", description="name in the columns (default: what it is and its number)")
    x: Component = Component()
    y: Component = Component()
    rotation: Turning = Turning()
    record: bool = pydantic.Field(False, description="force and displacement over time in control.csv")

    def _faults(self) -> list[Fault]:
        if sum(getattr(self, kind) is not None for kind in BODIES) != 1:
            repair = "give one of them"
            return [Fault(", ".join(BODIES), None, "exactly one of them is needed", repair=repair)]
        return []

    @property
    def of(self) -> tuple[str, int]:
        """Kind of the body and its number."""
        kind = next(kind for kind in BODIES if getattr(self, kind) is not None)
        return kind, int(getattr(self, kind))

    @property
    def stays(self) -> bool:
        """Whether the body stays where it is; it may turn."""
        return all(it.prescribes and it.fastest == 0.0 for it in (self.x, self.y))

    @property
    def called(self) -> str:
        """Name of the body in the columns of forces.csv."""
        kind, number = self.of
        return self.name or f"{kind} {number}"
