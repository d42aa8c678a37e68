"""Forces on particles that functions of the user's give: added to accelerations when these are computed."""

from typing import Any

import numpy as np

from continuum_sph.builders.assembly import Particles
from continuum_sph.builders.parts.mixture import MixturePart
from continuum_sph.soil import SoilFlow
from continuum_sph.unsaturated import MoistSoil
from continuum_sph.water.step import Flow
from porescale.common.api.hooks import ForceHook
from porescale.common.core.types import Floats
from porescale.common.record.part import Part


class UserForces(Part):
    """Calls all force hooks once a step, where it computes accelerations: at its end, with velocities of its middle.

    hooks : in the order in which they act;  flow : what moves;  shown : the part whose particles they are.
    """

    def __init__(self, flow: Any, shown: Particles) -> None:
        self.hooks: list[ForceHook] = []
        self.flow, self.shown = flow, shown
        self.added_at: int = flow.step
        flow.before_force = self.add_to_step
        if isinstance(flow, SoilFlow):
            self.base = flow.soil.force.copy()

    def forces(self, time: float) -> Floats:
        """What all hooks give together at a ``time`` (s), (n, 2) N/m."""
        views = [values.view() for values in self.shown.motion()]
        for view in views:
            view.flags.writeable = False
        first, *others = [hook.call(self.flow.step, time, *views) for hook in self.hooks]
        return np.sum([first, *others], axis=0) if others else first

    def before(self) -> None:
        """The accelerations that the first step starts from were computed before there was a hook."""
        if self.added_at != self.flow.step:
            return
        self.added_at = -1
        force = self.forces(self.flow.time)
        if isinstance(self.flow, SoilFlow):
            self.flow.soil.acceleration += force / self.shown.masses()[:, None]
        else:
            self._add(force, start=True)

    def add_to_step(self, flow: Any) -> None:
        """Add to the accelerations, or to the force on the soil, at the end of the step that is being done."""
        force = self.forces(flow.time + flow.next_step)
        if isinstance(flow, SoilFlow):
            np.add(self.base, force, out=flow.soil.force)
        else:
            self._add(force, start=False)

    def _add(self, force: Floats, *, start: bool) -> None:
        """Accelerations of the water; the soil's, or the force on it, which `Seepage.accelerate` takes."""
        mass = self.shown.masses()[:, None]
        if isinstance(self.flow, MoistSoil):
            ground = self.flow.ground
            if start:
                ground.soil.acceleration += force / mass
            else:
                ground.soil.force += force
        elif isinstance(self.shown, MixturePart):
            both = self.shown.flow
            rows = np.concatenate(self.shown.rows())
            wet = len(rows)
            both.water.layer.acceleration[rows] += force[:wet] / mass[:wet]
            soil = both.water.skeleton
            if start:
                soil.acceleration += force[wet:] / mass[wet:]
            else:
                soil.force += force[wet:]
        else:
            assert isinstance(self.flow, Flow)
            self.flow.layer.acceleration += force / mass
