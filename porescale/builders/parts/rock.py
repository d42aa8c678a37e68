"""The record of a rock between its plates: rock.csv."""

from porescale.builders.parts.bonds import BondsPart
from porescale.builders.stepper import Row
from porescale.builders.system import System
from porescale.common.record.part import Part


class RockPart(Part):
    """Strain, stress and broken bonds.  recorded : bodies that are watched before the plates."""

    def __init__(self, system: System) -> None:
        """Of a scene with [rock] and plates, whose pieces are bonded."""
        rock, packing = system.scene.rock, system.scene.grains and system.scene.grains.packing
        assert rock
        assert packing
        assert system.grains
        sides = packing.width, packing.height
        self.axis = 0 if rock.plates == "x" else 1
        self.length, self.height = sides[self.axis], sides[1 - self.axis]
        self.clock, self.grains, self.bonds = system.clock, system.grains, system.part(BondsPart)
        self.recorded = len(system.recorded) - 2

    def tables(self) -> dict[str, Row]:
        """rock.csv; stress is the mean of both plates over the last step, > 0 tension.

        strain () : of the sample's length between the plates, > 0 longer
        stress (Pa) : mean of both plates over the last step, tension > 0
        broken bonds () : since they were made
        """
        one, other = self.grains.steering.record()[self.recorded :]
        stress = 0.5 * (one.contact[self.axis] - other.contact[self.axis]) / self.height
        strain = (other.displacement[self.axis] - one.displacement[self.axis]) / self.length
        broken = self.bonds.row()["broken bonds ()"]
        row = {"strain ()": strain, "stress (Pa)": stress, "broken bonds ()": broken}
        return {"rock": {"time (s)": self.clock.time} | row}
