"""The gate, for fluid and grains alike: it opens at its time, at once or upward with a speed."""

from math import inf
from typing import Any

from porescale.builders.initial.grains import GATE
from porescale.builders.system import System
from porescale.common.record.part import Part


class GatePart(Part):
    """Opens the gate.  plate : as the fluid has it;  spacing : of the lattice, m;  open : whether it has opened."""

    def __init__(self, system: System) -> None:
        """Adds its plate to the fluid, as the grains have theirs."""
        derived, section = system.derived, system.scene.gate
        assert section
        self.clock, self.opens_at, self.lift_speed = system.clock, section.opens_at, section.lift_speed
        self.fluid, self.grains = system.fluid, system.grains
        self.plate = self.fluid.add_plate(derived.gate_column or 0) if self.fluid else None
        self.spacing = derived.scales.spacing if derived.scales else 1.0
        self.open = False

    @property
    def acts_from(self) -> float:
        """The step that opens it; later it is lifted step by step in fluid, and by contact steps among grains."""
        if not self.open:
            return self.clock.step_of(self.opens_at)
        return 0.0 if self.plate and self.lift_speed is not None else inf

    def before(self) -> None:
        """Open it in the step that begins nearest to its time, and lift it."""
        if not self.open and self.clock.time >= self.opens_at - 0.5 * self.clock.seconds:
            self.open = True
            if self.lift_speed is None:
                self._vanish()
            else:
                self._lift(self.lift_speed)
        if self.plate:
            self.plate.lower_edge += self.plate.speed

    def _vanish(self) -> None:
        if self.fluid and self.plate in self.fluid.plates:
            self.fluid.plates.remove(self.plate)
        if self.grains:
            self.grains.remove_plate(GATE)

    def _lift(self, speed: float) -> None:
        if self.plate:
            self.plate.speed = speed * self.clock.seconds / self.spacing
        if self.grains:
            self.grains.move_plate(GATE, speed)

    def state(self) -> dict[str, Any]:
        """Whether it has opened; the edges of its plates belong to fluid and grains."""
        return {"gate_open": self.open}

    def restore(self, state: dict[str, Any]) -> None:
        """Take up a state, before fluid and grains do."""
        if bool(state["gate_open"]):
            self.open = True
            if self.lift_speed is None and self.fluid:
                self.fluid.plates.clear()
