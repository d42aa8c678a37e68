"""Water and grains in one volume: porosity and flux at water particles, and what of their forces the grains bear.

Notation and derivation: `continuum_sph.seepage`.  What water finds about it of the soil is gathered once a step, by
`gather_soil`, drag's sums too, with the weights of all pairs; soil finds its weights in `load_soil`.
"""

import numpy as np

from continuum_sph.seepage.overlap import overlap_kernel
from continuum_sph.water.smoothing import CUBIC, kernel_value
from continuum_sph.water.state import BY_SHIFTING, COMPRESSIBILITY, RHO, VOLUME, VX, VY, X, Y
from porescale.common.compiled.jit import parallel_kernel, prange
from porescale.common.compiled.simd import LANES, gather_four, gather_rows, mask_tail, reduce_add, store, zeros
from porescale.common.neighbors.cells import minimum_image

(
    POROSITY, ROOM, GRAINS, FLUX_X, FLUX_Y, RESISTING, SOIL, MASSES, DENSITY, MASS, WEIGHT, SLIP_X, SLIP_Y, PULL_X,
    PULL_Y,
) = range(15)  # fmt: skip
"""Lines of pores, of each water particle: n;  Ω;  Σ V^grains W;  the same times velocity, m/s;  R = Σ r W with r =
V^grains/k, s/m;  Σ V W of the soil, grains and pores;  Σ m W, kg/m³;  its own density kg/m³, mass kg/m and what stands
for ρ g in the drag, N/m³;  velocity (m/s) and acceleration (m/s²) less the soil's mean by r W."""
LINES = 15
LEAST_ROOM = 0.2  # of a kernel: a particle in a right-angled corner has a quarter
GROUND = 0.25  # share of grains from which on water counts as among them: loose sand has 0.45, its surface half of that
INSIDE = 0.9
"""Share of the kernel in soil from which on water counts as enclosed by it: what runs along its surface is not to part
(`volume_excess`), nor to be held for walled in (`water.kernel_correction`).  Half a spacing under a level surface 0.75
of a kernel of 1.35 spacings is in soil, 0.92 under one, 0.99 under one and a half: the uppermost row is not enclosed,
the next is.  The front of `volume_excess.PACE` is the same to 0.2 mm with 0.45 and with 0.95."""
LEAST_POROSITY = 0.05  # grains packed more densely leave the water the volume of this porosity


@parallel_kernel
def gather_soil(fluid, near, soil, weight, record, mass, burden, gravity, specific_weight, pores, reach):
    """Overwrites ``weight`` (m,) 1/m² of the water's rows, W, and all lines of ``pores`` (15, fluid…) but porosity,
    room and pull.

    near, soil, weight: rows of the overlap;  record: of the water alone;  mass (fluid…,) kg/m;  burden: see Skeleton;
    gravity: g, m/s²;  specific_weight (fluid,) N/m³, what stands for ρ g in the drag on particles of several fluids,
    ρ_w g μ/μ_w; empty for one;  reach: see `overlap.Reach`.
    """
    several = specific_weight.shape[0] > 0
    h, period_x, period_y = reach.h, reach.period_x, reach.period_y
    turns_x = 1.0 / period_x if period_x > 0.0 else 0.0
    turns_y = 1.0 / period_y if period_y > 0.0 else 0.0
    for i in prange(fluid):
        xi = record[i, X]
        yi = record[i, Y]
        grains = zeros()
        flux_x = zeros()
        flux_y = zeros()
        resisting = zeros()
        soils = zeros()
        masses = zeros()
        flow_x = zeros()
        flow_y = zeros()
        k = near[i]
        while k < near[i + 1]:  # any soil stands for the missing end of a row, with no weight
            xj, yj, volume, resistance, inertia, vx, vy, bulk = gather_rows(burden, soil, k, near[i + 1], 0, 0, fluid)
            near_by = overlap_kernel(xi - xj, yi - yj, h, period_x, period_y, turns_x, turns_y)
            near_by = mask_tail(near_by, k, near[i + 1])
            store(weight, k, near[i + 1], near_by)
            k += LANES
            share = volume * near_by
            grains += share
            flux_x += share * vx
            flux_y += share * vy
            share = resistance * near_by
            resisting += share
            flow_x += share * vx
            flow_y += share * vy
            masses += inertia * near_by
            soils += bulk * near_by
        pores[GRAINS, i] = reduce_add(grains)
        pores[FLUX_X, i] = reduce_add(flux_x)
        pores[FLUX_Y, i] = reduce_add(flux_y)
        resists = reduce_add(resisting)
        pores[RESISTING, i] = resists
        pores[SOIL, i] = reduce_add(soils)
        pores[MASSES, i] = reduce_add(masses)
        pores[DENSITY, i] = record[i, RHO]
        pores[MASS, i] = mass[i]
        pores[WEIGHT, i] = specific_weight[i] if several else record[i, RHO] * gravity
        share = 1.0 / resists if resists > 0.0 else 0.0
        pores[SLIP_X, i] = record[i, VX] - share * reduce_add(flow_x) if resists > 0.0 else 0.0
        pores[SLIP_Y, i] = record[i, VY] - share * reduce_add(flow_y) if resists > 0.0 else 0.0


@parallel_kernel
def mix_fluxes(fluid, start, split, partner, record, home, pores, h, period_x, period_y):
    """Overwrites porosity and room in ``pores`` (15, fluid…), and in ``record`` the velocity by q and the volume by
    m/(n ρ_f), of water.

    start, split, partner: the water's full list, walls from ``split[i]`` on, which have the volume that ``record``
    gives them and stand at ``home`` (n, 2) m;  h: smoothing length;  periods, m or 0.
    """
    for i in prange(fluid):
        room = 1.0
        for k in range(np.uint64(split[i]), np.uint64(start[i + 1])):
            j = np.uint64(partner[k])
            dx = minimum_image(record[i, X] - home[j, 0], period_x)
            dy = minimum_image(record[i, Y] - home[j, 1], period_y)
            room -= record[j, VOLUME] * kernel_value(CUBIC, np.sqrt(dx * dx + dy * dy) / h, h)
        room = max(LEAST_ROOM, room)
        solid = pores[GRAINS, i]
        porosity = 1.0
        if solid > 0.0:
            porosity = max(LEAST_POROSITY, 1.0 - solid / room)
            # The mean velocity of the grains, times their share: q is exact for layers that move as one.
            part = (1.0 - porosity) / solid
            record[i, VX] = porosity * record[i, VX] + part * pores[FLUX_X, i]
            record[i, VY] = porosity * record[i, VY] + part * pores[FLUX_Y, i]
            record[i, VOLUME] /= porosity
        pores[ROOM, i] = room
        pores[POROSITY, i] = porosity


@parallel_kernel
def find_enclosed(fluid, pores, enclosed):
    """Overwrites ``enclosed`` (fluid,): whether soil fills what a particle sees before walls but for 1 - INSIDE."""
    for i in prange(fluid):
        enclosed[i] = pores[SOIL, i] > INSIDE * pores[ROOM, i]


@parallel_kernel
def open_gradients(fluid, pores, record, matrix, density, lattice, gx, gy):
    """Overwrites L of water particles in ``matrix`` (fluid, 4) and the gradient of ``density`` (fluid, 2) kg/m⁴, from
    which its diffusion takes departures, with those of water in the open as far as grains are few.

    In the open L is ``lattice``, that of water alone (`water.parameters.Law`), for all, and the gradient that of
    water at rest (`water.density`);  where grains take up GROUND or more both stay;  between them linear in their
    share.  density: None where nothing diffuses;  record: see `water.state`;  (gx, gy) m/s².
    """
    for i in prange(fluid):
        share = min(1.0, (1.0 - pores[POROSITY, i]) / GROUND)
        rest = (1.0 - share) * lattice
        matrix[i, 0] = share * matrix[i, 0] + rest
        matrix[i, 1] *= share
        matrix[i, 2] = share * matrix[i, 2] + rest
        if density is not None:
            weight = (1.0 - share) * record[i, COMPRESSIBILITY]
            density[i, 0] = share * density[i, 0] + weight * gx
            density[i, 1] = share * density[i, 1] + weight * gy


@parallel_kernel
def keep_place_density(fluid, pores, slant, drift, rate):
    """Takes off ``rate`` (fluid,) what `share_forces` will multiply too much: 1 - n of what shifting gives.

    A particle that drifts takes the true density of another place, δu · ∇ρ, however little room grains leave there.
    slant (fluid, 2) kg/m⁴, drift (fluid, 2) m/s: those that `rates` has had.
    """
    for i in prange(fluid):
        rate[i] -= (1.0 - pores[POROSITY, i]) * (drift[i, 0] * slant[i, 0] + drift[i, 1] * slant[i, 1])


@parallel_kernel
def share_forces(fluid, mass, acceleration, gx, gy, pores, rate, power, thrust):
    """Divides ``rate`` (fluid,) and ``power`` (fluid, 6), but for BY_SHIFTING and STOPPED, by n; overwrites the
    last two columns of ``thrust`` (fluid, 4), N/m: force of the whole volume over the grains' weight.

    acceleration (fluid, 2) m/s² of the water, with gravity (gx, gy), which acts on each layer by itself;  mass
    (fluid…,) kg/m, of water;  power: None without a budget.
    """
    for i in prange(fluid):
        porosity = pores[POROSITY, i]
        solid = pores[GRAINS, i]
        thrust[i, 2] = 0.0
        thrust[i, 3] = 0.0
        if solid > 0.0:
            open_ = 1.0 / porosity
            rate[i] *= open_
            if power is not None:
                for k in range(BY_SHIFTING):
                    power[i, k] *= open_
            whole = mass[i] * (1.0 - porosity) / (porosity * solid)
            thrust[i, 2] = whole * (acceleration[i, 0] - gx)
            thrust[i, 3] = whole * (acceleration[i, 1] - gy)


@parallel_kernel
def load_soil(fluid, near, other, weight, x, grains, thrust, force, h, period_x, period_y):
    """Overwrites ``force`` (s, 2) N/m on the soil, of `share_forces`, and ``weight`` (m,) 1/m² of its rows, W.

    near, other, weight: the overlap, water rows first;  x (s, 2) m, grains (s,) m²: of the soil;  thrust (fluid, 4):
    places of the water, m, and what `share_forces` makes;  h: smoothing length;  periods, m or 0.
    """
    turns_x = 1.0 / period_x if period_x > 0.0 else 0.0
    turns_y = 1.0 / period_y if period_y > 0.0 else 0.0
    for s in prange(grains.shape[0]):
        fx = zeros()
        fy = zeros()
        k = near[fluid + s]
        end = near[fluid + s + 1]
        while k < end:
            xj, yj, tx, ty = gather_four(thrust, other, k, end, 0)
            near_by = mask_tail(
                overlap_kernel(x[s, 0] - xj, x[s, 1] - yj, h, period_x, period_y, turns_x, turns_y), k, end
            )
            store(weight, k, end, near_by)
            k += LANES
            fx += near_by * tx
            fy += near_by * ty
        force[s, 0] = grains[s] * reduce_add(fx)
        force[s, 1] = grains[s] * reduce_add(fy)
