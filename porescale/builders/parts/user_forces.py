"""Forces on grains that functions of the user's give: added to their weight, less buoyancy, in every step."""

import numpy as np

from porescale.builders.parts.clouds import GrainCloud
from porescale.builders.parts.grains import GrainsPart
from porescale.builders.stepper import Clock, Stepper
from porescale.common.api.hooks import ForceHook
from porescale.common.record.part import Part
from porescale.coupling.step import Coupled


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
