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

Volumes diffuse as stress does, dV_i/dt = -χ h² γ' spacing² Σ (V_j - V_i) (1/r) W'.  Stress that diffuses no longer
tells how closely a particle is squeezed, so nothing would resist: where soil slides far its density would grow without
end, 1.3, 2.5 and 4.5 times, 0.6, 1.6 and 2.7 s after a levee gives way.  Volumes are exchanged, so their sum stays,
also between materials; spacing² stands for the volume in the sum, as V_i V_j would favour what is loose.  Uniform
strain leaves nothing to exchange, so dilatancy is what it was.  All particles stand for spacing² at the start, whatever
they weigh (`SoilFlow` refuses others).  By how much soil has come apart it keeps for itself: a lone grain at the tip of
a tongue that gave volume away is the denser, up to a fifth, once it has closed, until it has its neighbours' volume.
"""

from __future__ import annotations

import numpy as np

from continuum_sph.soil.gradient import before
from continuum_sph.soil.state import (
    GROWN,
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
from continuum_sph.water.smoothing import slope_scale, slope_shape
from porescale.common.compiled.jit import parallel_kernel, prange
from porescale.common.compiled.simd import LANES, greater, lesser, nearest, nothing, root, take_four, take_rows, total
from porescale.common.neighbors.cells import minimum_image

SOFTENING = 0.01  # of h²: keeps the quotient finite when two centres meet


@parallel_kernel
def accelerate(
    soil, start, split, partner, record, facing, force, stress, acceleration, spread, drift, kind, h, gx, gy,
    damping, printed, diffusion, pace, apart, spacing, period_x, period_y,
):  # fmt: skip
    """Overwrites ``acceleration`` (soil, 2) m/s², ``spread`` (soil, 5) Pa/s and m²/s, ``drift`` (soil, 2) m/s.

    start, split, partner: full list, walls of row i from ``split[i]`` on;  record, facing: see Soil;  force (soil, 2)
    N/m of other layers;  stress (n, 4) Pa;  kind, h: smoothing;  gx, gy: gravity, m/s²;  damping: α;
    printed: as eq. 36;  diffusion: χ, pace: the same by sound, 1/s;  apart: A;  spacing, m;  periods, m.
    """
    scale = slope_scale(kind, h)
    inverse_h = 1.0 / h
    soft = SOFTENING * h * h
    braking = 0.5 * damping * h
    smooth = -0.5 * h * h * diffusion  # of both strain rates together, twice their mean
    restless = -h * h * pace
    inverse_spacing2 = 1.0 / (spacing * spacing)
    turns_x = 1.0 / period_x if period_x > 0.0 else 0.0
    turns_y = 1.0 / period_y if period_y > 0.0 else 0.0
    linear = 0.0 if printed else 0.5  # of both gradients: the part of velocities that is not damped
    most = 0.0 if printed else np.inf  # of the closing that is damped
    for i in prange(soil):
        xi = record[i, X]
        yi = record[i, Y]
        vxi = record[i, VX]
        vyi = record[i, VY]
        bulk = record[i, VOLUME]
        own = bulk / record[i, MASS]
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
        bx = nothing()
        by = nothing()
        rxx = nothing()
        ryy = nothing()
        rxy = nothing()
        rzz = nothing()
        grown = nothing()
        wx = nothing()
        wy = nothing()
        k = start[i]
        while k < split[i]:  # a particle stands for the missing end of its row: it does nothing to itself
            xj, yj, vxj, vyj, volume, mass, quick_j, shearing_j = take_rows(record, partner, k, split[i], i)
            txx_j, txy_j, tyx_j, tyy_j, gxx_j, gxy_j, gyx_j, gyy_j = take_rows(record, partner, k, split[i], i, TXX)
            xx_j, yy_j, xy_j, zz_j = take_four(stress, partner, k, split[i], i)
            k += LANES
            dx = xi - xj
            dy = yi - yj
            dx -= period_x * nearest(dx * turns_x)
            dy -= period_y * nearest(dy * turns_y)
            distance2 = dx * dx + dy * dy
            slope = scale * slope_shape(kind, root(distance2) * inverse_h)
            vx = vxi - vxj - linear * ((gxx + gxx_j) * dx + (gxy + gxy_j) * dy)
            vy = vyi - vyj - linear * ((gyx + gyx_j) * dx + (gyy + gyy_j) * dy)
            approach = lesser(vx * dx + vy * dy, most)
            swept = volume * slope
            damp = (quick + quick_j) * approach * mass * slope / (distance2 + soft)
            thrust = own * swept
            bx += braking * damp * dx - thrust * ((txx + txx_j) * dx + (txy + txy_j) * dy)
            by += braking * damp * dy - thrust * ((tyx + tyx_j) * dx + (tyy + tyy_j) * dy)
            rate = shearing + shearing_j
            diffusing = smooth * rate + restless
            part = diffusing * swept
            grown += diffusing * slope * (volume - bulk)
            rxx += part * (xx_j - xx)
            ryy += part * (yy_j - yy)
            rxy += part * (xy_j - xy)
            rzz += part * (zz_j - zz)
            near = rate * greater(1.0 - distance2 * inverse_spacing2, 0.0)
            wx += near * dx
            wy += near * dy
        ax = total(bx)
        ay = total(by)
        ux = total(wx)
        uy = total(wy)
        for w in range(np.uint64(split[i]), np.uint64(start[i + 1])):
            j = np.uint64(partner[w])
            dx = xi - record[j, X]
            dy = yi - record[j, Y]
            dx = minimum_image(dx, period_x)
            dy = minimum_image(dy, period_y)
            if not before(facing, j, record[j, X] + dx, record[j, Y] + dy):
                continue
            distance2 = dx * dx + dy * dy
            slope = scale * slope_shape(kind, np.sqrt(distance2) * inverse_h)
            vx = vxi - record[j, VX]
            vy = vyi - record[j, VY]
            vx -= 2.0 * linear * (gxx * dx + gxy * dy)  # a wall's gradient and sound are those of the soil before it
            vy -= 2.0 * linear * (gyx * dx + gyy * dy)
            approach = min(most, vx * dx + vy * dy)
            thrust = own * record[j, VOLUME] * slope
            damp = 2.0 * braking * quick * approach * record[j, MASS] * slope / (distance2 + soft)
            ax += damp * dx - thrust * ((txx + record[j, TXX]) * dx + (txy + record[j, TXY]) * dy)
            ay += damp * dy - thrust * ((tyx + record[j, TYX]) * dx + (tyy + record[j, TYY]) * dy)
            near = 2.0 * shearing * max(0.0, 1.0 - distance2 * inverse_spacing2)
            ux += near * dx
            uy += near * dy
        spread[i, XX] = total(rxx)
        spread[i, YY] = total(ryy)
        spread[i, XY] = total(rxy)
        spread[i, ZZ] = total(rzz)
        spread[i, GROWN] = spacing * spacing * total(grown)
        drift[i, 0] = 0.5 * apart * ux
        drift[i, 1] = 0.5 * apart * uy
        acceleration[i, 0] = ax + gx + force[i, 0] / record[i, MASS]
        acceleration[i, 1] = ay + gy + force[i, 1] / record[i, MASS]
