"""The sections of what is measured in a tank."""

import pydantic

from porescale.common.schema.sections import Section, quantity


class ProbeSection(Section):
    """A point where pressure and velocity of the water are recorded over time: probes.csv."""

    name: str = pydantic.Field("", description="name in the columns (default: its number)")
    x: float = quantity("m", ge=0, le=1e5, help="place")
    y: float = quantity("m", ge=0, le=1e5, help="place")


class LevelSection(Section):
    """A strip in which the height of the free surface is recorded over time: levels.csv."""

    name: str = pydantic.Field("", description="name in the columns (default: its number)")
    x: float = quantity("m", ge=0, le=1e5, help="middle of the strip")
    breadth: float | None = quantity("m", None, ge=1e-6, le=1e5, help="breadth of the strip (default: 4 spacings)")
