"""Grains and bodies of segments in snapshots: points with their arrays."""

from collections.abc import Callable, Sequence

import numpy as np

from porescale.builders.initial.frames import Placed, disc_count
from porescale.builders.system import System
from porescale.common.core.types import AnyArray
from porescale.common.record.model import Cloud, Snapshot
from porescale.common.record.part import Part
from porescale.dem.grains import Grains
from porescale.output.frame_clouds import FRAMES, frame_cloud

Motion = Callable[[], tuple[AnyArray, AnyArray]]
"""Positions (n, 2) m and velocities (n, 2) m/s of all discs, as they are shown."""


class GrainCloud(Part):
    """The discs.  hydraulic_radius : (n,) m, None without fluid;  motion : of a strained cell, None of a box."""

    def __init__(self, grains: Grains, hydraulic_radius: AnyArray | None, motion: Motion | None) -> None:
        self.grains, self.hydraulic_radius, self.motion = grains, hydraulic_radius, motion or self._own
        self.period = np.array([0.0, 0.0] if motion else grains.box.period)

    @classmethod
    def build(cls, system: System, motion: Motion | None = None) -> "GrainCloud":
        """The part of a system with grains; ``motion`` : of a strained cell."""
        assert system.grains
        return cls(system.grains, system.coupled.hydraulic_radius if system.coupled else None, motion)

    def _own(self) -> tuple[AnyArray, AnyArray]:
        return self.grains.discs.position, self.grains.discs.velocity

    def show(self, snapshot: Snapshot) -> None:
        """The cloud "grains"; centres within a periodic box."""
        own = slice(disc_count(self.grains))
        d, flat = self.grains.discs, np.zeros((disc_count(self.grains), 3))
        position, velocity = self.motion()
        flat[:, :2], position = velocity[own], position[own]
        data = {"radius": d.radius[own], "angle": d.angle[own], "velocity": flat, "spin": d.spin[own]}
        units = {"radius": "m", "angle": "rad", "velocity": "m/s", "spin": "rad/s"}
        if self.hydraulic_radius is not None:
            data["hydraulic_radius"], units["hydraulic_radius"] = self.hydraulic_radius[own], "m"
        period = self.period
        inside = np.where(period > 0, np.mod(position, np.where(period > 0, period, 1.0)), position)
        snapshot.clouds["grains"] = Cloud(inside, data, units)


class FrameCloud(Part):
    """Rigid bodies of segments, as a cloud of points in snapshots."""

    def __init__(self, grains: Grains, frames: Sequence[Placed]) -> None:
        self.grains, self.frames = grains, frames

    @classmethod
    def build(cls, system: System) -> "FrameCloud":
        """The part of a system with frames."""
        assert system.grains
        return cls(system.grains, system.frames)

    def show(self, snapshot: Snapshot) -> None:
        """The cloud of frames."""
        snapshot.clouds[FRAMES] = frame_cloud(self.grains, self.frames)
