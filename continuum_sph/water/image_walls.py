"""Image walls: boundary particles as particles of the fluid, with a velocity as the fluid's image has it.

v_aB = β v_a, β = min(β_max, 1 + d_B/d_a): eqs 50, 51 of Maeda & Sakai 2004 (Morris, Fox & Zhu 1997), d the distances
of fluid particle and boundary particle from the wall's surface.  So the fluid sticks to the wall; where it slips, only
the part across the wall is doubled so, and no viscous force acts.  (An image that moved along with slipping fluid would
leave the push of boundary particles along the wall without work of compression: water at rest then stirs itself.)
Boundary particles stay where they are, do not interact, and carry a density that follows continuity like that of the
fluid, and the pressure that goes with it.
"""

from typing import Any, NamedTuple

import numpy as np

from continuum_sph.water.bundles import image
from continuum_sph.water.eos.law import pressure_of
from continuum_sph.water.smoothing import kernel_kind, kernel_slope
from continuum_sph.water.state import RHO, VOLUME, VX, VY, P, X, Y
from porescale.common.compiled.jit import inline, parallel_kernel, prange
from porescale.common.core.types import Floats

STEEPEST = 2.0  # β_max of eq. 51


def facing(walls: Floats, lower: tuple[float, float], upper: tuple[float, float]) -> Floats:
    """Nearest point of a tank's surface and normal into the tank, (n, 4) m, of wall particles at ``walls`` (n, 2) m."""
    near = np.clip(walls, lower, upper)
    normal = near - walls
    depth = np.hypot(normal[:, 0], normal[:, 1])
    return np.column_stack((near, normal / depth[:, None]))


@inline
def image_velocity(x, y, vx, vy, wall_x, wall_y, facing, stick):
    """v_aB (m/s) of fluid at (x, y) m whose velocity relative to the wall is (vx, vy) m/s.

    facing (4,): a point of the surface and its normal;  stick: no slip.
    """
    nx = facing[2]
    ny = facing[3]
    behind = (facing[0] - wall_x) * nx + (facing[1] - wall_y) * ny
    before = (x - facing[0]) * nx + (y - facing[1]) * ny
    beta = STEEPEST
    if before * (STEEPEST - 1.0) > behind:
        beta = 1.0 + behind / before
    if stick:
        return beta * vx, beta * vy
    more = (beta - 1.0) * (vx * nx + vy * ny)
    return vx + more * nx, vy + more * ny


class WallDensities(NamedTuple):
    """density (walls,) kg/m³;  rate, rate_before (walls,) kg/(m³ s), of the last step and the one before."""

    density: Any
    rate: Any
    rate_before: Any


@parallel_kernel
def wall_rates(fluid, record, near, facing, stick, density, rate, step):
    """Continuity of boundary particles over their fluid partners; overwrites ``rate`` (walls,) kg/(m³ s) and takes
    ``density`` (walls,) a ``step`` (s) further.

    record, facing: see `state.Layer`;  near: see `bundles`;  stick: no slip.
    """
    kind, h = kernel_kind(near.kind), near.h
    for w in prange(fluid, record.shape[0]):
        change = 0.0
        for k in range(np.uint64(near.start[w]), np.uint64(near.split[w])):
            j = np.uint64(near.partner[k])
            dx = image(record[w, X] - record[j, X], near.period_x)
            dy = image(record[w, Y] - record[j, Y], near.period_y)
            vx, vy = image_velocity(
                record[w, X] - dx, record[w, Y] - dy, record[j, VX] - record[w, VX], record[j, VY] - record[w, VY],
                record[w, X], record[w, Y], facing[w], stick,
            )  # fmt: skip
            slope = kernel_slope(kind, np.sqrt(dx * dx + dy * dy) / h, h)
            change -= record[j, VOLUME] * (vx * dx + vy * dy) * slope
        change *= record[w, RHO]
        rate[w - fluid] = change
        density[w - fluid] += step * change


@parallel_kernel
def update_walls(fluid, x, v, mass, densities, step, ratio, cut, record, pressure, law):
    """What fluid reads of boundary particles; overwrites their rows of ``record`` (n, 8) and ``pressure`` (n,).

    Their density is taken a ``step`` (s) {rate + ratio (rate - rate_before)} beyond that of ``densities``, as that of
    the fluid is;  law: numbers of their fluid's, see `eos`;  cut: no tension.
    """
    for w in prange(fluid, x.shape[0]):
        b = w - fluid
        rate = densities.rate[b]
        rho = densities.density[b] + step * (rate + ratio * (rate - densities.rate_before[b]))
        p, _ = pressure_of(rho / law.density, law)
        if cut:
            p = max(0.0, p)
        pressure[w] = p
        record[w, X] = x[w, 0]
        record[w, Y] = x[w, 1]
        record[w, VX] = v[w, 0]
        record[w, VY] = v[w, 1]
        record[w, RHO] = rho
        record[w, P] = p
        record[w, VOLUME] = mass[w] / rho
