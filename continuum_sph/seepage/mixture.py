"""Water and grains in one volume: porosity and flux at water particles, and what of their forces the grains bear.

Notation and derivation: `continuum_sph.seepage`.
"""

from __future__ import annotations

import numpy as np

from continuum_sph.layers import VOLUME, VX, VY, X, Y
from continuum_sph.smoothing import CUBIC, kernel_value
from porescale.ground.jit import parallel_kernel, prange
from porescale.ground.lanes import LANES, nothing, take_line, take_rows, take_two, total
from porescale.particles.cells import minimum_image

POROSITY, ROOM, GRAINS = range(3)
"""Columns of pores: n, Ω, Σ V^grains W."""
LEAST_ROOM = 0.2  # of a kernel: a particle in a right-angled corner has a quarter
LEAST_POROSITY = 0.05  # grains that crowd beyond this leave the water no more volume


@parallel_kernel
def blend(
    fluid, start, split, partner, record, home, near, soil, weight, burden, pores, h, period_x, period_y
):  # fmt: skip
    """Overwrites ``pores`` (fluid, 3), and in ``record`` the velocity by q and the volume by m/(n ρ_f), of water.

    start, split, partner: the water's full list, walls from ``split[i]`` on, which have the volume that ``record``
    gives them and stand at ``home`` (n, 2) m;  near, soil, weight: rows of the overlap;  burden: see Skeleton;  h:
    smoothing length;  periods, m or 0.
    """
    for i in prange(fluid):
        room = 1.0
        for k in range(np.uint64(split[i]), np.uint64(start[i + 1])):
            j = np.uint64(partner[k])
            dx = minimum_image(record[i, X] - home[j, 0], period_x)
            dy = minimum_image(record[i, Y] - home[j, 1], period_y)
            room -= record[j, VOLUME] * kernel_value(CUBIC, np.sqrt(dx * dx + dy * dy) / h, h)
        room = max(LEAST_ROOM, room)
        grains = nothing()
        flux_x = nothing()
        flux_y = nothing()
        n = near[i]
        while n < near[i + 1]:  # any soil stands for the missing end of a row, with no weight
            volume, _, _, vx, vy, _, _, _ = take_rows(burden, soil, n, near[i + 1], 0, 0, fluid)
            share = volume * take_line(weight, n, near[i + 1])
            n += LANES
            grains += share
            flux_x += share * vx
            flux_y += share * vy
        solid = total(grains)
        ux = total(flux_x)
        uy = total(flux_y)
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
        fx = nothing()
        fy = nothing()
        k = near[fluid + s]
        while k < near[fluid + s + 1]:
            tx, ty = take_two(thrust, other, k, near[fluid + s + 1], 0)
            share = take_line(weight, k, near[fluid + s + 1])
            k += LANES
            fx += share * tx
            fy += share * ty
        force[s, 0] = grains[s] * total(fx)
        force[s, 1] = grains[s] * total(fy)
