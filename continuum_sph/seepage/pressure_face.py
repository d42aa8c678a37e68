"""Faces through which water comes and goes: wall particles that hold the pressure there.

Behind a face z = 0 of pressure p0 the field goes on as a straight line through p0: a wall particle at depth d takes
p0 - (p̄ - p0) d/z̄, p̄ and z̄ being the kernel means of pressure and distance over the water before it; and the mean flux
q̄, so that flow passes (its gradient across vanishes where p is given for ever).  Exact for linear pressures.
Adami, Hu & Adams, J. Comput. Phys. 231 (2012) 7057, have the means, for walls that nothing passes.

The particles behind the face go along with the water (`follow`).  If they stayed, water that comes in would leave a gap
behind its first row, and the pressures about it would push it back: a gap of a share ε of a spacing takes ε of the
whole pressure p0 off the push of the face.  So each column of them stands where it pushes the water before it as one
does on the lattice of the start, by p0 times its breadth (`push_of`):

    -2 p0 V_w Σ_w Σ_j V_j L_j ∇_j W_jw · n = p0 × breadth

In ground that is held that is a place beside the first row, at its distance.  Under ground that is lifted pores widen
and the rows of water in them come closer, as V = m/(n ρ) has it: particles that drifted with the mean speed of the rows
before them, as in earlier versions, stayed behind by 0.06 spacings within 0.1 s, which took 150 Pa off 2340, more than
was to lift the ground, and it sank.  Good for ways of up to half a spacing: nothing new comes in, nothing is taken out.
"""

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from continuum_sph.water.bundles import Neighbours, image, row
from continuum_sph.water.pressure_walls import wall_mean
from continuum_sph.water.rates_walls import corrected
from continuum_sph.water.smoothing import kernel_slope, kernel_value
from continuum_sph.water.state import VOLUME, VX, VY, Layer, P, X, Y
from porescale.common.compiled.jit import inline, parallel_kernel, prange
from porescale.common.core.types import Floats

TRIAL = 0.05  # spacings by which columns are moved to find how their push changes


@dataclass
class PressureFace:
    """A face of given pressure.

    rows : (k,) numbers of its wall particles;  point : (x, y) m on it;  normal : (x, y) of unit length, into the
    water;  pressure : (k,) Pa, at the foot of each particle, settable at any time;  corners : (l,) numbers of the wall
    particles behind it that lie beyond its ends, in corners of the tank;  columns : (m, layers) numbers of those of
    ``rows`` behind each other;  whole, slope : (m,) 1/m and 1/m², push of each column on the water of the start
    (`push_of`), and how it grows as the column moves along the normal.
    """

    rows: NDArray[np.int64]
    point: tuple[float, float]
    normal: tuple[float, float]
    pressure: Floats
    corners: NDArray[np.int64] = field(default_factory=lambda: np.zeros(0, np.int64))
    columns: NDArray[np.int64] = field(init=False)
    whole: Floats = field(init=False)
    slope: Floats = field(init=False)

    def arrange(self, near: Neighbours, layer: Layer, matrix: Floats | None, spacing: float) -> None:
        """Take up columns and their push from a ``layer`` at its start, on the lattice;  matrix (fluid, 4): L, None
        with plain gradients;  spacing, m."""
        nx, ny = self.normal
        depth, along = np.array([(-nx, -ny), (ny, -nx)]) @ layer.x[self.rows].T / spacing
        order = np.lexsort((depth, np.rint(2.0 * along)))
        self.columns = self.rows[order].reshape(-1, len(np.unique(np.rint(2.0 * depth))))
        self.whole, ahead, back = np.zeros((3, len(self.columns)))
        for push, shift in ((self.whole, 0.0), (ahead, TRIAL * spacing), (back, -TRIAL * spacing)):
            push_of(self.columns, shift, near, layer.x, layer.record, matrix, nx, ny, push)
        self.slope = (ahead - back) / (2.0 * TRIAL * spacing)

    def passed(self, at: Floats, x: Floats, home: Floats) -> Floats:
        """How far the first particles behind the face have gone across it, (s, 2) m, beside places ``at`` (s, 2) m; 0
        beyond its ends.  x, home (n, 2) m: of all particles, and where they stood at the start."""
        first, axis = self.columns[:, 0], int(self.normal[0] != 0.0)  # along the face
        order = np.argsort(home[first, axis])
        first = first[order]
        way = np.zeros_like(at)
        gone = x[first, 1 - axis] - home[first, 1 - axis]
        way[:, 1 - axis] = np.interp(at[:, axis], home[first, axis], gone, left=0.0, right=0.0)
        return way

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
def continue_in_corners(corners, near, x, v, record, pressure, gx, gy):
    """Overwrites pressure of the wall particles ``corners`` (l,) in ``record`` and ``pressure`` (n,) Pa with that of
    the water before them continued, of either sign.

    near: see `water.bundles`;  x, v (n, 2) m, m/s;  (gx, gy): gravity, m/s².
    """
    for number in prange(corners.shape[0]):
        w = corners[number]
        if near.start[w] < near.split[w]:
            p, _, _ = wall_mean(w, near, x, v, record, pressure, gx, gy)
            record[w, P] = p
            pressure[w] = p


@inline
def column_push(columns, c, shift, near, x, record, matrix, nx, ny):
    """Σ_w Σ_j V_j L_j ∇W(x_j - x_w) · n of column ``c``, 1/m, moved by ``shift`` (m) along the normal.

    The rest: of `push_of`.
    """
    kind, h = near.kind, near.h
    push = 0.0
    for layer in range(columns.shape[1]):
        w = columns[c, layer]
        for k in range(np.uint64(near.start[w]), np.uint64(near.split[w])):
            j = np.uint64(near.partner[k])
            dx = image(x[j, 0] - x[w, 0] - shift * nx, near.period_x)
            dy = image(x[j, 1] - x[w, 1] - shift * ny, near.period_y)
            slope = kernel_slope(kind, np.sqrt(dx * dx + dy * dy) / h, h)
            dx, dy = corrected(matrix, j, dx, dy)
            push -= record[j, VOLUME] * slope * (dx * nx + dy * ny)
    return push


@parallel_kernel
def push_of(columns, shift, near, x, record, matrix, nx, ny, push):
    """Overwrites ``push`` (m,) 1/m, the impulse of each of the ``columns`` (m, layers) of wall particles, moved by
    ``shift`` (m) along the normal (nx, ny), on the water before it, over 2 p V_w.

    near: see `water.bundles`;  x (n, 2) m;  record: see `Layer`, volumes are read;  matrix (fluid, 4): L, or None.
    """
    for c in prange(columns.shape[0]):
        push[c] = column_push(columns, row(c), shift, near, x, record, matrix, nx, ny)


@parallel_kernel
def follow(columns, whole, slope, near, x, record, matrix, nx, ny):
    """Moves the ``columns`` (m, layers) of wall particles along the normal (nx, ny) to where they push as much as at
    the start, ``whole`` (m,) 1/m, by one step of Newton's method with its ``slope`` (m,) 1/m² there; overwrites their
    ``x`` (n, 2) m.  Those without water before them stay.

    The rest: of `push_of`.
    """
    for c in prange(columns.shape[0]):
        push = column_push(columns, row(c), 0.0, near, x, record, matrix, nx, ny)
        if push > 0.0:
            way = (whole[c] - push) / slope[c]
            for layer in range(columns.shape[1]):
                x[columns[c, layer], 0] += way * nx
                x[columns[c, layer], 1] += way * ny
