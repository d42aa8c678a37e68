"""The record of a rock between its plates: rock.csv."""

from porescale.builders.parts.bonds import BondsPart
from porescale.builders.stepper import Clock, Row
from porescale.builders.system import System
from porescale.common.record.part import Part
from porescale.dem.grains import Grains
from porescale.scene.bodies.rock import Rock
from porescale.scene.packing import Packing


class RockPart(Part):
    """Strain, stress and broken bonds.  recorded : bodies that are watched before the plates."""

    def __init__(
        self, clock: Clock, section: Rock, packing: Packing, grains: Grains, bonds: BondsPart, recorded: int
    ) -> None:
        sides = packing.width, packing.height
        self.axis = 0 if section.plates == "x" else 1
        self.length, self.height = sides[self.axis], sides[1 - self.axis]
        self.clock, self.grains, self.bonds, self.recorded = clock, grains, bonds, recorded

    @classmethod
    def build(cls, system: System, bonds: BondsPart) -> "RockPart":
        """The part of a scene with [rock] and plates, whose pieces are bonded."""
        scene = system.scene
        assert scene.rock
        assert scene.grains
        assert scene.grains.packing
        assert system.grains
        recorded = len(system.recorded) - 2
        return cls(system.clock, scene.rock, scene.grains.packing, system.grains, bonds, recorded)

    def tables(self) -> dict[str, Row]:
        """rock.csv; stress is the mean of both plates over the last step, > 0 tension."""
        one, other = self.grains.steering.record()[self.recorded :]
        stress = 0.5 * (one.contact[self.axis] - other.contact[self.axis]) / self.height
        strain = (other.displacement[self.axis] - one.displacement[self.axis]) / self.length
        broken = self.bonds.row()["broken bonds ()"]
        row = {"strain ()": strain, "stress (Pa)": stress, "broken bonds ()": broken}
        return {"rock": {"time (s)": self.clock.time} | row}
