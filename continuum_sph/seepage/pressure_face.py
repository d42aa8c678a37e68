"""Faces through which water comes and goes: wall particles that hold the pressure there.

Behind a face z = 0 of pressure p0 the field goes on as a straight line through p0, exactly if it is one; and with the
mean flux q̄ of the water that a wall particle sees, so that flow passes (its gradient across vanishes where p is given
for ever).  Of a particle at depth d that has gone by w along the normal since the start, with kernel means p̄ of
pressure and z̄ of distance, and the slope s of the line through p0 that fits best what the first particle of its column
sees, Σ (p - p0) z W/Σ z² W:

    p1 = p0 + s w,   p = p1 - (p̄ - p1) (d + w)/(z̄ - w)

p1 is the pressure of the line where the edge of the water is now, and (d + w)/(z̄ - w) about 1 on the lattice: it
continues departures of the first rows from the line with the other sign, so that such swings neither gain nor lose.
With p0 - (p̄ - p0) d/z̄, as in earlier versions, they gained once water had passed outwards: after 0.11 spacings more
than diffusion took, and they grew (a layer of 40 rows that consolidates, 40 mm/s in place of 0.3); once it had passed
inwards they pushed: ground that a face lifts by half a spacing had up to 1.14 of its momentum (damping bounded).
With p0 - s d they fade, but flow between faces 8 m deep is 2.3 % low.  Adami, Hu & Adams, J. Comput. Phys. 231 (2012)
7057, have the means, for walls that nothing passes.

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

    columns : (m, layers) numbers of its wall particles, those behind each other in a row (`in_columns`);  point :
    (x, y) m on it;  normal : (x, y) of unit length, into the water;  pressure : (m, layers) Pa, at the foot of each
    particle, settable at any time;  whole, slope : (m,) 1/m and 1/m², push of each column on the water of the start
    (`push_of`), and how it grows as the column moves along the normal.
    """

    columns: NDArray[np.int64]
    point: tuple[float, float]
    normal: tuple[float, float]
    pressure: Floats
    whole: Floats = field(init=False)
    slope: Floats = field(init=False)

    def arrange(self, near: Neighbours, layer: Layer, matrix: Floats | None, spacing: float) -> None:
        """Take up the push of the columns from a ``layer`` at its start, on the lattice;  matrix (fluid, 4): L, None
        with plain gradients;  spacing, m."""
        nx, ny = self.normal
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

    def hydrostatic(self, x: Floats, level: float, weight: float) -> None:
        """Set the pressure of water that stands to ``level`` (m) over it; none above.

        x (n, 2) m: of all particles;  weight ρ g, N/m³.
        """
        at = x[self.columns]
        depth = (at - np.array(self.point)) @ np.array(self.normal)
        foot = at[:, :, 1] - depth * self.normal[1]
        self.pressure[:] = weight * np.maximum(0.0, level - foot)


def in_columns(rows: NDArray[np.int64], x: Floats, normal: tuple[float, float]) -> NDArray[np.int64]:
    """The wall particles ``rows`` (k,) behind a side of a lattice ``x`` (n, 2) m, as (m, layers): the first of each
    column beside the side, the others behind it.  normal : of unit length, into the water."""
    nx, ny = normal
    depth, along = np.array([(-nx, -ny), (ny, -nx)]) @ x[rows].T
    depth -= depth.min()
    spacing = depth[depth > 1e-9 * np.ptp(x)].min(initial=np.ptp(x))
    layer = np.rint(depth / spacing)
    return rows[np.lexsort((layer, np.rint(2.0 * along / spacing)))].reshape(-1, int(layer.max()) + 1)


@inline
def seen_behind(w, depth, p0, near, x, record, nx, ny):
    """Sums over the water that wall particle ``w`` sees at a ``depth`` (m) behind a face: Σ W, Σ z W, Σ z² W,
    Σ (p - p0) W, Σ (p - p0) z W, and of velocity Σ u W, Σ v W.  The rest: of `prescribe_pressure`."""
    kind, h = near.kind, near.h
    weight, height, square, rise, moment, ux, uy = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
    for k in range(np.uint64(near.start[w]), np.uint64(near.split[w])):
        j = np.uint64(near.partner[k])
        dx = image(x[w, 0] - record[j, X], near.period_x)
        dy = image(x[w, 1] - record[j, Y], near.period_y)
        value = kernel_value(kind, np.sqrt(dx * dx + dy * dy) / h, h)
        z = -(dx * nx + dy * ny) - depth
        above = record[j, P] - p0
        weight += value
        height += z * value
        square += z * z * value
        rise += above * value
        moment += above * z * value
        ux += record[j, VX] * value
        uy += record[j, VY] * value
    return weight, height, square, rise, moment, ux, uy


@parallel_kernel
def prescribe_pressure(columns, given, home, near, x, record, pressure, ox, oy, nx, ny):
    """Overwrites pressure and velocity of the ``columns`` (m, layers) of wall particles in ``record`` and ``pressure``
    (n,) Pa.

    given (m, layers) Pa;  home (n, 2) m: places at the start;  near: see `water.bundles`;  x (n, 2) m;  (ox, oy),
    (nx, ny): a point of the face and its normal into the water.
    """
    h = near.h
    for number in prange(columns.shape[0]):
        c = row(number)
        slope = 0.0
        for layer in range(columns.shape[1]):
            w = columns[c, layer]
            depth = (ox - x[w, 0]) * nx + (oy - x[w, 1]) * ny
            behind = given[c, layer]
            weight, height, square, rise, moment, ux, uy = seen_behind(w, depth, behind, near, x, record, nx, ny)
            if weight > 0.0:
                if layer == 0:
                    slope = moment / max(square, 0.0625 * h * h * weight)
                height /= weight
                way = (x[w, 0] - home[w, 0]) * nx + (x[w, 1] - home[w, 1]) * ny
                rise = rise / weight - slope * way
                behind += slope * way - rise * (depth + way) / max(height - way, 0.25 * h)
                record[w, VX] = ux / weight
                record[w, VY] = uy / weight
            record[w, P] = behind
            pressure[w] = behind


@parallel_kernel
def flux_before(rows, near, x, record, nx, ny, flux):
    """Overwrites ``flux`` (l,) m/s with the mean flux along (nx, ny) of the water before the wall particles ``rows``
    (l,), 0 where there is none.

    The rest: of `prescribe_pressure`.
    """
    for number in prange(rows.shape[0]):
        weight, _, _, _, _, ux, uy = seen_behind(row(rows[number]), 0.0, 0.0, near, x, record, nx, ny)
        flux[number] = (ux * nx + uy * ny) / weight if weight > 0.0 else 0.0


@parallel_kernel
def continue_behind(rows, near, x, v, record, pressure, gx, gy):
    """Overwrites pressure of the wall particles ``rows`` (l,) in ``record`` and ``pressure`` (n,) Pa with that of the
    water before them continued, of either sign.

    near: see `water.bundles`;  x, v (n, 2) m, m/s;  (gx, gy): gravity, m/s².
    """
    for number in prange(rows.shape[0]):
        w = rows[number]
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
