"""Velocity gradients of soil particles: G_i = Σ V_j (v_j - v_i) ⊗ K_i ∇_i W.

K_i is the inverse of M_i = Σ V_j (x_j - x_i) ⊗ ∇_i W, which makes G exact for linear fields and so blind to rigid
rotation, at free surfaces too: Randles & Libersky, Comput. Methods Appl. Mech. Eng. 139 (1996) 375; Bonet & Lok, ibid.
180 (1999) 97.  M has the least eigenvalue 0.49 in the first row of a level surface and 0.27 in a corner; below FULL
neighbours are too few: K goes over to the unit tensor, which it is from NONE on (from 0.25 and 0.1 on, single grains
that collide with others gain speed from gradients of nothing).  G then takes the rotation out first, ω = skew G⁰/tr M
of the plain sums G⁰, which is exact for rigid rotation with any neighbours: G = G⁰ K + ω rest J (1 - M), J the quarter
turn and rest the share of the unit tensor in K.  Seen from its end a step that turns by θ also swells by 1 - cos θ,
which the sums must not lose either: + (1 - √(1 - ω² Δt²))/Δt rest (1 - M).

Eq. 37 of Maeda & Sakai 2004 has K = 1 and no more, and the opposite sign of v_j - v_i, which is that of strain with
compression positive.
"""

import numpy as np

from continuum_sph.soil.state import GXX, GXY, GYX, GYY, VOLUME, VX, VY, X, Y
from continuum_sph.water.bundles import image, inverse_period, nearest_image, row
from continuum_sph.water.kernel_correction import inverse
from continuum_sph.water.smoothing import slope_scale, slope_shape
from porescale.common.compiled.jit import inline, parallel_kernel, prange
from porescale.common.compiled.simd import LANES, gather_rows, reduce_add, sqrt, zeros

NONE, FULL = 0.25, 0.45


@inline
def before(facing, w, x, y):
    """Whether soil at (x, y) m lies on the side of the wall that wall particle w is of;  facing (n, 4): see Soil."""
    return (x - facing[w, 0]) * facing[w, 2] + (y - facing[w, 1]) * facing[w, 3] >= 0.0


@parallel_kernel
def velocity_gradients(soil, record, facing, matrix, near, corrected, step):
    """Overwrites, of soil, the last four columns of ``record`` (n, 16), G, and ``matrix`` (soil, 5): xx, xy, yy of
    K, and M_xy, M_xx - M_yy times rest/tr M.

    record, facing: see `state.Soil`; walls count where soil lies before them;  near: see `water.bundles`;  corrected:
    else K = 1;  step, s.
    """
    for at in prange(soil):
        i = row(at)
        m, g = soil_gradient_sums(i, record, near)
        m, g = with_walls(i, record, facing, near, m, g)
        (mxx, mxy, myy), (gxx, gxy, gyx, gyy) = m, g
        kxx = 1.0
        kxy = 0.0
        kyy = 1.0
        rest = 0.0
        if corrected:
            kxx, kxy, kyy, rest = inverse(mxx, mxy, myy, NONE, FULL)
        trace = mxx + myy
        part = rest / trace if trace > 0.0 else 0.0
        turn = part * (gyx - gxy)
        swell = 0.0
        if rest > 0.0 and step > 0.0:
            sine = turn / rest * step
            swell = rest * (1.0 - np.sqrt(max(0.0, 1.0 - sine * sine))) / step
        matrix[i, 0] = kxx
        matrix[i, 1] = kxy
        matrix[i, 2] = kyy
        matrix[i, 3] = part * mxy
        matrix[i, 4] = part * (mxx - myy)
        record[i, GXX] = gxx * kxx + gxy * kxy + turn * mxy + swell * (1.0 - mxx)
        record[i, GXY] = gxx * kxy + gxy * kyy - turn * (1.0 - myy) - swell * mxy
        record[i, GYX] = gyx * kxx + gyy * kxy + turn * (1.0 - mxx) - swell * mxy
        record[i, GYY] = gyx * kxy + gyy * kyy - turn * mxy + swell * (1.0 - myy)


@inline
def soil_gradient_sums(i, record, near):
    """(M: xx, xy, yy;  G⁰ = Σ V_j (v_j - v_i) ⊗ ∇_i W, 1/s: xx, xy, yx, yy) over partners of particle i in the soil."""
    kind, inverse_h, scale = near.kind, 1.0 / near.h, slope_scale(near.kind, near.h)
    turns_x, turns_y = inverse_period(near.period_x), inverse_period(near.period_y)
    xi, yi, vxi, vyi = record[i, X], record[i, Y], record[i, VX], record[i, VY]
    lxx, lxy, lyy = zeros(), zeros(), zeros()
    hxx, hxy, hyx, hyy = zeros(), zeros(), zeros(), zeros()
    k, end = near.start[i], near.split[i]
    while k < end:  # a particle stands for the missing end of its row: it lies and moves as itself
        xj, yj, vxj, vyj, volume, _, _, _ = gather_rows(record, near.partner, k, end, i)
        k += LANES
        dx, dy = nearest_image(xi - xj, near.period_x, turns_x), nearest_image(yi - yj, near.period_y, turns_y)
        part = volume * scale * slope_shape(kind, sqrt(dx * dx + dy * dy) * inverse_h)
        px, py = part * dx, part * dy
        vx, vy = vxj - vxi, vyj - vyi
        lxx += px * dx
        lxy += px * dy
        lyy += py * dy
        hxx += vx * px
        hxy += vx * py
        hyx += vy * px
        hyy += vy * py
    return (-reduce_add(lxx), -reduce_add(lxy), -reduce_add(lyy)), (
        reduce_add(hxx),
        reduce_add(hxy),
        reduce_add(hyx),
        reduce_add(hyy),
    )


@inline
def with_walls(i, record, facing, near, m, g):
    """The sums of `soil_gradient_sums`, ``m`` and ``g``, with partners in walls before which particle i lies."""
    kind, inverse_h, scale = near.kind, 1.0 / near.h, slope_scale(near.kind, near.h)
    xi, yi, vxi, vyi = record[i, X], record[i, Y], record[i, VX], record[i, VY]
    mxx, mxy, myy = m
    gxx, gxy, gyx, gyy = g
    for w in range(np.uint64(near.split[i]), np.uint64(near.start[i + 1])):
        j = np.uint64(near.partner[w])
        dx, dy = image(xi - record[j, X], near.period_x), image(yi - record[j, Y], near.period_y)
        if not before(facing, j, record[j, X] + dx, record[j, Y] + dy):
            continue
        part = record[j, VOLUME] * scale * slope_shape(kind, np.sqrt(dx * dx + dy * dy) * inverse_h)
        px = part * dx
        py = part * dy
        vx = record[j, VX] - vxi
        vy = record[j, VY] - vyi
        mxx -= px * dx
        mxy -= px * dy
        myy -= py * dy
        gxx += vx * px
        gxy += vx * py
        gyx += vy * px
        gyy += vy * py
    return (mxx, mxy, myy), (gxx, gxy, gyx, gyy)
