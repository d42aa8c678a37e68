"""The smallest kernels that do the job of water with XSPH: those of `bench_plain`, and what XSPH adds to them.

Places go by v + Σ (m_j/ρ̄) ε (v_j - v_i) W: one sum more in the pass over pairs, read by the drift.
"""

from __future__ import annotations

import numpy as np

from continuum_sph.bench_plain import PlainColumn, plain_kick, plain_walls
from continuum_sph.density import haste_of
from continuum_sph.layers import RHO, STIFF, VOLUME, VX, VY, P, X, Y
from continuum_sph.rates import split_rows
from continuum_sph.step import Flow
from porescale.ground.jit import parallel_kernel, prange
from porescale.ground.lanes import LANES, greater, lesser, nothing, root, take_rows, total


@parallel_kernel
def smoothed_drift(
    x, v, acceleration, smoothed, density, rate, before, mass, record, half, step, ratio, lower, upper, density0, b
):
    """`bench_plain.plain_drift` by ``smoothed`` (fluid, 2) m/s more than the velocity."""
    fastest = 0.0
    for i in prange(density.shape[0]):
        for axis in range(2):
            speed = v[i, axis] + half * acceleration[i, axis]
            at = x[i, axis] + step * (speed + smoothed[i, axis])
            if at < lower[axis]:
                at, speed = lower[axis], max(0.0, speed)
            if at > upper[axis]:
                at, speed = upper[axis], min(0.0, speed)
            x[i, axis] = at
            v[i, axis] = speed
            record[i, X + axis] = at
            record[i, VX + axis] = speed
        rho = max(0.8 * density0, density[i] + step * (rate[i] + ratio * (rate[i] - before[i])))
        relative = rho / density0
        square = relative * relative
        power = square * square * square
        record[i, RHO] = rho
        record[i, P] = b * (power * relative - 1.0)
        record[i, VOLUME] = mass[i] / rho
        record[i, STIFF] = rho / (7.0 * b / density0 * power)
        fastest = max(fastest, power)
    return fastest


@parallel_kernel
def smoothed_pairs(
    fluid, start, split, partner, record, acceleration, rate, smoothed, h, g, alpha, softening, delta, calm, sound, mu,
    xsph,
):  # fmt: skip
    """`bench_plain.plain_pairs`, and overwrites ``smoothed`` (fluid, 2) m/s;  xsph: ε."""
    scale = -8.75 / (np.pi * h * h * h * h)
    inverse, soft, half_g = 1.0 / h, softening * h * h, 0.5 * g
    haste, restless = haste_of(calm, h)
    strength = 2.0 * xsph * 1.75 / (np.pi * h * h)
    for i in prange(fluid):
        xi, yi, vxi, vyi = record[i, X], record[i, Y], record[i, VX], record[i, VY]
        rho, own, stiff = record[i, RHO], record[i, P], record[i, STIFF]
        specific = 1.0 / rho
        friction = 2.0 * mu * specific
        ax, ay, change, spread, sx, sy = nothing(), nothing(), nothing(), nothing(), nothing(), nothing()
        k = start[i]
        while k < split[i]:
            xj, yj, vxj, vyj, rho_j, pressure_j, volume, stiff_j = take_rows(record, partner, k, split[i], i)
            k += LANES
            dx, dy, vx, vy = xi - xj, yi - yj, vxi - vxj, vyi - vyj
            distance2 = dx * dx + dy * dy
            q = root(distance2) * inverse
            rest = greater(1.0 - 0.5 * q, 0.0)
            cube = rest * rest * rest
            part = volume * scale * cube
            approach = vx * dx + vy * dy
            hasty = lesser(restless + haste * greater(approach, -approach), 1.0)
            spread += (rho - rho_j + (stiff + stiff_j) * (half_g * dy)) * (part * hasty)
            change += approach * part
            both = rho + rho_j
            damp = -2.0 * alpha * sound * h * lesser(approach, 0.0) / ((distance2 + soft) * both) * rho_j
            push = ((own + pressure_j) * specific + damp) * part
            brake = friction * part
            ax += brake * vx - push * dx
            ay += brake * vy - push * dy
            weight = rho_j * volume / both * (cube * rest * (1.0 + 2.0 * q))
            sx -= weight * vx
            sy -= weight * vy
        wx, wy, swept = 0.0, 0.0, 0.0
        for n in range(np.uint64(split[i]), np.uint64(start[i + 1])):
            j = np.uint64(partner[n])
            dx, dy = xi - record[j, X], yi - record[j, Y]
            rest = max(1.0 - 0.5 * (np.sqrt(dx * dx + dy * dy) / h), 0.0)
            part = record[j, VOLUME] * scale * (rest * rest * rest)
            swept += (vxi * dx + vyi * dy) * part
            push = (own + record[j, P]) * specific * part
            wx -= push * dx
            wy -= push * dy
        acceleration[i, 0] = total(ax) + wx
        acceleration[i, 1] = total(ay) + wy - g
        rate[i] = rho * (total(change) + swept) + delta * sound * total(spread)
        smoothed[i, 0] = strength * total(sx)
        smoothed[i, 1] = strength * total(sy)


class PlainSmoothed(PlainColumn):
    """The water of ``flow``, with XSPH, by the smallest kernels."""

    xsph = True

    def __init__(self, flow: Flow) -> None:
        super().__init__(flow)
        self._smoothed = flow.layer.smoothed.copy()

    def _one(self, step: float) -> None:
        law, listed, h, sound = self.law, self.pairs, self.law.smoothing.length, self.state.sound_speed
        ratio = (step + self._last[0]) / (self._last[0] + self._last[1])
        fastest = smoothed_drift(
            self.x, self.v, self.acceleration, self._smoothed, self.density, self._rate, self._before, self.mass,
            self.record, 0.5 * step, step, ratio, self._lower, self._upper, self.state.density, self.state.stiffness,
        )  # fmt: skip
        self._rate, self._before = self._before, self._rate
        if listed.update(self.x, self._length):
            split_rows(self.fluid, listed.start, listed.partner, self._split)
        where = (self.fluid, listed.start, self._split, listed.partner, self.record)
        plain_walls(*where, h, -law.gravity[1])
        smoothed_pairs(
            *where, self.acceleration, self._rate, self._smoothed, h, -law.gravity[1], law.alpha, law.softening,
            2.0 * law.diffusion * h, law.calm, sound, law.fluids[0].viscosity, law.xsph,
        )  # fmt: skip
        hardest = plain_kick(
            self.v, self.acceleration, self.density, self._rate, 0.5 * step, step, 0.8 * self.state.density
        )  # fmt: skip
        self._last = (step, self._last[0])
        self.next_step = min(law.limits(float(hardest) ** 0.5, sound / h * float(fastest) ** 0.5))
