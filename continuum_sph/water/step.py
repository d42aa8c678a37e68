"""One step of a layer: kick, drift, pass over pairs, kick; and how long it may be.

v and x go by kick-drift-kick.  Density leaps over the velocity at mid-step:

    v½ = v + Δt/2 a,   x' = x + Δt v½,   ρ' = ρ + Δt D(x', v½),   v' = v½ + Δt/2 a(x', ρ*)

Eq. 48 of Maeda & Sakai 2004 advances ρ with the divergence of the last step, forward Euler for sound,
which grows at any step.  The exact leapfrog needs ρ' for a and so a second pass over the pairs.  One pass
does when a takes

    ρ* = ρ + Δt {D + r (D - D_before)},   r = (Δt + Δt_last)/(Δt_last + Δt_before)

instead: D extrapolated in a straight line from the last two mid-steps to this one (r = 1 at equal steps).  For sound
of frequency ω the amplification per step is then a root of z²(z - 1)² + (ωΔt)²(3z² - 3z + 1) = 0, inside the unit
circle for ωΔt < 0.7, with damping 1 - (ωΔt)⁴/2; with D alone (no extrapolation) it is outside for every Δt.  Only a
uses ρ*; ρ itself is never extrapolated.
"""

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from continuum_sph.water.bundles import Choices, Fluids, Gradients, Neighbours, Walls
from continuum_sph.water.density import LINEAR, filtered
from continuum_sph.water.fluids import table
from continuum_sph.water.image_walls import WallDensities, facing, update_walls, wall_rates
from continuum_sph.water.kernel_correction import neighbourhood_moments
from continuum_sph.water.leapfrog import Densities, Motion, Pressing, kick, kick_drift, pressurise
from continuum_sph.water.no_step import LEAST, no_step
from continuum_sph.water.parameters import RULES, Law
from continuum_sph.water.parting import LOOK, part_at_walls
from continuum_sph.water.pressure_walls import load_walls
from continuum_sph.water.rates import rates, split_rows
from continuum_sph.water.shifting import MOST, QUIET, shift
from continuum_sph.water.smoothing import WENDLAND
from continuum_sph.water.state import Layer
from continuum_sph.water.surface_tension import colours, curvatures, mark, middle_curvatures, normals, pull_interface
from porescale.common.core.types import Floats
from porescale.common.neighbors import PairList


@dataclass
class Flow:
    """A layer, its law and its pairs, moving.

    step : steps done;  time, next_step : s;  last_steps : lengths (s) of the last step and the one before;
    limited : steps that each of `law.RULES` limited, rule : the one that limits the next;  stopped : times a particle
    was stopped at a wall's surface, ``lower`` and ``upper`` (2,) m, infinite unless set;  sound_rate : largest c/h,
    1/s;  max_speed : m/s;  before_force : called once accelerations are computed, to add to them.
    """

    layer: Layer
    law: Law
    pairs: PairList
    step: int = 0
    time: float = 0.0
    next_step: float = 0.0
    last_steps: tuple[float, float] = (0.0, 0.0)
    limited: list[int] = field(default_factory=lambda: [0, 0, 0, 0])
    rule: int = 0
    stopped: int = 0
    sound_rate: float = 0.0
    max_speed: float = 0.0
    before_force: "Callable[[Flow], None] | None" = None

    def __post_init__(self) -> None:
        layer, count = self.layer, self.layer.count
        layer.length[:] = self.law.smoothing.length
        self.pairs.adaptive = True
        self.split, self.together = np.zeros(count, np.int64), False
        self.enclosed: NDArray[np.bool_] | None = None
        self.bounds = np.array([[-np.inf, -np.inf], [np.inf, np.inf]])
        self.lower, self.upper = self.bounds
        walls = count - layer.fluid
        self.wall_density = np.full(walls, self.law.state.density)
        self.wall_rate, self.wall_rate_before = np.zeros(walls), np.zeros(walls)
        self.marked = False

    def choose(self) -> None:
        """What kernels take: the arrays that the law needs, None in place of the others."""
        layer, law = self.layer, self.law
        self.table = table(law.fluids)
        several, shifted, xsph = len(law.fluids) > 1, law.shifting > 0.0, law.xsph > 0.0
        if several:
            layer.properties = np.zeros((layer.fluid, 2))
        if law.varied:
            layer.lengths = np.column_stack((layer.length, np.zeros(layer.count)))
        linear = law.noise == LINEAR and law.diffusion > 0.0
        sizes = (layer.fluid if it else 0 for it in (shifted, shifted or linear))
        self.concentration_gradient, self.density_gradient = (np.zeros((size, 2)) for size in sizes)
        self.normalised = np.zeros(layer.fluid if law.filter_every else 0)
        pulled = layer.fluid if law.tension > 0.0 else 0
        self.beside, self.marked = np.zeros(pulled, np.int8), False
        self.marked_material = np.zeros(pulled, np.int64)
        self.colour, self.normal = np.zeros(pulled), np.zeros((pulled, 3))
        self.curvature, self.middle = np.zeros(pulled), np.zeros(pulled)
        self.surveyed = law.corrected or shifted or linear
        held = law.sticky and not law.images
        layer.ghost = np.zeros((layer.count if held else 0, 2))
        layer.facing = np.zeros((layer.count if law.images else 0, 4))
        layer.matrix = np.zeros((layer.fluid if self.surveyed else 0, 4))
        self.walls = Walls(
            material=layer.material if law.sticky else None,
            ghost=layer.ghost if held else None,
            facing=layer.facing if law.images else None,
        )
        self.gradients = Gradients(
            matrix=layer.matrix if law.corrected else None,
            density=self.density_gradient if shifted or linear else None,
            drift=layer.drift if shifted else None,
        )
        self.smoothed = layer.smoothed if xsph else None
        self.count()

    def count(self) -> None:
        """The numbers that `rates` takes, of the law as it is: it may change on the way."""
        law, layer, h = self.law, self.layer, self.law.smoothing.length
        cohesive = True if any(fluid.cohesion for fluid in law.fluids) else None
        self.counted = law
        self.fluids = Fluids(
            table=self.table,
            properties=layer.properties if len(law.fluids) > 1 else None,
            lengths=layer.lengths if law.varied else None,
            mass=layer.mass if layer.has_budget or cohesive else None,
        )
        # XSPH evaluates the kernel twice a pair, and is 2 % faster with Wendland's compiled in (alone it is no faster).
        self.kind = None if law.xsph > 0.0 and law.smoothing.kind == WENDLAND else law.smoothing.kind
        self.choices = Choices(
            gravity_x=law.gravity[0] or None,
            gravity_y=law.gravity[1],
            alpha=law.alpha,
            beta=law.beta or None,
            softening=law.softening,
            diffusion=2.0 * law.diffusion * h,
            noise_speed=law.noise_speed,
            noise=law.noise,
            cohesive=cohesive,
            xsph=law.xsph or None,
            lattice=None if law.corrected else law.lattice,
        )

    def near(self, kind: int | None) -> Neighbours:
        """The list of pairs as kernels take it, with a ``kind`` of kernel."""
        pairs = self.pairs
        x, y = pairs.period
        around, along = (x, y) if max(x, y) > 0.0 else (None, None)
        return Neighbours(pairs.start, self.split, pairs.partner, around, along, kind, self.law.smoothing.length)

    @property
    def budget(self) -> tuple[Floats | None, Floats | None]:
        """Power and energy, if a budget of energies is kept."""
        layer = self.layer
        return (layer.power, layer.energy) if layer.has_budget else (None, None)

    def pressing(self, number: int) -> Pressing:
        """What makes pressures of the fluid of that ``number``."""
        layer, fluids, law = self.layer, self.fluids, self.law
        return Pressing(
            number, law.fluids[number].viscosity, None if len(law.fluids) == 1 else layer.material, fluids.properties,
            fluids.lengths, layer.mass, layer.length, layer.pressure, layer.record, law.cut,
        )  # fmt: skip

    def start(self) -> None:
        """Rates of the initial state, from which the first step goes on."""
        layer = self.layer
        self.choose()
        if self.law.images:
            walls = layer.x[layer.fluid :]
            layer.facing[layer.fluid :] = facing(walls, tuple(self.lower), tuple(self.upper))
            self.wet_walls()
        speeds = np.hypot(layer.v[: layer.fluid, 0], layer.v[: layer.fluid, 1])
        self.max_speed = float(speeds.max(initial=0.0))
        layer.predicted[:] = layer.density
        self.evaluate(0.0, 0.0)
        layer.rate_before[:] = layer.rate
        self.wall_rate_before[:] = self.wall_rate
        self.finish(0.0)
        self.last_steps = (self.next_step, self.next_step)

    def advance(self) -> None:
        """Advance the flow by one time step."""
        step, self.together = self.next_step, True
        self.evaluate(step, self.begin(step))
        self.together = False
        self.end(step)

    def begin(self, step: float) -> float:
        """First half kick and drift of a ``step`` (s); returns the ratio of `kick_drift` for `evaluate`."""
        layer = self.layer
        # Rates belong to mid-steps: distance from the last to this one over that between the last two.
        ratio = (step + self.last_steps[0]) / (self.last_steps[0] + self.last_steps[1])
        motion = Motion(layer.acceleration, self.smoothed, self.gradients.drift)
        densities = Densities(layer.density, layer.rate, layer.rate_before)
        fastest = 0.0
        for number, fluid in enumerate(self.law.fluids):
            stopped, sound2 = kick_drift(
                layer.x, layer.v, motion, densities, layer.predicted, self.pressing(number), self.budget[1], step,
                ratio, self.bounds, self.together or None, fluid.state.numbers,
            )  # fmt: skip
            self.stopped += stopped
            fastest = max(fastest, float(sound2))
        if self.stopped and self.step % LOOK == 0:
            part_at_walls(layer, self.bounds, self.law.spacing)
        if self.together:
            self.sound_rate = fastest**0.5
        layer.rate, layer.rate_before = layer.rate_before, layer.rate
        return ratio

    def end(self, step: float) -> None:
        """Second half kick of a ``step`` (s), and what is counted."""
        self.limited[self.rule] += 1
        self.finish(step)
        self.step += 1
        self.time += step
        self.last_steps = (step, self.last_steps[0])
        if self.law.filter_every and self.step % self.law.filter_every == 0:
            self.filter()

    def evaluate(self, step: float, ratio: float) -> None:
        """Accelerations and density rates at the predicted densities, a ``step`` (s) on;  ratio: as in `kick_drift`."""
        if not self.together:  # else the drift has done it
            self.pressurise(self.layer.predicted)
        layer, law = self.layer, self.law
        h, fluid = law.smoothing.length, layer.fluid
        self.list_pairs()
        self.update_walls(step, ratio)
        near = self.near(law.smoothing.kind)
        if self.surveyed:
            concentration = self.concentration_gradient if law.shifting > 0.0 else None
            neighbourhood_moments(
                fluid, layer.record, near, self.fluids.properties, layer.matrix, concentration, self.gradients.density,
                self.enclosed, law.spacing,
            )  # fmt: skip
        self.sum_pairs(0.5 * step)
        if law.tension > 0.0:
            self.pull()
        if law.images:
            self.wall_rate, self.wall_rate_before = self.wall_rate_before, self.wall_rate
            wall_rates(fluid, layer.record, near, layer.facing, law.sticky, self.wall_density, self.wall_rate, step)
        if law.shifting > 0.0:
            quiet = QUIET * law.state.sound_speed if len(law.fluids) == 1 else 0.0
            urge = max(0.0, self.max_speed - quiet)
            shift(
                fluid, layer.record, near, layer.material, self.table, layer.matrix, self.concentration_gradient,
                layer.drift, 2.0 * h * law.shifting * urge, MOST * urge,
            )  # fmt: skip
        if self.before_force is not None:
            self.before_force(self)

    @property
    def wall_densities(self) -> WallDensities:
        """Densities of image walls and their rates."""
        return WallDensities(self.wall_density, self.wall_rate, self.wall_rate_before)

    def sum_pairs(self, half: float) -> None:
        """The pass over pairs from records as they are, at the end of a step of twice ``half`` (s)."""
        layer = self.layer
        if self.law is not self.counted or (layer.has_budget and self.fluids.mass is None):
            self.count()
        rates(
            layer.fluid, layer.record, self.near(self.kind), self.fluids, self.walls, self.gradients, self.choices,
            layer.acceleration, layer.rate, self.smoothed, self.budget[0], half,
        )  # fmt: skip

    def pressurise(self, density: Floats) -> None:
        """Pressures of the fluids from a ``density`` (fluid,) kg/m³."""
        layer, fastest = self.layer, 0.0
        for number, fluid in enumerate(self.law.fluids):
            sound2 = pressurise(layer.x, layer.v, density, self.pressing(number), fluid.state.numbers)
            fastest = max(fastest, float(sound2))
        self.sound_rate = fastest**0.5

    def list_pairs(self) -> None:
        """Bring the list of pairs to where particles are."""
        layer, pairs = self.layer, self.pairs
        if pairs.update(layer.x, layer.length):
            split_rows(layer.fluid, pairs.start, pairs.partner, self.split)
            self.marked = False

    def pull(self) -> None:
        """Add the accelerations of surface tension between two fluids."""
        layer, law = self.layer, self.law
        near = self.near(law.smoothing.kind)
        where = (layer.fluid, layer.record, near)
        if not (self.marked and np.array_equal(self.marked_material, layer.material[: layer.fluid])):
            mark(layer.fluid, near, layer.material, self.beside)
            self.marked, self.marked_material[:] = True, layer.material[: layer.fluid]
        colours(*where, layer.material, self.beside, self.colour)
        normals(*where, self.beside, self.colour, self.normal)
        curvatures(*where, self.normal, self.curvature)
        middle_curvatures(*where, self.normal, self.curvature, self.middle)
        pull_interface(
            *where, layer.material, self.beside, self.middle, self.gradients.matrix, law.tension, layer.acceleration,
            layer.mass, layer.v, self.budget[0],
        )  # fmt: skip

    def update_walls(self, step: float, ratio: float) -> None:
        """What fluid reads of walls, a ``step`` (s) on."""
        layer, law = self.layer, self.law
        if law.images:
            update_walls(
                layer.fluid, layer.x, layer.v, layer.mass, self.wall_densities, step, ratio, law.cut, layer.record,
                layer.pressure, law.state.numbers,
            )  # fmt: skip
        else:
            self.take_pressure()

    def wet_walls(self) -> None:
        """Start boundary particles with the pressure of the fluid before them; Maeda & Sakai 2004 start
        at ρ0 everywhere."""
        layer, law = self.layer, self.law
        self.list_pairs()
        self.pressurise(layer.density)
        self.take_pressure()
        self.wall_density[:] = law.state.density_at(layer.pressure[layer.fluid :])

    def take_pressure(self) -> None:
        """Pressure and velocity of the fluid before walls, as their particles have it."""
        layer, law = self.layer, self.law
        load_walls(
            layer.fluid, self.near(law.smoothing.kind), layer.x, layer.v, layer.mass, layer.record, layer.pressure,
            self.walls.ghost, *law.gravity, law.state.density,
        )  # fmt: skip

    def finish(self, step: float) -> None:
        """Second half of a ``step`` (s), and length of the next from the largest |a| and c/h."""
        layer, law = self.layer, self.law
        material = None if len(law.fluids) == 1 else layer.material
        acceleration2, speed2 = kick(
            layer.v, layer.acceleration, layer.density, layer.rate, material, layer.length, self.fluids.lengths,
            self.table, *self.budget, 0.5 * step, step,
        )  # fmt: skip
        self.max_speed = float(speed2) ** 0.5
        limits = law.limits(float(acceleration2) ** 0.5, self.sound_rate)
        self.next_step = min(limits)
        self.rule = limits.index(self.next_step)
        if not LEAST * law.step_at_rest <= self.next_step < np.inf:
            raise no_step(
                self.next_step, RULES[self.rule], layer.x, layer.acceleration, layer.density, self.step, self.time,
                "lower numerics.courant, or raise numerics.artificial_viscosity or water.sound_speed",
            )  # fmt: skip

    def filter(self) -> None:
        """Normalise the density within each fluid, eq. 27."""
        layer, pairs = self.layer, self.pairs
        filtered(
            pairs.start, self.split, pairs.partner, layer.record, layer.material, layer.mass, layer.density,
            self.normalised, self.law.smoothing.kind, self.law.smoothing.length, *pairs.period,
        )  # fmt: skip
        layer.density[:] = self.normalised

    def state(self) -> dict[str, Any]:
        """Everything that later steps depend on."""
        return {
            "layer": self.layer.state(),
            "walls": {"density": self.wall_density.copy(), "rate": self.wall_rate.copy(),
                      "rate_before": self.wall_rate_before.copy()},
            "pairs": self.pairs.state(),
            "step": self.step,
            "time": self.time,
            "next_step": self.next_step,
            "last_steps": list(self.last_steps),
            "limited": list(self.limited),
            "rule": self.rule,
            "stopped": self.stopped,
            "swiftest": self.max_speed,
        }  # fmt: skip

    def restore(self, state: dict[str, Any]) -> None:
        """Go on bit for bit from the ``state`` of a flow of the same start."""
        self.layer.restore(state["layer"])
        self.pairs.restore(state["pairs"])
        split_rows(self.layer.fluid, self.pairs.start, self.pairs.partner, self.split)
        self.marked = False
        walls = state["walls"]
        self.wall_density[:], self.wall_rate[:] = walls["density"], walls["rate"]
        self.wall_rate_before[:] = walls["rate_before"]
        self.step, self.time, self.next_step = state["step"], state["time"], state["next_step"]
        first, second = state["last_steps"]
        self.last_steps = (first, second)
        self.limited, self.rule = list(state["limited"]), state["rule"]
        self.stopped, self.max_speed = state["stopped"], state["swiftest"]
