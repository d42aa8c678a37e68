"""The section of a sheet pile."""

import math
from typing import Literal

import pydantic

from continuum_sph.scene.bounds import WHOLE
from porescale.common.core.errors import Fault
from porescale.common.schema.sections import Section, quantity


class SheetPileSection(Section):
    """A rigid, impermeable sheet that stands in soil and water, from its tip to the top of the tank.

    faces : whether they "hold" the soil or let it "slip".  One column of particles stands for it, which ends a row
    above that of the tip; the flow of water is that of a sheet down to the tip (`continuum_sph.seepage.sheet_pile`).
    """

    x: float = quantity("m", ge=0, le=1e5, help="place of the pile, in the column that holds x")
    tip: float = quantity("m", ge=0, le=1e5, help="height of its lower end; soil has it to the nearest row")
    faces: Literal["slip", "hold"] = pydantic.Field(default="slip", description="whether the faces hold the soil")

    def column(self, spacing: float) -> float:
        """Middle (m) of the column of particles of a ``spacing`` (m) that stands for it."""
        return (math.floor(self.x / spacing + 1e-9) + 0.5) * spacing

    def lower_end(self, spacing: float) -> float:
        """Height (m) at which that column ends, a row above the edge nearest the tip."""
        return (round(self.tip / spacing) + 1) * spacing

    def faults(self, width: float, height: float, spacing: float) -> list[Fault]:
        """What is wrong with it in a tank of ``width`` by ``height``, m, with particles of a ``spacing``, m."""
        found = []
        if width < (9.0 - WHOLE) * spacing:
            found.append(Fault("numerics.spacing", spacing, "leaves fewer than 4 particles on each side of the pile",
                               "m", f"<= {width / 9.0:g}"))  # fmt: skip
        elif not 4.0 * spacing < self.column(spacing) < width - 4.0 * spacing:
            found.append(Fault("pile.x", self.x, "leaves fewer than 4 particles beside it", "m",
                               f"{4.5 * spacing:g} to {width - 4.5 * spacing:g}"))  # fmt: skip
        if self.lower_end(spacing) > height - 2.0 * spacing:
            found.append(Fault("pile.tip", self.tip, "leaves nothing of it in the tank", "m",
                               f"<= {height - 3.0 * spacing:g}"))  # fmt: skip
        return found
