"""The pass over pairs that pushes soil: stress and damping, forces of a pair opposite.

m_i dv_i/dt = -Σ V_i V_j (σ_i K_i + σ_j K_j)·∇_i W + Σ m_i m_j α c̄ h (w·x)/{(x² + 0.01 h²) ρ̄} ∇_i W + f_i + m_i g

With K = 1 the first is eq. 33 of Maeda & Sakai 2004 but for V_j/ρ_i in place of m_j/ρ_i² and m_j/ρ_j²; with the K of
`velocity_gradients` it does the work that these say, of a velocity field of any kind.

w is the velocity difference of the pair less what the mean of both gradients makes of their distance: the part that
gradients, and so stress, do not see.  Zig-zags in it would live on as nothing resists them.  Eq. 36 damps the whole
difference where particles approach, and with it flow itself.

Zig-zags in stress push nothing and so live on too.  Stress diffuses, dσ_i/dt = -χ h² γ' Σ V_j (σ_j - σ_i) (1/r) W', but
at the pace of the shear strain rate γ' (mean of the pair), not of sound as in Feng, Fourtakas, Rogers & Lombardi,
Comput. Geotech. 138 (2021) 104356 and its kin: what is smoothed at the pace of sound must be strained anew for ever to
carry its weight, so soil at rest creeps.  In the same way particles nearer than a spacing are moved apart, by x_ij A γ'
(1 - r²/spacing²), only while soil is sheared.  Both are opposite in a pair.
"""

from __future__ import annotations

import numpy as np

from continuum_sph.smoothing import slope_scale, slope_shape
from continuum_sph.soil.gradient import before
from continuum_sph.soil.state import (
    GXX,
    GXY,
    GYX,
    GYY,
    MASS,
    QUICK,
    SHEARING,
    TXX,
    TXY,
    TYX,
    TYY,
    VOLUME,
    VX,
    VY,
    XX,
    XY,
    YY,
    ZZ,
    X,
    Y,
)
from porescale.ground.jit import parallel_kernel, prange
from porescale.particles.cells import minimum_image

SOFTENING = 0.01  # of h²: keeps the quotient finite when two centres meet


@parallel_kernel
def accelerate(
    soil, start, split, partner, record, facing, force, stress, acceleration, spread, drift, kind, h, gx, gy,
    damping, printed, diffusion, pace, apart, spacing, period_x, period_y,
):  # fmt: skip
    """Overwrites ``acceleration`` (soil, 2) m/s², ``spread`` (soil, 4) Pa/s, ``drift`` (soil, 2) m/s.

    start, split, partner: full list, walls of row i from ``split[i]`` on;  record, facing: see Soil;  force (soil, 2)
    N/m of other layers;  stress (n, 4) Pa;  kind, h: smoothing;  gx, gy: gravity, m/s²;  damping: α;
    printed: as eq. 36;  diffusion: χ, pace: the same by sound, 1/s;  apart: A;  spacing, m;  periods, m.
    """
    scale = slope_scale(kind, h)
    inverse_h = 1.0 / h
    for i in prange(soil):
        xi = record[i, X]
        yi = record[i, Y]
        vxi = record[i, VX]
        vyi = record[i, VY]
        own = record[i, VOLUME] / record[i, MASS]
        ax = 0.0
        ay = 0.0
        sxx = 0.0
        syy = 0.0
        sxy = 0.0
        szz = 0.0
        ux = 0.0
        uy = 0.0
        walls = np.uint64(split[i])
        for k in range(np.uint64(start[i]), np.uint64(start[i + 1])):
            j = np.uint64(partner[k])
            dx = minimum_image(xi - record[j, X], period_x)
            dy = minimum_image(yi - record[j, Y], period_y)
            wall = k >= walls
            if wall and not before(facing[j], record[j, X] + dx, record[j, Y] + dy):
                continue
            distance2 = dx * dx + dy * dy
            slope = scale * slope_shape(kind, np.sqrt(distance2) * inverse_h)
            vx = vxi - record[j, VX]
            vy = vyi - record[j, VY]
            m = np.uint64(i) if wall else j  # a wall's gradients, density and sound are those of the soil before it
            if not printed:
                vx -= 0.5 * ((record[i, GXX] + record[m, GXX]) * dx + (record[i, GXY] + record[m, GXY]) * dy)
                vy -= 0.5 * ((record[i, GYX] + record[m, GYX]) * dx + (record[i, GYY] + record[m, GYY]) * dy)
            approach = vx * dx + vy * dy
            if printed:
                approach = min(0.0, approach)
            thrust = own * record[j, VOLUME] * slope
            damp = 0.5 * damping * h * (record[i, QUICK] + record[m, QUICK]) * approach * record[j, MASS] * slope
            damp /= distance2 + SOFTENING * h * h
            ax += damp * dx - thrust * ((record[i, TXX] + record[j, TXX]) * dx + (record[i, TXY] + record[j, TXY]) * dy)
            ay += damp * dy - thrust * ((record[i, TYX] + record[j, TYX]) * dx + (record[i, TYY] + record[j, TYY]) * dy)
            if not wall:
                rate = 0.5 * (record[i, SHEARING] + record[j, SHEARING])
                part = -h * h * (diffusion * rate + pace) * record[j, VOLUME] * slope
                sxx += part * (stress[j, XX] - stress[i, XX])
                syy += part * (stress[j, YY] - stress[i, YY])
                sxy += part * (stress[j, XY] - stress[i, XY])
                szz += part * (stress[j, ZZ] - stress[i, ZZ])
                near = apart * rate * max(0.0, 1.0 - distance2 / (spacing * spacing))
                ux += near * dx
                uy += near * dy
        spread[i, XX] = sxx
        spread[i, YY] = syy
        spread[i, XY] = sxy
        spread[i, ZZ] = szz
        drift[i, 0] = ux
        drift[i, 1] = uy
        acceleration[i, 0] = ax + gx + force[i, 0] / record[i, MASS]
        acceleration[i, 1] = ay + gy + force[i, 1] / record[i, MASS]
