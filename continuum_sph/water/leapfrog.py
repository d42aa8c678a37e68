"""Kernels that move particles one by one: half kicks, drift, pressure from density.

As of `rates`, what a scene does not ask for is None.
"""

from __future__ import annotations

from continuum_sph.water.eos import printed_gas, tait
from continuum_sph.water.fluids import DENSITY, EXPONENT, PRINTED, SOUND, STIFFNESS, THINNEST, VISCOSITY
from continuum_sph.water.state import RHO, STIFF, STOPPED, VOLUME, VX, P, X
from porescale.common.compiled.jit import inline, parallel_kernel, prange


@inline
def row_of(table, number):
    """What `show` knows of the fluid of that number."""
    row = table[number]
    return row[DENSITY], row[SOUND], row[STIFFNESS], row[EXPONENT], row[PRINTED], row[THINNEST]


@inline
def show(i, rho, mass, row, cut, pressure, record):
    """Pressure (Pa) of particle i from its density ``rho`` by the law of a ``row`` of `row_of`; overwrites its
    ``pressure`` and ``record`` but for places and velocities.  Returns its c², m²/s².
    """
    density, sound, stiffness, exponent, printed, thinnest = row
    if rho < thinnest:
        rho = thinnest
    if printed > 0.0:
        p, speed_ratio2 = printed_gas(rho / density, stiffness, exponent)
    else:
        p, speed_ratio2 = tait(rho / density, stiffness, exponent)
    if cut:
        p = max(0.0, p)
    speed2 = sound * sound * speed_ratio2
    pressure[i] = p
    record[i, RHO] = rho
    record[i, P] = p
    record[i, VOLUME] = mass[i] / rho
    record[i, STIFF] = rho / speed2
    return speed2


@parallel_kernel
def kick_drift(
    x, v, acceleration, smoothed, drift, density, rate, rate_before, predicted, mass, material, length, table, cut,
    pressure, record, traits, girths, energy, half, step, ratio, lower, upper,
):  # fmt: skip
    """First half kick, drift and prediction of density for fluid particles; overwrites x, v, predicted.

    v += half a;  x += step (v + smoothed + drift);  predicted = ρ + step {D + ratio (D - D_before)}.  half, step: s;
    lower, upper (2,) m: surfaces of the walls.  The pressure of wall particles keeps water out of walls, but spray
    carries none: a particle that reaches a surface is put on it and loses its speed into it, whose energy is added to
    ``energy`` (fluid, 6) J/m, mass (n,) kg/m.  Does also what `pressurise` does, with the same arguments, unless
    ``record`` is None.  Returns how often, and what `pressurise` does, or 0.

    None: ``smoothed`` without XSPH, ``drift`` without shifting, ``energy`` without a book.
    """
    stopped = 0
    pace = 0.0
    if material is None:
        row = row_of(table, 0)
    for i in prange(density.shape[0]):
        for axis in range(2):
            speed = v[i, axis] + half * acceleration[i, axis]
            carried = speed
            if smoothed is not None:
                carried += smoothed[i, axis]
            if drift is not None:
                carried += drift[i, axis]
            at = x[i, axis] + step * carried
            if at < lower[axis] or at > upper[axis]:
                into = min(0.0, speed) if at < lower[axis] else max(0.0, speed)
                at = lower[axis] if at < lower[axis] else upper[axis]
                speed -= into
                stopped += 1
                if energy is not None:
                    energy[i, STOPPED] += 0.5 * mass[i] * into**2
            x[i, axis] = at
            v[i, axis] = speed
            if record is not None:
                record[i, X + axis] = at
                record[i, VX + axis] = speed
        rho = density[i] + step * (rate[i] + ratio * (rate[i] - rate_before[i]))
        predicted[i] = rho
        if record is not None:
            if material is not None:
                row = row_of(table, material[i])
                traits[i, 0] = material[i]
                traits[i, 1] = table[material[i], VISCOSITY]
            speed2 = show(i, rho, mass, row, cut, pressure, record)
            if girths is not None:
                girths[i, 0] = length[i]
                speed2 /= length[i] * length[i]
            pace = max(pace, speed2)
    return stopped, pace if girths is not None else pace / (length[0] * length[0])


@parallel_kernel
def pressurise(x, v, mass, density, material, length, table, cut, pressure, record, traits, girths):
    """Pressure (Pa) of fluid particles from ``density`` (fluid,); overwrites their ``pressure`` and ``record``.

    The density of a step's end is extrapolated, for spray that hits a wall below zero: it stops at the fluid's least.
    table (m, 9): the fluids;  material (n,), those of the particles, and ``traits``, overwritten as `rates` takes them:
    None of one fluid;  length (n,): h, m, and ``girths``, overwritten, None unless it varies;  cut: pressures below
    that of the air count as none (particles of a free surface do not pull).  Returns the largest (c/h)², 1/s²; a
    maximum is exact in any order.
    """
    pace = 0.0
    if material is None:
        row = row_of(table, 0)
    for i in prange(density.shape[0]):
        for axis in range(2):
            record[i, X + axis] = x[i, axis]
            record[i, VX + axis] = v[i, axis]
        if material is not None:
            row = row_of(table, material[i])
            traits[i, 0] = material[i]
            traits[i, 1] = table[material[i], VISCOSITY]
        speed2 = show(i, density[i], mass, row, cut, pressure, record)
        if girths is not None:
            girths[i, 0] = length[i]
            speed2 /= length[i] * length[i]
        pace = max(pace, speed2)
    return pace if girths is not None else pace / (length[0] * length[0])


@parallel_kernel
def kick(v, acceleration, density, rate, material, length, girths, table, power, energy, half, step):
    """Second half kick, density, smoothing length and energies; overwrites v, density, length, energy.

    Continuity follows a particle that leaves its neighbours down to the density of a cloud, below zero if they were
    crowded: densities stop at the fluid's least.  Where there are ``girths`` h -= step h/(2ρ) dρ/dt, eq. 52 in two
    dimensions.  energy (fluid, 6) J/m grows by step times ``power`` but for what was STOPPED; both None without a book.
    material, length, girths, table: of `pressurise`.  Returns the largest |a|² (m²/s⁴) and |v|² (m²/s²), which limit
    the next step and its shifting.
    """
    hardest = 0.0
    swiftest = 0.0
    for i in prange(density.shape[0]):
        kind = 0
        if material is not None:
            kind = material[i]
        ax = acceleration[i, 0]
        ay = acceleration[i, 1]
        v[i, 0] += half * ax
        v[i, 1] += half * ay
        if girths is not None:
            length[i] -= step * length[i] / (2.0 * density[i]) * rate[i]
        density[i] = max(table[kind, THINNEST], density[i] + step * rate[i])
        if energy is not None:
            for k in range(STOPPED):
                energy[i, k] += step * power[i, k]
        hardest = max(hardest, ax * ax + ay * ay)
        swiftest = max(swiftest, v[i, 0] * v[i, 0] + v[i, 1] * v[i, 1])
    return hardest, swiftest
