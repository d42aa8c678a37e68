"""[look]: how pictures and films of a run show it; nothing of it changes the physics."""

import pydantic

from porescale.common.core.errors import Fault
from porescale.common.schema.sections import Section, quantity


class LookSection(Section):
    """What the pictures of a run show where they are not asked for something else; `show` has the same words.

    What is left out is as always: the fluid's speed with the grains in it, or what colours particles best.
    """

    field: str = pydantic.Field("", description="array of the fluid's cells that is painted, as velocity or pressure")
    colour: str = pydantic.Field("", description="array that colours grains or particles, as velocity or spin")
    limits: tuple[float, float] | None = pydantic.Field(
        None, description="range of the painted colours, SI units of the array (default: from its values)"
    )
    colour_limits: tuple[float, float] | None = pydantic.Field(
        None, description="range of the colours of grains or particles, likewise"
    )
    arrows: int = pydantic.Field(0, ge=0, le=500, description="arrows of the velocity across the picture")
    view: tuple[float, float, float, float] | None = quantity(
        "m", None, ge=-1e3, le=1e5, help="part of the box to show, [left, right, bottom, top]"
    )
    size: int = pydantic.Field(1000, ge=200, le=8000, description="long side of pictures and films, pixels")

    def _faults(self) -> list[Fault]:
        faults = [
            Fault(key, str(pair), "must be [low, high]", repair="exchange them")
            for key in ("limits", "colour_limits")
            if (pair := getattr(self, key)) is not None and not pair[0] < pair[1]
        ]
        if self.view is not None and not (self.view[0] < self.view[1] and self.view[2] < self.view[3]):
            faults.append(Fault("view", str(self.view), "must be [left, right, bottom, top]", "m", repair="order them"))
        return faults
