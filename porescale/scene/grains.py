"""[grains] and [[grains.grain]]: a packing, grains placed by hand, or both."""

from typing import Any

import pydantic

from porescale.common.schema.sections import Section, quantity
from porescale.scene.circles import Circles, with_circles
from porescale.scene.packing import Packing
from porescale.scene.ranges import DENSITY, LENGTH, PLACE, SPEED, SPIN

DEEPEST = 0.1
"""Overlap over the smaller diameter in which grains placed by hand may start at most."""


class Grain(Section):
    """One grain, placed by hand."""

    x: float = quantity("m", **PLACE, help="centre")
    y: float = quantity("m", **PLACE, help="centre")
    diameter: float = quantity("m", **LENGTH, help="diameter")
    velocity: tuple[float, float] = quantity("m/s", (0.0, 0.0), **SPEED, help="velocity at the start")
    spin: float = quantity("rad/s", 0.0, **SPIN, help="angular velocity at the start, counter-clockwise")
    material: str = pydantic.Field("", description="name of its material (default: the first)")


class Grains(Section):
    """The grains: a packing, grains placed by hand, or both."""

    density: float = quantity("kg/m^3", **DENSITY, help="density of the grains")
    hydraulic_radius_ratio: float | None = quantity(
        "", None, ge=0.01, le=1, help="radius that the fluid sees over the mechanical radius, 0.7 to 0.9 in dense beds"
    )
    packing: Packing | None = None
    overlap: float = quantity(
        "",
        1e-3,
        ge=0,
        le=DEEPEST,
        help="overlap over diameter up to which grains placed by hand may start (circles: 0.02)",
    )
    grain: tuple[Grain, ...] = ()
    circles: Circles | None = None

    @pydantic.model_validator(mode="before")
    @classmethod
    def _from_file(cls, table: Any, info: pydantic.ValidationInfo) -> Any:
        return with_circles(table, (info.context or {}).get("folder"))
