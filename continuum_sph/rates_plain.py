"""The pass over pairs of one fluid between walls that take pressures: that of `rates`, faster.

The equations are those of `rates`, its slow twin; there is no second fluid here, no XSPH and no change of h.  A row
of partners is taken several at a time (`porescale.ground.lanes`); a particle stands for the missing end of its own row
and adds nothing, being at no distance from itself and moving as it does.  Factors that all partners share multiply the
sums.
"""

from __future__ import annotations

from continuum_sph.artificial_viscosity import artificial
from continuum_sph.density import HYDROSTATIC, LINEAR, haste_of, pace
from continuum_sph.fluids import SOUND, VISCOSITY
from continuum_sph.layers import BY_SHIFTING, BY_WALLS, DIFFUSIVE, RHO, STIFF, VISCOUS, VX, VY, P, X, Y
from continuum_sph.rates import CORRECTED, NOISE, SHIFTED
from continuum_sph.rates_walls import walls_push
from continuum_sph.smoothing import slope_scale, slope_shape
from continuum_sph.viscosity import laminar
from porescale.ground.jit import parallel_kernel, prange
from porescale.ground.lanes import LANES, nearest, nothing, root, take_four, take_rows, take_two, total


@parallel_kernel
def plain_rates(
    fluid, start, split, partner, record, ghost, material, matrix, slant, drift, mass, table, choices,
    acceleration, rate, power,
    kind, h, gx, gy, alpha, beta, softening, delta, calm, sticky, period_x, period_y, half,
):  # fmt: skip
    """Overwrites ``acceleration``, ``rate`` and columns of ``power`` as `rates.rates` does.

    Arguments: those of the same names there;  ``table`` (1, 9) has one fluid, without cohesion, and of ``choices``
    NOISE, SHIFTED and CORRECTED count.  ``matrix``, ``slant``, ``gx`` and ``beta`` are None where no choice needs them,
    all or none: what would read them is then not compiled, and the pass takes a fifth less.
    """
    linear = choices[NOISE] == LINEAR
    shifted = choices[SHIFTED] > 0
    corrected = choices[CORRECTED] > 0
    booked = power.shape[0] > 0
    viscosity = table[0, VISCOSITY]
    sound = table[0, SOUND]
    strength = delta * sound
    haste, restless = haste_of(calm, h)
    scale = slope_scale(kind, h)
    inverse = 1.0 / h
    level = 0.5 if choices[NOISE] == HYDROSTATIC else 0.0
    lift_x = level * gx if gx is not None else 0.0
    lift_y = level * gy
    wraps = period_x > 0.0 or period_y > 0.0
    turns_x = 1.0 / period_x if period_x > 0.0 else 0.0
    turns_y = 1.0 / period_y if period_y > 0.0 else 0.0
    for i in prange(fluid):
        xi = record[i, X]
        yi = record[i, Y]
        vxi = record[i, VX]
        vyi = record[i, VY]
        rho = record[i, RHO]
        own = record[i, P]
        stiff = record[i, STIFF]
        specific = 1.0 / rho
        friction = laminar(viscosity, 1.0, specific, 1.0)
        lxx = 1.0
        lxy = 0.0
        lyy = 1.0
        if matrix is not None and corrected:
            lxx = matrix[i, 0]
            lxy = matrix[i, 1]
            lyy = matrix[i, 2]
        ax = nothing()
        ay = nothing()
        bx = nothing()
        by = nothing()
        change = nothing()
        spread = nothing()
        k = start[i]
        while k < split[i]:
            xj, yj, vxj, vyj, rho_j, pressure_j, volume, stiff_j = take_rows(record, partner, k, split[i], i)
            dx = xi - xj
            dy = yi - yj
            if wraps:
                dx -= period_x * nearest(dx * turns_x)
                dy -= period_y * nearest(dy * turns_y)
            vx = vxi - vxj
            vy = vyi - vyj
            distance2 = dx * dx + dy * dy
            q = root(distance2) * inverse
            part = volume * scale * slope_shape(kind, q)
            approach = vx * dx + vy * dy
            lift = lift_y * dy
            if gx is not None:
                lift += lift_x * dx
            spreading = part * pace(approach, haste, restless)
            spread += (rho - rho_j - (stiff + stiff_j) * lift) * spreading
            if slant is not None and linear:
                sx, sy = take_two(slant, partner, k, split[i], i)
                spread -= 0.5 * ((slant[i, 0] + sx) * dx + (slant[i, 1] + sy) * dy) * spreading
            thrust = (own + pressure_j) * specific * part
            both = rho + rho_j
            damp = artificial(alpha, beta, sound, h, softening, approach, distance2, both) * rho_j * part
            brake = friction * part
            tx = dx
            ty = dy
            if matrix is not None and corrected:
                mxx, mxy, myy, _ = take_four(matrix, partner, k, split[i], i)
                mxx = 0.5 * (lxx + mxx)
                mxy = 0.5 * (lxy + mxy)
                myy = 0.5 * (lyy + myy)
                tx = mxx * dx + mxy * dy
                ty = mxy * dx + myy * dy
                brake *= 0.5 * (mxx + myy)
            k += LANES
            change += (vx * tx + vy * ty) * part
            ax -= thrust * tx
            ay -= thrust * ty
            bx += brake * vx - damp * dx
            by += brake * vy - damp * dy
        pushed_x, pushed_y, held_x, held_y, swept = walls_push(
            split[i], start[i + 1], partner, record, ghost, material, xi, yi, vxi, vyi, rho, own, viscosity,
            lxx, lxy, lyy, kind, h, scale, sticky, period_x, period_y,
        )  # fmt: skip
        moved = 0.0
        lifted = 0.0
        if slant is not None and shifted:
            moved = drift[i, 0] * slant[i, 0] + drift[i, 1] * slant[i, 1]
            lifted = gy * drift[i, 1]
            if gx is not None:
                lifted += gx * drift[i, 0]
        rubbed_x = total(bx) + held_x
        rubbed_y = total(by) + held_y
        diffused = strength * total(spread)
        acceleration[i, 0] = total(ax) + pushed_x + rubbed_x
        if gx is not None:
            acceleration[i, 0] += gx
        acceleration[i, 1] = total(ay) + pushed_y + rubbed_y + gy
        rate[i] = rho * total(change) + swept + moved + diffused
        if booked:
            # What these do to speeds they do at the step's end, and what they do to densities at its middle.
            vxi += half * acceleration[i, 0]
            vyi += half * acceleration[i, 1]
            work = mass[i] * specific * specific * (own - half * rho / stiff * rate[i])
            power[i, VISCOUS] = -mass[i] * (rubbed_x * vxi + rubbed_y * vyi)
            power[i, DIFFUSIVE] = -work * diffused
            power[i, BY_WALLS] = work * swept + mass[i] * (pushed_x * vxi + pushed_y * vyi)
            power[i, BY_SHIFTING] = work * moved - mass[i] * lifted
