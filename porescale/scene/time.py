"""[time]: how long a run lasts."""

from porescale.common.schema.sections import Section, quantity
from porescale.scene.ranges import TIME


class Time(Section):
    """How long a run lasts."""

    end: float = quantity("s", **TIME, help="physical time to simulate")
