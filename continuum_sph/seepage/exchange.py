"""Drag between the layers over a given time, exactly opposite on both; derivation: `continuum_sph.seepage`."""

from continuum_sph.seepage.mixture import (
    DENSITY,
    MASS,
    MASSES,
    POROSITY,
    PULL_X,
    PULL_Y,
    RESISTING,
    ROOM,
    SLIP_X,
    SLIP_Y,
    SOIL,
    WEIGHT,
)
from continuum_sph.seepage.resistance import drag, sharpened
from porescale.common.compiled.jit import inline, parallel_kernel, prange
from porescale.common.compiled.simd import LANES, gather_two, load, maximum, minimum, reduce_add, store, zeros

LONGEST = 44.0  # times of relaxation: e^-44 is less than half a unit in the last place of 1
HALVINGS = 6  # of it, after which the series needs 12 terms: (44/64)^12/13! is 2e-12 of half such a unit
SLOWEST = 1e-16  # 1/s: where nothing resists, the impulse per pull would divide 0 by 0
PER_SLIP, PER_PULL, SHARE, INVERSE_MASS = range(4)
"""Lines of parts, of a water particle: impulse per slip, kg/m; per pull, kg s/m; 1/R; 1/m."""


@inline
def relaxation(times):
    """1 - e^-x of x >= 0 ``times`` of relaxation, to some units in the last place, however small.

    By its series for x/64, and 1 - e^-2y = (1 - e^-y)(2 - (1 - e^-y)): no branch, and several at once.
    """
    y = minimum(times, LONGEST) * (1.0 / 2.0**HALVINGS)
    rest = 1.0 - y * (1.0 / 12.0)
    rest = 1.0 - y * (1.0 / 11.0) * rest
    rest = 1.0 - y * (1.0 / 10.0) * rest
    rest = 1.0 - y * (1.0 / 9.0) * rest
    rest = 1.0 - y * (1.0 / 8.0) * rest
    rest = 1.0 - y * (1.0 / 7.0) * rest
    rest = 1.0 - y * (1.0 / 6.0) * rest
    rest = 1.0 - y * (1.0 / 5.0) * rest
    rest = 1.0 - y * (1.0 / 4.0) * rest
    rest = 1.0 - y * (1.0 / 3.0) * rest
    rest = 1.0 - y * (1.0 / 2.0) * rest
    gone = y * rest
    for _ in range(HALVINGS):
        gone = gone * (2.0 - gone)
    return gone


@parallel_kernel
def relative_to_soil(fluid, near, other, weight, shown, own, pores, line):
    """Overwrites ``line`` and the next of ``pores``: ``own`` (fluid…, 2) less the mean of the soil's about each water
    particle by r W; 0 where there is none.

    near, other, weight: the overlap, water rows first;  shown (s, 2): the soil's times r, of `Skeleton.weigh`.
    """
    for i in prange(fluid):
        sum_x = zeros()
        sum_y = zeros()
        k = near[i]
        while k < near[i + 1]:  # any soil stands for the missing end of a row, with no weight
            sx, sy = gather_two(shown, other, k, near[i + 1], 0, 0, fluid)
            near_by = load(weight, k, near[i + 1])
            k += LANES
            sum_x += near_by * sx
            sum_y += near_by * sy
        resisting = pores[RESISTING, i]
        share = 1.0 / resisting if resisting > 0.0 else 0.0
        pores[line, i] = own[i, 0] - share * reduce_add(sum_x) if resisting > 0.0 else 0.0
        pores[line + 1, i] = own[i, 1] - share * reduce_add(sum_y) if resisting > 0.0 else 0.0


@parallel_kernel
def apply_drag(fluid, pores, v, law, factor, share, seconds, parts, push, heat):
    """Takes the drag of ``seconds`` from the water's ``v`` (fluid…, 2) m/s; what it takes goes to `apply_reaction`.

    Overwrites ``push`` (fluid, 2), the impulse over the weight by which soil particles share it, and the scratch
    ``parts`` (4, fluid + LANES); adds to ``heat`` (fluid…,) J/m the work that it takes from both layers.

    pores: of `gather_soil`, `mix_fluxes` and `relative_to_soil`: slip and pull of now, the latter without drag;
    law, factor, share: of `Resistance`.
    """
    lines = pores.ravel()
    width = pores.shape[1]
    for block in prange((fluid + LANES - 1) // LANES):
        first = block * LANES
        end = first + LANES  # lines are that much longer
        porosity = load(lines, POROSITY * width + first, POROSITY * width + end)
        rho = load(lines, DENSITY * width + first, DENSITY * width + end)
        room = load(lines, ROOM * width + first, ROOM * width + end)
        resisting = load(lines, RESISTING * width + first, RESISTING * width + end)
        partial = load(lines, MASSES * width + first, MASSES * width + end)
        unit = load(lines, WEIGHT * width + first, WEIGHT * width + end)
        mass = load(lines, MASS * width + first, MASS * width + end)
        own = 1.0 / (porosity * rho)
        specific_volume = own + room / partial
        soil = load(lines, SOIL * width + first, SOIL * width + end)
        sum_of = resisting / room * sharpened(soil / room)
        kappa = maximum(drag(law, porosity, sum_of, unit, factor, share) * specific_volume, SLOWEST)
        gone = relaxation(kappa * seconds)
        impulse = mass * own / specific_volume
        store(parts[PER_SLIP], first, end, impulse * gone)
        store(parts[PER_PULL], first, end, impulse * (seconds - gone / kappa))
        store(parts[SHARE], first, end, 1.0 / resisting)
        store(parts[INVERSE_MASS], first, end, 1.0 / mass)
        for i in range(first, min(end, fluid)):
            push[i, 0] = 0.0
            push[i, 1] = 0.0
            if pores[RESISTING, i] > 0.0:
                wx = pores[SLIP_X, i]
                wy = pores[SLIP_Y, i]
                ax = pores[PULL_X, i]
                ay = pores[PULL_Y, i]
                jx = parts[PER_SLIP, i] * wx + parts[PER_PULL, i] * ax
                jy = parts[PER_SLIP, i] * wy + parts[PER_PULL, i] * ay
                push[i, 0] = jx * parts[SHARE, i]
                push[i, 1] = jy * parts[SHARE, i]
                v[i, 0] -= jx * parts[INVERSE_MASS, i]
                v[i, 1] -= jy * parts[INVERSE_MASS, i]
                # Half the velocities before and after, kick included, times the impulse; of soil: `apply_reaction`.
                work = jx * (wx + 0.5 * seconds * ax) + jy * (wy + 0.5 * seconds * ay)
                heat[i] += work - 0.5 * (jx * jx + jy * jy) * parts[INVERSE_MASS, i]


@parallel_kernel
def apply_reaction(fluid, near, other, weight, push, resisting, soil_mass, soil_v, seconds, borne, heat):
    """Gives ``push`` (fluid, 2), of `apply_drag`, to the soil: adds to ``soil_v`` (s, 2) m/s; overwrites ``borne``
    (s, 2) N/m, the mean force over ``seconds``; takes from ``heat`` (fluid + s,) J/m what they do in excess of that of
    `apply_drag`."""
    often = 1.0 / seconds
    for s in prange(resisting.shape[0]):
        sum_x = zeros()
        sum_y = zeros()
        k = near[fluid + s]
        while k < near[fluid + s + 1]:
            px, py = gather_two(push, other, k, near[fluid + s + 1], 0)
            share = load(weight, k, near[fluid + s + 1])
            k += LANES
            sum_x += share * px
            sum_y += share * py
        jx = resisting[s] * reduce_add(sum_x)
        jy = resisting[s] * reduce_add(sum_y)
        light = 1.0 / soil_mass[s]
        soil_v[s, 0] += light * jx
        soil_v[s, 1] += light * jy
        borne[s, 0] = often * jx
        borne[s, 1] = often * jy
        heat[fluid + s] -= 0.5 * light * (jx * jx + jy * jy)
