"""The one pass over pairs: accelerations and density rates of all fluid particles.

dv_i/dt = -(1/ρ_i) Σ V_j (p_i + p_j) ∇_i W - Σ m_j Π_ij ∇_i W + laminar viscosity + g   (eqs 34, 35)
dρ_i/dt =  ρ_i Σ V_j v_ij · ∇_i W + diffusion                                          (eq. 25)

The print has p_i/ρ_i² + p_j/ρ_j² with masses; (p_i + p_j) V_j/ρ_i is the same within one fluid but for its small
changes of density, holds between fluids of any two densities, and is what continuity with volumes does the work of:
kinetic and compressive energy balance pair by pair.

Every particle gathers from its full row of partners: each pair is computed twice, nothing is scattered, so threads
never meet and the sums have one order.  Forces of a pair are opposite but for the rounding of the division by mass.
A row of partners is taken several at a time (`porescale.common.compiled.simd`); a particle stands for the missing end
of its own row and adds nothing, being at no distance from itself and moving as it does.  Factors that all partners
share multiply the sums.

What a scene does not ask for is None among the arguments.  The pass is compiled for what there is, and kept on disk,
each kind by itself: it holds no branch, load or sum of anything else.
"""

from __future__ import annotations

from continuum_sph.water.artificial_viscosity import artificial
from continuum_sph.water.density import HYDROSTATIC, LINEAR, haste_of, pace
from continuum_sph.water.fluids import COHESION, SOUND, VISCOSITY, alike
from continuum_sph.water.rates_walls import walls_push
from continuum_sph.water.smoothing import WENDLAND, slope_scale, slope_shape, value_scale, value_shape
from continuum_sph.water.state import BY_SHIFTING, BY_WALLS, DIFFUSIVE, RHO, STIFF, VISCOUS, VX, VY, P, X, Y
from continuum_sph.water.viscosity import laminar, mutual
from porescale.common.compiled.jit import parallel_kernel, prange
from porescale.common.compiled.simd import LANES, nearest, nothing, root, take_four, take_rows, take_two, total


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
    fluid, start, split, partner, record, traits, girths, ghost, facing, material, matrix, slant, drift, mass, table,
    acceleration, rate, smoothed, power,
    kind, h, gx, gy, alpha, beta, softening, delta, calm, noise, cohesive, smoothing, period_x, period_y, half,
):  # fmt: skip
    """Overwrites ``acceleration`` (fluid, 2) m/s², ``rate`` (fluid,) kg/(m³ s), ``smoothed`` (fluid, 2) m/s and the
    columns of ``power`` (fluid, 6) W/m that are its own: BY_SHIFTING only if there is ``drift``.

    start, split, partner: full pair list, wall partners of row i from ``split[i]`` on;  record: see Layer;  table
    (m, 9): the fluids;  kind, h: smoothing;  gy gravity, m/s²;  alpha, softening: artificial viscosity;  delta 2 δ h of
    the density diffusion, m, calm, m/s, of `haste_of`, and noise, what diffusion takes for noise;  half: of the step
    that ends here, s.  None where a scene has no

    second fluid: ``traits`` (fluid, 2), number of the fluid and μ, Pa s: two fluids rub along the line of centres, one
    as eq. 34 has it (`viscosity`);  h of its own for each particle: ``girths`` (n, 2), h, m, in the first (eq. 7);
    walls that hold: ``material`` (n,), 0 for wall particles that do, and ``ghost``, see Layer, which walls of the paper
    need not;  walls of the paper: ``facing``, see Layer;  corrected gradients: ``matrix``, see Layer;  noise about a
    linear field, nor shifting: ``slant`` of `surroundings`;  shifting: ``drift`` (fluid, 2) m/s, to whose place the
    density belongs;  book: ``power`` and, without cohesion, ``mass`` (n,) kg/m;  cohesion: ``cohesive``;  XSPH:
    ``smoothed`` and ``smoothing``, its ε, for Σ (m_j/ρ̄)(v_j - v_i) W (eq. 53 with the sign that smooths);  gravity
    sideways: ``gx``, m/s²;  β of artificial viscosity: ``beta``;  periods: ``period_x`` and ``period_y``, m or 0.
    ``kind`` is None for Wendland's kernel where that is to be compiled in.
    """
    form = WENDLAND
    if kind is not None:
        form = kind
    linear = noise == LINEAR
    haste, restless = haste_of(calm, h)
    level = 0.5 if noise == HYDROSTATIC else 0.0
    lift_x = level * gx if gx is not None else 0.0
    lift_y = level * gy
    turns_x = 0.0
    turns_y = 0.0
    if period_x is not None:
        turns_x = 1.0 / period_x if period_x > 0.0 else 0.0
        turns_y = 1.0 / period_y if period_y > 0.0 else 0.0
    scale_h = slope_scale(form, h)
    inverse_h = 1.0 / h
    for i in prange(fluid):
        xi = record[i, X]
        yi = record[i, Y]
        vxi = record[i, VX]
        vyi = record[i, VY]
        rho = record[i, RHO]
        own = record[i, P]
        stiff = record[i, STIFF]
        specific = 1.0 / rho
        own_material = 0
        if traits is not None:
            own_material = int(traits[i, 0])
        viscosity = table[own_material, VISCOSITY]
        sound = table[own_material, SOUND]
        friction = laminar(viscosity, 1.0, specific, 1.0)
        if cohesive is not None:
            pull = 2.0 * table[own_material, COHESION] / (mass[i] * mass[i])
        ax = nothing()
        ay = nothing()
        bx = nothing()
        by = nothing()
        sx = nothing()
        sy = nothing()
        change = nothing()
        spread = nothing()
        k = start[i]
        while k < split[i]:
            xj, yj, vxj, vyj, rho_j, pressure_j, volume, stiff_j = take_rows(record, partner, k, split[i], i)
            dx = xi - xj
            dy = yi - yj
            if period_x is not None:
                dx -= period_x * nearest(dx * turns_x)
                dy -= period_y * nearest(dy * turns_y)
            vx = vxi - vxj
            vy = vyi - vyj
            distance2 = dx * dx + dy * dy
            if girths is not None:
                girth, _ = take_two(girths, partner, k, split[i], i)
                width = 0.5 * (girths[i, 0] + girth)
                inverse = 1.0 / width
                scale = slope_scale(form, width)
            else:
                width = h
                inverse = inverse_h
                scale = scale_h
            q = root(distance2) * inverse
            part = volume * scale * slope_shape(form, q)
            approach = vx * dx + vy * dy
            spreading = part * pace(approach, haste, restless)
            if traits is not None:
                material_j, viscosity_j = take_two(traits, partner, k, split[i], i)
                same = alike(traits[i, 0], material_j)
                spreading *= same
            lift = lift_y * dy
            if gx is not None:
                lift += lift_x * dx
            spread += (rho - rho_j - (stiff + stiff_j) * lift) * spreading
            if slant is not None and linear:
                sideways, up = take_two(slant, partner, k, split[i], i)
                spread -= 0.5 * ((slant[i, 0] + sideways) * dx + (slant[i, 1] + up) * dy) * spreading
            thrust = (own + pressure_j) * specific
            if cohesive is not None:
                if traits is not None:
                    thrust -= pull * same * rho_j
                else:
                    thrust -= pull * rho_j
            both = rho + rho_j
            damp = artificial(alpha, beta, sound, width, softening, approach, distance2, both) * rho_j
            if matrix is not None:
                mxx, mxy, myy, _ = take_four(matrix, partner, k, split[i], i)
                mxx = 0.5 * (matrix[i, 0] + mxx)
                mxy = 0.5 * (matrix[i, 1] + mxy)
                myy = 0.5 * (matrix[i, 2] + myy)
                tx = mxx * dx + mxy * dy
                ty = mxy * dx + myy * dy
                change += (vx * tx + vy * ty) * part
                thrust *= part
                ax -= thrust * tx
                ay -= thrust * ty
                if power is not None:
                    bx += thrust * tx
                    by += thrust * ty
                braking = 0.5 * (mxx + myy) * part
                push = damp * part
            else:
                change += approach * part
                braking = part
                push = (thrust + damp) * part
                if power is not None:
                    thrust *= part
                    bx += thrust * dx
                    by += thrust * dy
            if traits is not None:
                rub = mutual(viscosity, viscosity_j, specific, approach, distance2) * braking
                ax -= (push - rub) * dx
                ay -= (push - rub) * dy
            else:
                brake = friction * braking
                ax += brake * vx - push * dx
                ay += brake * vy - push * dy
            if smoothing is not None:
                weight = rho_j * volume / both * value_shape(form, q)
                if girths is not None:
                    weight *= value_scale(form, width)
                sx -= weight * vx
                sy -= weight * vy
            k += LANES
        pushed_x, pushed_y, held_x, held_y, swept = walls_push(
            i, split[i], start[i + 1], partner, record, traits, girths, ghost, facing, material, matrix, vxi, vyi, rho,
            own, viscosity, form, h, scale_h, period_x, period_y,
        )  # fmt: skip
        diffused = delta * sound * total(spread)
        acceleration[i, 0] = total(ax) + pushed_x + held_x
        if gx is not None:
            acceleration[i, 0] += gx
        acceleration[i, 1] = total(ay) + pushed_y + held_y + gy
        moved = 0.0
        lifted = 0.0
        if drift is not None:
            moved = drift[i, 0] * slant[i, 0] + drift[i, 1] * slant[i, 1]
            lifted = gy * drift[i, 1]
            if gx is not None:
                lifted += gx * drift[i, 0]
        rate[i] = rho * total(change) + swept + moved + diffused
        if smoothing is not None:
            whole = 2.0 * smoothing
            if girths is None:
                whole *= value_scale(form, h)
            smoothed[i, 0] = whole * total(sx)
            smoothed[i, 1] = whole * total(sy)
        if power is not None:
            # What these do to speeds they do at the step's end, and what they do to densities at its middle.
            vxi += half * acceleration[i, 0]
            vyi += half * acceleration[i, 1]
            work = mass[i] * specific * specific * (own - half * rho / stiff * rate[i])
            rubbed_x = total(ax) + total(bx) + held_x  # all but pressures, whose sums are bx and by
            rubbed_y = total(ay) + total(by) + held_y
            power[i, VISCOUS] = -mass[i] * (rubbed_x * vxi + rubbed_y * vyi)
            power[i, DIFFUSIVE] = -work * diffused
            power[i, BY_WALLS] = work * swept + mass[i] * (pushed_x * vxi + pushed_y * vyi)
            if drift is not None:
                power[i, BY_SHIFTING] = work * moved - mass[i] * lifted
