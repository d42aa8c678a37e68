"""[[disc]]: discs that are held, or move at a given velocity."""

import math
from typing import ClassVar

import pydantic

from porescale.common.core.errors import Fault
from porescale.common.schema.sections import quantity
from porescale.scene.ranges import LENGTH, PLACE, SPEED
from porescale.scene.time_function import Timed, TimeFunction


class Disc(Timed):
    """A disc that is held: fixed where it is, towed with a velocity and a spin that nothing changes, or moved by
    functions of time, as a cylinder that oscillates.

    In the fluid it has its full radius.  It pushes grains and is not pushed.
    """

    x: float = quantity("m", **PLACE, help="centre at the start")
    y: float = quantity("m", **PLACE, help="centre at the start")
    diameter: float = quantity("m", **LENGTH, help="diameter")
    velocity: tuple[float, float] = quantity("m/s", (0.0, 0.0), **SPEED, help="velocity; [0, 0] is a fixed disc")
    spin: float = quantity("rad/s", 0.0, ge=-1e7, le=1e7, help="angular velocity, counter-clockwise")
    velocity_x: TimeFunction | None = None
    velocity_y: TimeFunction | None = None
    turning: TimeFunction | None = None
    material: str = pydantic.Field("", description="name of its material (default: that of the walls)")

    UNITS: ClassVar[dict[str, tuple[str, str]]] = {
        "velocity_x": ("m/s", "velocity"), "velocity_y": ("m/s", "velocity"), "turning": ("rad/s", "rotation"),
    }  # fmt: skip

    def _faults(self) -> list[Fault]:
        faults = []
        for key, constant, given in (
            ("velocity_x", "velocity", self.velocity[0] != 0.0), ("velocity_y", "velocity", self.velocity[1] != 0.0),
            ("turning", "spin", self.spin != 0.0),
        ):  # fmt: skip
            if getattr(self, key) is not None and given:
                faults.append(Fault(key, None, f"and {constant} cannot both be given", repair="give one of them"))
        for key, (unit, _) in self.UNITS.items():
            function, most = getattr(self, key), 1e7 if key == "turning" else SPEED["le"]
            if function is not None and function.largest > most:
                faults.append(Fault(key, function.largest, "is out of range", unit, f"<= {most:g}"))
        return faults

    @property
    def timed(self) -> bool:
        """Whether a function of time moves it."""
        return any(it is not None for it in (self.velocity_x, self.velocity_y, self.turning))

    @property
    def fastest(self) -> float:
        """Largest speed of its rim, m/s; of components that change with time, each at its largest."""
        x, y, spin = (
            it.largest if it else abs(constant)
            for it, constant in (
                (self.velocity_x, self.velocity[0]), (self.velocity_y, self.velocity[1]), (self.turning, self.spin),
            )
        )  # fmt: skip
        return math.hypot(x, y) + spin * self.diameter / 2

    @property
    def stays(self) -> bool:
        """Whether its centre stays where it is; it may turn."""
        given = zip((self.velocity_x, self.velocity_y), self.velocity, strict=True)
        return all((it.largest if it else constant) == 0.0 for it, constant in given)

    def motion(self, time: float) -> tuple[float, float, float]:
        """Velocity (m/s) and spin (rad/s) at ``time`` (s)."""
        x, y, spin = self.velocity_x, self.velocity_y, self.turning
        return (
            x.value(time) if x else self.velocity[0],
            y.value(time) if y else self.velocity[1],
            spin.value(time) if spin else self.spin,
        )

    def travelled(self, time: float) -> tuple[float, float, float]:
        """How far it has gone (m) and turned (rad) at ``time`` (s)."""
        x, y, spin = self.velocity_x, self.velocity_y, self.turning
        return (
            x.integral(time) if x else self.velocity[0] * time,
            y.integral(time) if y else self.velocity[1] * time,
            spin.integral(time) if spin else self.spin * time,
        )
