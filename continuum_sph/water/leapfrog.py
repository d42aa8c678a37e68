"""Kernels that move particles one by one: half kicks, drift, pressure from density.

As of `rates`, what a scene has no use for is None.  Pressures are those of one fluid, by whose law the kernel is
compiled: of several fluids each takes a call, which leaves the particles of the others alone.
"""

from typing import Any, NamedTuple

from continuum_sph.water.bundles import row
from continuum_sph.water.eos.law import pressure_of
from continuum_sph.water.fluids import LEAST_DENSITY
from continuum_sph.water.state import COMPRESSIBILITY, RHO, STOPPED, VOLUME, VX, P, X
from porescale.common.compiled.jit import inline, parallel_kernel, prange


class Motion(NamedTuple):
    """acceleration (fluid, 2) m/s²;  smoothed (fluid, 2) m/s, None without XSPH, and drift (fluid, 2) m/s, None without
    shifting: what moves particles besides their velocity."""

    acceleration: Any
    smoothed: Any
    drift: Any


class Densities(NamedTuple):
    """density (fluid,) kg/m³;  rate, rate_before (fluid,) kg/(m³ s), of the last step and the one before."""

    density: Any
    rate: Any
    rate_before: Any


class Pressing(NamedTuple):
    """What pressures are made of, and where they go.

    number, viscosity (Pa s): of the fluid;  material (n,): numbers of the particles' fluids, None of one fluid;
    properties (fluid, 2), lengths (n, 2): overwritten, see `bundles.Fluids`;  mass (n,) kg/m;  length (n,) m;
    pressure (n,) Pa and record (n, 8), see `state.Layer`: overwritten;  cut: pressures below that of the air count as
    none (particles of a free surface do not pull).
    """

    number: Any
    viscosity: Any
    material: Any
    properties: Any
    lengths: Any
    mass: Any
    length: Any
    pressure: Any
    record: Any
    cut: Any


@inline
def is_other(material, number, i):
    """Whether particle i is of another fluid than that of the ``number``."""
    if material is None:
        return False
    return material[i] != number


@inline
def store_properties(properties, i, number, viscosity):
    """Overwrites row i of ``properties`` (fluid, 2), unless it is None."""
    if properties is not None:
        properties[i, 0] = number
        properties[i, 1] = viscosity


@inline
def over_length2(lengths, length, i, speed2):
    """c², m²/s², over h² of particle i where lengths vary, whose row of ``lengths`` it overwrites; c² elsewhere."""
    if lengths is not None:
        lengths[i, 0] = length[i]
        speed2 /= length[i] * length[i]
    return speed2


@inline
def over_common_length2(lengths, length, speed2):
    """c², m²/s², over the h² that all have, where they have one."""
    if lengths is None:
        return speed2 / (length[0] * length[0])
    return speed2


@inline
def update_pressure(i, rho, to, law):
    """Pressure (Pa) of particle i from its density ``rho`` by the numbers of a ``law`` (`eos`); overwrites all of it
    that ``to``, a `Pressing`, holds but places and velocities.  Returns c²/h² or c², as of `over_length2`.

    The density of a step's end is extrapolated, for spray that hits a wall below zero: it stops at the fluid's least.
    """
    if rho < law.least_density:
        rho = law.least_density
    p, speed_ratio2 = pressure_of(rho / law.density, law)
    if to.cut:
        p = max(0.0, p)
    speed2 = law.sound_speed * law.sound_speed * speed_ratio2
    to.pressure[i] = p
    to.record[i, RHO] = rho
    to.record[i, P] = p
    to.record[i, VOLUME] = to.mass[i] / rho
    to.record[i, COMPRESSIBILITY] = rho / speed2
    store_properties(to.properties, i, to.number, to.viscosity)
    return over_length2(to.lengths, to.length, i, speed2)


@inline
def store_place(record, i, axis, at, speed):
    """Overwrites place (m) and velocity (m/s) of particle i along an axis in ``record`` (n, 8)."""
    record[i, X + axis] = at
    record[i, VX + axis] = speed


@inline
def added(carried, velocities, i, axis):
    """A velocity (m/s) with that of row i of ``velocities`` (fluid, 2), unless these are None."""
    if velocities is None:
        return carried
    return carried + velocities[i, axis]


@inline
def add_stopped(energy, i, mass, into):
    """Adds the kinetic energy of a speed ``into`` a wall (m/s) to that stopped there, (fluid, 6) J/m, unless None."""
    if energy is not None:
        energy[i, STOPPED] += 0.5 * mass[i] * into**2


@parallel_kernel
def kick_drift(x, v, motion, densities, predicted, to, energy, step, ratio, bounds, together, law):
    """First half kick, drift and prediction of density for particles of a fluid; overwrites x, v, predicted.

    v += step/2 a;  x += step (v + smoothed + drift);  predicted = ρ + step {D + ratio (D - D_before)}.  motion,
    densities, to: see `Motion`, `Densities`, `Pressing`;  step, s;  bounds (2, 2) m: lower and upper surfaces of the
    walls.  The pressure of wall particles keeps water out of walls, but spray carries none: a particle that reaches a
    surface is put on it and loses its speed into it, whose energy is added to ``energy`` (fluid, 6) J/m, None without
    a budget.  Does also what `pressurise` does, unless ``together`` is None;  law: see there.  Returns how often
    particles were stopped, and what `pressurise` does, or 0.
    """
    stopped = 0
    fastest = 0.0
    half = 0.5 * step
    for number in prange(densities.density.shape[0]):
        i = row(number)
        if is_other(to.material, to.number, i):
            continue
        for axis in range(2):
            speed = v[i, axis] + half * motion.acceleration[i, axis]
            carried = added(added(speed, motion.smoothed, i, axis), motion.drift, i, axis)
            at = x[i, axis] + step * carried
            if at < bounds[0, axis] or at > bounds[1, axis]:
                into = min(0.0, speed) if at < bounds[0, axis] else max(0.0, speed)
                at = bounds[0, axis] if at < bounds[0, axis] else bounds[1, axis]
                speed -= into
                stopped += 1
                add_stopped(energy, i, to.mass, into)
            x[i, axis] = at
            v[i, axis] = speed
            if together is not None:
                store_place(to.record, i, axis, at, speed)
        rate = densities.rate[i]
        rho = densities.density[i] + step * (rate + ratio * (rate - densities.rate_before[i]))
        predicted[i] = rho
        if together is not None:
            fastest = max(fastest, update_pressure(i, rho, to, law))
    return stopped, over_common_length2(to.lengths, to.length, fastest)


@parallel_kernel
def pressurise(x, v, density, to, law):
    """Pressure (Pa) of particles of a fluid from ``density`` (fluid,); overwrites what ``to`` holds, see `Pressing`.

    law: numbers of the fluid's, see `eos`.  Returns the largest (c/h)², 1/s²; a maximum is exact in any order.
    """
    fastest = 0.0
    for number in prange(density.shape[0]):
        i = row(number)
        if is_other(to.material, to.number, i):
            continue
        for axis in range(2):
            store_place(to.record, i, axis, x[i, axis], v[i, axis])
        fastest = max(fastest, update_pressure(i, density[i], to, law))
    return over_common_length2(to.lengths, to.length, fastest)


@parallel_kernel
def kick(v, acceleration, density, rate, material, length, lengths, table, power, energy, half, step):
    """Second half kick, density, smoothing length and energies; overwrites v, density, length, energy.

    Continuity follows a particle that leaves its neighbours down to the density of a cloud, below zero if they were
    close: densities stop at the fluid's least.  Where there are ``lengths`` h -= step h/(2ρ) dρ/dt, eq. 52 in two
    dimensions.  energy (fluid, 6) J/m grows by step times ``power`` but for what was STOPPED; both None without a
    budget.  material, length, lengths: of `Pressing`;  table: the fluids.  Returns the largest |a|² (m²/s⁴) and |v|²
    (m²/s²), which limit the next step and its shifting.
    """
    max_acceleration2 = 0.0
    max_speed2 = 0.0
    for i in prange(density.shape[0]):
        kind = 0
        if material is not None:
            kind = material[i]
        ax = acceleration[i, 0]
        ay = acceleration[i, 1]
        v[i, 0] += half * ax
        v[i, 1] += half * ay
        if lengths is not None:
            length[i] -= step * length[i] / (2.0 * density[i]) * rate[i]
        density[i] = max(table[kind, LEAST_DENSITY], density[i] + step * rate[i])
        if energy is not None:
            for k in range(STOPPED):
                energy[i, k] += step * power[i, k]
        max_acceleration2 = max(max_acceleration2, ax * ax + ay * ay)
        max_speed2 = max(max_speed2, v[i, 0] * v[i, 0] + v[i, 1] * v[i, 1])
    return max_acceleration2, max_speed2
