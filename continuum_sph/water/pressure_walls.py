"""Walls of dummy particles that carry the pressure of the fluid in front of them.

Source: Adami, Hu & Adams, J. Comput. Phys. 231 (2012) 7057, eqs 22, 23, 27: pressure and velocity of a wall particle
are kernel averages over the fluid, the pressure with the hydrostatic difference from fluid to wall particle.  It
stands in for eqs 50, 51 of Maeda & Sakai 2004 (Morris' image velocities), which need a straight wall's distance.
"""

import numpy as np

from continuum_sph.water.bundles import image
from continuum_sph.water.smoothing import kernel_kind, kernel_value
from continuum_sph.water.state import RHO, VOLUME, VX, VY, P, X, Y
from porescale.common.compiled.jit import inline, parallel_kernel, prange
from porescale.common.core.types import Floats


@inline
def wall_mean(w, near, x, v, record, pressure, gx, gy):
    """Pressure (Pa) and mean fluid velocity (m/s) at wall particle w from its fluid partners.

    p_w = Σ (p_f + ρ_f g · (x_w - x_f)) W / Σ W, of either sign.
    """
    kind, h = kernel_kind(near.kind), near.h
    weight = 0.0
    p = 0.0
    ux = 0.0
    uy = 0.0
    for k in range(np.uint64(near.start[w]), np.uint64(near.split[w])):
        j = np.uint64(near.partner[k])
        dx = image(x[w, 0] - record[j, X], near.period_x)
        dy = image(x[w, 1] - record[j, Y], near.period_y)
        value = kernel_value(kind, np.sqrt(dx * dx + dy * dy) / h, h)
        weight += value
        p += (pressure[j] + record[j, RHO] * (gx * dx + gy * dy)) * value
        ux += record[j, VX] * value
        uy += record[j, VY] * value
    if weight > 0.0:
        return p / weight, ux / weight, uy / weight
    return 0.0, v[w, 0], v[w, 1]


@parallel_kernel
def load_walls(fluid, near, x, v, mass, record, pressure, ghost, gx, gy, density0):
    """Give wall particles (rows ``fluid`` on) the pressure and velocity of the fluid before them.  Their pressure is
    not below zero: a wall does not pull on a free surface's fluid.

    Overwrites the rows of ``record`` (n, 8) and ``ghost`` (n, 2) of those that have fluid for partners, and all of
    their ``pressure`` (n,);  ghost: 2 v_wall - mean fluid velocity: the average of fluid and ghost is then the wall's
    velocity at the wall;  None where no wall holds the fluid.  Their volume stays mass/density0, the square of the
    spacing, as that of fluid at the start.  near: see `bundles`.
    """
    for w in prange(fluid, x.shape[0]):
        if near.start[w] == near.split[w]:
            pressure[w] = 0.0  # and no fluid reads the rest
            continue
        p, ux, uy = wall_mean(w, near, x, v, record, pressure, gx, gy)
        p = max(0.0, p)
        pressure[w] = p
        record[w, X] = x[w, 0]
        record[w, Y] = x[w, 1]
        record[w, VX] = v[w, 0]
        record[w, VY] = v[w, 1]
        record[w, RHO] = density0
        record[w, P] = p
        record[w, VOLUME] = mass[w] / density0
        if ghost is not None:
            ghost[w, 0] = 2.0 * v[w, 0] - ux
            ghost[w, 1] = 2.0 * v[w, 1] - uy


def tank_walls(
    width: float,
    height: float,
    spacing: float,
    layers: int,
    *,
    sides: bool = True,
    lid: bool = False,
) -> Floats:
    """Positions (n, 2) m of the wall particles around the rectangle 0 … width, 0 … height, ``layers`` deep.

    The wall's surface lies half a ``spacing`` before its first layer.  Without ``sides`` (periodic) floor and lid
    are as long as the width; with them they reach round the corners.
    """
    columns, rows = round(width / spacing), round(height / spacing)
    i = np.arange(-layers if sides else 0, columns + (layers if sides else 0))
    j = np.arange(-layers, rows + (layers if lid else 0))
    grid_i, grid_j = np.meshgrid(i, j)
    inside = (grid_i >= 0) & (grid_i < columns) & (grid_j >= 0) & (grid_j < rows)
    centres: Floats = np.column_stack((grid_i[~inside], grid_j[~inside])).astype(np.float64)
    return (centres + 0.5) * spacing
