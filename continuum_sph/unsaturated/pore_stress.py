"""Forces of pore water on soil: -∇π with π = χ p, χ = S_e under suction and 1 above.

χ p is the form of Bishop 1959, who leaves χ to be measured; χ = S_e is that of Lu, Godt & Wu 2010.

    f_i = -V_i Σ_j V_j {(π_i - p°) K_i + (π_j - p°) K_j}·∇W

as forces of stress are (`soil.momentum`), K the correction of `soil.gradient`: the counterpart of the volume that soil
loses, from which p follows.  p° is the pressure outside at particle i, of open water about it and 0 in air: a sum over
soil alone pushes its surface with π, and open water pushes back.  Where kernels do not reach out of the soil p° is that
of the soil about, as K differs from 1 a row farther in, and 0 where that has none.  Walls go on with the π of the soil
before them, hydrostatic where pores are full.
"""

import numpy as np

from continuum_sph.soil.gradient import before
from continuum_sph.soil.state import VOLUME as BULK
from continuum_sph.soil.state import X as PLACE_X
from continuum_sph.soil.state import Y as PLACE_Y
from continuum_sph.unsaturated.outside import KIND, LEVEL, PX, PY
from continuum_sph.unsaturated.richards import EFFECTIVE, PRESSURE
from continuum_sph.water.bundles import image, row
from continuum_sph.water.smoothing import kernel_slope, kernel_value
from porescale.common.compiled.jit import inline, parallel_kernel, prange


@inline
def borne(pressure, effective):
    """π = χ p, Pa."""
    return pressure * effective if pressure < 0.0 else pressure


@parallel_kernel
def pore_pressures(soil, state, record, facing, near, outer, weight, pore, around):
    """Overwrites ``pore`` (n,) Pa, π of soil and of walls, and ``around`` (soil, 2): p° of what kernels see, Pa, and
    how much they see, 1/m².

    state: of `richards`;  record (n, 16), facing (n, 4): of `soil.Soil`;  near: its list;  outer: see `outside`;
    weight ρ_w g, N/m³.
    """
    for i in prange(record.shape[0]):
        x = record[i, PLACE_X]
        y = record[i, PLACE_Y]
        total = 0.0
        mean = 0.0
        if i < soil:
            pore[i] = borne(state[i, PRESSURE], state[i, EFFECTIVE])
            for k in range(np.uint64(outer.start[i]), np.uint64(outer.start[i + 1])):
                j = np.uint64(outer.partner[k])
                if outer.places[j, KIND] < 0.0:
                    continue
                dx = image(x - outer.places[j, PX], near.period_x)
                dy = image(y - outer.places[j, PY], near.period_y)
                value = kernel_value(near.kind, np.sqrt(dx * dx + dy * dy) / near.h, near.h)
                total += value
                if outer.places[j, KIND] > 0.0:
                    mean += value * weight * max(0.0, outer.places[j, LEVEL] - y)
            around[i, 0] = mean / total if total > 0.0 else 0.0
            around[i, 1] = total
        else:
            for k in range(np.uint64(near.start[i]), np.uint64(near.split[i])):
                j = np.uint64(near.partner[k])
                dx = image(x - record[j, PLACE_X], near.period_x)
                dy = image(y - record[j, PLACE_Y], near.period_y)
                if not before(facing, i, x - dx, y - dy):
                    continue
                value = kernel_value(near.kind, np.sqrt(dx * dx + dy * dy) / near.h, near.h)
                total += value
                lower = -weight * dy if state[j, PRESSURE] > 0.0 else 0.0
                mean += value * (borne(state[j, PRESSURE], state[j, EFFECTIVE]) + lower)
            pore[i] = mean / total if total > 0.0 else 0.0


@inline
def outer_pressure(i, soil, record, near, weight, around):
    """p°, Pa, at particle i of soil; the arguments: of `pore_forces`."""
    if around[i, 1] > 0.0:
        return around[i, 0]
    total = 0.0
    mean = 0.0
    for k in range(np.uint64(near.start[i]), np.uint64(near.split[i])):
        j = np.uint64(near.partner[k])
        if around[j, 1] > 0.0:
            dx = image(record[i, PLACE_X] - record[j, PLACE_X], near.period_x)
            dy = image(record[i, PLACE_Y] - record[j, PLACE_Y], near.period_y)
            value = kernel_value(near.kind, np.sqrt(dx * dx + dy * dy) / near.h, near.h)
            total += value
            if around[j, 0] > 0.0:
                mean += value * max(0.0, around[j, 0] - weight * dy)
    return mean / total if total > 0.0 else 0.0


@parallel_kernel
def pore_forces(soil, record, facing, matrix, near, pore, around, weight, force):
    """Adds to ``force`` (soil, 2) N/m those of pore water.

    matrix (soil, 5): K of `soil.gradient`;  pore (n,), around (soil, 2): of `pore_pressures`;  the rest: see there.
    """
    for at in prange(soil):
        i = row(at)
        fx = 0.0
        fy = 0.0
        outer = outer_pressure(i, soil, record, near, weight, around)
        own = pore[i] - outer
        for k in range(np.uint64(near.start[i]), np.uint64(near.start[i + 1])):
            j = np.uint64(near.partner[k])
            dx = image(record[i, PLACE_X] - record[j, PLACE_X], near.period_x)
            dy = image(record[i, PLACE_Y] - record[j, PLACE_Y], near.period_y)
            other = pore[j] - outer
            wall = j >= np.uint64(soil)
            if wall and not before(facing, j, record[j, PLACE_X] + dx, record[j, PLACE_Y] + dy):
                continue
            part = record[j, BULK] * kernel_slope(near.kind, np.sqrt(dx * dx + dy * dy) / near.h, near.h)
            xx = own * matrix[i, 0] + other * (1.0 if wall else matrix[j, 0])
            xy = own * matrix[i, 1] + other * (0.0 if wall else matrix[j, 1])
            yy = own * matrix[i, 2] + other * (1.0 if wall else matrix[j, 2])
            fx -= part * (xx * dx + xy * dy)
            fy -= part * (xy * dx + yy * dy)
        force[i, 0] += record[i, BULK] * fx
        force[i, 1] += record[i, BULK] * fy
