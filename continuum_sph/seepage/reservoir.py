"""Water kept at a level: strips of open water in which particles enter and leave, each one recorded.

What stands in a strip is measured by its weight above a line two spacings over its bottom,

    level = line + Σ w(x_i, y_i) m_i/(ρ0 ∫ w dx)

so that the head on what lies below is exact, however the particles are packed and whatever is below the line: kernels
smear the grains of ground over two spacings and more, its lowest rows of water hold 0.15 of a row less than in the
open, and what flowed out of it stood 0.1 spacings too high where it was weighed from the bottom.  w is 1 but for cosine
ramps at the ends that lie in the water: a column of particles that crosses an end would else change the level by its
whole share.  So would a row that crosses the line, and water that rises by a fraction of a row would be let stand as
much too high: there a straight ramp of a spacing, the distance of rows in the open, takes in rows in part.  Water less
than four spacings deep is weighed above half of its depth.  On the floor of a tank all of it is.

While more than half a particle is missing one is put on the lowest place of the surface, at rest or as fast as the
surface there sinks, unless that stands far over the level already; while more than half a particle is over the highest
of the strip is taken out.  A level at the bottom takes out whatever comes.

A particle is put a spacing above what is below it, and nearer by the cube of level over surface where what stands in
the strip is sparse.  Water would else come in sparser than it is, by 5 %, stand so much higher, and press the more on
what lies beside it: the discharge of a dam, right up to 21 s, is 2.6 % too large up to 35.  Put at rest on water that
runs off below, it would fall after that: a river that rises fast would be half as dense over a third of its depth, and
stand up to a quarter higher than it weighs.

What has passed on is a balance of the strip and the water before it: what was let in less what was let out, and less
the change of

    Σ w(x_i, y_i) m_i

where w is 1 in the strip, with a ramp of two spacings about its bottom, and falls as a cosine beyond each end that lies
in the water: to 0 halfway to the next strip, or over 3 spacings where there is none.  It is the mass that has passed a
section, in the mean over all sections on the way, so it has no steps of whole particles, and hardly any of the drops in
which water leaves ground.  The sum over all reservoirs is, to round-off, what the rest of the tank has gained: nothing
where nothing changes any more.

Arrays keep their lengths: particles that are not in the tank have no mass and wait at berths of their own over it, so
far from each other and from all else that they have no neighbours.  A row without mass is a waiting particle.
"""

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any, NamedTuple

import numpy as np

from continuum_sph.water.state import Layer
from porescale.common.compiled.jit import kernel
from porescale.common.core.types import Floats

HALF = 0.5  # of the distance between two rows
ABOVE = 2.0  # spacings from the bottom to the line above which water is weighed: kernels end at 2.75
RAMP = 3.0  # spacings: of a lattice that passes, w takes in the same mass to a thousandth
BERTH = 1.5  # cutoffs between berths
HEAP = 0.1
"""Of the depth: how much higher than its level a surface may stand to make up for what its particles leave empty; a
column of water that falls is not topped up beyond."""
CLOSER = 3
"""Power p of level over surface by which particles are put nearer.  Of a share ε by which water comes in too sparse it
leaves ε/(1 + p): what stands there has the density γ with γ = (1 - ε)/γ^p."""


@kernel
def park_waiting(fluid, x, v, mass, density, predicted, berth, density0):
    """Puts particles without mass back where they wait, at rest; overwrites their ``x``, ``v`` (n, 2), ``density`` and
    ``predicted`` (fluid,) kg/m³;  berth (fluid, 2) m;  density0 kg/m³."""
    for i in range(fluid):
        if mass[i] == 0.0:
            x[i, 0] = berth[i, 0]
            x[i, 1] = berth[i, 1]
            v[i, 0] = 0.0
            v[i, 1] = 0.0
            density[i] = density0
            predicted[i] = density0


class Strip(NamedTuple):
    """Where water is weighed, m: ends and the ramps beside them; bottom; the line above which it is, half the height of
    the ramp about it; ``half`` a spacing."""

    left: float
    right: float
    ramp_left: float
    ramp_right: float
    bottom: float
    line: float
    ramp: float
    half: float


@kernel
def measure_strip(fluid, x, v, mass, material, strip, least, tops, sinking):
    """(Σ w m over the ``strip`` above its line, kg/m;  number of its highest particle of a w over ``least``, -1 for
    none);  overwrites ``tops`` (columns,) m, the highest particle near the middle of each column of the strip, half a
    spacing below the bottom where there is none, and ``sinking`` (columns,) m/s, its upright velocity if down, else 0.

    x (n, 2) m;  v (n, 2) m/s;  mass (n,) kg/m, 0: not there;  material (n,), water is 0;  strip: a `Strip`, m.
    """
    left, right, ramp_left, ramp_right, bottom, line, ramp, half = strip
    columns = tops.shape[0]
    breadth = (right - left) / columns
    inverse = 0.5 / ramp
    for c in range(columns):
        tops[c] = bottom - half
        sinking[c] = 0.0
    total = 0.0
    highest = -1
    for i in range(fluid):
        if mass[i] == 0.0 or material[i] != 0 or x[i, 0] < left or x[i, 0] > right:
            continue
        share = max(0.0, min(1.0, 0.5 + (x[i, 1] - line) * inverse))
        if share == 0.0 and x[i, 1] < bottom:
            continue
        weight = 1.0
        if x[i, 0] < left + ramp_left:
            weight = 0.5 - 0.5 * np.cos(np.pi * (x[i, 0] - left) / ramp_left)
        elif x[i, 0] > right - ramp_right:
            weight = 0.5 - 0.5 * np.cos(np.pi * (right - x[i, 0]) / ramp_right)
        total += weight * mass[i] * share
        if x[i, 1] < bottom:
            continue
        if weight > least and (highest < 0 or x[i, 1] > x[highest, 1]):
            highest = i
        at = (x[i, 0] - left) / breadth
        first = max(0, int(np.floor(at - 1.25)))
        for c in range(first, min(columns, first + 3)):
            if abs(at - c - 0.5) < 0.75 and x[i, 1] > tops[c]:
                tops[c] = x[i, 1]
                sinking[c] = min(0.0, v[i, 1])
    return total, highest


class NoneLeftError(Exception):
    """No particle waits to bring the reservoir ``name`` from its ``level`` (m) to its ``target`` (m)."""

    def __init__(self, name: str, level: float, target: float) -> None:
        self.name, self.level, self.target = name, level, target
        super().__init__(f"reservoir {name}: no particles left to bring it from {level:g} to {target:g} m")


@dataclass
class Reservoir:
    """A strip whose water is kept at a level.

    left, right, bottom : m;  times (k,) s and levels (k,) m : straight lines between them, constant before and after;
    walls : whether each end lies at a wall of the tank;  let_in, let_out : mass recorded so far, kg/m;  level : of the
    last step, m;  full : kg/m² of the strip to a metre of level;  strip : where it is weighed on the floor
    of a tank, and see `strip_for`;  reach : the strip and the ways on which water counts in part as passed on;  held :
    mass in the reach at the start, kg/m.
    """

    name: str
    left: float
    right: float
    bottom: float
    times: Floats
    levels: Floats
    walls: tuple[bool, bool] = (False, False)
    let_in: float = 0.0
    let_out: float = 0.0
    level: float = 0.0
    held: float = field(default=float("nan"))
    full: float = 0.0
    tops: Floats = field(default_factory=lambda: np.zeros(0))
    sinking: Floats = field(default_factory=lambda: np.zeros(0))
    ramps: tuple[float, float] = (0.0, 0.0)
    strip: Strip = field(init=False)
    reach: Strip = field(init=False)

    def fit(self, spacing: float, density: float, others: Sequence["Reservoir"] = ()) -> None:
        """Columns, ramps and reach for particles of a ``spacing``, m, and a ``density``, kg/m³, beside ``others``."""
        breadth = self.right - self.left
        self.tops, self.sinking = np.zeros((2, max(1, round(breadth / spacing))))
        ramp = min(RAMP * spacing, 0.5 * breadth)
        self.ramps = (0.0 if self.walls[0] else ramp, 0.0 if self.walls[1] else ramp)
        self.full = density * self.width
        half = HALF * spacing
        # On the floor the line lies below all water.
        self.strip = Strip(self.left, self.right, *self.ramps, self.bottom, self.bottom - spacing, half, half)
        before = [HALF * (self.left - it.right) for it in others if it.left < self.left]
        behind = [HALF * (it.left - self.right) for it in others if it.left > self.left]
        ways = [max(0.0, min(gaps, default=RAMP * spacing)) for gaps in (before, behind)]
        first, last = (0.0 if wall else way for wall, way in zip(self.walls, ways, strict=True))
        self.reach = self.strip._replace(
            left=self.left - first, right=self.right + last, ramp_left=first, ramp_right=last,
            line=self.bottom if self.bottom > 0.0 else self.strip.line, ramp=spacing,
        )  # fmt: skip

    @property
    def width(self) -> float:
        """Effective width of the strip, ∫ w dx, m."""
        return self.right - self.left - 0.5 * sum(self.ramps)

    def strip_for(self, level: float) -> tuple[Strip, float]:
        """The strip, with the line above which water is weighed for a ``level`` (m), and the height (m) from which that
        weight counts."""
        if self.bottom <= 0.0:
            return self.strip, self.bottom
        line = self.bottom + min(ABOVE * 2.0 * self.strip.half, 0.5 * max(0.0, level - self.bottom))
        return self.strip._replace(line=line), line

    def wanted(self, time: float) -> float:
        """Level (m) at a ``time`` (s)."""
        return float(np.interp(time, self.times, self.levels))


class Supply:
    """The reservoirs of a layer, and those of its particles that wait.

    berth : (fluid, 2) m, where each would wait;  spare : particles that wait for reservoirs at the start, those beyond
    are for `halving`.
    """

    def __init__(
        self, layer: Layer, reservoirs: Sequence[Reservoir], berth: Floats, spacing: float, density: float,
        stiffness: float, gravity: float, spare: int,
    ) -> None:  # fmt: skip
        """spacing m;  density : ρ0, kg/m³;  stiffness : ρ0 c0², Pa, for pressures of new particles;  gravity m/s²."""
        assert berth.shape == (layer.fluid, 2)
        self.layer, self.reservoirs, self.berth, self.spacing = layer, list(reservoirs), berth, spacing
        self.density, self.stiffness, self.gravity, self.spare = density, stiffness, gravity, spare
        self.whole = density * spacing * spacing  # kg/m, of a new particle
        for it in self.reservoirs:
            it.fit(spacing, density, [other for other in self.reservoirs if other is not it])

    @property
    def reserve(self) -> int:
        """How many particles are still to wait for reservoirs."""
        net = sum(pool.let_in - pool.let_out for pool in self.reservoirs)
        return max(0, self.spare - round(net / self.whole))

    def keep(self, time: float) -> None:
        """Bring every reservoir to its level of ``time`` (s), between drift and forces of a step.

        Raises NoneLeftError when more water is wanted than there are particles.
        """
        layer = self.layer
        for reservoir in self.reservoirs:
            if np.isnan(reservoir.held):
                reservoir.held = self._within(reservoir)
            self._level(reservoir, time)
        park_waiting(
            layer.fluid, layer.x, layer.v, layer.mass, layer.density, layer.predicted, self.berth, self.density
        )  # fmt: skip

    def _within(self, pool: Reservoir) -> float:
        """Mass in the reach of ``pool``, kg/m."""
        layer, unused = self.layer, np.zeros((2, 1))
        return float(
            measure_strip(layer.fluid, layer.x, layer.v, layer.mass, layer.material, pool.reach, 1.0, *unused)[0]
        )

    def passed(self, pool: Reservoir) -> float:
        """Mass that has passed on from ``pool`` towards the next reservoir since the start, kg/m, below zero for what
        has come from there: let in less let out, and less what its reach holds more."""
        return pool.let_in - pool.let_out + pool.held - self._within(pool)

    def _level(self, pool: Reservoir, time: float) -> None:
        """Add or take particles until ``pool`` is within half a particle of its level."""
        layer, target, full = self.layer, pool.wanted(time), pool.full
        strip, line = pool.strip_for(target)
        while True:
            held, highest = measure_strip(
                layer.fluid, layer.x, layer.v, layer.mass, layer.material, strip,
                -1.0 if target <= pool.bottom else 0.5, pool.tops, pool.sinking,
            )  # fmt: skip
            over = held - full * (target - line)
            pool.level = line + held / full
            if highest >= 0 and (over > 0.5 * layer.mass[highest] or target <= pool.bottom):
                pool.let_out += float(layer.mass[highest])
                layer.mass[highest] = 0.0
            elif over > -0.5 * self.whole or not self._fill(pool, target, round(-over / self.whole)):
                return

    def _fill(self, pool: Reservoir, target: float, count: int) -> bool:
        """Put ``count`` particles, at most a row, on the lowest places of the surface of ``pool``, unless these are as
        high as they may be; whether one was put."""
        layer, columns = self.layer, len(pool.tops)
        most = target + HEAP * (target - pool.bottom)
        if float(pool.tops.min()) + 0.5 * self.spacing > most:
            return False
        surface = float(pool.tops.mean()) + 0.5 * self.spacing - pool.bottom
        dense = min(1.0, (pool.level - pool.bottom) / surface) if surface > 0.0 else 1.0
        dense = max(dense, 1.0 / (1.0 + HEAP))  # what splashes over the strip does not make it sparse
        apart = dense**CLOSER * self.spacing
        free = np.flatnonzero(layer.mass[: layer.fluid] == 0.0)
        for i in free[: min(count, columns)]:
            c = int(np.argmin(pool.tops))
            if pool.tops[c] + 0.5 * self.spacing > most:
                break
            height = pool.tops[c] = pool.tops[c] + apart
            layer.x[i] = pool.left + (c + 0.5) * (pool.right - pool.left) / columns, height
            layer.v[i] = layer.smoothed[i] = 0.0, pool.sinking[c]
            layer.drift[i] = 0.0
            depth = max(0.0, target - height)
            layer.density[i] = layer.predicted[i] = self.density * (
                1.0 + self.density * self.gravity * depth / self.stiffness
            )
            layer.rate[i] = layer.rate_before[i] = 0.0
            layer.mass[i], layer.renewed[i] = self.whole, True
            pool.let_in += self.whole
        if not len(free):
            raise NoneLeftError(pool.name, pool.level, target)
        return True

    def state(self) -> dict[str, Any]:
        """The mass let in and out of each reservoir, kg/m; waiting particles are those without mass."""
        return {
            "let_in": np.array([pool.let_in for pool in self.reservoirs]),
            "let_out": np.array([pool.let_out for pool in self.reservoirs]),
            "level": np.array([pool.level for pool in self.reservoirs]),
        }

    def restore(self, state: dict[str, Any]) -> None:
        """Go on from the ``state`` of a supply of the same reservoirs."""
        for name in ("let_in", "let_out", "level"):
            for pool, value in zip(self.reservoirs, state[name], strict=True):
                setattr(pool, name, float(value))


def berths(count: int, width: float, floor: float, pitch: float) -> Floats:
    """Places (count, 2) m, ``pitch`` (m) apart, in rows of a ``width`` (m) over a height ``floor`` (m)."""
    row = max(1, int(width / pitch))
    number = np.arange(count)
    return np.column_stack(((number % row + 0.5) * pitch, floor + (number // row + 1.0) * pitch))
