"""What walls do to one particle: those that take the pressure of the fluid before them (`pressure_walls`), and those
whose particles move as the fluid's image (`image_walls`)."""

import numpy as np

from continuum_sph.water.bundles import image
from continuum_sph.water.fluids import VISCOSITY, fluid_number
from continuum_sph.water.image_walls import image_velocity
from continuum_sph.water.smoothing import kernel_kind, slope_scale, slope_shape
from continuum_sph.water.state import RHO, VOLUME, VX, VY, P, X, Y
from continuum_sph.water.viscosity import central, laminar
from porescale.common.compiled.jit import inline


@inline
def wall_sums(i, record, near, fluids, walls, gradients):
    """(acceleration of particle i by the pressure of walls, m/s², x and y;  by their friction, x and y;  rate of
    density, kg/(m³ s)).

    The arguments: of `rates.rates`.
    """
    kind, h = kernel_kind(near.kind), near.h
    scale = slope_scale(kind, h)
    viscosity = fluids.table[fluid_number(fluids.properties, i), VISCOSITY]
    x, y, vx, vy = record[i, X], record[i, Y], record[i, VX], record[i, VY]
    rho, pressure = record[i, RHO], record[i, P]
    specific_volume = 1.0 / rho
    ax = 0.0
    ay = 0.0
    bx = 0.0
    by = 0.0
    change = 0.0
    for k in range(np.uint64(near.split[i]), np.uint64(near.start[i + 1])):
        j = np.uint64(near.partner[k])
        dx, dy = image(x - record[j, X], near.period_x), image(y - record[j, Y], near.period_y)
        distance2 = dx * dx + dy * dy
        part = record[j, VOLUME] * wall_slope(fluids.lengths, i, j, kind, np.sqrt(distance2), h, scale)
        ux, uy = vx - record[j, VX], vy - record[j, VY]
        ux, uy = image_of(walls.facing, walls.material, record, j, dx, dy, ux, uy)
        rx, ry = beside_ghost(walls.ghost, j, vx, vy, ux, uy)
        viscous = laminar(viscosity, 1.0, specific_volume, part)
        fx, fy = wall_friction(
            walls.material, fluids.properties, gradients.matrix, viscous, i, j, (rx, ry), (dx, dy), distance2
        )
        bx += fx
        by += fy
        dx, dy = corrected(gradients.matrix, i, dx, dy)
        change += (ux * dx + uy * dy) * part
        pressure_term = (pressure + record[j, P]) * specific_volume * part
        ax -= pressure_term * dx
        ay -= pressure_term * dy
    return ax, ay, bx, by, rho * change


@inline
def wall_slope(lengths, i, j, kind, distance, h, scale):
    """`kernel_slope` at a ``distance`` (m) of particles i and j;  scale: `slope_scale` of h, where all have that."""
    if lengths is None:
        return scale * slope_shape(kind, distance / h)
    width = 0.5 * (lengths[i, 0] + lengths[j, 0])
    return slope_scale(kind, width) * slope_shape(kind, distance / width)


@inline
def image_of(facing, material, record, j, dx, dy, ux, uy):
    """Velocity (m/s) of fluid relative to wall particle j of image walls: of its image, (ux, uy) without such."""
    if facing is None:
        return ux, uy
    x, y = record[j, X], record[j, Y]
    return image_velocity(x + dx, y + dy, ux, uy, x, y, facing[j], material is not None)


@inline
def beside_ghost(ghost, j, vx, vy, ux, uy):
    """Velocity (m/s) of fluid relative to the ``ghost`` of wall particle j; (ux, uy) without such."""
    if ghost is None:
        return ux, uy
    return vx - ghost[j, 0], vy - ghost[j, 1]


@inline
def half_trace(matrix, i):
    """Half the trace of the gradient correction of particle i; 1 without."""
    if matrix is None:
        return 1.0
    return 0.5 * (matrix[i, 0] + matrix[i, 2])


@inline
def wall_friction(material, properties, matrix, viscous, i, j, relative, distance, distance2):
    """Acceleration (x, y) m/s² of particle i by the friction of wall particle j; 0 where that does not hold the fluid.

    viscous: `laminar` of the pair, 1/s;  relative: velocity, m/s;  distance (x, y) m, whose square is ``distance2``;
    the rest: see `bundles`.  Between several fluids friction acts along the line of centres.
    """
    if material is None:
        return 0.0, 0.0
    if material[j] != 0:
        return 0.0, 0.0
    return along_or_across(properties, viscous * half_trace(matrix, i), relative, distance, distance2)


@inline
def along_or_across(properties, viscous_term, relative, distance, distance2):
    """``viscous_term`` (1/s) times the ``relative`` velocity, or times its part along the line of centres."""
    rx, ry = relative
    if properties is None:
        return viscous_term * rx, viscous_term * ry
    dx, dy = distance
    along = central(viscous_term, rx * dx + ry * dy, distance2)
    return along * dx, along * dy


@inline
def corrected(matrix, i, dx, dy):
    """L_i times a distance (dx, dy) m; the distance itself without."""
    if matrix is None:
        return dx, dy
    return matrix[i, 0] * dx + matrix[i, 1] * dy, matrix[i, 1] * dx + matrix[i, 2] * dy
