"""The section of a second fluid in the water."""

from __future__ import annotations

import math
from itertools import combinations
from typing import TYPE_CHECKING, Literal

import pydantic

from continuum_sph.scene.bounds import LARGEST, SMALLEST
from continuum_sph.water.eos.register import offered
from porescale.common.core.errors import Fault
from porescale.common.schema.sections import Section, quantity

if TYPE_CHECKING:
    LawName = str
else:
    LawName = Literal[tuple(offered())]


class Disc(Section):
    """A disc filled with the second fluid at the start."""

    x: float = quantity("m", ge=0, le=LARGEST, help="centre")
    y: float = quantity("m", ge=0, le=LARGEST, help="centre, above the floor")
    radius: float = quantity("m", ge=SMALLEST, le=LARGEST, help="radius")


class InclusionSection(Section):
    """A second fluid, in discs within the water: bubbles or drops.

    Discs that overlap are one body of it; with surface tension they are refused, as it starts with σ/R of each disc.
    law : "liquid" (eq. 41), as stiff as the water unless sound_speed is given; gas under the pressure of the air,
    "adiabatic", or "printed" (eqs 39, 40); or another file of `continuum_sph.water.eos`;  surface_tension : σ against
    the water;  cohesion : a of eq. 54 within it.
    """

    density: float = quantity("kg/m^3", 1.207, ge=1e-2, le=1e5, help="density under the pressure of the air")
    viscosity: float = quantity("Pa s", 1.810e-5, ge=0, le=1e9, help="viscosity")
    law: LawName = pydantic.Field(default="adiabatic", description="equation of state of the second fluid")
    sound_speed: float | None = quantity("m/s", None, ge=1e-3, le=1e6, help="speed of sound of a liquid")
    pressure: float = quantity("Pa", 1e5, ge=1e-3, le=1e9, help="pressure of the air, of a gas")
    exponent: float | None = quantity("", None, ge=1.01, le=20, help="exponent: 7 of a liquid, 1.403 of a gas")
    surface_tension: float = quantity("N/m", 0.0, ge=0, le=1e6, help="surface tension against the water")
    cohesion: float = quantity("Pa m^4", 0.0, ge=0, le=1e6, help="cohesion a of eq. 54")
    disc: tuple[Disc, ...] = pydantic.Field(min_length=1, description="discs of the second fluid")

    def overlaps(self, slack: float) -> list[Fault]:
        """Discs that overlap by more than ``slack`` (m), where surface tension gives each a pressure of its own."""
        found: list[Fault] = []
        if self.surface_tension == 0.0:
            return found
        for (j, other), (i, disc) in combinations(enumerate(self.disc), 2):
            shared = other.radius + disc.radius - math.hypot(disc.x - other.x, disc.y - other.y)
            if shared > slack:
                problem = (
                    f"overlaps inclusion.disc[{j}] by {shared:.3g} m, and surface tension gives each its own pressure"
                )
                found.append(Fault(f"inclusion.disc[{i}]", (disc.x, disc.y), problem, "m",
                                   repair="move them apart, or give one disc in place of both"))  # fmt: skip
        return found
