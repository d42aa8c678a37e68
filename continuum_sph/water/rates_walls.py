"""What walls do to one particle: those that take the pressure of the fluid before them (`boundary`), and the paper's,
whose particles move as the fluid's image (`boundary_paper`)."""

from __future__ import annotations

import numpy as np

from continuum_sph.water.image_walls import image
from continuum_sph.water.smoothing import slope_scale, slope_shape
from continuum_sph.water.state import VOLUME, VX, VY, P, X, Y
from continuum_sph.water.viscosity import central, laminar
from porescale.common.compiled.jit import inline
from porescale.common.neighbors.cells import minimum_image


@inline
def walls_push(
    i, begin, end, partner, record, traits, girths, ghost, facing, material, matrix, vx, vy, rho, pressure, viscosity,
    kind, h, scale, period_x, period_y,
):  # fmt: skip
    """Of wall partners ``partner[begin:end]`` on particle i, of (vx, vy) m/s, ``rho`` kg/m³, ``pressure`` Pa:
    (acceleration by pressure, m/s², 2;  by friction, 2;  rate of density, kg/(m³ s)).

    record: see Layer;  viscosity μ, Pa s;  scale: of `slope_scale`;  the rest, of which much may be None: as
    `rates.rates`.
    """
    ax = 0.0
    ay = 0.0
    bx = 0.0
    by = 0.0
    change = 0.0
    specific = 1.0 / rho
    x = record[i, X]
    y = record[i, Y]
    for k in range(np.uint64(begin), np.uint64(end)):
        j = np.uint64(partner[k])
        dx = x - record[j, X]
        dy = y - record[j, Y]
        if period_x is not None:
            dx = minimum_image(dx, period_x)
            dy = minimum_image(dy, period_y)
        distance2 = dx * dx + dy * dy
        if girths is not None:
            width = 0.5 * (girths[i, 0] + girths[j, 0])
            slope = slope_scale(kind, width) * slope_shape(kind, np.sqrt(distance2) / width)
        else:
            slope = scale * slope_shape(kind, np.sqrt(distance2) / h)
        part = record[j, VOLUME] * slope
        ux = vx - record[j, VX]
        uy = vy - record[j, VY]
        if facing is not None:
            ux, uy = image(
                record[j, X] + dx, record[j, Y] + dy, ux, uy, record[j, X], record[j, Y], facing[j],
                material is not None,
            )  # fmt: skip
        rx = ux
        ry = uy
        if ghost is not None:
            rx = vx - ghost[j, 0]
            ry = vy - ghost[j, 1]
        if material is not None and material[j] == 0:
            brake = laminar(viscosity, 1.0, specific, part)
            if matrix is not None:
                brake *= 0.5 * (matrix[i, 0] + matrix[i, 2])
            if traits is not None:
                along = central(brake, rx * dx + ry * dy, distance2)
                bx += along * dx
                by += along * dy
            else:
                bx += brake * rx
                by += brake * ry
        if matrix is not None:
            dx, dy = matrix[i, 0] * dx + matrix[i, 1] * dy, matrix[i, 1] * dx + matrix[i, 2] * dy
        change += (ux * dx + uy * dy) * part
        thrust = (pressure + record[j, P]) * specific * part
        ax -= thrust * dx
        ay -= thrust * dy
    return ax, ay, bx, by, rho * change
