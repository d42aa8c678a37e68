"""Drag between the layers over a given time, exactly opposite on both; derivation: `continuum_sph.seepage`."""

from __future__ import annotations

import numpy as np

from continuum_sph.layers import RHO
from continuum_sph.seepage.mixture import POROSITY, ROOM
from continuum_sph.seepage.resistance import drag
from porescale.ground.jit import parallel_kernel, prange
from porescale.ground.lanes import LANES, nothing, take_line, take_rows, take_two, total


@parallel_kernel
def brake(
    fluid, near, other, weight, record, pores, mass, v, acceleration, burden, law, factor, gravity, thick, seconds,
    slip, push, heat,
):  # fmt: skip
    """Takes the drag of ``seconds`` from the water's ``v`` (fluid…, 2) m/s; what it takes goes to `take`.

    Overwrites ``slip`` (fluid, 2) m/s, velocity of the water over the soil's before, and ``push`` (fluid, 2), the
    impulse over the weight by which soil particles share it; adds to ``heat`` (fluid…,) J/m the work that it takes
    from both layers.

    near, other, weight: the overlap, water rows first;  record: true densities of water;  pores: of `blend`;  mass
    kg/m;  acceleration (fluid, 2) m/s², without drag;  burden: see Skeleton, soil's accelerations without drag;
    law, factor, gravity: of `Resistance`;  thick (fluid,) N/m³, what stands for ρ g in the drag on particles of several
    fluids, ρ_w g μ/μ_w; empty for one.
    """
    for i in prange(fluid):
        resisting = nothing()
        masses = nothing()
        flow_x = nothing()
        flow_y = nothing()
        gain_x = nothing()
        gain_y = nothing()
        k = near[i]
        while k < near[i + 1]:  # any soil stands for the missing end of a row, with no weight
            _, resistance, inertia, vx, vy, fx, fy, _ = take_rows(burden, other, k, near[i + 1], 0, 0, fluid)
            near_by = take_line(weight, k, near[i + 1])
            k += LANES
            share = resistance * near_by
            resisting += share
            masses += inertia * near_by
            flow_x += share * vx
            flow_y += share * vy
            gain_x += share * fx
            gain_y += share * fy
        sum_of = total(resisting)
        partial = total(masses)
        ux = total(flow_x)
        uy = total(flow_y)
        bx = total(gain_x)
        by = total(gain_y)
        push[i, 0] = 0.0
        push[i, 1] = 0.0
        slip[i, 0] = 0.0
        slip[i, 1] = 0.0
        if sum_of > 0.0:
            porosity = pores[i, POROSITY]
            rho = record[i, RHO]
            volume = mass[i] / (porosity * rho)
            unit = thick[i] if thick.shape[0] > 0 else rho * gravity
            beta = drag(law, porosity, sum_of / pores[i, ROOM], unit, factor)
            wx = v[i, 0] - ux / sum_of
            wy = v[i, 1] - uy / sum_of
            ax = acceleration[i, 0] - bx / sum_of
            ay = acceleration[i, 1] - by / sum_of
            lightness = 1.0 / (porosity * rho) + pores[i, ROOM] / partial
            kappa = beta * lightness
            gone = -np.expm1(-kappa * seconds)
            late = seconds - gone / kappa
            impulse = volume / lightness
            jx = impulse * (gone * wx + late * ax)
            jy = impulse * (gone * wy + late * ay)
            slip[i, 0] = wx
            slip[i, 1] = wy
            push[i, 0] = jx / sum_of
            push[i, 1] = jy / sum_of
            v[i, 0] -= jx / mass[i]
            v[i, 1] -= jy / mass[i]
            # Half the velocities before and after, kick included, times the impulse; what soil gains is in `take`.
            work = jx * (wx + 0.5 * seconds * ax) + jy * (wy + 0.5 * seconds * ay)
            heat[i] += work - 0.5 * (jx * jx + jy * jy) / mass[i]


@parallel_kernel
def take(fluid, near, other, weight, push, resisting, soil_mass, soil_v, seconds, borne, heat):
    """Gives ``push`` (fluid, 2), of `brake`, to the soil: adds to ``soil_v`` (s, 2) m/s; overwrites ``borne`` (s, 2)
    N/m, the mean force over ``seconds``; takes from ``heat`` (fluid + s,) J/m what they do in excess of `brake`'s."""
    for s in prange(resisting.shape[0]):
        sum_x = nothing()
        sum_y = nothing()
        k = near[fluid + s]
        while k < near[fluid + s + 1]:
            px, py = take_two(push, other, k, near[fluid + s + 1], 0)
            share = take_line(weight, k, near[fluid + s + 1])
            k += LANES
            sum_x += share * px
            sum_y += share * py
        jx = total(sum_x)
        jy = total(sum_y)
        soil_v[s, 0] += resisting[s] / soil_mass[s] * jx
        soil_v[s, 1] += resisting[s] / soil_mass[s] * jy
        borne[s, 0] = resisting[s] / seconds * jx
        borne[s, 1] = resisting[s] / seconds * jy
        heat[fluid + s] -= 0.5 * resisting[s] * resisting[s] / soil_mass[s] * (jx * jx + jy * jy)
