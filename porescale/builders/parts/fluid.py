"""The fluid of a scene without grains: its steps, its fields in snapshots, and checks of its state."""

from typing import Any

import numpy as np

from porescale.builders.initial.fluid_options import weight_of
from porescale.builders.parts.flow_fields import UNITS, derived_fields, plain_row, total_pressure
from porescale.builders.stepper import Fields, Row, Stepper
from porescale.builders.system import System
from porescale.common.core.errors import Unstable
from porescale.common.core.types import AnyArray
from porescale.common.record.model import Grid, Snapshot
from porescale.coupling.divergence_check import DivergenceCheck


class FluidPart(Stepper):
    """Fluid alone.  mass : excess of the lattice's mass at the start, lattice units."""

    def __init__(self, system: System) -> None:
        fluid, scales, section = system.fluid, system.derived.scales, system.scene.fluid
        assert fluid
        assert scales
        assert section
        self.clock, self.fluid, self.scales = system.clock, fluid, scales
        self.sense = DivergenceCheck(
            fluid, scales, system.coupled, operator=section.operator, eddies=bool(section.smagorinsky),
            solid_operator=section.solid_operator, weighting=weight_of(section),
        )  # fmt: skip
        self.gravity, self.names = system.scene.gravity, system.scene.output.fields
        self.mass = fluid.totals().mass

    def advance(self) -> None:
        """Advance the fluid by one lattice step."""
        self.fluid.advance()

    def explained(self, error: Unstable) -> Unstable:
        """Where fluid and grains both diverge, the error names the fluid: it is the cause."""
        self.sense.check(self.clock.step, self.clock.time)
        return self.clock.in_steps(error)

    def fields(self) -> Fields:
        """Density excess, velocity, and nothing solid."""
        rho, ux, uy = self.fluid.fields()
        s = self.scales
        return (rho - 1) * s.density, ux * s.velocity, uy * s.velocity, np.zeros_like(rho)

    def flow_row(self) -> tuple[Row, float]:
        """Columns of the fluid in the series, and the excess of the lattice's mass."""
        totals = self.fluid.totals()
        return plain_row(totals, self.scales), totals.mass

    def check(self) -> None:
        """Raise Unstable where the fluid is not finite or out of bounds."""
        self.sense.check(self.clock.step, self.clock.time)

    def show(self, snapshot: Snapshot) -> None:
        """The grid of fields."""
        excess, ux, uy, solid = self.fields()
        velocity = np.zeros((*ux.shape, 3), np.float32)
        velocity[..., 0], velocity[..., 1] = ux, uy
        pressure = total_pressure(self.gravity, self.scales, excess).astype(np.float32)
        cells: dict[str, AnyArray] = {"velocity": velocity, "pressure": pressure, **self._solid(solid)}
        cells |= derived_fields(self.names, self.fluid, ux, uy, self.scales)
        units = {"velocity": "m/s", "pressure": "Pa", **UNITS}
        units = {name: unit for name, unit in units.items() if name in cells}
        snapshot.grids["fields"] = Grid((0.0, 0.0), (self.scales.spacing, self.scales.spacing), cells, units)

    def _solid(self, solid: AnyArray) -> dict[str, AnyArray]:
        """Fields of what is solid in cells."""
        return {}

    def state(self) -> dict[str, Any]:
        """The lattice, and its mass at the start."""
        return {"mass": self.mass, "fluid": self.fluid.state()}

    def restore(self, state: dict[str, Any]) -> None:
        """Restore the state of a checkpoint."""
        self.mass = float(state["mass"])
        self.fluid.restore(state["fluid"])
