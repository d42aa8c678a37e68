"""Fluid and grains together."""

from typing import Any

import numpy as np

from porescale.builders.parts.flow_fields import fluid_row
from porescale.builders.parts.fluid import FluidPart
from porescale.builders.stepper import Fields, Row
from porescale.builders.system import System
from porescale.common.core.errors import Unstable
from porescale.common.core.types import AnyArray


class CoupledPart(FluidPart):
    """A step of the fluid, with as many contact steps of the grains as go into it."""

    def __init__(self, system: System) -> None:
        super().__init__(system)
        assert system.coupled
        self.coupled = system.coupled
        self.mass = self.fluid.mass_excess()

    def advance(self) -> None:
        """Advance fluid and grains by one step of the fluid."""
        self.coupled.advance()

    def fields(self) -> Fields:
        """Velocity and pressure fields of the fluid between the grains."""
        return self.coupled.fields()

    def flow_row(self) -> tuple[Row, float]:
        """Columns of the fluid between the grains in the series, and the excess of the lattice's mass."""
        return fluid_row(*self.fields(), self.scales), self.fluid.mass_excess()

    def check(self) -> None:
        """Raise Unstable where fluid or grains are not finite or out of bounds; of both, the fluid is named."""
        fault = None
        try:
            self.coupled.grains.check()
        except Unstable as error:
            fault = self.clock.in_steps(error)
        super().check()
        if fault:
            raise fault

    def _solid(self, solid: AnyArray) -> dict[str, AnyArray]:
        """The solid fraction of every cell, as float32."""
        return {"solid_fraction": solid.astype(np.float32)}

    def state(self) -> dict[str, Any]:
        """Both, and the mass of the lattice at the start."""
        return {"mass": self.mass, "coupled": self.coupled.state()}

    def restore(self, state: dict[str, Any]) -> None:
        """Restore the state of a checkpoint."""
        self.mass = float(state["mass"])
        self.coupled.restore(state["coupled"])
