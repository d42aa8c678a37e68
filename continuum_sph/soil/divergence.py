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
(1 - r²/spacing²), only while soil is sheared, and away from walls.  Both are opposite in a pair of soil.
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
    soft = SOFTENING * h * h
    braking = 0.5 * damping * h
    smooth = -h * h * diffusion
    restless = -h * h * pace
    inverse_spacing2 = 1.0 / (spacing * spacing)
    wraps = period_x > 0.0 or period_y > 0.0
    for i in prange(soil):
        xi = record[i, X]
        yi = record[i, Y]
        vxi = record[i, VX]
        vyi = record[i, VY]
        own = record[i, VOLUME] / record[i, MASS]
        quick = record[i, QUICK]
        shearing = record[i, SHEARING]
        txx = record[i, TXX]
        txy = record[i, TXY]
        tyx = record[i, TYX]
        tyy = record[i, TYY]
        gxx = record[i, GXX]
        gxy = record[i, GXY]
        gyx = record[i, GYX]
        gyy = record[i, GYY]
        xx = stress[i, XX]
        yy = stress[i, YY]
        xy = stress[i, XY]
        zz = stress[i, ZZ]
        ax = 0.0
        ay = 0.0
        sxx = 0.0
        syy = 0.0
        sxy = 0.0
        szz = 0.0
        ux = 0.0
        uy = 0.0
        for k in range(np.uint64(start[i]), np.uint64(split[i])):
            j = np.uint64(partner[k])
            dx = xi - record[j, X]
            dy = yi - record[j, Y]
            if wraps:
                dx = minimum_image(dx, period_x)
                dy = minimum_image(dy, period_y)
            distance2 = dx * dx + dy * dy
            slope = scale * slope_shape(kind, np.sqrt(distance2) * inverse_h)
            vx = vxi - record[j, VX]
            vy = vyi - record[j, VY]
            if not printed:
                vx -= 0.5 * ((gxx + record[j, GXX]) * dx + (gxy + record[j, GXY]) * dy)
                vy -= 0.5 * ((gyx + record[j, GYX]) * dx + (gyy + record[j, GYY]) * dy)
            approach = vx * dx + vy * dy
            if printed:
                approach = min(0.0, approach)
            swept = record[j, VOLUME] * slope
            thrust = own * swept
            damp = braking * (quick + record[j, QUICK]) * approach * record[j, MASS] * slope / (distance2 + soft)
            ax += damp * dx - thrust * ((txx + record[j, TXX]) * dx + (txy + record[j, TXY]) * dy)
            ay += damp * dy - thrust * ((tyx + record[j, TYX]) * dx + (tyy + record[j, TYY]) * dy)
            rate = 0.5 * (shearing + record[j, SHEARING])
            part = (smooth * rate + restless) * swept
            sxx += part * (stress[j, XX] - xx)
            syy += part * (stress[j, YY] - yy)
            sxy += part * (stress[j, XY] - xy)
            szz += part * (stress[j, ZZ] - zz)
            near = rate * max(0.0, 1.0 - distance2 * inverse_spacing2)
            ux += near * dx
            uy += near * dy
        for k in range(np.uint64(split[i]), np.uint64(start[i + 1])):
            j = np.uint64(partner[k])
            dx = xi - record[j, X]
            dy = yi - record[j, Y]
            if wraps:
                dx = minimum_image(dx, period_x)
                dy = minimum_image(dy, period_y)
            if not before(facing, j, record[j, X] + dx, record[j, Y] + dy):
                continue
            distance2 = dx * dx + dy * dy
            slope = scale * slope_shape(kind, np.sqrt(distance2) * inverse_h)
            vx = vxi - record[j, VX]
            vy = vyi - record[j, VY]
            if not printed:  # a wall's gradient and sound are those of the soil before it
                vx -= gxx * dx + gxy * dy
                vy -= gyx * dx + gyy * dy
            approach = vx * dx + vy * dy
            if printed:
                approach = min(0.0, approach)
            thrust = own * record[j, VOLUME] * slope
            damp = 2.0 * braking * quick * approach * record[j, MASS] * slope / (distance2 + soft)
            ax += damp * dx - thrust * ((txx + record[j, TXX]) * dx + (txy + record[j, TXY]) * dy)
            ay += damp * dy - thrust * ((tyx + record[j, TYX]) * dx + (tyy + record[j, TYY]) * dy)
            near = shearing * max(0.0, 1.0 - distance2 * inverse_spacing2)
            ux += near * dx
            uy += near * dy
        spread[i, XX] = sxx
        spread[i, YY] = syy
        spread[i, XY] = sxy
        spread[i, ZZ] = szz
        drift[i, 0] = apart * ux
        drift[i, 1] = apart * uy
        acceleration[i, 0] = ax + gx + force[i, 0] / record[i, MASS]
        acceleration[i, 1] = ay + gy + force[i, 1] / record[i, MASS]
