"""What functions of a user prescribe: forces on grains, a body force on the fluid, velocities of sides."""

from typing import Any

import numpy as np

from porescale.builders.parts.clouds import GrainCloud
from porescale.builders.parts.grains import GrainsPart
from porescale.builders.stepper import Clock, Stepper
from porescale.builders.system import System
from porescale.common.api.hooks import ForceHook
from porescale.common.compiled.own import OwnLaw
from porescale.common.compiled.own_kernel import kernel_of
from porescale.common.record.part import Part
from porescale.coupling.step import Coupled
from porescale.lbm.own import Fill, force_filler, side_filler


class UserForces(Part):
    """Calls all force hooks at the begin of a step; the force is the same in all contact steps of a fluid step.

    hooks : in the order in which they act;  cloud : of the discs;  held : how many discs, the last ones, are held: what
    is written for them is left out.
    """

    def __init__(self, stepper: Stepper, coupled: Coupled | None, cloud: GrainCloud, held: int) -> None:
        self.hooks: list[ForceHook] = []
        self.clock: Clock = stepper.clock
        self.motion, self.count, self.free = cloud.motion, cloud.count, cloud.count - held
        if coupled is not None:
            self.weight = coupled.weight
            self.total = coupled.immersed.weight = self.weight.copy()
        else:
            assert isinstance(stepper, GrainsPart)
            assert stepper.weight is not None
            self.weight = stepper.weight
            self.total = stepper.weight = self.weight.copy()
        self._shown: tuple[object, object] = (None, None)

    def before(self) -> None:
        """The forces at the positions that the step begins with."""
        shown = self.motion()
        if shown[0] is not self._shown[0] or shown[1] is not self._shown[1]:
            self._shown = shown
            self.views = [values[: self.count] for values in shown]
            for view in self.views:
                view.flags.writeable = False
        clock, total, free = self.clock, self.total, self.free
        np.copyto(total, self.weight)
        for hook in self.hooks:
            force = hook.call(clock.step, clock.time, *self.views)
            total[:free] += force[:free]


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
