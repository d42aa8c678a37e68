"""Richards' equation on soil particles: water of a piece of soil, and what flows between pieces.

    ∂(ρ_w n w)/∂t = ρ_w ∇·(K ∇H),   H = p/(ρ_w g) + y,   K = k k_r

with w, p of `retention`, k_r of `conductivity`.  Water m_w of a particle is conserved; its pores are V less the volume
of its grains, so soil that is compressed raises p, and full pores have the stiffness K_w/n.  Between particles

    dm_i/dt = c ρ_w V_i Σ_j V_j k_ij (k_r,i + k_r,j) (H_i - H_j) (1/r) W',   k_ij = 2 k_i k_j/(k_i + k_j)

opposite in a pair (Cleary & Monaghan, J. Comput. Phys. 148 (1999) 227). Pieces of ground one after the other add up
their resistances, so the mean of k is their harmonic one: with the arithmetic one two pieces of 1 : 10 and 1 : 100, 4
rows each, let 12 % and 37 % too much through. That of k_r is arithmetic, so that wetting goes on into dry soil. c is
the inverse of -Σ V x² (1/r) W' on the lattice, which makes it exact there for quadratic H. H = const stays, whatever
the particles' places are: water at rest under its capillary fringe is exact.

Walls and soil that ends let nothing through.  Places outside (`outside`) do: open water has H = its level and no
resistance, so k_r = 1 there, and the half spacing of it that a pair crosses costs no head; into air water only leaves,
with H_i - y_f > 0, y_f the height at which the pair crosses the surface, half a spacing before the place, and at least
y_i: a seepage face to the first order in the spacing.  (With y_i for y_f soil full to a level surface drained until
the second row below it was at 0, one and a half spacings.)  Air over water that a piece sees and lies below
(y_i < level <= y_j) takes nothing: beside that piece the face is under water, and at rest, H_i = level, it would lose
level - y_f > 0 within a kernel's reach below the waterline.

Rates of all pieces advance together by a Runge-Kutta-Legendre scheme of the first order: s stages are stable for a step
(s² + s)/2 times that of one (Meyer, Balsara & Aslam, J. Comput. Phys. 257 (2014) 594).  What it leaves of a wave that
is faster than the step is a Legendre polynomial, of either sign.  A negative one would turn round the pressure that
pores have at the end of a step in which they are squeezed, and drive the soil where it should brake it; so each step is
two halves, which leave the square.
"""

import math
from dataclasses import dataclass, field
from typing import Any, NamedTuple

import numpy as np

from continuum_sph.seepage.mixture import LEAST_POROSITY
from continuum_sph.seepage.resistance import Resistance
from continuum_sph.unsaturated.conductivity import CONNECTIVITY, relative_permeability
from continuum_sph.unsaturated.outside import KIND, LEVEL, PX, PY, Outer
from continuum_sph.unsaturated.retention import VanGenuchten, effective_saturation, pressure_and_slope
from continuum_sph.water.bundles import Neighbours, image, row
from continuum_sph.water.smoothing import kernel_slope
from porescale.common.compiled.jit import inline, parallel_kernel, prange
from porescale.common.core.types import Floats

X, Y, VOLUME, HEAD, CONDUCTIVITY, SLOPE, PRESSURE, EFFECTIVE = range(8)
"""Columns of the state of a piece of soil: m, m, m²;  H, m;  k k_r, m/s;  dH/dw over the porosity, m;  p, Pa;  S_e."""
CONTENT, FROM_WATER, TO_AIR = range(3)
"""Columns of what is advanced: water of a piece of soil, what of it came from open water and went to air, kg/m."""
SAFE = 0.7
"""Share of the longest stable step that is taken: K and dH/dw grow within it where a front arrives."""
PART, RISE = range(2)
"""Columns of the weight of a pair of soil and a place: 1/m²;  how far the surface lies over the piece there, m."""
CHANGE = 0.01
"""Of the pores: by how much one step may change what is in those of any piece."""
MOST_STAGES = 25
"""Of one step; longer ones are split: round-off grows with s²."""


class Properties(NamedTuple):
    """density ρ_w kg/m³;  weight ρ_w g, N/m³;  connectivity l, m of k_r: 0 and 0 for k_r = 1;  place: volume of a
    place outside, m²;  unity: c."""

    density: Any
    weight: Any
    connectivity: Any
    m: Any
    place: Any
    unity: Any


@parallel_kernel
def update_state(content, grains, permeability, retention, properties, state):
    """Overwrites head, conductivity, slope, pressure and effective saturation in ``state`` (s, 8).

    content (s, 3) kg/m;  grains (s,) m²: volume of solid;  permeability (s,) m/s;  retention: `RetentionNumbers`.
    """
    for i in prange(grains.shape[0]):
        pores = max(1e-3 * state[i, VOLUME], state[i, VOLUME] - grains[i])
        filling = content[i, CONTENT] / (properties.density * pores)
        pressure, slope = pressure_and_slope(filling, retention)
        effective = effective_saturation(filling, retention)
        part = 1.0
        if properties.m > 0.0:
            part = relative_permeability(effective, properties.connectivity, properties.m)
        state[i, HEAD] = pressure / properties.weight + state[i, Y]
        state[i, CONDUCTIVITY] = permeability[i] * part
        if filling > retention.wet - 2.0 * CHANGE:  # it may be full at the end of the step
            slope = retention.stiffness
        state[i, SLOPE] = slope / properties.weight * state[i, VOLUME] / pores
        state[i, PRESSURE] = pressure
        state[i, EFFECTIVE] = effective


@parallel_kernel
def pair_weights(state, near, outer, place, weight, outer_weight):
    """Overwrites ``weight`` (m,) and ``outer_weight`` (k, 2), of which the first, 1/m²: -V_j (1/r) W' of every pair of
    soil and of every place that a row of soil sees, the latter over the share of the pair that lies in soil; 0 of
    covered places, and of air over water that the row sees and lies below.  The second: y_f - y_i >= 0, m.

    state (s, 8): places and volumes;  near, outer: see `flow_rates`;  place: volume of a place, m².
    """
    half = 0.5 * np.sqrt(place)
    for i in prange(state.shape[0]):
        for k in range(np.uint64(near.start[i]), np.uint64(near.split[i])):
            j = np.uint64(near.partner[k])
            dx = image(state[i, X] - state[j, X], near.period_x)
            dy = image(state[i, Y] - state[j, Y], near.period_y)
            weight[k] = -state[j, VOLUME] * kernel_slope(near.kind, np.sqrt(dx * dx + dy * dy) / near.h, near.h)
        level = -np.inf
        for k in range(np.uint64(outer.start[i]), np.uint64(outer.start[i + 1])):
            j = np.uint64(outer.partner[k])
            if outer.places[j, KIND] > 0.0:
                level = max(level, outer.places[j, LEVEL])
        below = state[i, Y] < level
        for k in range(np.uint64(outer.start[i]), np.uint64(outer.start[i + 1])):
            j = np.uint64(outer.partner[k])
            outer_weight[k, PART] = 0.0
            outer_weight[k, RISE] = 0.0
            submerged = below and outer.places[j, KIND] == 0.0 and outer.places[j, PY] >= level
            if outer.places[j, KIND] >= 0.0 and not submerged:
                dx = image(state[i, X] - outer.places[j, PX], near.period_x)
                dy = image(state[i, Y] - outer.places[j, PY], near.period_y)
                distance = np.sqrt(dx * dx + dy * dy)
                within = max(distance - half, half)
                slope = kernel_slope(near.kind, distance / near.h, near.h)
                outer_weight[k, PART] = -place * slope * distance / within
                if dy < 0.0 and distance > half:
                    outer_weight[k, RISE] = -dy * (distance - half) / distance


@inline
def outside_rate(i, state, permeability, outer, weight):
    """(rate from open water, rate to air, both 1/s over c V_i;  sum of conductances, 1/s) of piece i of soil.

    weight: the outer one of `pair_weights`;  the rest: of `flow_rates`.
    """
    own = permeability[i] + state[i, CONDUCTIVITY]
    head = state[i, HEAD] - state[i, Y]  # p/(ρ_w g), m
    leaving = 2.0 * state[i, CONDUCTIVITY]
    taken, given, conductance = 0.0, 0.0, 0.0
    for k in range(np.uint64(outer.start[i]), np.uint64(outer.start[i + 1])):
        j = np.uint64(outer.partner[k])
        if outer.places[j, KIND] > 0.0:
            taken += weight[k, PART] * own * (outer.places[j, LEVEL] - state[i, HEAD])
            conductance += weight[k, PART] * own
        elif head > weight[k, RISE]:
            given += weight[k, PART] * leaving * (head - weight[k, RISE])
            conductance += weight[k, PART] * leaving
    return taken, given, conductance


@parallel_kernel
def flow_rates(state, permeability, near, outer, weight, outer_weight, properties, rate):
    """Overwrites ``rate`` (s, 3) kg/(m s), that of `CONTENT` and what came from water and went to air.

    state (s, 8);  permeability (s,) m/s;  near: the list of soil, see `water.bundles`, of which partners that are no
    walls are read;  outer: see `outside`;  weight, outer_weight: of `pair_weights`.  Returns the largest rate (1/s) at
    which one piece goes to the head of the others, and the largest over volumes, 1/s.
    """
    fastest = 0.0
    quickest = 0.0
    for at in prange(permeability.shape[0]):
        i = row(at)
        within = 0.0
        conductance = 0.0
        head = state[i, HEAD]
        own = state[i, CONDUCTIVITY]
        through = permeability[i]
        for k in range(np.uint64(near.start[i]), np.uint64(near.split[i])):
            j = np.uint64(near.partner[k])
            part = weight[k] * (own + state[j, CONDUCTIVITY])
            if permeability[j] != through:
                share = 2.0 / (through + permeability[j])
                part = weight[k] * (own * (share * permeability[j]) + state[j, CONDUCTIVITY] * (share * through))
            within += part * (state[j, HEAD] - head)
            conductance += part
        taken, given, more = outside_rate(i, state, permeability, outer, outer_weight)
        whole = properties.unity * properties.density * state[i, VOLUME]
        rate[i, CONTENT] = whole * (within + taken - given)
        rate[i, FROM_WATER] = whole * taken
        rate[i, TO_AIR] = whole * given
        fastest = max(fastest, properties.unity * (conductance + more) * state[i, SLOPE])
        quickest = max(quickest, abs(rate[i, CONTENT]) / (properties.density * state[i, VOLUME]))
    return fastest, quickest


def unity(kind: int, ratio: float) -> float:
    """c: the inverse of -Σ V x² (1/r) W' over a square lattice, of a kernel of a ``kind`` with h ``ratio`` spacings."""
    total = 0.0
    for x, y in _lattice(ratio):
        total -= x * x * float(kernel_slope(kind, math.hypot(x, y) / ratio, ratio))
    return 1.0 / total


def lattice_rate(kind: int, ratio: float) -> float:
    """Rate (1/s) at which a piece within a square lattice goes to the head of the others, over D/spacing²: what
    `flow_rates` returns of full pores, where D = k K_w/(n ρ_w g)."""
    slopes = [float(kernel_slope(kind, math.hypot(x, y) / ratio, ratio)) for x, y in _lattice(ratio)]
    return -2.0 * unity(kind, ratio) * math.fsum(slopes)


def _lattice(ratio: float) -> list[tuple[float, float]]:
    """Places within 2 h, of h ``ratio`` spacings, of a square lattice about the one at 0, in spacings."""
    reach = math.ceil(2.0 * ratio)
    sites = [float(it) for it in range(-reach, reach + 1)]
    return [(x, y) for x in sites for y in sites if x or y]


def stages_of(share: float) -> int:
    """Stages of each half of a step that is so many times the longest safe one: an odd number, at most MOST_STAGES."""
    stages = max(1, math.ceil(0.5 * (math.sqrt(1.0 + 4.0 * min(share, 1e6)) - 1.0) - 1e-9))
    return min(MOST_STAGES, stages | 1)


def stages_in(share: float) -> int:
    """Stages that `Moisture.advance` takes for a time that is so many times the longest safe step, of pores whose
    filling hardly changes."""
    most = float(MOST_STAGES * (MOST_STAGES + 1))
    whole = max(0, math.ceil(share / most) - 1)
    return 2 * (whole * MOST_STAGES + stages_of(share - whole * most))


@dataclass
class Moisture:
    """Water in the pores of ``grains`` (s,) m² of solid with ``permeability`` (s,) m/s.

    retention : of the soil;  properties : see `Properties`;  porosity : at the start;  resistance : how k follows the
    porosity, None: it does not;  content (s, 3) kg/m: water, what of it came from outside
    and what went to air, since the start.
    """

    retention: VanGenuchten
    properties: Properties
    grains: Floats
    permeability: Floats
    porosity: float
    resistance: Resistance | None = None
    content: Floats = field(init=False)
    state: Floats = field(init=False)
    weight: Floats = field(init=False)  # (m,) and outer_weight (k, 2): of `pair_weights`, and room for more

    def __post_init__(self) -> None:
        count = len(self.grains)
        self.given = self.permeability.copy()
        self.content, self.state = np.zeros((count, 3)), np.zeros((count, 8))
        self.weight, self.outer_weight = np.zeros(0), np.zeros((0, 2))
        self._stages = [np.zeros((count, 3)) for _ in range(4)]

    def place(self, x: Floats, volume: Floats) -> None:
        """Take positions (s, 2) m and volumes (s,) m² of the soil."""
        self.state[:, :2], self.state[:, VOLUME] = x, volume
        if self.resistance is not None:
            n = np.maximum(LEAST_POROSITY, 1.0 - self.grains / volume)
            self.permeability[:] = self.resistance.permeability(self.given, n)

    def fill(self, pressure: Floats) -> None:
        """Start from a ``pressure`` (s,) Pa in the pores of the volumes taken last."""
        pores = self.state[:, VOLUME] - self.grains
        self.content[:] = 0.0
        self.content[:, CONTENT] = self.properties.density * pores * self.retention.filling(pressure)
        self.update(self.content)

    def update(self, content: Floats) -> None:
        """Pressures and conductivities of a ``content`` (s, 3) kg/m."""
        update_state(content, self.grains, self.permeability, self.retention.numbers, self.properties, self.state)

    def weigh(self, near: Neighbours, outer: Outer) -> None:
        """Take up which pieces of soil and places are near which, where they are now."""
        if len(self.weight) < len(near.partner):
            self.weight = np.zeros(len(near.partner) * 3 // 2)
        if len(self.outer_weight) < len(outer.partner):
            self.outer_weight = np.zeros((len(outer.partner) * 3 // 2, 2))
        pair_weights(self.state, near, outer, self.properties.place, self.weight, self.outer_weight)

    def rates(self, near: Neighbours, outer: Outer, rate: Floats) -> tuple[float, float]:
        """Overwrite ``rate`` (s, 3) kg/(m s); returns what `flow_rates` does."""
        fastest, quickest = flow_rates(
            self.state, self.permeability, near, outer, self.weight, self.outer_weight, self.properties, rate
        )
        return float(fastest), float(quickest)

    def advance(self, seconds: float, near: Neighbours, outer: Outer) -> int:
        """Let water flow for ``seconds``; returns the number of stages that it took."""
        self.weigh(near, outer)
        left, used = seconds, 0
        while left > 0.0:
            self.update(self.content)
            first = self._stages[3]
            fastest, quickest = self.rates(near, outer, first)
            longest = SAFE / fastest if fastest > 0.0 else math.inf
            wanted = min(left, CHANGE * self.porosity / quickest) if quickest > 0.0 else left
            stages = stages_of(wanted / longest)
            step = min(wanted, longest * stages * (stages + 1))
            self._legendre(0.5 * step, stages, first, near, outer)
            self.update(self.content)
            self.rates(near, outer, first)
            self._legendre(0.5 * step, stages, first, near, outer)
            left = left - step if step < left else 0.0
            used += 2 * stages
        self.update(self.content)
        return used

    def _legendre(self, step: float, stages: int, first: Floats, near: Neighbours, outer: Outer) -> None:
        """A ``step`` (s) of so many ``stages``, from the rates ``first``; overwrites ``content``."""
        before, now, rate, _ = self._stages
        weight = 2.0 * step / (stages * (stages + 1.0))
        before[:] = self.content
        np.multiply(first, weight, out=now)
        now += before
        for stage in range(2, stages + 1):
            self.update(now)
            self.rates(near, outer, rate)
            mu = (2.0 * stage - 1.0) / stage
            before *= (1.0 - stage) / stage
            before += mu * now
            before += mu * weight * rate
            before, now = now, before
        self.content[:] = now


def properties_of(
    density: float,
    gravity: float,
    retention: VanGenuchten,
    spacing: float,
    c: float,
    connectivity: float = CONNECTIVITY,
) -> Properties:
    """Properties of water of a ``density`` (kg/m³) in soil of a ``retention``;  gravity m/s²;  c: of `unity`."""
    return Properties(density, density * gravity, connectivity, retention.m, spacing * spacing, c)
