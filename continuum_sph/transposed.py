"""What eq. 34 leaves out where viscosity changes: the transposed gradient of the stress μ (∇v + ∇vᵀ).

Eq. 34 of Maeda & Sakai 2004 is ∇·(μ ∇v).  In one fluid ∇·(μ ∇vᵀ) = μ ∇(∇·v) vanishes; at an interface it does not: a
strained one would bear half of the jump of 2μ ∂v_n/∂n, and two fluids that turn as one would brake each other.  It is
added as the divergence of T = μ ∇vᵀ, in the form of the pressure, whose forces on pairs are opposite:

    dv_i/dt = (1/ρ_i) Σ V_j (T_i + T_j) · ∇_i W

Walls take no part: at a wall that holds the fluid ∇vᵀ · n = 0, and past one that lets it slip it is along n.
Friction along the lines of centres (Monaghan, Rep. Prog. Phys. 68 (2005) 1703) has the whole stress in one pass, but on
a square lattice it is 14 % too stiff along the axes and 19 % too soft across, and the step suffers from it.  Which
form has which stress: Colagrossi et al., Phys. Rev. E 84 (2011) 026705.
"""

from __future__ import annotations

import numpy as np

from continuum_sph.correction import inverse
from continuum_sph.fluids import VISCOSITY
from continuum_sph.layers import RHO, VISCOUS, VOLUME, VX, VY, X, Y
from continuum_sph.smoothing import kernel_slope
from porescale.ground.jit import parallel_kernel, prange
from porescale.particles.cells import minimum_image


@parallel_kernel
def transposed_stress(fluid, start, split, partner, record, material, table, stress, kind, h, period_x, period_y):
    """Overwrites ``stress`` (fluid, 4) Pa, rows xx, xy, yx, yy of T_kl = μ ∂v_k/∂x_l, exact for linear velocities.

    start, split, partner: full list, walls from ``split[i]`` on;  record, material: see Layer;  table: the fluids;
    kind, h: smoothing;  periods, m or 0.
    """
    for i in prange(fluid):
        xx = 0.0
        xy = 0.0
        yy = 0.0
        ux = 0.0
        uy = 0.0
        wx = 0.0
        wy = 0.0
        for k in range(np.uint64(start[i]), np.uint64(split[i])):
            j = np.uint64(partner[k])
            dx = minimum_image(record[i, X] - record[j, X], period_x)
            dy = minimum_image(record[i, Y] - record[j, Y], period_y)
            part = record[j, VOLUME] * kernel_slope(kind, np.sqrt(dx * dx + dy * dy) / h, h)
            px = part * dx
            py = part * dy
            xx -= px * dx
            xy -= px * dy
            yy -= py * dy
            vx = record[j, VX] - record[i, VX]
            vy = record[j, VY] - record[i, VY]
            ux += vx * px
            uy += vx * py
            wx += vy * px
            wy += vy * py
        lxx, lxy, lyy = inverse(xx, xy, yy)
        mu = table[material[i], VISCOSITY]
        stress[i, 0] = mu * (lxx * ux + lxy * uy)
        stress[i, 1] = mu * (lxy * ux + lyy * uy)
        stress[i, 2] = mu * (lxx * wx + lxy * wy)
        stress[i, 3] = mu * (lxy * wx + lyy * wy)


@parallel_kernel
def rub_transposed(
    fluid, start, split, partner, record, stress, acceleration, mass, v, power, kind, h, period_x, period_y
):  # fmt: skip
    """Adds the divergence of ``stress`` (fluid, 4) Pa over ρ to ``acceleration`` (fluid, 2) m/s², and the heat that it
    makes to ``power`` (fluid, 6) W/m.

    mass (n,) kg/m;  v (n, 2) m/s;  the rest: as `transposed_stress`.
    """
    for i in prange(fluid):
        ax = 0.0
        ay = 0.0
        for k in range(np.uint64(start[i]), np.uint64(split[i])):
            j = np.uint64(partner[k])
            dx = minimum_image(record[i, X] - record[j, X], period_x)
            dy = minimum_image(record[i, Y] - record[j, Y], period_y)
            part = record[j, VOLUME] * kernel_slope(kind, np.sqrt(dx * dx + dy * dy) / h, h)
            px = part * dx
            py = part * dy
            ax += (stress[i, 0] + stress[j, 0]) * px + (stress[i, 2] + stress[j, 2]) * py
            ay += (stress[i, 1] + stress[j, 1]) * px + (stress[i, 3] + stress[j, 3]) * py
        ax /= record[i, RHO]
        ay /= record[i, RHO]
        acceleration[i, 0] += ax
        acceleration[i, 1] += ay
        power[i, VISCOUS] -= mass[i] * (ax * v[i, 0] + ay * v[i, 1])
