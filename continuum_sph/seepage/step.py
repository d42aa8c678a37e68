"""One step of two layers: half a drag, kicks and drifts of both, stresses, pressures, forces, the other half."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from continuum_sph.seepage.halving import halve
from continuum_sph.seepage.pores import PoreFlow
from continuum_sph.seepage.reservoir import Supply

SHARE = 0.25
"""Of h/c: the step's bound for sound in water and soil that move together."""


class Ground(Protocol):
    """Soil that moves with its water: `soil.SoilFlow`, or a `Frame`."""

    step: int
    time: float
    next_step: float

    def start(self) -> None:
        """Rates of the initial state."""

    def begin(self, step: float) -> None:
        """Half kick and drift."""

    def strain(self, step: float) -> None:
        """Velocity gradients, densities and stresses at the new positions."""

    def push(self) -> None:
        """Accelerations, with the skeleton's force."""

    def end(self, step: float) -> None:
        """Half kick, and the longest next step."""


@dataclass
class Seepage:
    """Water and the ground it is in.

    modulus : largest M of the soil (Pa) and weight : least whole density (kg/m³), for the step that sound allows when
    both layers move together;  next_step s;  load (soil, 2) N/m: dead load on the soil, or None;  supply : water that
    is kept at levels, or None;  before_force : called before the soil is accelerated, to add to the accelerations of
    the water and to ``skeleton.force``.
    """

    water: PoreFlow
    ground: Ground
    modulus: float = 0.0
    weight: float = np.inf
    next_step: float = 0.0
    load: NDArray[np.float64] | None = None
    supply: Supply | None = None
    before_force: "Callable[[Seepage], None] | None" = None

    def __post_init__(self) -> None:
        self.wet = np.zeros_like(self.water.borne)

    @property
    def step(self) -> int:
        """Number of steps done since time 0."""
        return self.water.step

    @property
    def time(self) -> float:
        """Time reached, in seconds."""
        return self.water.time

    @property
    def bound(self) -> float:
        """Longest step (s) for sound of the mixture: c² = (M + K_w/n)/ρ, undrained."""
        water = self.water
        state, h = water.law.state, water.law.smoothing.length
        stiff = state.density * state.sound_speed**2 / water.resistance.porosity
        return float(SHARE * h / ((self.modulus + stiff) / self.weight) ** 0.5) if self.weight < np.inf else np.inf

    def start(self) -> None:
        """Rates of the initial state, from which the first step goes on."""
        water = self.water
        water.overlap.update(water.layer.x[: water.layer.fluid], water.skeleton.x)
        water.start()
        self.ground.start()
        self.accelerate()
        self.choose_step()
        water.last_steps = (self.next_step, self.next_step)

    def advance(self) -> None:
        """Advance water and soil by one time step."""
        water, ground, step = self.water, self.ground, self.next_step
        water.update_slip()  # accelerations are those of the end of the last step
        water.drag(0.5 * step)
        ground.begin(step)
        ratio = water.begin(step)
        if self.supply is not None:
            self.supply.keep(water.time + step)
            halve(water, self.supply.whole, self.supply.reserve)
        ground.strain(step)
        water.evaluate(step, ratio)
        self.accelerate()
        water.drag(0.5 * step)
        ground.end(step)
        ground.step += 1
        ground.time += step
        water.end(step)
        self.choose_step()

    def accelerate(self) -> None:
        """Accelerations of the soil without drag.  Its walls include the drag: they continue what weight and all forces
        make of its stress.  The next drag is given both layers' accelerations."""
        water, soil = self.water, self.water.skeleton
        np.copyto(self.wet, soil.force)
        soil.force += water.borne
        if self.load is not None:
            soil.force += self.load
        if self.before_force is not None:
            self.before_force(self)
        self.ground.push()
        np.copyto(soil.force, self.wet)
        if not soil.held:
            np.divide(water.borne, soil.mass[:, None], out=self.wet)
            soil.acceleration -= self.wet
        water.update_pull()

    def choose_step(self) -> None:
        """The next step: the shortest that water, ground and their common sound allow."""
        self.next_step = min(self.water.next_step, self.ground.next_step, self.bound)
        self.water.next_step = self.next_step
