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
sees ρ*; ρ itself is never extrapolated.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from continuum_sph.water.density import LINEAR
from continuum_sph.water.density_filter import filtered
from continuum_sph.water.fluids import table
from continuum_sph.water.image_walls import facing, show_walls, wall_rates
from continuum_sph.water.kernel_correction import surroundings
from continuum_sph.water.leapfrog import kick, kick_drift, pressurise
from continuum_sph.water.no_step import no_step
from continuum_sph.water.parameters import RULES, Law
from continuum_sph.water.pressure_walls import load_walls
from continuum_sph.water.rates import rates, split_rows
from continuum_sph.water.shifting import MOST, QUIET, shift
from continuum_sph.water.smoothing import WENDLAND
from continuum_sph.water.state import Layer
from continuum_sph.water.surface_tension import colours, curvatures, mark, middle_curvatures, normals, pull_interface
from porescale.common.neighbors import PairList

Floats = NDArray[np.float64]


@dataclass
class Flow:
    """A layer, its law and its pairs, moving.

    step : steps done;  time, next_step : s;  last_steps : lengths (s) of the last step and the one before;
    limited : steps that each of `law.RULES` limited, rule : the one that limits the next;  stopped : times a particle
    was stopped at a wall's surface, ``lower`` and ``upper`` (2,) m, infinite unless set;  sound_rate : largest c/h,
    1/s;  max_speed : m/s.
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

    def __post_init__(self) -> None:
        layer, count = self.layer, self.layer.count
        layer.length[:] = self.law.smoothing.length
        self.pairs.adaptive = True
        self.split, self.together = np.zeros(count, np.int64), False
        self.lower, self.upper = np.full(2, -np.inf), np.full(2, np.inf)
        walls = count - layer.fluid
        self.wall_density = np.full(walls, self.law.state.density)
        self.wall_rate, self.wall_rate_before = np.zeros(walls), np.zeros(walls)
        self.marked = False

    def choose(self) -> None:
        """What kernels take: the arrays of what the law asks for, None in place of the others."""
        layer, law = self.layer, self.law
        self.table = table(law.fluids)
        several, shifted, xsph = len(law.fluids) > 1, law.shifting > 0.0, law.xsph > 0.0
        if several:
            layer.traits = np.zeros((layer.fluid, 2))
        if law.varied:
            layer.girths = np.column_stack((layer.length, np.zeros(layer.count)))
        linear = law.noise == LINEAR and law.diffusion > 0.0
        self.crowd, self.slant = (np.zeros((layer.fluid if it else 0, 2)) for it in (shifted, shifted or linear))
        self.normalised = np.zeros(layer.fluid if law.filter_every else 0)
        pulled = layer.fluid if law.tension > 0.0 else 0
        self.beside, self.marked, self.told = np.zeros(pulled, np.int8), False, np.zeros(pulled, np.int64)
        self.colour, self.normal = np.zeros(pulled), np.zeros((pulled, 3))
        self.curvature, self.middle = np.zeros(pulled), np.zeros(pulled)
        self.surveyed = law.corrected or shifted or linear
        around, along = self.pairs.period
        wraps = max(around, along) > 0.0
        self.period: tuple[float | None, float | None] = (around, along) if wraps else (None, None)
        self.of_fluids = (layer.material if several else None, layer.length, self.table)
        self.of_pairs = (layer.traits if several else None, layer.girths if law.varied else None)
        self.moving = (layer.smoothed if xsph else None, layer.drift if shifted else None)
        self.crowded = (self.crowd if shifted else None, self.slant if shifted or linear else None)
        held = law.sticky and not law.images
        layer.ghost = np.zeros((layer.count if held else 0, 2))
        layer.facing = np.zeros((layer.count if law.images else 0, 4))
        layer.matrix = np.zeros((layer.fluid if self.surveyed else 0, 4))
        self.walled = (
            layer.ghost if held else None,
            layer.facing if law.images else None,
            layer.material if law.sticky else None,
        )
        self.count()

    def count(self) -> None:
        """The numbers that `rates` takes, of the law as it is: it may change on the way."""
        law, h = self.law, self.law.smoothing.length
        cohesive = True if any(fluid.cohesion for fluid in law.fluids) else None
        self.counted, self.weighed = law, self.layer.mass if cohesive else None
        # XSPH asks for the kernel twice a pair, and is 2 % faster with Wendland's compiled in (alone it is no faster).
        kind = None if law.xsph > 0.0 and law.smoothing.kind == WENDLAND else law.smoothing.kind
        self.numbers = (
            kind, h, law.gravity[0] or None, law.gravity[1], law.alpha, law.beta or None, law.softening,
            2.0 * law.diffusion * h, law.noise_speed, law.noise, cohesive, law.xsph or None, *self.period,
        )  # fmt: skip

    @property
    def book(self) -> tuple[Floats | None, Floats | None]:
        """Power and energy, if a book is kept."""
        layer = self.layer
        return (layer.power, layer.energy) if layer.booked else (None, None)

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
        """One step."""
        step, self.together = self.next_step, True
        self.evaluate(step, self.begin(step))
        self.together = False
        self.end(step)

    def begin(self, step: float) -> float:
        """First half kick and drift of a ``step`` (s); returns the ratio of `kick_drift` for `evaluate`."""
        layer = self.layer
        # Rates belong to mid-steps: distance from the last to this one over that between the last two.
        ratio = (step + self.last_steps[0]) / (self.last_steps[0] + self.last_steps[1])
        stopped, pace = kick_drift(
            layer.x, layer.v, layer.acceleration, *self.moving, layer.density, layer.rate, layer.rate_before,
            layer.predicted, layer.mass, *self.of_fluids, self.law.cut, layer.pressure,
            layer.record if self.together else None, *self.of_pairs, self.book[1], 0.5 * step, step, ratio,
            self.lower, self.upper,
        )  # fmt: skip
        self.stopped += stopped
        if self.together:
            self.sound_rate = float(pace) ** 0.5
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
        layer, law, pairs = self.layer, self.law, self.pairs
        h, kind, fluid = law.smoothing.length, law.smoothing.kind, layer.fluid
        self.list_pairs()
        self.show_walls(step, ratio)
        where = (fluid, pairs.start, self.split, pairs.partner, layer.record)
        if self.surveyed:
            surroundings(
                *where, self.of_pairs[0], layer.matrix, *self.crowded, kind, h, law.spacing, *self.period
            )  # fmt: skip
        self.sum_pairs(0.5 * step)
        if law.tension > 0.0:
            self.pull()
        if law.images:
            self.wall_rate, self.wall_rate_before = self.wall_rate_before, self.wall_rate
            wall_rates(
                *where, layer.facing, law.sticky, self.wall_density, self.wall_rate, step, kind, h, *pairs.period
            )  # fmt: skip
        if law.shifting > 0.0:
            quiet = QUIET * law.state.sound_speed if len(law.fluids) == 1 else 0.0
            urge = max(0.0, self.max_speed - quiet)
            shift(
                *where, layer.material, self.table, layer.matrix, self.crowd, layer.drift, kind, h,
                2.0 * h * law.shifting * urge, MOST * urge, *self.period,
            )  # fmt: skip

    def sum_pairs(self, half: float) -> None:
        """The pass over pairs from records as they are, at the end of a step of twice ``half`` (s)."""
        layer, pairs = self.layer, self.pairs
        if self.law is not self.counted:
            self.count()
        rates(
            layer.fluid, pairs.start, self.split, pairs.partner, layer.record, *self.of_pairs, *self.walled,
            layer.matrix if self.law.corrected else None, self.crowded[1], self.moving[1],
            layer.mass if layer.booked else self.weighed, self.table, layer.acceleration, layer.rate, self.moving[0],
            self.book[0], *self.numbers, half,
        )  # fmt: skip

    def pressurise(self, density: Floats) -> None:
        """Pressures of the fluid from a ``density`` (fluid,) kg/m³."""
        layer = self.layer
        pace = pressurise(
            layer.x, layer.v, layer.mass, density, *self.of_fluids, self.law.cut, layer.pressure, layer.record,
            *self.of_pairs,
        )  # fmt: skip
        self.sound_rate = float(pace) ** 0.5

    def list_pairs(self) -> None:
        """Bring the list of pairs to where particles are."""
        layer, pairs = self.layer, self.pairs
        if pairs.update(layer.x, layer.length):
            split_rows(layer.fluid, pairs.start, pairs.partner, self.split)
            self.marked = False

    def pull(self) -> None:
        """Surface tension between two fluids."""
        layer, law, pairs = self.layer, self.law, self.pairs
        where = (layer.fluid, pairs.start, self.split, pairs.partner, layer.record)
        how = (law.smoothing.kind, law.smoothing.length, *pairs.period)
        if not (self.marked and np.array_equal(self.told, layer.material[: layer.fluid])):
            mark(*where[:4], layer.material, self.beside)
            self.marked, self.told[:] = True, layer.material[: layer.fluid]
        colours(*where, layer.material, self.beside, self.colour, *how)
        normals(*where, self.beside, self.colour, self.normal, *how)
        curvatures(*where, self.normal, self.curvature, *how)
        middle_curvatures(*where, self.normal, self.curvature, self.middle, *how)
        pull_interface(
            *where, layer.material, self.beside, self.middle, layer.matrix, law.corrected, law.tension,
            layer.acceleration, layer.mass, layer.v, self.book[0], *how,
        )  # fmt: skip

    def show_walls(self, step: float, ratio: float) -> None:
        """What fluid sees of walls, a ``step`` (s) on."""
        layer, law = self.layer, self.law
        if law.images:
            show_walls(
                layer.fluid, layer.x, layer.v, layer.mass, self.wall_density, self.wall_rate, self.wall_rate_before,
                step, ratio, self.table[0], law.cut, layer.record, layer.pressure,
            )  # fmt: skip
        else:
            self.take_pressure()

    def wet_walls(self) -> None:
        """Start boundary particles with the pressure of the fluid before them: the paper starts at ρ0 everywhere."""
        layer, law = self.layer, self.law
        self.list_pairs()
        self.pressurise(layer.density)
        self.take_pressure()
        self.wall_density[:] = law.state.density_at(layer.pressure[layer.fluid :])

    def take_pressure(self) -> None:
        """Pressure and velocity of the fluid before walls, as their particles have it."""
        layer, law, pairs = self.layer, self.law, self.pairs
        load_walls(
            layer.fluid, pairs.start, self.split, pairs.partner, layer.x, layer.v, layer.mass, layer.record,
            layer.pressure, self.walled[0], law.smoothing.kind, law.smoothing.length,
            *law.gravity, law.state.density, *pairs.period,
        )  # fmt: skip

    def finish(self, step: float) -> None:
        """Second half of a ``step`` (s), and length of the next from the largest |a| and c/h."""
        layer, law = self.layer, self.law
        hardest, swiftest = kick(
            layer.v, layer.acceleration, layer.density, layer.rate, *self.of_fluids[:2], self.of_pairs[1], self.table,
            *self.book, 0.5 * step, step,
        )  # fmt: skip
        self.max_speed = float(swiftest) ** 0.5
        limits = law.limits(float(hardest) ** 0.5, self.sound_rate)
        self.next_step = min(limits)
        self.rule = limits.index(self.next_step)
        if not 0.0 < self.next_step < np.inf:
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
