"""One step of a soil: kick, drift, strain, push, kick; and how long it may be.

    v½ = v + Δt/2 a,   x' = x + Δt v½,   σ' = σ(x', v½),   a' = a(x', σ', v½),   v' = v½ + Δt/2 a'

Eq. 48 of Maeda & Sakai 2004 has this order but for the rate of the step before, which no Δt makes stable for sound.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from continuum_sph.soil.gradient import velocity_gradients
from continuum_sph.soil.leapfrog import kick, kick_drift
from continuum_sph.soil.material import DENSITY, SOFTENED_STRAIN, TENSION, table
from continuum_sph.soil.momentum import Choices, accelerate
from continuum_sph.soil.parameters import RULES, SoilLaw
from continuum_sph.soil.side_walls import brake_beside_walls
from continuum_sph.soil.softening import average
from continuum_sph.soil.state import Soil
from continuum_sph.soil.stress import Straining, deform
from continuum_sph.soil.tension import repel_under_tension
from continuum_sph.soil.walls import place_walls, update_walls
from continuum_sph.water.bundles import Neighbours
from continuum_sph.water.no_step import LEAST, no_step
from continuum_sph.water.rates import split_rows
from porescale.common.core.errors import Fault, InputError
from porescale.common.neighbors import PairList

LASTING = 1.25
"""Times the step that diffusion was bounded for, how long it may last: one that is longer yet after a short step, or
the first, would exchange more volume than there is (`SoilLaw.most`)."""


@dataclass
class SoilFlow:
    """A soil, its law and its pairs (a full list), moving.

    step : steps done;  time, next_step : s;  limited : steps that each of `law.RULES` limited, rule : the one that
    limits the next;  limit : longest step that other layers allow, s;  stopped : times a particle was stopped at
    ``lower`` or ``upper`` (2,) m, infinite unless set;  sound_rate : largest c/h, 1/s;  max_speed : m/s;
    strained : the last step, s, for which the diffusion that is under way was bounded;  sheared (soil,) : plastic shear
    strain of the last step, averaged, where soil softens, else empty;  before_force : called before
    accelerations, to overwrite ``soil.force``.
    """

    soil: Soil
    law: SoilLaw
    pairs: PairList
    before_force: "Callable[[SoilFlow], None] | None" = None
    step: int = 0
    time: float = 0.0
    next_step: float = 0.0
    limit: float = float("inf")
    limited: list[int] = field(default_factory=lambda: [0, 0, 0])
    rule: int = 0
    stopped: int = 0
    sound_rate: float = 0.0
    max_speed: float = 0.0
    strained: float = 0.0

    def __post_init__(self) -> None:
        soil = self.soil
        soil.length[:] = self.law.smoothing.length
        self.pairs.adaptive = True
        self.table = table(self.law.materials)
        self.refuse_other_sizes()
        self.pulling = self.law.repulsion > 0.0 and bool((self.table[:, TENSION] > 0.0).any())
        softens = bool((self.table[:, SOFTENED_STRAIN] > 0.0).any())
        self.sheared, self.mean = np.zeros((2, soil.soil if softens else 0))
        self.split = np.zeros(soil.count, np.int64)
        self.lower, self.upper = np.full(2, -np.inf), np.full(2, np.inf)
        # Walls do not interact.
        self.pairs.group = np.where(np.arange(soil.count) < soil.soil, -1, 0).astype(np.int32)

    def refuse_other_sizes(self) -> None:
        """InputError when particles do not all stand for spacing² at the start, as their exchange of volume needs."""
        soil, n, wanted = self.soil, self.soil.soil, self.law.spacing**2
        found = soil.mass[:n] / self.table[soil.material[:n], DENSITY]
        wrong = np.flatnonzero(~np.isclose(found, wanted, rtol=1e-9, atol=0.0))
        if wrong.size:
            at = int(wrong[0])
            fault = Fault(
                f"soil.mass[{at}]", float(soil.mass[at]), "is not its material's density times spacing²", "kg/m",
                f"{wanted * soil.mass[at] / found[at]:.6g}",
            )  # fmt: skip
            raise InputError(fault)

    def start(self) -> None:
        """Accelerations of the initial state, from which the first step goes on."""
        self.begin(0.0)
        self.strain(0.0)
        self.push()
        self.end(0.0)

    def advance(self, step: float | None = None) -> None:
        """One step, of ``step`` (s) at most ``next_step`` if given."""
        step = self.next_step if step is None else step
        self.begin(step)
        self.strain(step)
        self.push()
        self.limited[self.rule] += 1
        self.end(step)
        self.step += 1
        self.time += step

    def begin(self, step: float) -> None:
        """First half kick and drift of a ``step`` (s)."""
        soil = self.soil
        self.stopped += kick_drift(
            soil.x, soil.v, soil.mass, soil.density, soil.acceleration, soil.drift, soil.record, 0.5 * step, step,
            self.lower, self.upper,
        )  # fmt: skip
        place_walls(soil.soil, soil.x, soil.v, soil.mass, self.table, soil.facing, soil.record, step)
        if self.pairs.update(soil.x, soil.length):
            split_rows(soil.soil, self.pairs.start, self.pairs.partner, self.split)

    def strain(self, step: float) -> None:
        """Velocity gradients at the new positions, and densities and stresses a ``step`` (s) on."""
        soil, law = self.soil, self.law
        self.update_walls()
        velocity_gradients(soil.soil, soil.record, soil.facing, soil.matrix, self.near, law.corrected, step)
        spin = -1.0 if law.printed_spin else 1.0
        max_sound2 = deform(
            soil.density, soil.stress, soil.material, self.table, soil.matrix, soil.spread, soil.separation_strain,
            soil.plastic_shear, self.sheared, soil.swelling, soil.record,
            Straining(
                step, min(step, LASTING * self.strained), spin, law.most, law.damping / law.smoothing.length, law.even,
                law.bounded, law.bearing,
            ),
        )  # fmt: skip
        if self.sheared.size:
            for _ in range(law.averages):
                average(soil.soil, soil.record, soil.material, self.sheared, self.mean, self.near)
                self.sheared, self.mean = self.mean, self.sheared
            soil.plastic_shear += self.sheared
        self.strained = step
        self.sound_rate = float(max_sound2) ** 0.5 / law.smoothing.length

    def push(self) -> None:
        """Compute the accelerations of the soil particles, m/s²."""
        soil, law = self.soil, self.law
        if self.before_force is not None:
            self.before_force(self)
        self.update_walls()
        diffusion = law.diffusion if self.time >= law.level_from else 0.0
        choices = Choices(
            *law.gravity, law.damping, law.printed_damping, diffusion, law.sound_diffusion * self.sound_rate,
            law.spacing_recovery, law.parted(self.strained), law.spacing, law.bounded,
        )  # fmt: skip
        accelerate(
            soil.soil, soil.record, soil.facing, soil.force, soil.stress, soil.acceleration, soil.spread, soil.drift,
            self.near, choices,
        )  # fmt: skip
        if self.pulling:
            repel_under_tension(
                soil.soil, soil.record, soil.stress, soil.acceleration, self.near, law.spacing, law.repulsion
            )  # fmt: skip

    def end(self, step: float) -> None:
        """Second half kick of a ``step`` (s), and length of the next from the largest |a| and c/h."""
        soil = self.soil
        drag = self.law.drag if self.time < self.law.settle else 0.0
        acceleration2, speed2 = kick(soil.v, soil.acceleration, 0.5 * step, math.exp(-drag * step))
        if self.law.side_friction > 0.0:
            brake_beside_walls(soil.soil, soil.v, soil.stress, soil.density, self.law.side_friction, step)
        self.max_speed = float(speed2) ** 0.5
        limits = self.law.limits(float(acceleration2) ** 0.5, self.sound_rate, self.limit)
        self.rule = int(np.argmin(limits))
        self.next_step = limits[self.rule]
        if not LEAST * self.law.step_at_rest <= self.next_step < np.inf:
            raise no_step(
                self.next_step, RULES[self.rule], soil.x, soil.acceleration, soil.density, self.step, self.time,
                "lower numerics.courant, or raise soil.numerics.damping or soil.stiffness",
            )  # fmt: skip

    def update_walls(self) -> None:
        """What soil reads of walls: stress and velocity of the soil before them."""
        soil = self.soil
        update_walls(
            soil.soil, self.near, soil.v, soil.mass, soil.stress, soil.force, soil.material, self.table, soil.facing,
            soil.record, *self.law.gravity,
        )  # fmt: skip

    @property
    def near(self) -> Neighbours:
        """The list of pairs as kernels take it."""
        pairs, smoothing = self.pairs, self.law.smoothing
        x, y = pairs.period
        around, along = (x, y) if max(x, y) > 0.0 else (None, None)
        return Neighbours(pairs.start, self.split, pairs.partner, around, along, smoothing.kind, smoothing.length)

    def state(self) -> dict[str, Any]:
        """Everything that later steps depend on."""
        return {
            "soil": self.soil.state(),
            "facing": self.soil.facing.copy(),
            "pairs": self.pairs.state(),
            "step": self.step,
            "time": self.time,
            "next_step": self.next_step,
            "limit": self.limit,
            "limited": list(self.limited),
            "rule": self.rule,
            "stopped": self.stopped,
            "pace": self.sound_rate,
            "swiftest": self.max_speed,
            "strained": self.strained,
        }

    def restore(self, state: dict[str, Any]) -> None:
        """Go on bit for bit from the ``state`` of a flow of the same start."""
        self.soil.restore(state["soil"])
        self.soil.facing[:] = state["facing"]
        self.pairs.restore(state["pairs"])
        split_rows(self.soil.soil, self.pairs.start, self.pairs.partner, self.split)
        self.step, self.time, self.next_step = state["step"], state["time"], state["next_step"]
        self.limit, self.limited, self.rule = state["limit"], list(state["limited"]), state["rule"]
        self.stopped, self.sound_rate, self.max_speed = state["stopped"], state["pace"], state["swiftest"]
        self.strained = state["strained"]
