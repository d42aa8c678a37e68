"""The fluid in series.csv."""

from porescale.builders.parts.flow_fields import ratio_column
from porescale.builders.parts.fluid import FluidPart
from porescale.builders.stepper import Row
from porescale.builders.system import System
from porescale.common.record.part import Part


class FlowSeries(Part):
    """Energy, speeds and densities of the fluid, and the change of its mass."""

    def __init__(self, system: System) -> None:
        self.fluid, self.first = system.part(FluidPart), ratio_column(system.scene.grains)

    def row(self) -> Row:
        """Columns of the fluid in series.csv.

        fluid mass change () : since the start, over the mass of a box full of fluid
        """
        part, lattice = self.fluid, self.fluid.fluid
        columns, mass = part.flow_row()
        return {**columns, **self.first, "fluid mass change ()": (mass - part.mass) / (lattice.nx * lattice.ny)}
