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

import numpy as np
from numpy.typing import NDArray

from continuum_sph.boundary import load_walls
from continuum_sph.eos import Tait, tait
from continuum_sph.layers import PUSH, RHO, STIFF, VOLUME, VX, VY, Layer, X, Y
from continuum_sph.rates import rates, split_rows
from continuum_sph.smoothing import Smoothing
from porescale.ground.jit import parallel_kernel, prange
from porescale.particles import PairList

Floats = NDArray[np.float64]

THINNEST = 0.8  # of ρ0: least density, far below any that water at Mach 0.1 has
RULES = ("sound", "acceleration", "viscosity")


@parallel_kernel
def kick_drift(
    x, v, acceleration, smoothed, density, rate, rate_before, predicted, half, step, ratio, lower, upper
):  # fmt: skip
    """First half kick, drift and prediction of density for fluid particles; overwrites x, v, predicted.

    v += half a;  x += step (v + smoothed);  predicted = ρ + step {D + ratio (D - D_before)}.  half, step: s;
    lower, upper (2,) m: surfaces of the walls.  The pressure of wall particles keeps water out of walls, but spray
    carries none: a particle that reaches a surface is put on it and loses its speed into it.  Returns how often.
    """
    stopped = 0
    for i in prange(density.shape[0]):
        for axis in range(2):
            v[i, axis] += half * acceleration[i, axis]
            at = x[i, axis] + step * (v[i, axis] + smoothed[i, axis])
            if at < lower[axis]:
                at = lower[axis]
                v[i, axis] = max(0.0, v[i, axis])
                stopped += 1
            if at > upper[axis]:
                at = upper[axis]
                v[i, axis] = min(0.0, v[i, axis])
                stopped += 1
            x[i, axis] = at
        predicted[i] = density[i] + step * (rate[i] + ratio * (rate[i] - rate_before[i]))
    return stopped


@parallel_kernel
def pressurise(x, v, mass, density, density0, sound_speed, stiffness, exponent, cut, pressure, record):
    """Pressure (Pa) of fluid particles from ``density`` (fluid,); overwrites their ``pressure`` and ``record``.

    cut: pressures below that of the air count as none (particles of a free surface do not pull).
    """
    for i in prange(density.shape[0]):
        rho = density[i]
        p, speed_ratio2 = tait(rho / density0, stiffness, exponent)
        if cut:
            p = max(0.0, p)
        pressure[i] = p
        record[i, X] = x[i, 0]
        record[i, Y] = x[i, 1]
        record[i, VX] = v[i, 0]
        record[i, VY] = v[i, 1]
        record[i, RHO] = rho
        record[i, PUSH] = p / (rho * rho)
        record[i, VOLUME] = mass[i] / rho
        record[i, STIFF] = rho / (sound_speed * sound_speed * speed_ratio2)


@parallel_kernel
def kick(v, acceleration, density, rate, half, step, least):
    """Second half kick and density of fluid particles; overwrites ``v``, ``density``.

    Continuity follows a particle that leaves its neighbours down to the density of a cloud, below zero if they were
    crowded: densities stop at ``least`` (kg/m³).  Returns the largest |a|² (m²/s⁴) and density (kg/m³), which limit
    the next step; maxima are exact in any order.
    """
    fastest = 0.0
    densest = 0.0
    for i in prange(density.shape[0]):
        ax = acceleration[i, 0]
        ay = acceleration[i, 1]
        v[i, 0] += half * ax
        v[i, 1] += half * ay
        rho = max(least, density[i] + step * rate[i])
        density[i] = rho
        fastest = max(fastest, ax * ax + ay * ay)
        densest = max(densest, rho)
    return fastest, densest


@dataclass(frozen=True)
class Law:
    """What the particles obey; numbers in SI.

    smoothing, tait : kernel and equation of state;  gravity : (x, y) m/s²;  viscosity : μ, Pa s;
    alpha, beta, softening : artificial viscosity;  diffusion : δ;  xsph : ε;  sticky : no-slip walls;
    cut : no tension;  courant : the 0.25 of eq. 49.
    """

    smoothing: Smoothing
    tait: Tait
    gravity: tuple[float, float]
    viscosity: float
    alpha: float = 0.0
    beta: float = 0.0
    softening: float = 0.01
    diffusion: float = 0.1
    xsph: float = 0.0
    sticky: bool = False
    cut: bool = True
    courant: float = 0.25

    def limits(self, acceleration: float, densest: float) -> tuple[float, float, float]:
        """Steps allowed by sound, acceleration (m/s²) and viscosity, s: eq. 49 with h²/ν in the third.

        0.25 h/c, 0.25 √(h/|a|), 0.125 h²/ν;  c at the ``densest`` particle (kg/m³).
        """
        h, ratio = self.smoothing.length, densest / self.tait.density
        sound = self.tait.sound_speed * max(ratio, 1.0) ** (0.5 * (self.tait.exponent - 1.0))
        infinite = float("inf")
        return (
            self.courant * h / sound,
            self.courant * (h / acceleration) ** 0.5 if acceleration > 0.0 else infinite,
            0.125 * h * h * self.tait.density / self.viscosity if self.viscosity > 0.0 else infinite,
        )


@dataclass
class Flow:
    """A layer, its law and its pairs, moving.

    step : steps done;  time, next_step : s;  last_steps : lengths (s) of the last step and the one before;
    limited : steps that each of `RULES` limited, rule : the one that limits the next;  stopped : times a particle was
    stopped at a wall's surface, ``lower`` and ``upper`` (2,) m, infinite unless set.
    """

    layer: Layer
    law: Law
    pairs: PairList
    step: int = 0
    time: float = 0.0
    next_step: float = 0.0
    last_steps: tuple[float, float] = (0.0, 0.0)
    limited: list[int] = field(default_factory=lambda: [0, 0, 0])
    rule: int = 0
    stopped: int = 0

    def __post_init__(self) -> None:
        self.reach = np.full(self.layer.count, self.law.smoothing.length)
        self.split = np.zeros(self.layer.count, np.int64)
        self.lower, self.upper = np.full(2, -np.inf), np.full(2, np.inf)

    def start(self) -> None:
        """Rates of the initial state, from which the first step goes on."""
        layer = self.layer
        layer.predicted[:] = layer.density
        self.evaluate()
        layer.rate_before[:] = layer.rate
        self.finish(0.0)
        self.last_steps = (self.next_step, self.next_step)

    def advance(self) -> None:
        """One step."""
        layer, step = self.layer, self.next_step
        # Rates belong to mid-steps: distance from the last to this one over that between the last two.
        ratio = (step + self.last_steps[0]) / (self.last_steps[0] + self.last_steps[1])
        self.stopped += kick_drift(
            layer.x, layer.v, layer.acceleration, layer.smoothed, layer.density, layer.rate, layer.rate_before,
            layer.predicted, 0.5 * step, step, ratio, self.lower, self.upper,
        )  # fmt: skip
        layer.rate, layer.rate_before = layer.rate_before, layer.rate
        self.evaluate()
        self.limited[self.rule] += 1
        self.finish(step)
        self.step += 1
        self.time += step
        self.last_steps = (step, self.last_steps[0])

    def evaluate(self) -> None:
        """Accelerations and density rates at the predicted densities."""
        layer, law, pairs = self.layer, self.law, self.pairs
        tait_law, h, kind = law.tait, law.smoothing.length, law.smoothing.kind
        fluid = layer.fluid
        if pairs.update(layer.x, self.reach):
            split_rows(fluid, pairs.start, pairs.partner, self.split)
        pressurise(
            layer.x, layer.v, layer.mass, layer.predicted, tait_law.density, tait_law.sound_speed,
            tait_law.stiffness, tait_law.exponent, law.cut, layer.pressure, layer.record,
        )  # fmt: skip
        load_walls(
            fluid, pairs.start, self.split, pairs.partner, layer.x, layer.v, layer.mass, layer.record,
            layer.pressure, layer.ghost, kind, h, *law.gravity,
            tait_law.density, tait_law.stiffness, tait_law.exponent, *pairs.period,
        )  # fmt: skip
        rates(
            fluid, pairs.start, self.split, pairs.partner, layer.record, layer.ghost,
            layer.acceleration, layer.rate, layer.smoothed,
            kind, h, *law.gravity, law.viscosity, law.alpha, law.beta, law.softening, tait_law.sound_speed,
            2.0 * law.diffusion * h * tait_law.sound_speed, law.sticky, law.xsph, *pairs.period,
        )  # fmt: skip

    def finish(self, step: float) -> None:
        """Second half of a ``step`` (s), and length of the next from the largest |a| and density."""
        layer, law = self.layer, self.law
        least = THINNEST * law.tait.density
        fastest, densest = kick(
            layer.v, layer.acceleration, layer.density, layer.rate, 0.5 * step, step, least
        )  # fmt: skip
        limits = law.limits(float(fastest) ** 0.5, float(densest))
        self.rule = int(np.argmin(limits))
        self.next_step = limits[self.rule]
