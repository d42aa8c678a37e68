"""The one pass over pairs: accelerations and density rates of all fluid particles.

dv_i/dt = -Σ m_j (p_i/ρ_i² + p_j/ρ_j² + Π_ij) ∇_i W + laminar viscosity + g   (eqs 34, 35)
dρ_i/dt =  Σ m_j v_ij · ∇_i W + diffusion                                        (eq. 25)

Every particle gathers from its full row of partners: each pair is computed twice, nothing is scattered, so threads
never meet and the sums have one order.  Forces of a pair of equal masses are opposite to the last bit.
"""

from __future__ import annotations

import numpy as np

from continuum_sph.density import continuity, diffusion
from continuum_sph.layers import PUSH, RHO, STIFF, VOLUME, VX, VY, X, Y
from continuum_sph.smoothing import kernel_slope, kernel_value
from continuum_sph.viscosity import artificial, laminar
from porescale.ground.jit import parallel_kernel, prange
from porescale.particles.cells import minimum_image


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
    fluid, start, split, partner, record, ghost,
    acceleration, rate, smoothed,
    kind, h, gx, gy, viscosity, alpha, beta, softening, sound_speed, strength, sticky, smoothing,
    period_x, period_y,
):  # fmt: skip
    """Overwrites ``acceleration`` (fluid, 2) m/s², ``rate`` (fluid,) kg/(m³ s), and ``smoothed`` (fluid, 2) m/s.

    start, split, partner: full pair list, wall partners of row i from ``split[i]`` on;  record, ghost: see Layer;
    kind, h: smoothing;  gx, gy gravity, m/s²;  viscosity μ, Pa s;  alpha, beta, softening: artificial viscosity;
    strength 2 δ h c0 of the density diffusion, m²/s;  sticky: walls hold the fluid, else they let it slip;
    smoothing: XSPH's ε, for Σ (m_j/ρ̄)(v_j - v_i) W (eq. 53 with the sign that smooths);  periods, m or 0.
    """
    inverse = 1.0 / h
    wraps = period_x > 0.0 or period_y > 0.0
    for i in prange(fluid):
        xi = record[i, X]
        yi = record[i, Y]
        vxi = record[i, VX]
        vyi = record[i, VY]
        rho = record[i, RHO]
        own = record[i, PUSH]
        stiff_i = record[i, STIFF]
        specific = 1.0 / rho
        ax = gx
        ay = gy
        change = 0.0
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
            q = np.sqrt(distance2) * inverse
            slope = kernel_slope(kind, q, h)
            approach = vx * dx + vy * dy
            rho_j = record[j, RHO]
            volume = record[j, VOLUME]
            mass = rho_j * volume
            change += continuity(mass, approach, slope)
            change += diffusion(rho, rho_j, stiff_i, record[j, STIFF], gx * dx + gy * dy, volume, slope, strength)
            both = rho + rho_j
            thrust = own + record[j, PUSH]
            thrust += artificial(alpha, beta, sound_speed, h, softening, approach, distance2, both)
            thrust *= mass * slope
            brake = laminar(viscosity, volume, specific, slope)
            ax += brake * vx - thrust * dx
            ay += brake * vy - thrust * dy
            if smoothing > 0.0:
                weight = smoothing * 2.0 * mass / both * kernel_value(kind, q, h)
                sx -= weight * vx
                sy -= weight * vy
        for k in range(np.uint64(split[i]), np.uint64(start[i + 1])):
            j = np.uint64(partner[k])
            dx = xi - record[j, X]
            dy = yi - record[j, Y]
            if wraps:
                dx = minimum_image(dx, period_x)
                dy = minimum_image(dy, period_y)
            slope = kernel_slope(kind, np.sqrt(dx * dx + dy * dy) * inverse, h)
            mass = record[j, RHO] * record[j, VOLUME]
            change += continuity(mass, (vxi - record[j, VX]) * dx + (vyi - record[j, VY]) * dy, slope)
            thrust = (own + record[j, PUSH]) * mass * slope
            brake = laminar(viscosity, record[j, VOLUME], specific, slope) if sticky else 0.0
            ax += brake * (vxi - ghost[j, 0]) - thrust * dx
            ay += brake * (vyi - ghost[j, 1]) - thrust * dy
        acceleration[i, 0] = ax
        acceleration[i, 1] = ay
        rate[i] = change
        smoothed[i, 0] = sx
        smoothed[i, 1] = sy
