"""What the partners in the fluids do to one particle: the sums of `rates` over them, several at a time."""

from continuum_sph.water.bundles import inverse_period, nearest_image, plus_scaled
from continuum_sph.water.density import HYDROSTATIC, LINEAR, diffusion_share, noise_scale
from continuum_sph.water.fluids import COHESION, SOUND, VISCOSITY, fluid_number, pair_fluid
from continuum_sph.water.smoothing import kernel_kind, slope_scale, slope_shape, value_scale, value_shape
from continuum_sph.water.state import COMPRESSIBILITY, RHO, VX, VY, P, X, Y
from continuum_sph.water.viscosity import artificial, laminar, mutual
from porescale.common.compiled.jit import inline
from porescale.common.compiled.simd import LANES, gather_four, gather_rows, gather_two, reduce_add, sqrt, zeros


@inline
def fluid_sums(i, record, near, fluids, gradients, choices):
    """((a_x, a_y), m/s², of all partners;  the same of all but their pressures;  XSPH sums (x, y), m/s over
    2 ε times the scale of kernel values;  Σ V_j v_ij · ∇_i W, 1/s;  sum of the density diffusion).

    The arguments: of `rates.rates`.
    """
    kind, h = kernel_kind(near.kind), near.h
    inverse_h, scale_h = 1.0 / h, slope_scale(kind, h)
    inverse_noise_speed, sound_share = noise_scale(choices.noise_speed, h)
    level = 0.5 if choices.noise == HYDROSTATIC else 0.0
    lift_y = level * choices.gravity_y
    turns_x, turns_y = inverse_period(near.period_x), inverse_period(near.period_y)
    xi, yi, vxi, vyi = record[i, X], record[i, Y], record[i, VX], record[i, VY]
    rho, pressure, compressibility = record[i, RHO], record[i, P], record[i, COMPRESSIBILITY]
    specific_volume = 1.0 / rho
    number = fluid_number(fluids.properties, i)
    viscosity, sound = fluids.table[number, VISCOSITY], fluids.table[number, SOUND]
    friction = laminar(viscosity, 1.0, specific_volume, 1.0)
    cohesion = cohesion_of(choices.cohesive, fluids.table, number, fluids.mass, i)
    ax, ay, bx, by, sx, sy = zeros(), zeros(), zeros(), zeros(), zeros(), zeros()
    compression, diffused = zeros(), zeros()
    k, end = near.start[i], near.split[i]
    while k < end:
        xj, yj, vxj, vyj, rho_j, pressure_j, volume, compressibility_j = gather_rows(record, near.partner, k, end, i)
        dx, dy = nearest_image(xi - xj, near.period_x, turns_x), nearest_image(yi - yj, near.period_y, turns_y)
        vx, vy = vxi - vxj, vyi - vyj
        distance2 = dx * dx + dy * dy
        width, inverse, scale = pair_width(fluids.lengths, near.partner, k, end, i, kind, h, inverse_h, scale_h)
        q = sqrt(distance2) * inverse
        part = volume * scale * slope_shape(kind, q)
        approach = vx * dx + vy * dy
        same, viscosity_j = pair_fluid(fluids.properties, near.partner, k, end, i)
        noise_part = part * diffusion_share(approach, inverse_noise_speed, sound_share) * same
        lift = plus_scaled(lift_y * dy, choices.gravity_x, level, dx)
        diffused += (rho - rho_j - (compressibility + compressibility_j) * lift) * noise_part
        diffused = less_linear(
            diffused, gradients.density, choices.noise, near.partner, k, end, i, (dx, dy), noise_part
        )
        both = rho + rho_j
        pressure_term = (pressure + pressure_j) * specific_volume
        pressure_term -= cohesion_term(choices.cohesive, cohesion, same, rho_j)
        damping_term = rho_j * artificial(
            choices.alpha, choices.beta, sound, width, choices.softening, approach, distance2, both
        )
        tx, ty, trace = corrected_distance(gradients.matrix, near.partner, k, end, i, dx, dy)
        compression += (vx * tx + vy * ty) * part
        px, py, central = split_push(gradients.matrix, pressure_term, damping_term, part, tx, ty)
        ax -= px
        ay -= py
        bx += pressure_term * part * tx
        by += pressure_term * part * ty
        between = (viscosity, viscosity_j, specific_volume, friction, trace * part)
        fx, fy = friction_push(fluids.properties, between, approach, distance2, vx, vy, dx, dy, central)
        ax += fx
        ay += fy
        weight = rho_j * volume / both * value_shape(kind, q) * pair_value_scale(fluids.lengths, kind, width)
        sx -= weight * vx
        sy -= weight * vy
        k += LANES
    a = (reduce_add(ax), reduce_add(ay))
    return (
        a,
        (a[0] + reduce_add(bx), a[1] + reduce_add(by)),
        (reduce_add(sx), reduce_add(sy)),
        reduce_add(compression),
        reduce_add(diffused),
    )


@inline
def cohesion_of(cohesive, table, number, mass, i):
    """2 a/m² of particle i and its fluid ``number``, Pa m⁶/kg²: 0 without cohesion."""
    if cohesive is None:
        return 0.0
    return 2.0 * table[number, COHESION] / (mass[i] * mass[i])


@inline
def cohesion_term(cohesive, cohesion, same, rho):
    """What cohesion takes off the pressure term of partners of density ``rho`` (kg/m³) in the ``same`` fluid."""
    if cohesive is None:
        return 0.0
    return cohesion * same * rho


@inline
def pair_width(lengths, partner, k, end, i, kind, h, inverse_h, scale_h):
    """Smoothing lengths (m) of pairs, their inverses, and `slope_scale` of them: the mean of both particles' (eq. 7).

    lengths: see `bundles.Fluids`;  inverse_h, scale_h: of ``h``, where all have that.
    """
    if lengths is None:
        return h, inverse_h, scale_h
    length, _ = gather_two(lengths, partner, k, end, i)
    width = 0.5 * (lengths[i, 0] + length)
    return width, 1.0 / width, slope_scale(kind, width)


@inline
def pair_value_scale(lengths, kind, width):
    """`value_scale` of pairs where smoothing lengths vary; 1 where the whole sum is multiplied by it."""
    if lengths is None:
        return 1.0
    return value_scale(kind, width)


@inline
def less_linear(diffused, gradient, noise, partner, k, end, i, distance, noise_part):
    """``diffused`` less what differences of density by the mean ``gradient`` of both particles, over a ``distance``
    (x, y) m, make of it: where noise is what departs from a linear field."""
    if gradient is None:
        return diffused
    if noise != LINEAR:
        return diffused
    along_x, along_y = gather_two(gradient, partner, k, end, i)
    dx, dy = distance
    return diffused - 0.5 * ((gradient[i, 0] + along_x) * dx + (gradient[i, 1] + along_y) * dy) * noise_part


@inline
def corrected_distance(matrix, partner, k, end, i, dx, dy):
    """(x, y) m of (L_i + L_j)/2 times the distance, and half the trace of that; the distance and 1 without."""
    if matrix is None:
        return dx, dy, 1.0
    xx, xy, yy, _ = gather_four(matrix, partner, k, end, i)
    xx = 0.5 * (matrix[i, 0] + xx)
    xy = 0.5 * (matrix[i, 1] + xy)
    yy = 0.5 * (matrix[i, 2] + yy)
    return xx * dx + xy * dy, xy * dx + yy * dy, 0.5 * (xx + yy)


@inline
def split_push(matrix, pressure_term, damping_term, part, tx, ty):
    """(push along the corrected distance, x and y, m/s²;  factor of the push along the distance, 1/s²).

    With plain gradients pressure goes along the distance, too.
    """
    if matrix is None:
        return 0.0, 0.0, (pressure_term + damping_term) * part
    return pressure_term * part * tx, pressure_term * part * ty, damping_term * part


@inline
def friction_push(properties, between, approach, distance2, vx, vy, dx, dy, central):
    """Acceleration (x, y), m/s², by friction, less the push ``central`` (dx, dy), 1/s² and m.

    between: viscosities μ_i and μ_j, Pa s, 1/ρ_i, `laminar` without V_j W', and V_j W';  approach v_ij · x_ij, m²/s.
    """
    viscosity, viscosity_j, specific_volume, friction, part = between
    if properties is None:
        viscous_term = friction * part
        return viscous_term * vx - central * dx, viscous_term * vy - central * dy
    viscous_term = mutual(viscosity, viscosity_j, specific_volume, approach, distance2) * part
    return -((central - viscous_term) * dx), -((central - viscous_term) * dy)
