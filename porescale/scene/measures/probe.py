"""[[probe]]: points where the fluid is recorded."""

import pydantic

from porescale.common.schema.sections import Section, quantity
from porescale.scene.ranges import PLACE


class Probe(Section):
    """A point where pressure and velocity are recorded over time: probes.csv."""

    name: str = pydantic.Field("", description="name in the columns (default: its number)")
    x: float = quantity("m", **PLACE, help="place")
    y: float = quantity("m", **PLACE, help="place")
