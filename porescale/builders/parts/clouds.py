"""Grains and bodies of segments in snapshots: points with their arrays."""

import numpy as np

from porescale.builders.initial.frames import disc_count
from porescale.builders.system import System
from porescale.common.core.types import AnyArray
from porescale.common.record.model import Cloud, Snapshot
from porescale.common.record.part import Part
from porescale.output.frame_clouds import FRAMES, frame_cloud


class GrainCloud(Part):
    """The discs.  hydraulic_radius : (n,) m, None without fluid;  motion : positions (n, 2) m and velocities (n, 2) m/s
    of all discs as they are shown;  count : of discs that are no corners of frames, the first ones."""

    def __init__(self, system: System) -> None:
        assert system.grains
        self.grains, self.count = system.grains, disc_count(system.grains)
        self.hydraulic_radius = system.coupled.hydraulic_radius if system.coupled else None
        self.motion, self.period = self._own, np.array(system.grains.box.period)
        if system.scene.cell:
            from porescale.builders.parts.cell import CellPart

            self.motion, self.period = system.part(CellPart).seen, np.zeros(2)

    def _own(self) -> tuple[AnyArray, AnyArray]:
        return self.grains.discs.position, self.grains.discs.velocity

    def show(self, snapshot: Snapshot) -> None:
        """The cloud "grains"; centres within a periodic box."""
        own = slice(self.count)
        d, flat = self.grains.discs, np.zeros((self.count, 3))
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

    def __init__(self, system: System) -> None:
        assert system.grains
        self.grains, self.frames = system.grains, system.frames

    def show(self, snapshot: Snapshot) -> None:
        """The cloud of frames."""
        snapshot.clouds[FRAMES] = frame_cloud(self.grains, self.frames)
