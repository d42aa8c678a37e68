"""What is measured on grains, as sections: rectangular regions, and fields by coarse graining."""

from __future__ import annotations

from typing import Any, Literal

import pydantic

from porescale.common.core.errors import Fault
from porescale.common.schema.sections import Refused, Section, quantity

PLACE: Any = {"ge": -1e3, "le": 1e3}
LENGTH: Any = {"ge": 1e-9, "le": 1e3}
GrainField = Literal["density", "solid_fraction", "velocity", "strain_rate", "stress", "kinetic_stress"]


class Region(Section):
    """A rectangle in which porosity, stress, fabric and motion of the grains are recorded over time: regions.csv.

    XX
    """

    name: str = pydantic.Field("", description="name in the columns (default: its number)")
    lower: tuple[float, float] = quantity("m", **PLACE, help="lower left corner")
    upper: tuple[float, float] = quantity("m", **PLACE, help="upper right corner")

    @pydantic.model_validator(mode="after")
    def _has_area(self) -> Region:
        if not (self.lower[0] < self.upper[0] and self.lower[1] < self.upper[1]):
            problem = "must lie right of and above the lower corner"
            given, allowed = f"({self.upper[0]:g}, {self.upper[1]:g})", f"> ({self.lower[0]:g}, {self.lower[1]:g})"
            raise Refused(Fault("upper", given, problem, "m", allowed, "swap or move the corners"))
        return self


class CoarseGraining(Section):
    """Fields of the grains in snapshots, in grain_fields.vtkhdf: every grain and contact spread by a smooth kernel.

    Compression is positive.  Mass is kept: what the kernel would put behind a wall lies before it.
    """

    spacing: float = quantity("m", **LENGTH, help="distance between the points at which fields are taken, about")
    width: float | None = quantity(
        "m", None, **LENGTH, help="radius within which a grain is felt (default: 2.5 mean diameters)"
    )
    fields: tuple[GrainField, ...] = pydantic.Field(
        ("solid_fraction", "velocity", "stress"), min_length=1, description="which fields"
    )

    @pydantic.model_validator(mode="after")
    def _resolved(self) -> CoarseGraining:
        if self.width is not None and self.width < self.spacing:
            repair = "widen it, to some grains, or take the points closer"
            problem = "is less than the spacing: grains would fall between the points"
            raise Refused(Fault("width", self.width, problem, "m", f">= {self.spacing:g}", repair))
        return self
