"""The part of a scene whose grains may sleep: their number and the energy taken, in series.csv."""

import numpy as np

from porescale.builders.stepper import Row
from porescale.builders.system import System
from porescale.common.record.part import Part
from porescale.coupling.step import buoyant_weight
from porescale.dem.resting.sleep import Sleep as Sleepers


class SleepPart(Part):
    """How many grains sleep, and what energy was taken."""

    def __init__(self, system: System) -> None:
        """Lets the grains sleep, by their weight less lift."""
        grains, section = system.grains, system.scene.sleep
        assert grains
        assert section
        weight = system.coupled.weight if system.coupled else buoyant_weight(grains, 0.0, system.scene.gravity)
        size = np.hypot(weight[:, 0], weight[:, 1]).astype(float)
        self.sleepers = grains.sleep = Sleepers(grains, size, section.share, section.after)

    def row(self) -> Row:
        """Columns of the sleeping grains in series.csv.

        grains asleep () : number of grains that sleep now
        energy taken by sleep (J/m) : kinetic energy that falling asleep took away, since the start
        """
        return {
            "grains asleep ()": float(self.sleepers.count),
            "energy taken by sleep (J/m)": float(self.sleepers.removed.sum()),
        }
