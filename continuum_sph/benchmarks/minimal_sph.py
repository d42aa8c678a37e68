"""The smallest kernels that do the job of water alone: one liquid, closed walls that slip; nothing is chosen.

They are what `study parts` holds a column of water against: the step of `step.py` with Wendland's kernel, γ = 7,
artificial viscosity without β, hydrostatic density diffusion, and no energy budget; with XSPH, if the water has it,
and compiled without where it has not.  Sums run in the order of `rates`; the pair list is the one that everybody has.
"""

import numpy as np

from continuum_sph.water.density import HYDROSTATIC, noise_scale
from continuum_sph.water.eos.liquid import Tait
from continuum_sph.water.rates import split_rows
from continuum_sph.water.smoothing import WENDLAND
from continuum_sph.water.state import COMPRESSIBILITY, RHO, VOLUME, VX, VY, P, X, Y
from continuum_sph.water.step import Flow
from porescale.common.compiled.jit import parallel_kernel, prange
from porescale.common.compiled.simd import LANES, gather_rows, maximum, minimum, reduce_add, sqrt, zeros
from porescale.common.neighbors import PairList


@parallel_kernel
def plain_drift(x, v, acceleration, smoothed, density, rate, before, mass, record, lower, upper, numbers):
    """Half kick, drift, densities a step on and their pressures, of fluid particles: overwrites x, v, record.

    Arguments as of `leapfrog.kick_drift`;  numbers: step, s, ratio of rates, density0, kg/m³, and b of Tait, Pa.
    Returns the largest (c/c0)².
    """
    step, ratio, density0, b = numbers
    half = 0.5 * step
    fastest = 0.0
    for i in prange(density.shape[0]):
        for axis in range(2):
            speed = v[i, axis] + half * acceleration[i, axis]
            carried = speed
            if smoothed is not None:
                carried += smoothed[i, axis]
            at = x[i, axis] + step * carried
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
        record[i, COMPRESSIBILITY] = rho / (7.0 * b / density0 * power)
        fastest = max(fastest, power)
    return fastest


@parallel_kernel
def plain_walls(fluid, start, split, partner, record, h, g):
    """Pressure of the fluid before wall particles, `load_walls`: overwrites their column of ``record``."""
    for w in prange(fluid, record.shape[0]):
        weight, p = 0.0, 0.0
        for k in range(np.uint64(start[w]), np.uint64(split[w])):
            j = np.uint64(partner[k])
            dx, dy = record[w, X] - record[j, X], record[w, Y] - record[j, Y]
            q = np.sqrt(dx * dx + dy * dy) / h
            rest = max(1.0 - 0.5 * q, 0.0)
            value = rest * rest * rest * rest * (1.0 + 2.0 * q)
            weight += value
            p += (record[j, P] - record[j, RHO] * g * dy) * value
        record[w, P] = max(0.0, p / weight) if weight > 0.0 else 0.0


@parallel_kernel
def plain_pairs(fluid, start, split, partner, record, acceleration, rate, smoothed, numbers):
    """Overwrites ``acceleration`` (fluid, 2) and ``rate`` (fluid,), and ``smoothed`` (fluid, 2) if it is not None, as
    `rates.rates`.

    numbers: h, m;  g downwards, m/s²;  braking and spreading, α c0, m/s, and 2 δ h c0, m²/s;  softening, noise_speed,
    lattice and mu of `parameters.Law`;  xsph: ε, or 0.
    """
    h, g, braking, softening, spreading, noise_speed, mu, xsph, lattice = numbers
    scale = -8.75 / (np.pi * h * h * h * h)
    if smoothed is not None:
        strength = 2.0 * xsph * 1.75 / (np.pi * h * h)
    inverse, soft, half_g = 1.0 / h, softening * h * h, 0.5 * g
    inverse_noise_speed, sound_share = noise_scale(noise_speed, h)
    for i in prange(fluid):
        xi, yi, vxi, vyi = record[i, X], record[i, Y], record[i, VX], record[i, VY]
        rho, own, stiff = record[i, RHO], record[i, P], record[i, COMPRESSIBILITY]
        specific = 1.0 / rho
        friction = 2.0 * mu * specific
        ax, ay, change, spread, sx, sy = zeros(), zeros(), zeros(), zeros(), zeros(), zeros()
        k = start[i]
        while k < split[i]:
            xj, yj, vxj, vyj, rho_j, pressure_j, volume, stiff_j = gather_rows(record, partner, k, split[i], i)
            k += LANES
            dx, dy, vx, vy = xi - xj, yi - yj, vxi - vxj, vyi - vyj
            distance2 = dx * dx + dy * dy
            q = sqrt(distance2) * inverse
            rest = maximum(1.0 - 0.5 * q, 0.0)
            cube = rest * rest * rest
            part = volume * scale * cube
            approach = vx * dx + vy * dy
            hasty = minimum(sound_share + inverse_noise_speed * maximum(approach, -approach), 1.0)
            spread += (rho - rho_j + (stiff + stiff_j) * (half_g * dy)) * (part * hasty)
            change += approach * part
            both = rho + rho_j
            damp = -2.0 * braking * h * minimum(approach, 0.0) / ((distance2 + soft) * both) * rho_j
            push = ((own + pressure_j) * specific + damp) * part
            brake = friction * part
            ax += brake * vx - push * dx
            ay += brake * vy - push * dy
            if smoothed is not None:
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
        acceleration[i, 0] = lattice * (reduce_add(ax) + wx)
        acceleration[i, 1] = lattice * (reduce_add(ay) + wy) - g
        rate[i] = rho * lattice * (reduce_add(change) + swept) + spreading * reduce_add(spread)
        if smoothed is not None:
            smoothed[i, 0] = strength * reduce_add(sx)
            smoothed[i, 1] = strength * reduce_add(sy)


@parallel_kernel
def plain_kick(v, acceleration, density, rate, half, step, thinnest):
    """Second half kick and density: overwrites v, density.  Returns the largest |a|², m²/s⁴."""
    hardest = 0.0
    for i in prange(density.shape[0]):
        ax, ay = acceleration[i, 0], acceleration[i, 1]
        v[i, 0] += half * ax
        v[i, 1] += half * ay
        density[i] = max(thinnest, density[i] + step * rate[i])
        hardest = max(hardest, ax * ax + ay * ay)
    return hardest


class PlainColumn:
    """The water of ``flow`` by the smallest kernels, from where it is now on, with a list of its own."""

    def __init__(self, flow: Flow) -> None:
        layer, law, own = flow.layer, flow.law, flow.pairs
        assert len(law.fluids) == 1
        assert not any((law.images, law.varied, law.fluids[0].cohesion, law.gravity[0], layer.has_budget))
        assert law.smoothing.kind == WENDLAND
        assert law.noise == HYDROSTATIC
        assert not any((law.sticky, law.corrected, law.shifting, law.beta, law.cut, law.filter_every))
        assert own.period == (0.0, 0.0)
        state = law.fluids[0].state
        assert isinstance(state, Tait)
        assert state.exponent == 7.0
        self.fluid, self.law, self.state = layer.fluid, law, state
        self.x, self.v, self.mass, self.density = (a.copy() for a in (layer.x, layer.v, layer.mass, layer.density))
        self.acceleration, self.record = layer.acceleration.copy(), layer.record.copy()
        self._rate, self._before, self._length = layer.rate.copy(), layer.rate_before.copy(), layer.length.copy()
        self._lower, self._upper = flow.lower.copy(), flow.upper.copy()
        self.next_step, self._last = flow.next_step, flow.last_steps
        self._smoothed = layer.smoothed.copy() if law.xsph > 0.0 else None
        self.pairs = PairList(layer.count, own.most, own.lower, own.upper, full=True)
        self.pairs.adaptive = True
        self.pairs.restore(own.state())
        self._split = np.zeros(layer.count, np.int64)
        split_rows(self.fluid, self.pairs.start, self.pairs.partner, self._split)

    def advance(self, steps: int) -> None:
        """So many steps, each as long as sound, acceleration and viscosity allow."""
        for _ in range(steps):
            self._one(self.next_step)

    def _one(self, step: float) -> None:
        law, listed, h, sound = self.law, self.pairs, self.law.smoothing.length, self.state.sound_speed
        ratio = (step + self._last[0]) / (self._last[0] + self._last[1])
        fastest = plain_drift(
            self.x, self.v, self.acceleration, self._smoothed, self.density, self._rate, self._before, self.mass,
            self.record, self._lower, self._upper, (step, ratio, self.state.density, self.state.stiffness),
        )  # fmt: skip
        self._rate, self._before = self._before, self._rate
        if listed.update(self.x, self._length):
            split_rows(self.fluid, listed.start, listed.partner, self._split)
        where = (self.fluid, listed.start, self._split, listed.partner, self.record)
        plain_walls(*where, h, -law.gravity[1])
        plain_pairs(
            *where, self.acceleration, self._rate, self._smoothed,
            (h, -law.gravity[1], law.alpha * sound, law.softening, 2.0 * law.diffusion * h * sound, law.noise_speed,
             law.fluids[0].viscosity, law.xsph, law.lattice),
        )  # fmt: skip
        hardest = plain_kick(
            self.v, self.acceleration, self.density, self._rate, 0.5 * step, step, 0.8 * self.state.density
        )  # fmt: skip
        self._last = (step, self._last[0])
        self.next_step = min(law.limits(float(hardest) ** 0.5, sound / h * float(fastest) ** 0.5))
