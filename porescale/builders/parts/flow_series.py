"""The fluid in series.csv."""

from porescale.builders.parts.flow_fields import LAMBDA, fluid_row
from porescale.builders.parts.fluid import FluidPart
from porescale.builders.stepper import Row
from porescale.builders.system import System
from porescale.common.record.part import Part


class FlowSeries(Part):
    """Energy, speeds and densities of the fluid, and the change of its mass."""

    def __init__(self, fluid: FluidPart, ratio: float | None) -> None:
        """``ratio`` : hydraulic radius ratio of the grains, which every record of them carries; None: none."""
        self.fluid = fluid
        self.first: Row = {LAMBDA: ratio} if ratio else {}

    @classmethod
    def build(cls, system: System, fluid: FluidPart) -> "FlowSeries":
        """The part of a system with fluid."""
        grains = system.scene.grains
        return cls(fluid, grains.hydraulic_radius_ratio if grains else None)

    def row(self) -> Row:
        """Columns of the fluid in series.csv."""
        part, lattice = self.fluid, self.fluid.fluid
        change = (lattice.mass_excess() - part.mass) / (lattice.nx * lattice.ny)
        return {**fluid_row(*part.fields(), part.scales), **self.first, "fluid mass change ()": change}
