"""The energy budget of the grains, as columns of series.csv."""

from porescale.builders.stepper import Row
from porescale.builders.system import System
from porescale.common.record.part import Part
from porescale.dem.measures.energy import energy_budget

RESIDUAL = "residual (J/m)"


class EnergyPart(Part):
    """The budget since the first step.  acceleration : of free fall, m/s², whose work is the potential energy."""

    def __init__(self, system: System) -> None:
        assert system.grains
        self.grains, self.acceleration = system.grains, system.scene.gravity

    def row(self) -> Row:
        """Columns of the series, J/m, the residual last."""
        budget = energy_budget(self.grains, self.acceleration)
        return {**{name: value for name, value in budget.items() if name != RESIDUAL}, RESIDUAL: budget[RESIDUAL]}
