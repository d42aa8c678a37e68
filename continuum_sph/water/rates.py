"""The one pass over pairs: accelerations and density rates of all fluid particles.

dv_i/dt = f {-(1/ρ_i) Σ V_j (p_i + p_j) ∇_i W - Σ m_j Π_ij ∇_i W + laminar viscosity} + g   (eqs 34, 35)
dρ_i/dt = f ρ_i Σ V_j v_ij · ∇_i W + diffusion                                              (eq. 25)

f = 1/M of the lattice at the start (`kernel_correction.lattice_gradient`) makes the sums exact on it; eqs 34 and 25
have 1, and are 1.3 % weak each with the default kernel, at any spacing.  With corrected gradients L does this.

Eq. 34 has p_i/ρ_i² + p_j/ρ_j² with masses; (p_i + p_j) V_j/ρ_i is the same within one fluid but for its small
changes of density, holds between fluids of any two densities, and is what continuity with volumes does the work of:
kinetic and compressive energy balance pair by pair.

Every particle gathers from its full row of partners: each pair is computed twice, nothing is scattered, so threads
never write to one place and the sums have one order.  Forces of a pair are opposite but for the rounding of the
division by mass.  A row of partners is taken several at a time (`porescale.common.compiled.simd`); a particle stands
for the missing end of its own row and adds nothing, being at no distance from itself and moving as it does.  Factors
that all partners share multiply the sums.

What a scene has no use for is None in the bundles (`bundles`).  The pass is compiled for what there is, and kept on
disk, each kind by itself: it holds no branch, load or sum of anything else.  Sums over partners in the fluids are in
`rates_fluid`, over those in walls in `rates_walls`.
"""

from continuum_sph.water.bundles import plus, plus_scaled, row
from continuum_sph.water.fluids import SOUND, fluid_number
from continuum_sph.water.rates_fluid import fluid_sums
from continuum_sph.water.rates_walls import wall_sums
from continuum_sph.water.smoothing import kernel_kind, value_scale
from continuum_sph.water.state import (
    BY_SHIFTING,
    BY_WALLS,
    COMPRESSIBILITY,
    DIFFUSIVE,
    RHO,
    VISCOUS,
    VX,
    VY,
    P,
)
from porescale.common.compiled.jit import inline, parallel_kernel, prange


@parallel_kernel
def split_rows(fluid, start, partner, split):
    """Where wall partners begin in each row of a full list: overwrites ``split`` (n,).  Fluid indices come first."""
    for i in prange(split.shape[0]):
        k = start[i + 1]
        while k > start[i] and partner[k - 1] >= fluid:
            k -= 1
        split[i] = k


@parallel_kernel
def rates(fluid, record, near, fluids, walls, gradients, choices, acceleration, rate, smoothed, power, half):
    """Overwrites, of the particles of the fluids, ``acceleration`` (fluid, 2) m/s²;  ``rate`` (fluid,) of density,
    kg/(m³ s);  ``smoothed`` (fluid, 2) m/s, None without XSPH;  ``power`` (fluid, 6) W/m, but for the columns
    BY_TENSION, STOPPED and, without shifting, BY_SHIFTING: None without a budget.

    record (n, 8): see `state.Layer`;  near, fluids, walls, gradients, choices: see `bundles`;  half: of the step that
    ends here, s.  Two fluids have friction along the line of centres, one as eq. 34 has it (`viscosity`).
    """
    for at in prange(fluid):
        i = row(at)
        fluid_a, friction_a, xsph, compression, noise = fluid_sums(i, record, near, fluids, gradients, choices)
        push_x, push_y, held_x, held_y, wall_flux = wall_sums(i, record, near, fluids, walls, gradients)
        ax, ay = scaled(choices.lattice, fluid_a[0] + push_x + held_x, fluid_a[1] + push_y + held_y)
        push_x, push_y = scaled(choices.lattice, push_x, push_y)
        rubbed = scaled(choices.lattice, friction_a[0] + held_x, friction_a[1] + held_y)
        compression, wall_flux = scaled(choices.lattice, compression, wall_flux)
        rho = record[i, RHO]
        sound = fluids.table[fluid_number(fluids.properties, i), SOUND]
        diffused = choices.diffusion * sound * noise
        acceleration[i, 0] = plus(ax, choices.gravity_x)
        acceleration[i, 1] = ay + choices.gravity_y
        moved, lifted = carried(gradients.drift, gradients.density, choices, i)
        rate[i] = rho * compression + wall_flux + moved + diffused
        store_smoothed(smoothed, i, xsph, choices, near, fluids)
        flux = (diffused, wall_flux, moved, lifted)
        given = (acceleration[i, 0], acceleration[i, 1], rate[i])
        store_power(power, i, record, fluids.mass, given, half, rubbed, (push_x, push_y), flux, gradients.drift)


@inline
def scaled(lattice, one, other):
    """Both numbers times ``lattice``, which makes plain sums exact on the lattice of the start; as they are if None."""
    if lattice is None:
        return one, other
    return lattice * one, lattice * other


@inline
def carried(drift, gradient, choices, i):
    """Rate of density, kg/(m³ s), and power of gravity per mass, W/kg, that shifting gives particle i: 0 without."""
    if drift is None:
        return 0.0, 0.0
    lifted = plus_scaled(choices.gravity_y * drift[i, 1], choices.gravity_x, 1.0, drift[i, 0])
    return drift[i, 0] * gradient[i, 0] + drift[i, 1] * gradient[i, 1], lifted


@inline
def store_smoothed(smoothed, i, xsph, choices, near, fluids):
    """Overwrites row i of ``smoothed`` (fluid, 2) m/s, unless it is None, with 2 ε times the sums ``xsph``."""
    if smoothed is not None:
        whole = 2.0 * choices.xsph * common_value_scale(fluids.lengths, kernel_kind(near.kind), near.h)
        smoothed[i, 0] = whole * xsph[0]
        smoothed[i, 1] = whole * xsph[1]


@inline
def common_value_scale(lengths, kind, h):
    """What sums of kernel values are multiplied by as a whole: 1 where smoothing lengths vary."""
    if lengths is None:
        return value_scale(kind, h)
    return 1.0


@inline
def store_power(power, i, record, mass, given, half, rubbed, pushed, flux, drift):
    """Overwrites row i of ``power`` (fluid, 6) W/m, unless it is None.

    given: acceleration (x, y), m/s², and rate of density;  rubbed, pushed: accelerations by all but pressures, and by
    the pressure of walls, m/s²;  flux: rates of density by diffusion, walls and shifting, kg/(m³ s), and the power of
    gravity by shifting, W/kg;  the rest: of `rates`.
    What forces do to speeds they do at the end of the step, and what they do to densities at its middle.
    """
    if power is not None:
        diffused, wall_flux, moved, lifted = flux
        rho = record[i, RHO]
        specific_volume = 1.0 / rho
        vx = record[i, VX] + half * given[0]
        vy = record[i, VY] + half * given[1]
        mid_pressure = record[i, P] - half * rho / record[i, COMPRESSIBILITY] * given[2]
        work = mass[i] * specific_volume * specific_volume * mid_pressure
        power[i, VISCOUS] = -mass[i] * (rubbed[0] * vx + rubbed[1] * vy)
        power[i, DIFFUSIVE] = -work * diffused
        power[i, BY_WALLS] = work * wall_flux + mass[i] * (pushed[0] * vx + pushed[1] * vy)
        store_shifting(power, drift, i, work * moved - mass[i] * lifted)


@inline
def store_shifting(power, drift, i, value):
    """Overwrites the power of shifting of particle i, W/m, where there is a ``drift``."""
    if drift is not None:
        power[i, BY_SHIFTING] = value
