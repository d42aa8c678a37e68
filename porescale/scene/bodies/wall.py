"""[[wall]]: free straight walls without end, for dry grains."""

import math
from typing import ClassVar

import pydantic

from porescale.common.core.errors import Fault
from porescale.common.schema.sections import quantity
from porescale.scene.servo import SERVO, check_servo
from porescale.scene.time_function import Timed, TimeFunction


class Wall(Timed):
    """A straight wall without end, solid behind: it stands, moves and turns as prescribed, or the grains press on it.

    stress, force : it moves along its normal, no faster than ``fastest``, so that the grains press on it so, > 0 for
    compression.  Dry scenes only.
    """

    name: str = pydantic.Field("", description="name in the columns (default: wall and its number)")
    x: float = quantity("m", ge=-1e3, le=1e3, help="point of the wall, about which it turns")
    y: float = quantity("m", ge=-1e3, le=1e3, help="point of the wall, about which it turns")
    normal: tuple[float, float] = quantity("", ge=-1e6, le=1e6, help="direction towards the grains, of any length")
    friction: float | None = quantity("", None, ge=0, le=1e3, help="friction coefficient (default: that of the sides)")
    velocity_x: TimeFunction | None = None
    velocity_y: TimeFunction | None = None
    turning: TimeFunction | None = None
    stress: TimeFunction | None = None
    force: TimeFunction | None = None
    fastest: float | None = quantity("m/s", None, gt=0, le=1e4, help="largest speed under stress or force")
    length: float | None = quantity("m", None, ge=1e-9, le=1e3, help="length over which a stress acts")

    UNITS: ClassVar[dict[str, tuple[str, str]]] = {
        "velocity_x": ("m/s", "velocity"), "velocity_y": ("m/s", "velocity"), "turning": ("rad/s", "rotation"), **SERVO,
    }  # fmt: skip

    def _faults(self) -> list[Fault]:
        faults = check_servo(self, self.moves)
        if not math.hypot(*self.normal) > 0.0:
            faults.append(Fault("normal", "(0, 0)", "has no length", repair="point it towards the grains"))
        if (self.stress is None) != (self.length is None):
            problem = "is needed for a stress" if self.stress else "belongs to a wall with stress"
            faults.append(Fault("length", self.length, problem, "m", repair="give both, or neither"))
        return faults

    @property
    def moves(self) -> bool:
        """Whether the wall has a prescribed velocity."""
        return any(it is not None for it in (self.velocity_x, self.velocity_y, self.turning))
