"""Partially saturated cells that a graphics device steps: ``SaturatedCells`` for a fluid that lies there.

A step is the device's; what is read between steps (flow, solid fractions, weights, the push of a checkpoint) is the
CPU's code with patches of its own, filled where it is asked for.
"""

from typing import Any

import numpy as np

from porescale.common.core.types import Reals
from porescale.coupling.coverage.discs import place_corners
from porescale.coupling.coverage.rows import Motion
from porescale.coupling.device.bodies import DeviceBodies
from porescale.coupling.psm import SaturatedCells
from porescale.lbm.device.fluid import DeviceFluid, DeviceSweep
from porescale.lbm.fluid import Fluid


class DeviceSaturatedCells(SaturatedCells):
    """As ``SaturatedCells``, for a fluid on the device.  ValueError with rectangles or rings."""

    def __init__(self, fluid: Fluid, radius: Reals, **options: Any) -> None:
        super().__init__(fluid, radius, **options)
        if self.bodies:
            raise ValueError("a fluid on the device has no rectangles and no rings")
        self._there = DeviceBodies(fluid, self._patches, len(self.radius), self._laws, self._work.row_load.shape[2])
        self._sent = np.full((len(self.radius), 2), np.nan)
        self._pairs_there: Any = None

    def advance(self, fluid: Fluid, centre: Reals, velocity: Reals, spin: Reals) -> None:
        """One fluid step with the bodies where they are; fills the loads."""
        assert isinstance(fluid, DeviceFluid)
        there = self._there
        self._send(centre, velocity, spin)
        if self.driven:
            there.find_areas(None if self.operator.force_everywhere else self._half_rate)
        fluid.advance(DeviceSweep(there.sweep))
        self._load[...], self._entrained[...], area, rim = there.receive()
        if self.driven and there.moved:
            np.add(area, self.beyond, out=self._taken)
            self._taken[self.joined] = self.joined_area
        self._summed = True
        if self.soft_rim:
            self.soft_rim.sums[...] = rim
            self.soft_rim.low_pass()
        self._respond()

    def _send(self, centre: Reals, velocity: Reals, spin: Reals) -> None:
        """Send the bodies to the device; where there are discs only and none has moved, no more than their motion."""
        if self._pairs_there is not self.pairs:
            self._there.set_pairs(self.pairs)
            if self.body is not None:
                self._there.set_body(self.body)
            self._pairs_there, self._sent[:] = self.pairs, np.nan
        others = self.soft_rim or self.polygons
        moved = bool(others) or not np.array_equal(centre, self._sent)
        patches, discs = self._patches, len(self.radius)
        if moved:
            self._sent[:], self._placed[:] = centre, np.nan  # the CPU's patches are those of this step in part
            if self.soft_rim:
                self.soft_rim.soften(self.covering_radius)
            place_corners(centre, self.covering_radius, patches.corner)
            if self.soft_rim:
                patches.corner[:discs][self.soft_rim.theta > 0.0] -= 2
            if self.polygons:
                self.polygons.cover(patches, discs)
        motion = Motion(*self._gathered(centre, velocity, spin), self._shift, self._theta)
        self._there.send(motion, self.covering_radius, self.soft_rim, moved=moved)
