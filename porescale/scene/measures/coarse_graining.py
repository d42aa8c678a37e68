"""[coarse_graining]: fields of the grains in snapshots."""

from typing import Literal

import pydantic

from porescale.common.core.errors import Fault
from porescale.common.schema.sections import Section, quantity
from porescale.scene.ranges import LENGTH

GrainField = Literal["density", "solid_fraction", "velocity", "strain_rate", "stress", "kinetic_stress"]


class CoarseGraining(Section):
    """Fields of the grains in snapshots, in grain_fields.vtkhdf: every grain and contact spread by a smooth kernel.

    Compression is positive.  Mass is kept: what the kernel would put behind a wall lies before it.  Held bodies are
    solid, but have no mass: density, velocity, strain rate and kinetic stress are of the grains alone.
    """

    spacing: float = quantity("m", **LENGTH, help="distance between the points at which fields are taken, about")
    width: float | None = quantity(
        "m", None, **LENGTH, help="radius within which a grain is felt (default: 2.5 mean diameters, or 1.5 largest)"
    )
    fields: tuple[GrainField, ...] = pydantic.Field(
        ("solid_fraction", "velocity", "stress"), min_length=1, description="which fields"
    )

    def _faults(self) -> list[Fault]:
        if self.width is not None and self.width < self.spacing:
            repair = "widen it, to some grains, or take the points closer"
            problem = "is less than the spacing: grains would fall between the points"
            return [Fault("width", self.width, problem, "m", f">= {self.spacing:g}", repair)]
        return []
