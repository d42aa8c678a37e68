"""The record of a rock between its plates: rock.csv."""

from __future__ import annotations

from porescale.dem.grains import Grains
from porescale.scene.scene import Scene


class RockWatch:
    """The record of a rock between its plates: strain, stress and broken bonds."""

    def __init__(self, scene: Scene, grains: Grains, recorded: int) -> None:
        """``recorded`` : bodies that are watched before the plates."""
        assert scene.rock
        assert scene.grains
        assert scene.grains.packing
        packing = scene.grains.packing
        sides = packing.width, packing.height
        self.axis = 0 if scene.rock.plates == "x" else 1
        self.length, self.height = sides[self.axis], sides[1 - self.axis]
        self.grains, self.recorded = grains, recorded

    def row(self, broken: float) -> dict[str, float]:
        """Columns of rock.csv but the time; stress is the mean of both plates over the last step, > 0 tension."""
        one, other = self.grains.steering.record()[self.recorded :]
        stress = 0.5 * (one.contact[self.axis] - other.contact[self.axis]) / self.height
        strain = (other.displacement[self.axis] - one.displacement[self.axis]) / self.length
        return {"strain ()": strain, "stress (Pa)": stress, "broken bonds ()": broken}
