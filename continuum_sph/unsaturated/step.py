"""One step of soil with water in its pores: soil moves and strains, water flows, its pressure pushes the soil."""

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from continuum_sph.soil import SoilFlow
from continuum_sph.unsaturated.outside import Outside
from continuum_sph.unsaturated.pore_stress import pore_forces, pore_pressures
from continuum_sph.unsaturated.richards import CONTENT, Moisture
from porescale.common.core.types import Floats

SHARE = 0.25
"""Of h/c: the step's bound for sound in soil whose full pores cannot drain, c² = (M + K_w/n)/ρ."""


@dataclass
class MoistSoil:
    """Soil and the water that it carries.

    ground : the soil, its mass that of the grains;  water : in its pores;  outside : what lies about it;
    modulus : largest M of the soil, Pa;  stages : of all steps, that the flow of water took;  before_force : called
    before accelerations, to add to ``ground.soil.force``.
    """

    ground: SoilFlow
    water: Moisture
    outside: Outside
    modulus: float
    stages: int = 0
    before_force: "Callable[[MoistSoil], None] | None" = None
    pore: Floats = field(init=False)  # (n,) Pa, π of soil and walls
    around: Floats = field(init=False)  # (soil, 2) Pa and 1/m², see `pore_stress`

    def __post_init__(self) -> None:
        soil = self.ground.soil
        self.pore, self.around, self.share = np.zeros(soil.count), np.zeros((soil.soil, 2)), np.ones(soil.soil)

    @property
    def step(self) -> int:
        """Number of steps done since time 0."""
        return self.ground.step

    @property
    def time(self) -> float:
        """Time that both layers have reached, s."""
        return self.ground.time

    @property
    def next_step(self) -> float:
        """Length of the next step, s."""
        return self.ground.next_step

    @property
    def volume(self) -> Floats:
        """Whole volumes of the pieces of soil, (soil,) m²."""
        soil = self.ground.soil
        found: Floats = soil.mass[: soil.soil] / soil.density
        return found

    @property
    def bound(self) -> float:
        """Longest step (s) for sound in soil that cannot drain; of its whole mass, water's included."""
        stiff = self.water.retention.stiffness / self.water.porosity
        lightest = float((self.ground.soil.density / self.share).min())
        return float(SHARE * self.ground.law.smoothing.length / ((self.modulus + stiff) / lightest) ** 0.5)

    def start(self) -> None:
        """Forces of the initial state."""
        self.look(self.ground.time)
        self.water.update(self.water.content)
        self.ground.begin(0.0)
        self.ground.strain(0.0)
        self.push()
        self.finish(0.0)

    def look(self, time: float) -> None:
        """Take up where soil is, and what lies outside, at a ``time`` (s)."""
        soil = self.ground.soil
        x, volume = soil.x[: soil.soil], self.volume
        self.water.place(x, volume)
        self.outside.look(x, volume, time)

    def advance(self) -> None:
        """Advance soil and water by one time step."""
        ground, step = self.ground, self.ground.next_step
        ground.begin(step)
        ground.strain(step)
        self.look(ground.time + step)
        self.stages += self.water.advance(step, ground.near, self.outside.outer)
        self.push()
        ground.limited[ground.rule] += 1
        self.finish(step)
        ground.step += 1
        ground.time += step

    def push(self) -> None:
        """Accelerations of soil and its water as one, by stress, pore pressure and weight."""
        ground, soil, n = self.ground, self.ground.soil, self.ground.soil.soil
        weight = self.water.content[:, CONTENT]
        pore_pressures(
            n, self.water.state, soil.record, soil.facing, ground.near, self.outside.outer,
            self.water.properties.weight, self.pore, self.around,
        )  # fmt: skip
        np.multiply(weight[:, None], ground.law.gravity, out=soil.force)
        pore_forces(
            n, soil.record, soil.facing, soil.matrix, ground.near, self.pore, self.around,
            self.water.properties.weight, soil.force,
        )  # fmt: skip
        if self.before_force is not None:
            self.before_force(self)
        ground.push()
        np.divide(soil.mass[:n], soil.mass[:n] + weight, out=self.share)
        soil.acceleration *= self.share[:, None]

    def finish(self, step: float) -> None:
        """Second half kick, and the longest next step."""
        self.ground.limit = self.bound
        self.ground.end(step)

    def state(self) -> dict[str, Any]:
        """Everything of the water that later steps depend on."""
        return {
            "content": self.water.content.copy(),
            "stages": self.stages,
            "places": self.outside.overlap.pairs.state(),
            "water": self.water.state.copy(),
        }

    def restore(self, state: dict[str, Any]) -> None:
        """Go on bit for bit from the ``state`` of an equal start, the soil being restored already."""
        self.water.content[:], self.stages = state["content"], int(state["stages"])
        self.water.state[:] = state["water"]
        soil = self.ground.soil
        self.outside.overlap.restore(state["places"], self.outside.x, soil.x[: soil.soil])
        self.outside.see(self.volume, self.ground.time)
