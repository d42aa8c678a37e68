"""The pass over pairs that pushes soil: stress and damping, forces of a pair opposite.

m_i dv_i/dt = -Σ V_i V_j (σ_i K_i + σ_j K_j)·∇_i W + Σ m_i m_j α c̄ h (w·x)/{(x² + 0.01 h²) ρ̄} ∇_i W + f_i + m_i g

With K = 1 the first is eq. 33 of Maeda & Sakai 2004 but for V_j/ρ_i in place of m_j/ρ_i² and m_j/ρ_j²; with the K of
`velocity_gradients` it does the work that these gradients imply, for any velocity field.

w is the velocity difference of the pair less what the mean of both gradients makes of their distance: the part that
gradients, and so stress, do not contain.  Zig-zags in it would persist, as nothing resists them.  Eq. 36 damps the
whole difference where particles approach, and with it flow itself.

Particles that slip past each other across two rows differ by what gradients do not contain, too, so this holds a slip
back by as much as it is fast: a slab on a weak seam reaches a tenth of its acceleration with 20 rows.  ``bounded``, the
most that a pair damps of which a particle yields is DAMPED_BY of s, the largest shear stress of its particles, whatever
the velocities are: of the strength.  Across a plane that slips damping bears 2/π of that in the mean of directions,
|sin θ cos θ| over cos² θ: `HELD_BACK` of the strength.

Zig-zags in stress cause no force and persist too.  Stress diffuses, dσ_i/dt = -χ h² γ' Σ V_j (σ_j - σ_i) (1/r) W', but
at the rate of shear strain γ' (mean of the pair; with ``bounded`` damping that of plastic strain: nothing diffuses
within the strength), not of sound as in Feng, Fourtakas, Rogers & Lombardi, Comput. Geotech. 138 (2021) 104356 and its
kin: what is smoothed at the rate of sound must be strained anew for ever to carry its weight, so soil at rest creeps.
In the same way particles nearer than a spacing are moved apart, by x_ij A γ' (1 - r²/spacing²), only while soil is
sheared, and away from walls.  Both are opposite in a pair of soil.  Each has its
own bound on γ' Δt, `parameters.SoilLaw.most` and `PARTED`: diffusion is far the stiffer, and particles that parted at
its bounded rate would crowd where soil shears fast, on the floor of a layer that slides (by two thirds in 6 s on 32°,
with 20 rows, if soil did not swell there, see `stress`), as no density of theirs shows it.

Volumes diffuse as stress does, dV_i/dt = -χ h² γ' spacing² Σ (V_j - V_i) (1/r) W'.  Stress that diffuses no longer
shows how much a particle is compressed, so nothing would resist: where soil slides far its density would grow without
end, 1.3, 2.5 and 4.5 times, 0.6, 1.6 and 2.7 s after a levee gives way.  Volumes are exchanged, so their sum stays,
also between materials; spacing² stands for the volume in the sum, as V_i V_j would favour what is loose.  Uniform
strain leaves nothing to exchange, so dilatancy is what it was.  All particles stand for spacing² at the start, whatever
they weigh (`SoilFlow` refuses others).  By how much soil has come apart it keeps for itself: a lone grain at the tip of
a tongue that gave volume away is the denser, up to a fifth, once it has closed, until it has its neighbours' volume.

Mean p of the surroundings less p, for `plasticity`: -Σ V_j (p_j - p_i) (1/r) W' / 2π W(0), with partners in walls.  The
integral of -(1/r) W' is 2π W(0), so inside soil it is the mean of the partners less p, and zero for linear p.  At a
free surface partners are missing on one side, so p that grows with depth gains: 44 % in the top row of level ground,
1 % in the second, a strength that falls with the spacing.  Weighted by volume, what one gains its partner loses.
"""

import math
from typing import Any, NamedTuple

import numpy as np

from continuum_sph.soil.gradient import before
from continuum_sph.soil.state import (
    GXX,
    GXY,
    GYX,
    GYY,
    MASS,
    SHEAR_RATE,
    SOUND_OVER_DENSITY,
    TXX,
    TXY,
    TYX,
    TYY,
    VOLUME,
    VX,
    VY,
    X,
    Y,
)
from continuum_sph.soil.stress import CROWD, EXCESS, GROWN, XX, XY, YY, ZZ
from continuum_sph.water.bundles import image, inverse_period, nearest_image, row
from continuum_sph.water.smoothing import kernel_kind, kernel_value, slope_scale, slope_shape
from porescale.common.compiled.jit import inline, parallel_kernel, prange
from porescale.common.compiled.simd import (
    LANES,
    gather_four,
    gather_rows,
    mask_tail,
    maximum,
    minimum,
    reduce_add,
    sqrt,
    zeros,
)

SOFTENING = 0.01  # of h²: keeps the quotient finite when two centres coincide
DAMPED_BY = 0.04
"""Most that a pair is damped by, over the largest shear stress, where damping is bounded."""
HELD_BACK = DAMPED_BY * 2.0 / math.pi
"""Share of the strength that bounded damping bears where one side of a plane slips over the other, in the mean of
directions; on a square lattice 0.70 DAMPED_BY at most and 0.44 along its rows (h of 1.375 spacings)."""
BRAKED_BY = 0.055
"""Shear stress of damping without a bound where the two rows of a square lattice along a plane slip past each other at
v, over ρ α c h v/Δx, with the gradients that particles see of a step of velocity, h of 1.375 spacings."""
UNBOUND = 1e30  # Pa, in place of a stress: the bound of what has none
YIELDING = 1e12  # s: over a rate of plastic shear strain of 1e-12 1/s a particle yields


class Choices(NamedTuple):
    """gx, gy: gravity, m/s²;  damping: α;  printed: damping as eq. 36;  diffusion: χ;  sound_diffusion: the same by
    sound, 1/s;  spacing_recovery: A;  fastest: rate of shear strain up to which particles part, 1/s;  spacing of the
    particles, m;  bounded: damping bears a share of the shear stress at most."""

    gx: Any
    gy: Any
    damping: Any
    printed: Any
    diffusion: Any
    sound_diffusion: Any
    spacing_recovery: Any
    fastest: Any
    spacing: Any
    bounded: Any


@parallel_kernel
def accelerate(soil, record, facing, force, stress, acceleration, spread, drift, near, choices):
    """Overwrites ``acceleration`` (soil, 2) m/s², ``spread`` (soil, 7) Pa/s, m²/s, Pa and 1, ``drift`` (soil, 2) m/s.

    record, facing: see `state.Soil`;  force (soil, 2) N/m of other layers;  stress (n, 4) Pa;  near: see
    `water.bundles`;  choices: see `Choices`.
    """
    for at in prange(soil):
        i = row(at)
        pushed, diffused, grown, excess, crowd = soil_forces(i, record, stress, near, choices)
        integral = 2.0 * np.pi * kernel_value(kernel_kind(near.kind), 0.0, near.h)
        ax, ay, ux, uy, excess = with_wall_forces(i, record, facing, stress, near, choices, pushed, excess)
        spread[i, XX] = diffused[0]
        spread[i, YY] = diffused[1]
        spread[i, XY] = diffused[2]
        spread[i, ZZ] = diffused[3]
        spread[i, GROWN] = choices.spacing * choices.spacing * grown
        spread[i, EXCESS] = excess / integral
        spread[i, CROWD] = choices.spacing * choices.spacing * crowd / integral
        drift[i, 0] = 0.5 * choices.spacing_recovery * ux
        drift[i, 1] = 0.5 * choices.spacing_recovery * uy
        acceleration[i, 0] = ax + choices.gx + force[i, 0] / record[i, MASS]
        acceleration[i, 1] = ay + choices.gy + force[i, 1] / record[i, MASS]


@inline
def soil_forces(i, record, stress, near, choices):
    """Sums over soil partners of particle i: (acceleration m/s² and spacing recovery m/s over A/2, (x, y) each;
    diffusion of stress, Pa/s: xx, yy, xy, zz;  that of volume over spacing², 1/s;  Σ -V_j (p_j - p_i) (1/r) W',
    Pa/m²;  Σ -(1/r) W', 1/m⁴).

    The arguments: of `accelerate`.
    """
    kind, h, inverse_h, scale = near.kind, near.h, 1.0 / near.h, slope_scale(near.kind, near.h)
    soft, damping = SOFTENING * h * h, 0.5 * choices.damping * h
    share = 0.5 * DAMPED_BY / damping if damping > 0.0 else 1.0  # in units of what `damping` multiplies
    by_strain = -0.5 * h * h * choices.diffusion  # of both strain rates together, twice their mean
    by_sound = -h * h * choices.sound_diffusion
    inverse_spacing2 = 1.0 / (choices.spacing * choices.spacing)
    turns_x, turns_y = inverse_period(near.period_x), inverse_period(near.period_y)
    linear, most = undamped(choices.printed)
    slack = 0.0 if choices.bounded else UNBOUND
    xi, yi, vxi, vyi = record[i, X], record[i, Y], record[i, VX], record[i, VY]
    bulk = record[i, VOLUME]
    own = bulk / record[i, MASS]
    sound, shear_rate = record[i, SOUND_OVER_DENSITY], record[i, SHEAR_RATE]
    txx, txy, tyx, tyy = record[i, TXX], record[i, TXY], record[i, TYX], record[i, TYY]
    gxx, gxy, gyx, gyy = record[i, GXX], record[i, GXY], record[i, GYX], record[i, GYY]
    xx, yy, xy, zz = stress[i, XX], stress[i, YY], stress[i, XY], stress[i, ZZ]
    twice = 2.0 * largest_shear(xx, yy, xy) + slack  # of this particle
    fastest, shearing = choices.fastest, parting_rate(i, record, choices)
    bx, by, wx, wy, grown = zeros(), zeros(), zeros(), zeros(), zeros()
    rxx, ryy, rxy, rzz, around, crowd = zeros(), zeros(), zeros(), zeros(), zeros(), zeros()
    k, end = near.start[i], near.split[i]
    while k < end:  # a particle stands for the missing end of its row: it does nothing to itself
        xj, yj, vxj, vyj, volume, mass, sound_j, shear_rate_j = gather_rows(record, near.partner, k, end, i)
        txx_j, txy_j, tyx_j, tyy_j, gxx_j, gxy_j, gyx_j, gyy_j = gather_rows(record, near.partner, k, end, i, TXX)
        xx_j, yy_j, xy_j, zz_j = gather_four(stress, near.partner, k, end, i)
        dx, dy = nearest_image(xi - xj, near.period_x, turns_x), nearest_image(yi - yj, near.period_y, turns_y)
        distance2 = dx * dx + dy * dy
        slope = scale * slope_shape(kind, sqrt(distance2) * inverse_h)
        crowd -= mask_tail(slope, k, end)
        k += LANES
        vx = vxi - vxj - linear * ((gxx + gxx_j) * dx + (gxy + gxy_j) * dy)
        vy = vyi - vyj - linear * ((gyx + gyx_j) * dx + (gyy + gyy_j) * dy)
        approach = minimum(vx * dx + vy * dy, most)
        part = volume * slope
        damping_term = (sound + sound_j) * approach * mass * slope / (distance2 + soft)
        stress_term = own * part
        rate = shear_rate + shear_rate_j
        firm = UNBOUND * maximum(1.0 - YIELDING * rate, 0.0)  # where neither yields
        bound = share * (twice + firm + sqrt((xx_j - yy_j) * (xx_j - yy_j) + 4.0 * xy_j * xy_j))
        bound *= maximum(stress_term, 0.0 - stress_term)
        damping_term = maximum(0.0 - bound, minimum(bound, damping_term))
        bx += damping * damping_term * dx - stress_term * ((txx + txx_j) * dx + (txy + txy_j) * dy)
        by += damping * damping_term * dy - stress_term * ((tyx + tyx_j) * dx + (tyy + tyy_j) * dy)
        around -= part * ((xx_j - xx) + (yy_j - yy))
        diffusing = by_strain * rate + by_sound
        part = diffusing * part
        grown += diffusing * slope * (volume - bulk)
        rxx += part * (xx_j - xx)
        ryy += part * (yy_j - yy)
        rxy += part * (xy_j - xy)
        rzz += part * (zz_j - zz)
        stretching_j, sliding_j = gxx_j - gyy_j, gxy_j + gyx_j
        shearing_j = minimum(sqrt(stretching_j * stretching_j + sliding_j * sliding_j), fastest)
        close = (shearing + shearing_j) * maximum(1.0 - distance2 * inverse_spacing2, 0.0)
        wx += close * dx
        wy += close * dy
    diffused = (reduce_add(rxx), reduce_add(ryy), reduce_add(rxy), reduce_add(rzz))
    pushed = (reduce_add(bx), reduce_add(by), reduce_add(wx), reduce_add(wy))
    return pushed, diffused, reduce_add(grown), 0.5 * reduce_add(around), reduce_add(crowd)


@inline
def parting_rate(i, record, choices):
    """Rate of shear strain (1/s) at which particle i parts from those that are too near: its own, up to a bound."""
    stretching, sliding = record[i, GXX] - record[i, GYY], record[i, GXY] + record[i, GYX]
    return min(choices.fastest, np.sqrt(stretching * stretching + sliding * sliding))


@inline
def largest_shear(xx, yy, xy):
    """The largest shear stress of a stress (Pa): half of what its principal stresses differ by."""
    return np.sqrt(0.25 * (xx - yy) * (xx - yy) + xy * xy)


@inline
def undamped(printed):
    """(share of both gradients that velocities are not damped of;  largest closing that is damped, m²/s)."""
    if printed:
        return 0.0, 0.0
    return 0.5, np.inf


@inline
def with_wall_forces(i, record, facing, stress, near, choices, sums, around):
    """Accelerations, spacing recovery and mean p of `soil_forces`, ``sums`` and ``around``, with partners in walls
    before which particle i lies.  A wall's gradient, stress and sound are those of the soil before it.
    """
    ax, ay, ux, uy = sums
    own_p = 0.5 * (stress[i, XX] + stress[i, YY])
    kind, h, inverse_h, scale = near.kind, near.h, 1.0 / near.h, slope_scale(near.kind, near.h)
    soft, damping = SOFTENING * h * h, 0.5 * choices.damping * h
    inverse_spacing2 = 1.0 / (choices.spacing * choices.spacing)
    linear, most = undamped(choices.printed)
    yielding = choices.bounded and record[i, SHEAR_RATE] > 0.0
    sheared = 2.0 * largest_shear(stress[i, XX], stress[i, YY], stress[i, XY]) + (0.0 if yielding else UNBOUND)
    own = record[i, VOLUME] / record[i, MASS]
    shearing = parting_rate(i, record, choices)
    for w in range(np.uint64(near.split[i]), np.uint64(near.start[i + 1])):
        j = np.uint64(near.partner[w])
        dx = image(record[i, X] - record[j, X], near.period_x)
        dy = image(record[i, Y] - record[j, Y], near.period_y)
        if not before(facing, j, record[j, X] + dx, record[j, Y] + dy):
            continue
        distance2 = dx * dx + dy * dy
        slope = scale * slope_shape(kind, np.sqrt(distance2) * inverse_h)
        vx = record[i, VX] - record[j, VX]
        vy = record[i, VY] - record[j, VY]
        vx -= 2.0 * linear * (record[i, GXX] * dx + record[i, GXY] * dy)
        vy -= 2.0 * linear * (record[i, GYX] * dx + record[i, GYY] * dy)
        approach = min(most, vx * dx + vy * dy)
        stress_term = own * record[j, VOLUME] * slope
        sound = record[i, SOUND_OVER_DENSITY]
        damping_term = 2.0 * damping * sound * approach * record[j, MASS] * slope / (distance2 + soft)
        bound = DAMPED_BY * abs(stress_term) * sheared
        damping_term = max(min(damping_term, bound), -bound)
        txx, txy = record[i, TXX] + record[j, TXX], record[i, TXY] + record[j, TXY]
        tyx, tyy = record[i, TYX] + record[j, TYX], record[i, TYY] + record[j, TYY]
        ax += damping_term * dx - stress_term * (txx * dx + txy * dy)
        ay += damping_term * dy - stress_term * (tyx * dx + tyy * dy)
        around -= record[j, VOLUME] * slope * (0.5 * (stress[j, XX] + stress[j, YY]) - own_p)
        close = 2.0 * shearing * max(0.0, 1.0 - distance2 * inverse_spacing2)
        ux += close * dx
        uy += close * dy
    return ax, ay, ux, uy, around
