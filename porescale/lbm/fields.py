"""What a laboratory reads off a flow: vorticity, stream function, flux through a section, values at points, stress.

Lattice units.  Cell (row y, column x), from 0, has its centre at (x + 1/2, y + 1/2); the box spans 0 to nx, 0 to ny.
Fields are (ny, nx) as ``Fluid.fields`` gives them; corners of cells are (ny + 1, nx + 1).
"""

from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from porescale.common.core.types import Reals
from porescale.lbm.boundary.sides import Sides
from porescale.lbm.fluid import Fluid
from porescale.lbm.lattice import CX, CY, OPPOSITE


def face_velocities(fluid: Fluid, ux: Reals, uy: Reals) -> tuple[Reals, Reals]:
    """Velocity across the faces of cells: u (ny, nx + 1) at x = 0 … nx and v (ny + 1, nx) at y = 0 … ny.

    Means of the two cells; at a side what the side is: none through a wall or a line of symmetry, what was given at a
    velocity side, that of the cell inside at a pressure side.
    """
    sides, given = fluid.sides, fluid.links.velocity
    left, right = (_normal(sides, given, side, ux[:, end], ux[:, 0], ux[:, -1], 0) for side, end in _ENDS[:2])
    bottom, top = (_normal(sides, given, side, uy[end], uy[0], uy[-1], 1) for side, end in _ENDS[2:])
    inner_u, inner_v = 0.5 * (ux[:, 1:] + ux[:, :-1]), 0.5 * (uy[1:] + uy[:-1])
    return np.column_stack([left, inner_u, right]), np.vstack([bottom, inner_v, top])


_ENDS = (("left", 0), ("right", -1), ("bottom", 0), ("top", -1))


def _normal(sides: Sides, given: Any, side: str, inside: Reals, first: Reals, last: Reals, axis: int) -> Reals:
    kind = sides.boundary(side)
    if kind.prescribes_velocity:
        return np.asarray(given.of(side)[:, axis], float)
    if kind.passes:
        return inside
    return 0.5 * (first + last) if kind.periodic else np.zeros_like(inside)


def stream_function(fluid: Fluid, ux: Reals, uy: Reals) -> Reals:
    """psi at the corners of cells, (ny + 1, nx + 1): u = dpsi/dy, v = -dpsi/dx; zero in the lower left corner.

    Summed from fluxes through faces, along the bottom and then upwards.  Where as much flows into each cell as out of
    it any other way gives the same, and psi is constant along walls; elsewhere it misses the fluid that is stored on
    the way, of the order of the Mach number squared.
    """
    u, v = face_velocities(fluid, ux, uy)
    psi = np.zeros((u.shape[0] + 1, u.shape[1]))
    psi[0, 1:] = -np.cumsum(v[0])
    psi[1:] = psi[0] + np.cumsum(u, axis=0)
    return psi


def flux(psi: Reals, start: tuple[float, float], end: tuple[float, float]) -> float:
    """Area of fluid that passes a line from ``start`` to ``end`` in a step, from its left to its right side, of a
    stream function at corners: its difference, whatever the way between.  An upward line counts flow in +x."""
    low, high = at_points(psi, [start, end], corners=True)
    return float(high - low)


def vorticity(ux: Reals, uy: Reals) -> Reals:
    """dv/dx - du/dy at the inner corners of cells, (ny - 1, nx - 1): circulation around the corner's four cells.

    Differences of means over two cells: second order.
    """
    across = 0.5 * (uy[1:] + uy[:-1])
    up = 0.5 * (ux[:, 1:] + ux[:, :-1])
    return np.asarray(np.diff(across, axis=1) - np.diff(up, axis=0))


def at_points(field: Reals, points: ArrayLike, *, corners: bool = False) -> Reals:
    """Values (n,) of a field at points (n, 2), bilinear between the centres of cells (or their corners).

    Outside of the outermost centres: on along the same slope.  ValueError for points outside of the box.
    """
    at = np.asarray(points, float).reshape(-1, 2)
    rows, columns = field.shape
    size = np.array([columns, rows]) - (1.0 if corners else 0.0)
    if np.any((at < 0) | (at > size)):
        worst = at[np.any((at < 0) | (at > size), axis=1)][0]
        raise ValueError(
            f"point ({worst[0]:g}, {worst[1]:g}) is outside of the box of {size[0]:g} by {size[1]:g} cells"
        )
    place = at - (0.0 if corners else 0.5)
    (x, sx), (y, sy) = (_split(place[:, axis], count) for axis, count in ((0, columns), (1, rows)))
    x1, y1 = np.minimum(x + 1, columns - 1), np.minimum(y + 1, rows - 1)
    low = (1 - sx) * field[y, x] + sx * field[y, x1]
    high = (1 - sx) * field[y1, x] + sx * field[y1, x1]
    return np.asarray((1 - sy) * low + sy * high)


def _split(place: Reals, count: int) -> tuple[NDArray[np.int64], Reals]:
    low = np.clip(np.floor(place).astype(np.int64), 0, max(count - 2, 0))
    return low, place - low


def shear_stress(fluid: Fluid) -> tuple[Reals, Reals]:
    """Viscous shear stress in every cell, (xx - yy)/2 and xy, each (ny, nx): rho nu (du/dx - dv/dy) and
    rho nu (du/dy + dv/dx), an eddy viscosity's included.

    From the populations alone: -(1 - rate/2) times the non-equilibrium part of their second moments (Kruger et al.
    2009); second order like the velocity, up to the walls.
    """
    law = fluid.law
    with fluid.readable():
        h = [_slots(fluid, i).astype(float) for i in range(9)]
    fx, fy = (float(law.fx), float(law.fy)) if fluid.force_field is None else fluid.force_field.astype(float)
    basis = np.stack([np.ones(9), CX, CY, CX**2, CY**2, CX * CY])
    excess, jx, jy, xx, yy, xy = np.einsum("mi,iyx->myx", basis, np.stack(h))
    rho, jx, jy = 1 + excess, jx + 0.5 * fx, jy + 0.5 * fy
    ux, uy = jx / rho, jy / rho
    third = excess / 3
    xx, yy, xy = xx - third - jx * ux, yy - third - jy * uy, xy - jx * uy
    rate: Any = float(law.rate)
    if hasattr(law, "strain_factor"):
        size = np.sqrt(xx**2 + yy**2 + 2 * xy**2)
        rate = 2 * rate / (1 + np.sqrt(1 + rate**2 * float(law.strain_factor) * size / rho))
    share = 1 - 0.5 * rate
    return -share * 0.5 * (xx - yy + ux * fx - uy * fy), -share * (xy + 0.5 * (ux * fy + uy * fx))


def _slots(fluid: Fluid, i: int) -> Reals:
    """The populations h_i of every cell, (ny, nx), as they are before the next step."""
    if fluid.step % 2 == 0:
        return fluid.populations[i, 1:-1, 1:-1]
    x, y = 1 - int(CX[i]), 1 - int(CY[i])
    return fluid.populations[OPPOSITE[i], y : y + fluid.ny, x : x + fluid.nx]
