"""[gate]: an upright plate that opens."""

from porescale.common.schema.sections import Section, quantity
from porescale.scene.ranges import FRICTION, LENGTH


class Gate(Section):
    """An upright plate without thickness, over the whole height, that holds grains and water until it opens."""

    x: float = quantity("m", **LENGTH, help="place of the gate")
    opens_at: float = quantity("s", 0.0, ge=0, le=1e9, help="time at which it opens")
    lift_speed: float | None = quantity(
        "m/s", None, ge=1e-9, le=1e4, help="speed at which it rises; left out, it vanishes at once"
    )
    friction: float = quantity("", 0.0, **FRICTION, help="friction coefficient between gate and grains")
