"""[[line]] and [[flux]]: straight sections along which the fluid is recorded, or through which it flows."""

import pydantic

from porescale.common.core.errors import Fault
from porescale.common.schema.sections import Section, quantity
from porescale.scene.ranges import PLACE


class Segment(Section):
    """A straight section between two points."""

    name: str = pydantic.Field("", description="name in the columns (default: its number)")
    start: tuple[float, float] = quantity("m", **PLACE, help="first point")
    end: tuple[float, float] = quantity("m", **PLACE, help="last point")

    def _faults(self) -> list[Fault]:
        if self.start == self.end:
            return [Fault("end", None, "is the same as start", "m", repair="move one of them")]
        return []


class Line(Segment):
    """A straight line along which velocity and pressure are recorded at every snapshot: lines.csv."""

    name: str = pydantic.Field("", description="a note: lines.csv has the number of a line, from 0")
    points: int = pydantic.Field(101, ge=2, le=100_000, description="points along the line, both ends included")


class Flux(Segment):
    """A straight section through which the volume flux is recorded over time: flux.csv.

    Positive from left to right seen in the direction from ``start`` to ``end``: upwards means to the right.
    """
