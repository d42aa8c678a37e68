"""Periodic cells as used for pairs: one that stands still, or one that is strained.

A strained cell has the edges (width, 0) and (tilt, height).  Velocities of discs are then those relative to the affine
motion G x of the cell, G = [[gxx, gxy], [0, gyy]] in 1/s, so that every image of a disc has the same velocity, and two
discs that are d apart pass each other with v_i - v_j - G d, across a boundary or not.
Sources: Lees & Edwards, J. Phys. C 5 (1972) 1921; Evans & Morriss, Statistical Mechanics of Nonequilibrium Liquids
(1990), section 6.3.

The loop is compiled once for each kind of cell: a cell that stands still costs what it cost before there were others.
"""

from typing import NamedTuple

import numpy as np

from porescale.common.compiled.jit import law_function
from porescale.common.core.types import Floats
from porescale.common.neighbors.cells import minimum_image, tilted_image

XX, XY, YX, YY, SQUARES, TURNING_XX, TURNING_XY, TURNING_YY = range(8)
"""Columns of ``load``: sums over contacts of g_x d_x, g_x d_y, g_y d_x, g_y d_y (J/m) and of d^2 (m^2); from there on
what the turning of clumps adds to the sums of m c c of discs (J/m)."""
LOAD = 8


class Still(NamedTuple):
    """A cell that stands still, or none: period m, 0 where a side is not periodic."""

    period_x: float
    period_y: float


class Straining(NamedTuple):
    """A strained cell at one moment: edges m, velocity gradient 1/s;  load (LOAD,): see ``note``."""

    period_x: float
    period_y: float
    tilt: float
    gxx: float
    gxy: float
    gyy: float
    load: Floats


def period_of(cell: Still | Straining) -> tuple[float, float, float]:
    """Width and height of ``cell``, 0 where not periodic, and how far right the image one height up lies, m."""
    return cell.period_x, cell.period_y, cell.tilt if isinstance(cell, Straining) else 0.0


def before(position: Floats, velocity: Floats, cell: Still | Straining, dt: float) -> tuple[Floats, Still | Straining]:
    """Where discs (n, 2) m with ``velocity`` relative to the cell were ``dt`` (s) ago, and the cell then: the step of
    strain.py backwards."""
    if not isinstance(cell, Straining):
        return position - dt * velocity, cell
    along, up = 1.0 + dt * cell.gxx, 1.0 + dt * cell.gyy
    y = (position[:, 1] - dt * velocity[:, 1]) / up
    x = (position[:, 0] - dt * (velocity[:, 0] + cell.gxy * y)) / along
    height = cell.period_y / up
    tilt = (cell.tilt - dt * cell.gxy * height) / along
    return np.column_stack((x, y)), cell._replace(period_x=cell.period_x / along, period_y=height, tilt=tilt)


@law_function
def image(dx, dy, cell):
    """Components (m) of the way between nearest images in ``cell``."""


@image.of(Still)
def image_still(dx, dy, cell):
    """Two minimum images; nothing is worked out in a cell that is not periodic at all."""
    if cell.period_x > 0.0 or cell.period_y > 0.0:
        return minimum_image(dx, cell.period_x), minimum_image(dy, cell.period_y)
    return dx, dy


@image.of(Straining)
def image_straining(dx, dy, cell):
    """Nearest image in a sheared cell: the image one height up lies ``tilt`` (m) to the right."""
    return tilted_image(dx, dy, cell.period_x, cell.period_y, cell.tilt)


@law_function
def affine_velocity(dx, dy, cell):
    """Velocity (m/s) of the affine motion at (dx, dy) m from where it is zero."""


@affine_velocity.of(Still)
def drift_still(dx, dy, cell):
    """Affine velocity in a cell that does not deform: zero."""
    return 0.0, 0.0


@affine_velocity.of(Straining)
def drift_straining(dx, dy, cell):
    """Affine velocity G (dx, dy), m/s, with the velocity gradient G of the cell (1/s)."""
    return cell.gxx * dx + cell.gxy * dy, cell.gyy * dy


@law_function
def add_load(gx, gy, dx, dy, cell):
    """Add a contact to the sums of a strained cell: (gx, gy) N/m on i, (dx, dy) m from i to j.  For one thread only."""


@add_load.of(Still)
def add_load_still(gx, gy, dx, dy, cell):
    """Does nothing: a cell that does not deform has no sums."""


@add_load.of(Straining)
def add_load_straining(gx, gy, dx, dy, cell):
    """Add to ``cell.load`` of one contact the products of force and branch (N) and the squared branch (m²)."""
    cell.load[XX] += gx * dx
    cell.load[XY] += gx * dy
    cell.load[YX] += gy * dx
    cell.load[YY] += gy * dy
    cell.load[SQUARES] += dx * dx + dy * dy
