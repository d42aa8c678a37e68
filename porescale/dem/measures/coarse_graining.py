"""Fields of a granular medium on a grid: every disc and every contact spread by a smooth kernel.

Goldhirsch 2010 (Granular Matter 12, 239), points r, kernel phi with unit integral:
    density        rho   = sum_i m_i phi(r - x_i),             velocity  V = sum_i m_i v_i phi / rho,
    solid fraction nu    = sum_i pi r_i² phi,
    contact stress s_ab  = sum_c F_a l_b int_0^1 phi(r - x_i - s l) ds     (F of i on j, l from i to j; at walls to the
                           point of contact: Weinhart, Thornton, Luding & Bokhove 2012, Granular Matter 14, 289),
    kinetic stress k_ab  = sum_i m_i (v_i - V)_a (v_i - V)_b phi,
    wall force     t     = -sum over contacts with walls of F phi(r - point)    (N/m³, of the wall on the discs).
Compression is positive; in equilibrium div(s + k) = rho g + t.  phi is Lucy's (1977, Astron. J. 82, 1013), in two
dimensions 5/(pi c²) (1 + 3q)(1 - q)³ with q = r/c: zero beyond the width c, with two continuous derivatives.

With ``conserve`` each point's weights are scaled so that they sum to one over the cells of the grid: the sum of rho
over the grid is the mass, that of s the sum of F_a l_b, to round-off, and no mass is lost behind walls; within a width
of a wall it lies up to a width further in, and the balance of momentum does not hold there.  Without, kernels reach
beyond the grid: the balance holds everywhere, mass near the edges is partly outside.

In a strained cell (cell.py) velocities of discs are relative to its affine motion G x: V is then said with G x, the
gradient with G, and the kinetic stress without.  The grid stays where it is, whatever period of the cell it shows.

The strain rate is not the gradient of V, which shears where discs lie unevenly, but that of the affine motion that fits
the velocities best around each point (motion.py), with weights m phi: zero for a rigid rotation.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from porescale.common.compiled.jit import inline, kernel
from porescale.common.core.errors import Fault, InputError
from porescale.common.core.types import Floats
from porescale.dem.discs import Discs
from porescale.dem.measures.contact_list import Contacts
from porescale.dem.measures.region import Region
from porescale.dem.motion.periodic_cell import Straining, period_of

NODES, WEIGHTS = (np.asarray(part) for part in np.polynomial.legendre.leggauss(8))
"""Gauss points along a branch, on -1..1, and their weights."""
MASS, X, Y, XX, XY, YY, U, V, UX, UY, VX, VY, ENERGY_XX, ENERGY_XY, ENERGY_YY = range(15)
"""Columns of spread_motion: sums of m phi times the place o = (x_i - r)/c and its products, the velocity, the velocity
times the place, and the products of the velocity."""
FLAT = 1e-2
"""Discs around a point whose second moment has a smaller ratio of principal values, or a smaller sum in widths², lie in
a line or in one place: noise of their velocities would be all of the gradient there."""


@inline
def lucy(square, inverse_width):
    """Lucy's kernel over its value at zero, at a squared distance (m²); inverse_width 1/m."""
    q = np.sqrt(square) * inverse_width
    if q >= 1.0:
        return 0.0
    return (1.0 + 3.0 * q) * (1.0 - q) ** 3


@inline
def reached(at, width, lower, spacing):
    """First and last cell along an axis whose centre is within ``width`` of ``at``; they may lie beyond the grid."""
    return (
        int(np.ceil((at - width - lower) / spacing - 0.5)),
        int(np.floor((at + width - lower) / spacing - 0.5)),
    )


@inline
def scale_of(x, y, grid, columns, rows, wrap_x, wrap_y, width, conserve):
    """Factor of lucy (1/m²) for a point: its unit integral, or so that its sum over the grid is one if ``conserve``."""
    if not conserve:
        return 5.0 / (np.pi * width * width)
    first_i, last_i = reached(x, width, grid[0], grid[2])
    first_j, last_j = reached(y, width, grid[1], grid[3])
    inverse, total = 1.0 / width, 0.0
    for j in range(first_j, last_j + 1):
        if wrap_y or 0 <= j < rows:
            oy = grid[1] + (j + 0.5) * grid[3] - y
            for i in range(first_i, last_i + 1):
                if wrap_x or 0 <= i < columns:
                    ox = grid[0] + (i + 0.5) * grid[2] - x
                    total += lucy(ox * ox + oy * oy, inverse)
    return 1.0 / (total * grid[2] * grid[3]) if total > 0.0 else 0.0


@kernel
def spread(points, values, grid, wrap_x, wrap_y, width, conserve, fields):
    """Add ``values`` (n, k) at ``points`` (n, 2) m, times the kernel, to ``fields`` (rows, columns, k), per m².

    grid (4,): lower left corner and spacings, m;  wrap: whether the grid goes on at its other side;  width m;
    conserve: see module.
    """
    rows, columns, count = fields.shape
    inverse = 1.0 / width
    for n in range(points.shape[0]):
        x, y = points[n, 0], points[n, 1]
        scale = scale_of(x, y, grid, columns, rows, wrap_x, wrap_y, width, conserve)
        first_i, last_i = reached(x, width, grid[0], grid[2])
        first_j, last_j = reached(y, width, grid[1], grid[3])
        for j in range(first_j, last_j + 1):
            if wrap_y or 0 <= j < rows:
                oy = grid[1] + (j + 0.5) * grid[3] - y
                for i in range(first_i, last_i + 1):
                    if wrap_x or 0 <= i < columns:
                        ox = grid[0] + (i + 0.5) * grid[2] - x
                        w = scale * lucy(ox * ox + oy * oy, inverse)
                        for k in range(count):
                            fields[j % rows, i % columns, k] += w * values[n, k]


@kernel
def spread_motion(position, velocity, mass, grid, wrap_x, wrap_y, width, conserve, sums):
    """Add the columns MASS … ENERGY_YY of discs to ``sums`` (rows, columns, 15), per m².

    position, velocity (n, 2) m, m/s;  mass (n,) kg/m;  the rest as in spread.
    """
    rows, columns = sums.shape[0], sums.shape[1]
    inverse = 1.0 / width
    for n in range(mass.shape[0]):
        x, y, u, v = position[n, 0], position[n, 1], velocity[n, 0], velocity[n, 1]
        scale = mass[n] * scale_of(x, y, grid, columns, rows, wrap_x, wrap_y, width, conserve)
        first_i, last_i = reached(x, width, grid[0], grid[2])
        first_j, last_j = reached(y, width, grid[1], grid[3])
        for j in range(first_j, last_j + 1):
            if wrap_y or 0 <= j < rows:
                oy = (y - grid[1] - (j + 0.5) * grid[3]) * inverse
                for i in range(first_i, last_i + 1):
                    if wrap_x or 0 <= i < columns:
                        ox = (x - grid[0] - (i + 0.5) * grid[2]) * inverse
                        w = scale * lucy(ox * ox + oy * oy, 1.0)
                        here = sums[j % rows, i % columns]
                        here[MASS] += w
                        here[X] += w * ox
                        here[Y] += w * oy
                        here[XX] += w * ox * ox
                        here[XY] += w * ox * oy
                        here[YY] += w * oy * oy
                        here[U] += w * u
                        here[V] += w * v
                        here[UX] += w * u * ox
                        here[UY] += w * u * oy
                        here[VX] += w * v * ox
                        here[VY] += w * v * oy
                        here[ENERGY_XX] += w * u * u
                        here[ENERGY_XY] += w * u * v
                        here[ENERGY_YY] += w * v * v


@dataclass(frozen=True)
class Raster:
    """Cells on which fields are taken at their centres.

    lower : corner, m;  spacing : (dx, dy) m;  shape : (columns, rows);  periodic : per axis, the grid is then one
    period;  width : of the kernel, m, no less than the larger spacing.
    """

    lower: tuple[float, float]
    spacing: tuple[float, float]
    shape: tuple[int, int]
    width: float
    periodic: tuple[bool, bool] = (False, False)

    def __post_init__(self) -> None:
        if not (min(self.spacing) > 0.0 and min(self.shape) > 0):
            raise InputError(Fault("coarse_graining.spacing", str(self.spacing), "of the cells", "m", "> 0"))
        if not self.width >= max(self.spacing):
            problem = "is narrower than a cell: discs would fall between the points"
            raise InputError(Fault("coarse_graining.width", self.width, problem, "m", f">= {max(self.spacing):g}"))

    @classmethod
    def over(
        cls, lower: tuple[float, float], upper: tuple[float, float], spacing: float, width: float,
        periodic: tuple[bool, bool] = (False, False),
    ) -> "Raster":  # fmt: skip
        """Cells of about ``spacing`` (m) that fill the rectangle exactly."""
        size = upper[0] - lower[0], upper[1] - lower[1]
        shape = max(1, round(size[0] / spacing)), max(1, round(size[1] / spacing))
        return cls(lower, (size[0] / shape[0], size[1] / shape[1]), shape, width, periodic)

    @property
    def cell(self) -> float:
        """Area of a cell, m²."""
        return self.spacing[0] * self.spacing[1]

    @property
    def centres(self) -> tuple[Floats, Floats]:
        """x (columns,) and y (rows,) of the centres, m."""
        (x, y), (dx, dy), (columns, rows) = self.lower, self.spacing, self.shape
        return np.asarray(x + (np.arange(columns) + 0.5) * dx), np.asarray(y + (np.arange(rows) + 0.5) * dy)


class CoarseGrained:
    """Fields of discs and contacts on a raster, (rows, columns); each is computed when it is first requested.

    cell : the strained one that the discs are in, whose images are then shown on a raster that is not periodic, without
    ``conserve``: a raster need not be one period of it;  area : (n,) m^2 that each disc stands for (default: its own).
    """

    def __init__(
        self, raster: Raster, discs: Discs, contacts: Contacts, *, conserve: bool = True,
        cell: Straining | None = None, area: Floats | None = None,
    ) -> None:  # fmt: skip
        assert cell is None or not (conserve or any(raster.periodic))
        self.raster, self.discs, self.contacts, self.conserve = raster, discs, contacts, conserve
        self._grid = np.array([*raster.lower, *raster.spacing])
        self._how: tuple[bool, bool, float, bool] = (*raster.periodic, raster.width, conserve)
        self._cell, self._area = cell, discs.area if area is None else area
        gradient = [[cell.gxx, cell.gxy], [0.0, cell.gyy]] if cell else [[0.0, 0.0], [0.0, 0.0]]
        self._affine = np.array(gradient)

    def _images(self, points: Floats) -> tuple[Floats, NDArray[np.int64]]:
        """Points (m, 2) m whose kernels reach the raster, images too, and which of ``points`` (n, 2) m each is."""
        if self._cell is None:
            return points, np.arange(len(points))
        wide, (x, y), period = self.raster.width, self.raster.lower, period_of(self._cell)
        size = [number * step for number, step in zip(self.raster.shape, self.raster.spacing, strict=True)]
        seen = Region((x - wide, y - wide), (x + size[0] + wide, y + size[1] + wide))
        near = seen.near(points, period)
        found, which = [np.zeros((0, 2))], [np.zeros(0, np.int64)]
        for shift in seen.shifts(near, near, period):
            index = np.flatnonzero(seen.holds(near + shift))
            found.append(near[index] + shift)
            which.append(index)
        return np.concatenate(found), np.concatenate(which)

    def _spread(self, points: Floats, values: Floats) -> Floats:
        columns, rows = self.raster.shape
        fields = np.zeros((rows, columns, values.shape[1]))
        points, which = self._images(points)
        spread(np.ascontiguousarray(points), np.ascontiguousarray(values[which]), self._grid, *self._how, fields)
        return fields

    @cached_property
    def _motion(self) -> Floats:
        columns, rows = self.raster.shape
        sums, d = np.zeros((rows, columns, ENERGY_YY + 1)), self.discs
        position, which = self._images(d.position)
        spread_motion(position, d.velocity[which], d.mass[which], self._grid, *self._how, sums)
        return sums

    @property
    def density(self) -> Floats:
        """kg/m³ of the medium, pores included."""
        return np.asarray(self._motion[..., MASS])

    @cached_property
    def solid_fraction(self) -> Floats:
        """Area of discs over area, -."""
        return np.asarray(self._spread(self.discs.position, self._area[:, None])[..., 0])

    @cached_property
    def _own_velocity(self) -> Floats:
        """(rows, columns, 2) m/s, relative to the cell's; nan where there is no disc."""
        with np.errstate(invalid="ignore"):
            return np.asarray(self._motion[..., U : V + 1] / self.density[..., None])

    @cached_property
    def velocity(self) -> Floats:
        """(rows, columns, 2) m/s; nan where there is no disc."""
        if self._cell is None:
            return self._own_velocity
        x, y = np.meshgrid(*self.raster.centres)
        with np.errstate(invalid="ignore"):
            off = self.raster.width * self._motion[..., X : Y + 1] / self.density[..., None]
        return np.asarray(self._own_velocity + (np.stack((x, y), axis=-1) + off) @ self._affine.T)

    @cached_property
    def velocity_gradient(self) -> Floats:
        """d v_a / d x_b of the best affine motion, (rows, columns, 2, 2) 1/s; nan with fewer than three discs, or in a
        line."""
        s = self._motion
        with np.errstate(invalid="ignore", divide="ignore"):
            mean = s / s[..., MASS : MASS + 1]
            xx, yy = mean[..., XX] - mean[..., X] ** 2, mean[..., YY] - mean[..., Y] ** 2
            xy = mean[..., XY] - mean[..., X] * mean[..., Y]
            determinant = xx * yy - xy**2
            spread_out = (determinant > FLAT * (xx + yy) ** 2) & (xx + yy > FLAT)
            gradient = np.empty((*xx.shape, 2, 2))
            for a, (one, along, up) in enumerate(((U, UX, UY), (V, VX, VY))):
                cx = mean[..., along] - mean[..., one] * mean[..., X]
                cy = mean[..., up] - mean[..., one] * mean[..., Y]
                gradient[..., a, 0] = np.where(spread_out, (cx * yy - cy * xy) / determinant, np.nan)
                gradient[..., a, 1] = np.where(spread_out, (cy * xx - cx * xy) / determinant, np.nan)
        return np.asarray(gradient / self.raster.width + self._affine)

    @property
    def strain_rate(self) -> Floats:
        """Symmetric part of the gradient, (rows, columns, 2, 2) 1/s; extension positive."""
        gradient = self.velocity_gradient
        return np.asarray(0.5 * (gradient + gradient.swapaxes(-1, -2)))

    @cached_property
    def contact_stress(self) -> Floats:
        """(rows, columns, 2, 2) Pa, compression positive, first index that of the force."""
        c = self.contacts
        points = c.start[:, None, :] + 0.5 * (1.0 + NODES[None, :, None]) * c.branch[:, None, :]
        values = np.einsum("q,ca,cb->cqab", 0.5 * WEIGHTS, c.force, c.branch).reshape(-1, 4)
        return self._spread(points.reshape(-1, 2), values).reshape(*self.raster.shape[::-1], 2, 2)

    @cached_property
    def kinetic_stress(self) -> Floats:
        """(rows, columns, 2, 2) Pa of the velocities about their mean there, compression positive."""
        s, mean = self._motion, np.nan_to_num(self._own_velocity)
        stress = np.empty((*s.shape[:2], 2, 2))
        for a, b, column in ((0, 0, ENERGY_XX), (0, 1, ENERGY_XY), (1, 0, ENERGY_XY), (1, 1, ENERGY_YY)):
            stress[..., a, b] = s[..., column] - s[..., MASS] * mean[..., a] * mean[..., b]
        return stress

    @cached_property
    def wall_force(self) -> Floats:
        """(rows, columns, 2) N/m³ of walls, plates and rectangles on the discs."""
        walls = ~self.contacts.pairs
        return self._spread(self.contacts.point[walls], -self.contacts.force[walls])
