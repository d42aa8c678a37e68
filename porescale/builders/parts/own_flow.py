"""What a user's functions prescribe of the flow, step by step: a body force, and velocities of sides."""

from typing import Any

from porescale.builders.system import System
from porescale.common.compiled.own import OwnLaw
from porescale.common.compiled.own_kernel import kernel_of
from porescale.common.record.part import Part
from porescale.lbm.own import Fill, force_filler, side_filler


class OwnForce(Part):
    """A body force of every cell, as it is at the time reached: half of it acts there before, half after a step."""

    def __init__(self, system: System) -> None:
        section, fluid, scales = system.scene.fluid, system.fluid, system.derived.scales
        assert section
        assert fluid
        assert scales
        law = section.body_force
        assert isinstance(law, OwnLaw)
        self.clock, self.fluid = system.clock, fluid
        self.steady = law.function.__code__.co_argcount == 2
        shape, dtype = (fluid.ny, fluid.nx), fluid.populations.dtype
        self.fill = force_filler(kernel_of(law.function), scales, shape, dtype, steady=self.steady)
        fluid.set_force_field(self.fill(0.0))

    def after(self) -> None:
        """Take the force at the time reached."""
        if not self.steady:
            self.fill(self.clock.time)

    def restore(self, state: dict[str, Any]) -> None:
        """Take the force at the time of the checkpoint: it depends on nothing else."""
        self.fill(self.clock.time)


class OwnInflow(Part):
    """Velocities of sides in the middle of each step."""

    def __init__(self, system: System) -> None:
        fluid, scales = system.fluid, system.derived.scales
        assert fluid
        assert scales
        self.clock, self.fluid = system.clock, fluid
        self.sides: dict[str, Fill] = {}
        for name, side in system.scene.domain.sides.items():
            if isinstance(side.velocity, OwnLaw):
                cells = fluid.ny if name in ("left", "right") else fluid.nx
                self.sides[name] = side_filler(kernel_of(side.velocity.function), scales, cells)
        self.before()

    def before(self) -> None:
        """Take the velocities half a step from now."""
        for name, fill in self.sides.items():
            self.fluid.set_side_velocity(name, fill(self.clock.time + 0.5 * self.clock.seconds))
