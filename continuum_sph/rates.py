"""The one pass over pairs: accelerations and density rates of all fluid particles.

dv_i/dt = -(1/ρ_i) Σ V_j (p_i + p_j) ∇_i W - Σ m_j Π_ij ∇_i W + laminar viscosity + g   (eqs 34, 35)
dρ_i/dt =  ρ_i Σ V_j v_ij · ∇_i W + diffusion                                          (eq. 25)

The print has p_i/ρ_i² + p_j/ρ_j² with masses; (p_i + p_j) V_j/ρ_i is the same within one fluid but for its small
changes of density, holds between fluids of any two densities, and is what continuity with volumes does the work of:
kinetic and compressive energy balance pair by pair.

Every particle gathers from its full row of partners: each pair is computed twice, nothing is scattered, so threads
never meet and the sums have one order.  Forces of a pair are opposite but for the rounding of the division by mass.
"""

from __future__ import annotations

import numpy as np

from continuum_sph.artificial_viscosity import artificial
from continuum_sph.boundary_paper import image
from continuum_sph.density import HYDROSTATIC, LINEAR, continuity, diffusion, haste_of, pace
from continuum_sph.fluids import COHESION, SOUND, VISCOSITY
from continuum_sph.layers import BY_SHIFTING, BY_WALLS, DIFFUSIVE, RHO, STIFF, VISCOUS, VOLUME, VX, VY, P, X, Y
from continuum_sph.smoothing import kernel_value, slope_scale, slope_shape
from continuum_sph.viscosity import between, central, laminar
from porescale.ground.jit import parallel_kernel, prange
from porescale.particles.cells import minimum_image

NOISE, IMAGED, SHIFTED, CORRECTED, VARIED = range(5)
"""Entries of choices, see `rates`."""


@parallel_kernel
def split_rows(fluid, start, partner, split):
    """Where wall partners begin in each row of a full list: overwrites ``split`` (n,).  Fluid indices come first."""
    for i in prange(split.shape[0]):
        k = start[i + 1]
        while k > start[i] and partner[k - 1] >= fluid:
            k -= 1
        split[i] = k


@parallel_kernel
def rates(
    fluid, start, split, partner, record, ghost, facing, material, length, matrix, slant, drift, mass, table, choices,
    acceleration, rate, smoothed, power,
    kind, h, gx, gy, alpha, beta, softening, delta, calm, sticky, smoothing, period_x, period_y, half,
):  # fmt: skip
    """Overwrites ``acceleration`` (fluid, 2) m/s², ``rate`` (fluid,) kg/(m³ s), ``smoothed`` (fluid, 2) m/s and the
    columns of ``power`` (fluid, 6) W/m but for BY_TENSION, unless it has no rows.

    start, split, partner: full pair list, wall partners of row i from ``split[i]`` on;  record, ghost, facing,
    material, length, matrix, drift: see Layer;  slant: of `surroundings`;  mass (n,) kg/m;  table (m, 9): the fluids;
    choices: what is NOISE, IMAGED, SHIFTED, CORRECTED, VARIED;  kind, h: smoothing;  gx, gy gravity,
    m/s²;  alpha, beta, softening: artificial viscosity;  delta 2 δ h of the density diffusion, m, and
    calm, m/s, of `haste_of`;  sticky: walls hold the fluid, else they let it slip;  smoothing: XSPH's ε, for
    Σ (m_j/ρ̄)(v_j - v_i) W (eq. 53 with the sign that smooths);  periods, m or 0;  half: of the step that ends here, s.
    Two fluids rub along the line of centres, one as eq. 34 has it (`viscosity`).

    NOISE: what density diffusion takes for noise;  IMAGED: walls of the paper;  SHIFTED: density is that of the place
    that a particle's ``drift`` takes it to;  CORRECTED: gradients by ``matrix``;  VARIED: h by ``length`` (eq. 7).
    """
    wraps = period_x > 0.0 or period_y > 0.0
    mixed = table.shape[0] > 1
    noise = choices[NOISE]
    imaged = choices[IMAGED] > 0
    shifted = choices[SHIFTED] > 0
    corrected = choices[CORRECTED] > 0
    varied = choices[VARIED] > 0
    booked = power.shape[0] > 0
    haste, restless = haste_of(calm, h)
    for i in prange(fluid):
        xi = record[i, X]
        yi = record[i, Y]
        vxi = record[i, VX]
        vyi = record[i, VY]
        rho = record[i, RHO]
        own = record[i, P]
        stiff_i = record[i, STIFF]
        specific = 1.0 / rho
        own_material = material[i]
        own_viscosity = table[own_material, VISCOSITY]
        sound = table[own_material, SOUND]
        strength = delta * sound
        pull = 2.0 * table[own_material, COHESION] / (mass[i] * mass[i])
        viscosity = own_viscosity
        hij = h
        inverse = 1.0 / h
        scale = slope_scale(kind, h)
        lxx = 1.0
        lxy = 0.0
        lyy = 1.0
        ax = 0.0
        ay = 0.0
        bx = 0.0
        by = 0.0
        change = 0.0
        spread = 0.0
        sx = 0.0
        sy = 0.0
        # Unsigned indices: the compiler then needs no code for negative ones.
        for k in range(np.uint64(start[i]), np.uint64(split[i])):
            j = np.uint64(partner[k])
            dx = xi - record[j, X]
            dy = yi - record[j, Y]
            if wraps:
                dx = minimum_image(dx, period_x)
                dy = minimum_image(dy, period_y)
            vx = vxi - record[j, VX]
            vy = vyi - record[j, VY]
            distance2 = dx * dx + dy * dy
            if varied:
                hij = 0.5 * (length[i] + length[j])
                inverse = 1.0 / hij
                scale = slope_scale(kind, hij)
            q = np.sqrt(distance2) * inverse
            slope = scale * slope_shape(kind, q)
            rho_j = record[j, RHO]
            volume = record[j, VOLUME]
            same = True
            if mixed:
                same = material[j] == own_material
                viscosity = between(own_viscosity, table[material[j], VISCOSITY])
            approach = vx * dx + vy * dy
            tx = dx
            ty = dy
            braking = slope
            if corrected:
                lxx = 0.5 * (matrix[i, 0] + matrix[j, 0])
                lxy = 0.5 * (matrix[i, 1] + matrix[j, 1])
                lyy = 0.5 * (matrix[i, 2] + matrix[j, 2])
                tx = lxx * dx + lxy * dy
                ty = lxy * dx + lyy * dy
                braking = 0.5 * (lxx + lyy) * slope
            change += continuity(rho, volume, vx * tx + vy * ty, slope)
            if same:
                expected = 0.0
                if noise == HYDROSTATIC:
                    expected = -0.5 * (stiff_i + record[j, STIFF]) * (gx * dx + gy * dy)
                elif noise == LINEAR:
                    expected = -0.5 * ((slant[i, 0] + slant[j, 0]) * dx + (slant[i, 1] + slant[j, 1]) * dy)
                spread += diffusion(rho, rho_j, expected, volume, slope, strength * pace(approach, haste, restless))
            both = rho + rho_j
            partner_mass = rho_j * volume
            thrust = (own + record[j, P]) * specific * volume
            if same:
                thrust -= pull * partner_mass
            thrust *= slope
            ax -= thrust * tx
            ay -= thrust * ty
            damp = artificial(alpha, beta, sound, hij, softening, approach, distance2, both) * partner_mass * slope
            brake = laminar(viscosity, volume, specific, braking)
            if mixed:
                damp -= central(brake, approach, distance2)
                brake = 0.0
            bx += brake * vx - damp * dx
            by += brake * vy - damp * dy
            if smoothing > 0.0:
                weight = smoothing * 2.0 * partner_mass / both * kernel_value(kind, q, hij)
                sx -= weight * vx
                sy -= weight * vy
        swept = 0.0
        pushed_x = 0.0
        pushed_y = 0.0
        for k in range(np.uint64(split[i]), np.uint64(start[i + 1])):
            j = np.uint64(partner[k])
            dx = xi - record[j, X]
            dy = yi - record[j, Y]
            if wraps:
                dx = minimum_image(dx, period_x)
                dy = minimum_image(dy, period_y)
            if varied:
                hij = 0.5 * (length[i] + length[j])
                inverse = 1.0 / hij
                scale = slope_scale(kind, hij)
            distance2 = dx * dx + dy * dy
            slope = scale * slope_shape(kind, np.sqrt(distance2) * inverse)
            volume = record[j, VOLUME]
            vx = vxi - record[j, VX]
            vy = vyi - record[j, VY]
            ux = vxi - ghost[j, 0]
            uy = vyi - ghost[j, 1]
            if imaged:
                vx, vy = image(
                    record[j, X] + dx, record[j, Y] + dy, vx, vy, record[j, X], record[j, Y], facing[j], sticky
                )
                ux = vx
                uy = vy
            tx = dx
            ty = dy
            braking = slope
            if corrected:
                tx = matrix[i, 0] * dx + matrix[i, 1] * dy
                ty = matrix[i, 1] * dx + matrix[i, 2] * dy
                braking = 0.5 * (matrix[i, 0] + matrix[i, 2]) * slope
            swept += rho * volume * (vx * tx + vy * ty) * slope
            thrust = (own + record[j, P]) * specific * volume * slope
            brake = laminar(own_viscosity, volume, specific, braking) if sticky and material[j] == 0 else 0.0
            pushed_x -= thrust * tx
            pushed_y -= thrust * ty
            if mixed:
                along = central(brake, ux * dx + uy * dy, distance2)
                ux = along * dx
                uy = along * dy
                brake = 1.0
            bx += brake * ux
            by += brake * uy
        moved = 0.0
        lifted = 0.0
        if shifted:
            moved = drift[i, 0] * slant[i, 0] + drift[i, 1] * slant[i, 1]
            lifted = gx * drift[i, 0] + gy * drift[i, 1]
        acceleration[i, 0] = ax + pushed_x + bx + gx
        acceleration[i, 1] = ay + pushed_y + by + gy
        rate[i] = change + swept + moved + spread
        smoothed[i, 0] = sx
        smoothed[i, 1] = sy
        if booked:
            # What these do to speeds they do at the step's end, and what they do to densities at its middle.
            vxi += half * acceleration[i, 0]
            vyi += half * acceleration[i, 1]
            work = mass[i] * specific * specific * (own - half * rho / stiff_i * rate[i])
            power[i, VISCOUS] = -mass[i] * (bx * vxi + by * vyi)
            power[i, DIFFUSIVE] = -work * spread
            power[i, BY_WALLS] = work * swept + mass[i] * (pushed_x * vxi + pushed_y * vyi)
            power[i, BY_SHIFTING] = work * moved - mass[i] * lifted
