"""The section of the air in the pores of a scene's soil."""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal

import pydantic

from continuum_sph.water.eos.register import offered
from porescale.common.schema.sections import Section, quantity

if TYPE_CHECKING:
    GasName = str
else:
    GasName = Literal[tuple(offered(gas=True))]


class AirSection(Section):
    """A gas in all pores that hold no water at the start, which water has to drive out or compress.

    law : "adiabatic", "printed" (eqs 39, 40), or another gas of `continuum_sph.water.eos`;  pressure : of the room, at
    which it has its density and from which pressures count.  Where there is neither soil nor water there is nothing:
    the room, which air that leaves goes to.  Density is a numerical choice as the soil's stiffness is: as long as air
    weighs little beside water its drag, not its inertia, holds it, and heavier air allows longer steps.
    """

    density: float = quantity("kg/m^3", 1.207, ge=1e-2, le=100, help="density under the pressure of the room")
    viscosity: float = quantity("Pa s", 1.810e-5, ge=1e-9, le=1e3, help="viscosity: air passes soil as much easier")
    law: GasName = pydantic.Field(default="adiabatic", description="equation of state of the gas")
    pressure: float = quantity("Pa", 1e5, ge=1.0, le=1e9, help="pressure of the room")
    exponent: float = quantity("", 1.403, ge=1.01, le=3, help="ratio of the specific heats")
