"""The stream function of a flow, from its velocities across the faces of cells.

Lattice units.  Cell (row y, column x), from 0, has its centre at (x + 1/2, y + 1/2); the box spans 0 to nx, 0 to ny.
Fields are (ny, nx) as ``Fluid.fields`` gives them; corners of cells are (ny + 1, nx + 1).
"""

from typing import Any

import numpy as np

from porescale.common.core.types import Reals
from porescale.lbm.boundary.sides import Sides
from porescale.lbm.fluid import Fluid


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
