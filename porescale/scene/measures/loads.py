"""[loads]: bodies whose load from the fluid is recorded."""

import pydantic

from porescale.common.core.errors import Fault
from porescale.common.schema.sections import Section, quantity
from porescale.scene.ranges import LENGTH


class Loads(Section):
    """Chosen bodies whose force and torque from the fluid are recorded over time: loads.csv.

    With a speed U and a length L also the coefficients 2 F/(rho U² L): drag along ``direction``, lift to its left.
    """

    discs: tuple[int, ...] = pydantic.Field((), description="numbers of [[disc]] entries, from 0")
    grains: tuple[int, ...] = pydantic.Field((), description="numbers of grains, from 0: the packing's come first")
    rectangles: tuple[int, ...] = pydantic.Field((), description="numbers of [[rectangle]] entries, from 0")
    ring: bool = pydantic.Field(False, description="the [ring], too")
    speed: float | None = quantity("m/s", None, ge=1e-12, le=1e4, help="reference speed of the coefficients")
    length: float | None = quantity("m", None, **LENGTH, help="reference length of the coefficients")
    direction: tuple[float, float] = quantity("", (1.0, 0.0), ge=-1, le=1, help="direction of drag")

    def _faults(self) -> list[Fault]:
        faults = []
        if not (self.discs or self.grains or self.rectangles or self.ring):
            faults.append(Fault("discs, grains, rectangles", None, "name no body", repair="write discs = [0], say"))
        if (self.speed is None) != (self.length is None):
            faults.append(Fault("speed, length", None, "coefficients need both", repair="give both, or leave both out"))
        if self.direction == (0.0, 0.0):
            faults.append(Fault("direction", None, "has no length", repair="write [1, 0]"))
        return faults
