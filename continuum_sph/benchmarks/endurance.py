"""Small tanks for very long: water at rest, that sloshes until it rests, stirred; ground, and ground under water."""

from collections.abc import Mapping
from typing import Any

import numpy as np

from continuum_sph.builders.simulation import Simulation
from continuum_sph.scene.sections import Scene
from continuum_sph.validation.tanks import level_ground, tank_scene
from continuum_sph.validation.water.setups import open_box
from continuum_sph.water.step import Flow
from porescale.common.evidence.endurance import Endurance, Endurances, Held

EPS = float(np.finfo(float).eps)
SPACING = 0.05  # m
DEPTH = 1.0  # m
Table = dict[str, Any]

NUMERICS: Table = {"gradient": "corrected"}
GROUND: Table = {"stiffness": 2e6, "friction_angle": "30 degree", "body": [level_ground(0.5, 1.0)]}


def tank(**sections: Any) -> Scene:
    """A tank of 0.5 x 1.2 m, open at the top."""
    return tank_scene(0.5, 1.2, SPACING, 1e9, every=1.0, lid=False, **{"numerics": NUMERICS} | sections)


def still(**numerics: Any) -> Scene:
    """200 particles of water, 20 rows, with the pressure of their weight."""
    return tank(water={"column": [{"width": 0.5, "height": DEPTH}]}, numerics=NUMERICS | numerics)


def sloshing() -> Scene:
    """200 particles of water that fall down from one half of a tank and go to and fro.

    With 0.02 of artificial viscosity, and corrected gradients without shifting, they still do after 450 000 steps, and
    have lost 28 % of their room.
    """
    column = {"width": 0.5, "height": DEPTH}
    given: Table = {"width": 1.0, "height": 1.5, "lid": True}
    return tank(tank=given, water={"column": [column], "pressure": "released"},
                numerics=NUMERICS | {"artificial_viscosity": 0.1})  # fmt: skip


def ground() -> Scene:
    """200 particles of level ground with the stress of their weight."""
    return tank(soil=GROUND, numerics={})


def wet_ground() -> Scene:
    """Level ground of 0.5 m, 100 particles, beneath 0.3 m of water and full of it.

    The square lattice of water in the open stands with `continuum_sph.water.smoothing.RATIO`: sheared, its sums of V W
    grow.  With 1.3 spacings they shrink by 0.09 %, and it gives way after some 400 000 steps.
    """
    soil = GROUND | {"permeability": 1e-3, "body": [level_ground(0.5, 0.5)]}
    water = {"column": [{"width": 0.5, "height": 0.8}], "sound_speed": 80.0}
    read = {"probe": [{"x": 0.25, "y": 0.25}], "level": [{"x": 0.25}]}
    return tank(soil=soil, water=water, numerics={}, **read)


class Tank:
    """What is read of a scene's model: mass, where water and soil stand, how fast they go."""

    def __init__(self, model: Simulation, names: Mapping[str, str]) -> None:
        """names : columns of the model's series and of its tables, by what they are called here."""
        self.model, self._names = model, dict(names)

    def advance(self, steps: int) -> None:
        """Advance the model by a number of steps."""
        self.model.advance(steps)

    def check(self) -> None:
        """Check the state as a run does; raises Unstable."""
        self.model.check()

    def read(self) -> Mapping[str, float]:
        """The columns of the run's tables that the study follows."""
        row = dict(self.model.series())
        for table in self.model.tables().values():
            row |= table
        return {name: row[column] for name, column in self._names.items()}

    def state(self) -> dict[str, Any]:
        """All it takes to go on bit for bit."""
        return self.model.state()

    def restore(self, state: dict[str, Any]) -> None:
        """Go on from a state of the same start."""
        self.model.restore(state)


class Box:
    """What is read of a periodic box of water without weight: mass, and momentum."""

    def __init__(self, flow: Flow) -> None:
        self.flow = flow
        layer, n = flow.layer, flow.layer.fluid
        self._size = float((layer.mass[:n, None] * np.abs(layer.v[:n])).sum())

    def advance(self, steps: int) -> None:
        """Advance the flow by a number of steps."""
        for _ in range(steps):
            self.flow.advance()

    def check(self) -> None:
        """Nothing is checked: `Flow.advance` raises where a number is none."""

    def read(self) -> Mapping[str, float]:
        """Mass, and momentum over the sum of all sizes at the start."""
        layer, n = self.flow.layer, self.flow.layer.fluid
        x, y = (layer.mass[:n, None] * layer.v[:n]).sum(axis=0) / self._size
        return {MASS: float(layer.mass[:n].sum())} | dict(zip(MOMENTUM, (float(x), float(y)), strict=True))

    def state(self) -> dict[str, Any]:
        """All it takes to go on bit for bit."""
        return self.flow.state()

    def restore(self, state: dict[str, Any]) -> None:
        """Go on from a state of the same start."""
        self.flow.restore(state)


MASS, LEVEL, FASTEST, MOVED = "mass (kg/m)", "mean height (m)", "fastest (m/s)", "largest displacement (m)"
SOIL_MASS = "mass of soil (kg/m)"
STANDS, PORES = "level (m)", "pressure in pores, 0.55 m deep (Pa)"
MOMENTUM = tuple(f"momentum {axis} over Σ m|v| at the start ()" for axis in "xy")
WATER = {MASS: MASS, LEVEL: LEVEL, FASTEST: FASTEST}
SOIL = {MASS: MASS, MOVED: MOVED, FASTEST: FASTEST}
BOTH = {
    MASS: MASS,
    LEVEL: LEVEL,
    FASTEST: FASTEST,
    SOIL_MASS: "soil: mass (kg/m)",
    STANDS: "level 0 (m)",
    PORES: "probe 0 pressure (Pa)",
    MOVED: "soil: largest displacement (m)",
}


def exact(name: str) -> Held:
    """A quantity that no step changes."""
    return Held(name, lambda steps: 0.0, "particles keep their mass")


def held(name: str, allowed: float, because: str) -> Held:
    """A quantity that may change by this, however long it takes."""
    return Held(name, lambda steps: allowed, because)


def rounded(steps: int) -> float:
    """What round-off may do to momentum."""
    return 2 * EPS * steps


STAYS = held(LEVEL, 1e-3 * DEPTH, "a fiftieth of a spacing: no row is gained or lost")
RESTS = held(FASTEST, 0.05, "at rest: a thousandth of the speed of sound, 44 m/s")
KEEPS = held(STANDS, 1e-3 * DEPTH, "a fiftieth of a spacing: the water does not sink into the ground")
PRESSES = held(PORES, 9.81, "the weight of the millimetre by which the level may change")
LIES = held(MOVED, 0.02 * SPACING, "a fiftieth of a spacing, as of water's level")
CONSOLIDATED = 15_000
"""Steps until ground under water has come to rest.  The stress it starts with is off by the weight of half a row at its
surface at most, γ' Δx/2 = 243 Pa, as its kernels know the surface; what pore pressure takes of it fades as
exp(-π² c_v t/4H²), c_v = k M/{ρ g (1 + n M/K_w)} = 0.235 m²/s (Terzaghi 1923), H = 0.5 m: to 1 Pa in 2.4 s, steps of
0.17 ms."""
ROUNDING = "round-off: both kicks of a step round every velocity, all one way: 2 eps a step"

ENDURANCES = Endurances([
    Endurance("still water", "200 particles of water rest in a tank",
              lambda: Tank(Simulation(still()), WATER), (exact(MASS), STAYS, RESTS)),
    Endurance("still water without density diffusion", "the same, whose densities follow from its motion alone",
              lambda: Tank(Simulation(still(density_diffusion=0.0)), WATER), (exact(MASS), STAYS, RESTS)),
    Endurance("sloshing water", "200 particles of water slosh in a tank and come to rest within half of the run",
              lambda: Tank(Simulation(sloshing()), WATER), (exact(MASS), STAYS, RESTS), settles=10,
              least=1_000_000),
    Endurance("stirred water", "225 particles of water are stirred in a periodic box, without weight",
              lambda: Box(open_box(15, 1)), (exact(MASS), *(Held(name, rounded, ROUNDING) for name in MOMENTUM)),
              settles=0),
    Endurance("ground", "200 particles of level ground rest",
              lambda: Tank(Simulation(ground()), SOIL), (exact(MASS), LIES, RESTS)),
    Endurance("ground under water", "100 particles of ground rest beneath water, for a fifth of the steps",
              lambda: Tank(Simulation(wet_ground()), BOTH),
              (exact(MASS), exact(SOIL_MASS), STAYS, KEEPS, PRESSES, LIES, RESTS), share=0.2, before=CONSOLIDATED),
])  # fmt: skip
"""What `continuum-sph study endurance` runs."""
