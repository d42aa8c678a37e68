"""Water and grains in one volume: porosity and flux at water particles, and what of their forces the grains bear.

Notation and derivation: `continuum_sph.seepage`.
"""

from __future__ import annotations

import numpy as np

from continuum_sph.layers import VOLUME, VX, VY, X, Y
from continuum_sph.smoothing import CUBIC, kernel_value
from porescale.ground.jit import parallel_kernel, prange
from porescale.particles.cells import minimum_image

POROSITY, ROOM, GRAINS = range(3)
"""Columns of pores: n, Ω, Σ V^grains W."""
LEAST_ROOM = 0.2  # of a kernel: a particle in a right-angled corner has a quarter
LEAST_POROSITY = 0.05  # grains that crowd beyond this leave the water no more volume


@parallel_kernel
def blend(
    fluid, start, split, partner, record, home, near, soil, weight, grains, soil_v, pores, h,
    period_x, period_y,
):  # fmt: skip
    """Overwrites ``pores`` (fluid, 3), and in ``record`` the velocity by q and the volume by m/(n ρ_f), of water.

    start, split, partner: the water's full list, walls from ``split[i]`` on, which have the volume that ``record``
    gives them and stand at ``home`` (n, 2) m;  near, soil, weight: rows of the overlap;  grains (s,) m²;  soil_v (s, 2)
    m/s;  h: smoothing length;  periods, m or 0.
    """
    for i in prange(fluid):
        room = 1.0
        for k in range(np.uint64(split[i]), np.uint64(start[i + 1])):
            j = np.uint64(partner[k])
            dx = minimum_image(record[i, X] - home[j, 0], period_x)
            dy = minimum_image(record[i, Y] - home[j, 1], period_y)
            room -= record[j, VOLUME] * kernel_value(CUBIC, np.sqrt(dx * dx + dy * dy) / h, h)
        room = max(LEAST_ROOM, room)
        solid = 0.0
        ux = 0.0
        uy = 0.0
        for k in range(np.uint64(near[i]), np.uint64(near[i + 1])):
            s = np.uint64(soil[k]) - np.uint64(fluid)
            share = grains[s] * weight[k]
            solid += share
            ux += share * soil_v[s, 0]
            uy += share * soil_v[s, 1]
        pores[i, ROOM] = room
        porosity = 1.0
        if solid > 0.0:
            porosity = max(LEAST_POROSITY, 1.0 - solid / room)
            # The mean velocity of the grains, times their share: q is exact for layers that move as one.
            part = (1.0 - porosity) / solid
            record[i, VX] = porosity * record[i, VX] + part * ux
            record[i, VY] = porosity * record[i, VY] + part * uy
            record[i, VOLUME] /= porosity
        pores[i, POROSITY] = porosity
        pores[i, GRAINS] = solid


@parallel_kernel
def part_forces(
    fluid, near, other, weight, grains, mass, acceleration, gx, gy, pores, rate, power, thrust, force
):  # fmt: skip
    """Divides ``rate`` (fluid,) and ``power`` (fluid, 4) by n; overwrites ``force`` (s, 2) N/m on the soil, and
    ``thrust`` (fluid, 2) N/m: force of the whole volume over the grains' weight.

    acceleration (fluid, 2) m/s² of the water, with gravity (gx, gy), which acts on each layer by itself;  near, other,
    weight: the overlap, water rows first;  mass (fluid…,) kg/m, of water;  grains (s,) m².
    """
    for i in prange(fluid):
        porosity = pores[i, POROSITY]
        solid = pores[i, GRAINS]
        thrust[i, 0] = 0.0
        thrust[i, 1] = 0.0
        if solid > 0.0:
            rate[i] /= porosity
            for k in range(4):
                power[i, k] /= porosity
            whole = mass[i] * (1.0 - porosity) / (porosity * solid)
            thrust[i, 0] = whole * (acceleration[i, 0] - gx)
            thrust[i, 1] = whole * (acceleration[i, 1] - gy)
    for s in prange(grains.shape[0]):
        fx = 0.0
        fy = 0.0
        for k in range(np.uint64(near[fluid + s]), np.uint64(near[fluid + s + 1])):
            water = np.uint64(other[k])
            fx += weight[k] * thrust[water, 0]
            fy += weight[k] * thrust[water, 1]
        force[s, 0] = grains[s] * fx
        force[s, 1] = grains[s] * fy
