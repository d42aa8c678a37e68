"""How fast soil that yields swells about water: as its stress takes it to, in place of sums over its mean velocity.

∇·q of the mixture (`seepage`) contains ∇·v_s of the soil by way of the mean velocity v̄ of grains about each particle
of water,

    D_i = -Σ_j V_j (v̄_i - v̄_j)·∇W_ij                                                     (j: water and walls)

and effective stress follows the trace of the soil's own gradient G, and diffusion, which hands p from particle to
particle as if it were volume: soil swells at T_s = tr G_s - (dp_s/dt)/B by diffusion.  Where soil shears D and T differ
by some per cent of the rate of shear, most in the rows beside a floor over which it slides.  Full pores let soil swell
by no more than what flows in, so such a difference is made up by effective stress, which is wrong by B times as much:
soil that shears gains strength, the more the stiffer it is and the fewer its rows.  So the balance of the pores has

    dρ_i/dt = -(ρ_i/n_i) {(∇·q)_i + a_i y_i (T_i - D_i)},    T_i = Σ V_s W_is T_s/Σ V_s W_is                 (added)

with a from 0 to 1 where soil takes up from HALF to INSIDE of the kernel (water over the ground has no soil about it),
and y from 0 to 1 where 0 to a third of the soil there yields in a step and bears stress: elastic soil has D and T
alike, and water, far stiffer than soil, would zig-zag by what they differ; and soil that comes off a floor swells in no
stress.  What pressure gains or loses is booked with that of diffusion.
"""

import numpy as np

from continuum_sph.seepage.mixture import FLUX_X, FLUX_Y, GRAINS, INSIDE, POROSITY, ROOM, SOIL
from continuum_sph.seepage.volume_excess import BULK
from continuum_sph.water.bundles import image, inverse_period, nearest_image
from continuum_sph.water.rates_fluid import corrected_distance
from continuum_sph.water.rates_walls import corrected
from continuum_sph.water.smoothing import kernel_kind, slope_scale, slope_shape
from continuum_sph.water.state import DIFFUSIVE, RHO, VOLUME, P, X, Y
from porescale.common.compiled.jit import inline, parallel_kernel, prange
from porescale.common.compiled.simd import LANES, gather_four, gather_rows, minimum, reduce_add, sqrt, zeros

HALF = 0.5
"""Share of a kernel in soil from which on water is among it: on a level surface it is half."""
MEAN_X, MEAN_Y, SWELLING, YIELDING = range(4)
"""Columns of ``motion``: mean velocity of the soil about a particle, m/s;  T, 1/s;  y, or NONE without soil."""
NONE = -1.0
SURE = 3.0
"""y over the share of soil that yields in a step: particles that shear yield in most steps, not in all."""


@parallel_kernel
def gather_motion(fluid, near, soil, weight, burden, swelling, pores, motion):
    """Overwrites ``motion`` (fluid, 4) of the soil about water particles.

    near, soil, weight: rows of the overlap, soil numbered from ``fluid`` on;  burden (s, 8): see `skeleton.show_soil`;
    swelling (s, 2): T of the soil, 1/s, and 1 where it yields and bears stress, else 0;  pores: of
    `mixture.gather_soil`.
    """
    for i in prange(fluid):
        grains = pores[GRAINS, i]
        motion[i, MEAN_X] = 0.0
        motion[i, MEAN_Y] = 0.0
        motion[i, SWELLING] = 0.0
        motion[i, YIELDING] = NONE
        if grains > 0.0:
            total = 0.0
            yielding = 0.0
            whole = 0.0
            for k in range(near[i], near[i + 1]):
                s = soil[k] - fluid
                part = burden[s, BULK] * weight[k]
                total += part * swelling[s, 0]
                yielding += part * swelling[s, 1]
                whole += part
            motion[i, MEAN_X] = pores[FLUX_X, i] / grains
            motion[i, MEAN_Y] = pores[FLUX_Y, i] / grains
            motion[i, SWELLING] = total / whole
            motion[i, YIELDING] = min(1.0, SURE * yielding / whole)


@parallel_kernel
def add_swelling(fluid, record, near, matrix, mass, pores, motion, standing, top, rate, power):
    """Adds to ``rate`` (fluid,) kg/(m³ s) of densities what takes T in place of D, and takes from ``power`` (fluid, 6)
    W/m what that gives; None without a budget.

    record (n, 8), mass (fluid…,) kg/m: of the water, with whole volumes;  near: see `water.bundles`;  matrix (fluid,
    4): gradient correction;  pores: see `mixture`;  motion: of `gather_motion`;  standing (n, 2): velocity of walls,
    m/s;  top: height of the uppermost soil, m.
    """
    for i in prange(fluid):
        among = min(1.0, max(0.0, (pores[SOIL, i] / pores[ROOM, i] - HALF) / (INSIDE - HALF)))
        among *= max(0.0, motion[i, YIELDING])
        if among > 0.0 and mass[i] > 0.0:  # one that was taken out since is not there
            seen = seen_among_water(i, record, near, matrix, motion)
            seen += seen_by_walls(i, record, near, matrix, motion, standing, top)
            share = among * (seen - motion[i, SWELLING]) / pores[POROSITY, i]
            rate[i] += record[i, RHO] * share
            if power is not None:
                power[i, DIFFUSIVE] -= mass[i] * record[i, P] / record[i, RHO] * share


@inline
def seen_among_water(i, record, near, matrix, motion):
    """The part of D, 1/s, at particle i that its partners in the water make; those without soil move as it does."""
    kind, inverse_h, scale = kernel_kind(near.kind), 1.0 / near.h, slope_scale(kernel_kind(near.kind), near.h)
    turns_x, turns_y = inverse_period(near.period_x), inverse_period(near.period_y)
    xi, yi, ux, uy = record[i, X], record[i, Y], motion[i, MEAN_X], motion[i, MEAN_Y]
    seen = zeros()
    k, end = near.start[i], near.split[i]
    while k < end:  # a particle stands for the missing end of its row: it moves as itself
        xj, yj, _, _, _, _, volume, _ = gather_rows(record, near.partner, k, end, i)
        ux_j, uy_j, _, yielding = gather_four(motion, near.partner, k, end, i)
        dx, dy = nearest_image(xi - xj, near.period_x, turns_x), nearest_image(yi - yj, near.period_y, turns_y)
        part = minimum(1.0, yielding - NONE) * volume * scale * slope_shape(kind, sqrt(dx * dx + dy * dy) * inverse_h)
        tx, ty, _ = corrected_distance(matrix, near.partner, k, end, i, dx, dy)
        seen += ((ux_j - ux) * tx + (uy_j - uy) * ty) * part
        k += LANES
    return reduce_add(seen)


@inline
def seen_by_walls(i, record, near, matrix, motion, standing, top):
    """The part of D, 1/s, at particle i that walls make which hold soil: not those above all of it, a lid."""
    kind, scale = kernel_kind(near.kind), slope_scale(kernel_kind(near.kind), near.h)
    seen = 0.0
    for w in range(np.uint64(near.split[i]), np.uint64(near.start[i + 1])):
        j = np.uint64(near.partner[w])
        if record[j, Y] > top:
            continue
        dx, dy = image(record[i, X] - record[j, X], near.period_x), image(record[i, Y] - record[j, Y], near.period_y)
        part = record[j, VOLUME] * scale * slope_shape(kind, np.sqrt(dx * dx + dy * dy) / near.h)
        tx, ty = corrected(matrix, i, dx, dy)
        seen += part * ((standing[j, 0] - motion[i, MEAN_X]) * tx + (standing[j, 1] - motion[i, MEAN_Y]) * ty)
    return seen
