"""What walls that take the pressure of the fluid before them do to one particle (`boundary`)."""

from __future__ import annotations

import numpy as np

from continuum_sph.layers import VOLUME, VX, VY, P, X, Y
from continuum_sph.smoothing import slope_shape
from continuum_sph.viscosity import laminar
from porescale.ground.jit import inline
from porescale.particles.cells import minimum_image


@inline
def walls_push(
    begin, end, partner, record, ghost, material, x, y, vx, vy, rho, pressure, viscosity,
    lxx, lxy, lyy, kind, h, scale, sticky, period_x, period_y,
):  # fmt: skip
    """Of wall partners ``partner[begin:end]`` on a particle at (x, y) m, (vx, vy) m/s, ``rho`` kg/m³, ``pressure`` Pa:
    (acceleration by pressure, m/s², 2;  by friction, 2;  rate of density, kg/(m³ s)).

    record, ghost, material: see Layer;  viscosity μ, Pa s;  lxx, lxy, lyy: gradient correction;  scale: of
    `slope_scale`;  the rest: as
    `rates.rates`.
    """
    ax = 0.0
    ay = 0.0
    bx = 0.0
    by = 0.0
    change = 0.0
    specific = 1.0 / rho
    wraps = period_x > 0.0 or period_y > 0.0
    for k in range(np.uint64(begin), np.uint64(end)):
        j = np.uint64(partner[k])
        dx = x - record[j, X]
        dy = y - record[j, Y]
        if wraps:
            dx = minimum_image(dx, period_x)
            dy = minimum_image(dy, period_y)
        slope = scale * slope_shape(kind, np.sqrt(dx * dx + dy * dy) / h)
        volume = record[j, VOLUME]
        if sticky and material[j] == 0:
            brake = laminar(viscosity, volume, specific, 0.5 * (lxx + lyy) * slope)
            bx += brake * (vx - ghost[j, 0])
            by += brake * (vy - ghost[j, 1])
        dx, dy = lxx * dx + lxy * dy, lxy * dx + lyy * dy
        swept = volume * ((vx - record[j, VX]) * dx + (vy - record[j, VY]) * dy) * slope
        change += rho * swept
        thrust = (pressure + record[j, P]) * specific * volume * slope
        ax -= thrust * dx
        ay -= thrust * dy
    return ax, ay, bx, by, change
