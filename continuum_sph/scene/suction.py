"""The section of suction: soil whose pores may be partly full."""

from typing import TYPE_CHECKING

from continuum_sph.scene.bounds import WHOLE
from porescale.common.core.errors import Fault
from porescale.common.schema.sections import Section, quantity

if TYPE_CHECKING:
    from typing import Any


class SuctionSection(Section):
    """Retention of van Genuchten 1980, relative permeability of Mualem 1976, a share of ``soil.permeability``, Bishop's
    effective stress with χ = S_e.

    S = S_r + (1 - S_r) [1 + (alpha ψ)^n]^-(1 - 1/n) at a suction of ψ metres of water.  At the start pores have either
    one ``saturation`` everywhere, or are at rest over a ``water_table``.  The water of the pores is then carried by the
    particles of soil, and open water is at rest at the levels of the reservoirs: there are no particles of water.
    """

    alpha: float = quantity("1/m", ge=1e-3, le=1e3, help="alpha of van Genuchten: of the order of one over the fringe")
    n: float = quantity("", ge=1.05, le=20, help="n of van Genuchten: how evenly pores are sized")
    residual: float = quantity("", 0.0, ge=0, le=0.95, help="residual saturation S_r")
    connectivity: float = quantity("", 0.5, ge=-2, le=5, help="l of Mualem's relative permeability")
    saturation: float | None = quantity("", None, gt=0, le=1, help="saturation of all pores at the start")
    water_table: float | None = quantity("m", None, ge=-1e3, le=1e5, help="height over which pores are at rest")

    def faults(self, scene: "Any") -> list[Fault]:
        """What is wrong with it in a ``scene``."""
        key, found = "soil.suction", []
        if (self.saturation is None) == (self.water_table is None):
            found.append(Fault(key, None, "needs a saturation or a water_table, and not both",
                               repair="give one of them"))  # fmt: skip
        if self.saturation is not None and self.saturation <= self.residual:
            found.append(Fault(f"{key}.saturation", self.saturation, "is none that drains to the residual", "",
                               f"> {self.residual:g}"))  # fmt: skip
        if self.water_table is not None and self.water_table > scene.tank.height * (1.0 + WHOLE):
            found.append(Fault(f"{key}.water_table", self.water_table, "lies over the tank", "m",
                               f"<= {scene.tank.height:g}"))  # fmt: skip
        if scene.gravity == 0.0:
            found.append(Fault("gravity", 0.0, "gives suction in metres of water no pressure", "m/s^2", "> 0"))
        for name, there, instead in (
            ("water.column", scene.water.column, "use [[reservoir]] for open water"),
            ("probe", scene.probe, "leave it out: snapshots have pore_pressure and saturation of every particle"),
            ("level", scene.level, "leave it out: the series has the level of every reservoir"),
        ):
            if there:
                found.append(Fault(name, "given", "needs particles of water, which soil with suction has not",
                                   repair=f"{instead}, or take out [soil.suction]"))  # fmt: skip
        for name, there in (("air", scene.air), ("pile", scene.pile), ("inclusion", scene.inclusion)):
            if there is not None:
                found.append(Fault(name, "given", "cannot be with soil.suction", repair="take out one of them"))
        if scene.soil.saturated:
            found.append(Fault("soil.saturated", True, "is said by soil.suction", repair="give water_table"))
        if scene.output.energy:
            found.append(Fault("output.energy", True, "is of particles of water", repair="leave it out"))
        return found
