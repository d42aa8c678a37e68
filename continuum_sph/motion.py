"""Kernels that move particles one by one: half kicks, drift, pressure from density."""

from __future__ import annotations

from continuum_sph.eos import printed_gas, tait
from continuum_sph.fluids import DENSITY, EXPONENT, PRINTED, SOUND, STIFFNESS, THINNEST
from continuum_sph.layers import RHO, STIFF, STOPPED, VOLUME, VX, VY, P, X, Y
from porescale.ground.jit import parallel_kernel, prange


@parallel_kernel
def kick_drift(
    x, v, acceleration, smoothed, drift, density, rate, rate_before, predicted, mass, energy, half, step, ratio,
    lower, upper,
):  # fmt: skip
    """First half kick, drift and prediction of density for fluid particles; overwrites x, v, predicted.

    v += half a;  x += step (v + smoothed + drift);  predicted = ρ + step {D + ratio (D - D_before)}.  half, step: s;
    lower, upper (2,) m: surfaces of the walls.  The pressure of wall particles keeps water out of walls, but spray
    carries none: a particle that reaches a surface is put on it and loses its speed into it, whose energy is added to
    ``energy`` (fluid, 6) J/m if it has rows, mass (n,) kg/m.  Returns how often.
    """
    stopped = 0
    booked = energy.shape[0] > 0
    for i in prange(density.shape[0]):
        for axis in range(2):
            v[i, axis] += half * acceleration[i, axis]
            at = x[i, axis] + step * (v[i, axis] + smoothed[i, axis] + drift[i, axis])
            if at < lower[axis]:
                at = lower[axis]
                if booked:
                    energy[i, STOPPED] += 0.5 * mass[i] * min(0.0, v[i, axis]) ** 2
                v[i, axis] = max(0.0, v[i, axis])
                stopped += 1
            if at > upper[axis]:
                at = upper[axis]
                if booked:
                    energy[i, STOPPED] += 0.5 * mass[i] * max(0.0, v[i, axis]) ** 2
                v[i, axis] = min(0.0, v[i, axis])
                stopped += 1
            x[i, axis] = at
        predicted[i] = density[i] + step * (rate[i] + ratio * (rate[i] - rate_before[i]))
    return stopped


@parallel_kernel
def pressurise(x, v, mass, density, material, length, table, cut, varied, pressure, record):
    """Pressure (Pa) of fluid particles from ``density`` (fluid,); overwrites their ``pressure`` and ``record``.

    The density of a step's end is extrapolated, for spray that hits a wall below zero: it stops at the fluid's least.
    material (n,), table (m, 9): the particles' fluids;  length (n,): h, m, varied: whether it differs;  cut: pressures
    below that of the air count as none (particles of a free surface do not pull).  Returns the largest (c/h)², 1/s²; a
    maximum is exact in any order.
    """
    pace = 0.0
    fastest = 0.0
    for i in prange(density.shape[0]):
        kind = material[i]
        rho = density[i]
        if rho < table[kind, THINNEST]:
            rho = table[kind, THINNEST]
        ratio = rho / table[kind, DENSITY]
        if table[kind, PRINTED] > 0.0:
            p, speed_ratio2 = printed_gas(ratio, table[kind, STIFFNESS], table[kind, EXPONENT])
        else:
            p, speed_ratio2 = tait(ratio, table[kind, STIFFNESS], table[kind, EXPONENT])
        if cut:
            p = max(0.0, p)
        speed2 = table[kind, SOUND] * table[kind, SOUND] * speed_ratio2
        pressure[i] = p
        record[i, X] = x[i, 0]
        record[i, Y] = x[i, 1]
        record[i, VX] = v[i, 0]
        record[i, VY] = v[i, 1]
        record[i, RHO] = rho
        record[i, P] = p
        record[i, VOLUME] = mass[i] / rho
        record[i, STIFF] = rho / speed2
        if varied:
            pace = max(pace, speed2 / (length[i] * length[i]))
        fastest = max(fastest, speed2)
    return pace if varied else fastest / (length[0] * length[0])


@parallel_kernel
def kick(v, acceleration, density, rate, material, length, table, power, energy, half, step, varied):
    """Second half kick, density, smoothing length and energies; overwrites v, density, length, energy.

    Continuity follows a particle that leaves its neighbours down to the density of a cloud, below zero if they were
    crowded: densities stop at the fluid's least.  varied: h -= step h/(2ρ) dρ/dt, eq. 52 in two dimensions.
    energy (fluid, 6) J/m, if it has rows, grows by step times ``power`` but for what was STOPPED.  Returns the largest
    |a|² (m²/s⁴) and |v|² (m²/s²), which limit the next step and its shifting.
    """
    hardest = 0.0
    swiftest = 0.0
    booked = energy.shape[0] > 0
    for i in prange(density.shape[0]):
        ax = acceleration[i, 0]
        ay = acceleration[i, 1]
        v[i, 0] += half * ax
        v[i, 1] += half * ay
        if varied:
            length[i] -= step * length[i] / (2.0 * density[i]) * rate[i]
        density[i] = max(table[material[i], THINNEST], density[i] + step * rate[i])
        if booked:
            for k in range(STOPPED):
                energy[i, k] += step * power[i, k]
        hardest = max(hardest, ax * ax + ay * ay)
        swiftest = max(swiftest, v[i, 0] * v[i, 0] + v[i, 1] * v[i, 1])
    return hardest, swiftest
