"""Faces through which water comes and goes: wall particles that hold the pressure there.

Behind a face z = 0 of pressure p0 the field goes on as a straight line through p0: a wall particle at depth d takes
p0 - (p̄ - p0) d/z̄, p̄ and z̄ being the kernel means of pressure and distance over the water before it; and the mean flux
q̄, so that flow passes (its gradient across vanishes where p is given for ever).  Exact for linear pressures.
Adami, Hu & Adams, J. Comput. Phys. 231 (2012) 7057, have the means, for walls that nothing passes.

The particles behind the face go along with the water (`follow`).  If they stayed, water that comes in would leave a gap
behind its first row, and the pressures about it would push it back.  Good for ways of up to half a spacing: nothing new
comes in, nothing is taken out.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from continuum_sph.water.bundles import image
from continuum_sph.water.smoothing import CUBIC, kernel_value
from continuum_sph.water.state import VX, VY, P, X, Y
from porescale.common.compiled.jit import parallel_kernel, prange
from porescale.common.core.types import Floats


@dataclass
class PressureFace:
    """A face of given pressure.

    rows : (k,) numbers of its wall particles;  point : (x, y) m on it;  normal : (x, y) of unit length, into the
    water;  pressure : (k,) Pa, at the foot of each particle, settable at any time.
    """

    rows: NDArray[np.int64]
    point: tuple[float, float]
    normal: tuple[float, float]
    pressure: Floats

    def hydrostatic(self, x: Floats, level: float, weight: float, offset: float = 0.0) -> None:
        """Set the pressure of water that stands to ``level`` (m) over it; none above.

        x (n, 2) m: of all particles;  weight ρ g, N/m³;  offset: added, Pa.
        """
        at = x[self.rows]
        depth = (at - np.array(self.point)) @ np.array(self.normal)
        foot = at[:, 1] - depth * self.normal[1]
        self.pressure[:] = weight * np.maximum(0.0, level - foot) + offset


@parallel_kernel
def prescribe_pressure(rows, given, near, x, record, pressure, ox, oy, nx, ny):
    """Overwrites pressure and velocity of the wall particles ``rows`` (k,) in ``record`` and ``pressure`` (n,) Pa.

    given (k,) Pa;  near: see `water.bundles`;  x (n, 2) m;  (ox, oy), (nx, ny): a point of the face and its normal into
    the water.
    """
    kind, h = near.kind, near.h
    for number in prange(rows.shape[0]):
        w = rows[number]
        depth = (ox - x[w, 0]) * nx + (oy - x[w, 1]) * ny
        weight = 0.0
        p = 0.0
        height = 0.0
        ux = 0.0
        uy = 0.0
        for k in range(np.uint64(near.start[w]), np.uint64(near.split[w])):
            j = np.uint64(near.partner[k])
            dx = image(x[w, 0] - record[j, X], near.period_x)
            dy = image(x[w, 1] - record[j, Y], near.period_y)
            value = kernel_value(kind, np.sqrt(dx * dx + dy * dy) / h, h)
            weight += value
            p += record[j, P] * value
            height -= (dx * nx + dy * ny) * value
            ux += record[j, VX] * value
            uy += record[j, VY] * value
        behind = given[number]
        if weight > 0.0:
            above = height / weight - depth
            behind -= (p / weight - behind) * depth / max(above, 0.25 * h)
            record[w, VX] = ux / weight
            record[w, VY] = uy / weight
        record[w, P] = behind
        pressure[w] = behind


@parallel_kernel
def follow(rows, near, x, v, acceleration, nx, ny, step):
    """Moves the wall particles ``rows`` (k,) along the normal (nx, ny) as far as the water before them drifts in a
    ``step`` (s), on the mean; overwrites their ``x`` (n, 2) m.

    near: see `water.bundles`;  v (n, 2) m/s, acceleration (fluid, 2) m/s²: at the start of the step, whose drift is
    that of velocities half a step on.  The acceleration is that without drag: a drift without it lags by little, but
    always the same way.
    """
    h = near.h
    half = 0.5 * step
    for number in prange(rows.shape[0]):
        w = rows[number]
        weight = 0.0
        speed = 0.0
        for k in range(np.uint64(near.start[w]), np.uint64(near.split[w])):
            j = np.uint64(near.partner[k])
            dx = image(x[w, 0] - x[j, 0], near.period_x)
            dy = image(x[w, 1] - x[j, 1], near.period_y)
            value = kernel_value(CUBIC, np.sqrt(dx * dx + dy * dy) / h, h)
            weight += value
            ux = v[j, 0] + half * acceleration[j, 0]
            uy = v[j, 1] + half * acceleration[j, 1]
            speed += (ux * nx + uy * ny) * value
        if weight > 0.0:
            x[w, 0] += step * speed / weight * nx
            x[w, 1] += step * speed / weight * ny
