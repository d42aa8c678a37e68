"""Bodies that reach through a side of the box: there the side moves with them.

A full cell is rigid, and so is a side: what fills a body would be pinned where it touches a side at rest, and a gate on
its way out would carry it into the lid and compress it (densities of 8 to 13, then no numbers at all).  So a link
through the side, where bodies cover it by e, comes back from a side that moves with e v (Ladd 1994):

    f_back = f_out + (1 - e) a + 6 w c . sum e_n v_n,       a: what the motion of the side itself adds

For motion across the side e is the cell's.  For motion along it, it is the larger one of the cell's and of that of the
cell beside it towards which the link leans: both links that cross the side at a place then agree, so that a side that
slides carries mass (v/6 a step) from cell to cell, and the last of them is one that the fluid ahead can push on.
Measured, a piston in a channel of 20 cells: it pushes out 0.998 of what it displaces, and 0.98 with the cell's own
fraction or the mean of both, which take in too little or leave water behind in the corners.

What fills the body has the pressure that it had when it was fluid, and a little too dense is a little too slow where
sides carry it at density 1, and grows denser still.  So the density of cells deep inside is led back to 1
(``relax_density``), at rest and in equilibrium, which does not change the fluid outside; this counts as mass that came
in too.  Sides that move at the density of what fills the body instead were unstable.

A link that a free-slip side mirrors joins two cells: it leaves one and comes back to the other, in even steps the one
way and in odd steps the other (lbm/stream.py).  So e is the mean of both; that of one of them gives the even steps
another side than the odd ones, and velocities along the side alternate from cell to cell and step to step.

A gap below a cell is unresolved: by the cell's fraction the side moves with the body before they touch, and lets in, in
part, what a body needs that lifts off it.  Through a free-slip side only the part of v across
it counts.

What fills a body passes the side with it: mass is not conserved, and what comes in is counted.  Momentum passes as
well: the part of a body's load that sides bear,

    sum e_n ((f_out + f_back) c - v_n (f_back - f_out)),

is taken out of it, or it would depend on how a body that touches a side shares its load with it.  (The second term is
that of a moving wall: Wen, Zhang, Tu, Wang & Fang 2014.)  Pressures count from that of density 1.
"""

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from porescale.common.compiled.jit import inline, kernel
from porescale.lbm.boundary.sides import Bounds
from porescale.lbm.fluid import Fluid
from porescale.lbm.lattice import CX, CY, OPPOSITE, WEIGHTS


class SideLinks(NamedTuple):
    """Links out of the box through walls and free-slip sides.

    link (k,): number among those of the box (lbm/boundary/links.py);  cell, beside (k, 2): the cells (x, y), from 0,
    whose fractions count;  share (k,): of the second one's in the mean;  at (k, 2): where it crosses, from the first
    one's centre;  across, along (k, 2): c of the way back, its parts across and along the side, none along a free-slip
    side;  size (k,): 6 w;  own (k,): what the side itself adds;  halo, inner (k,): flat slots of what comes back and
    went out.
    """

    link: NDArray[np.int64]
    cell: NDArray[np.int64]
    beside: NDArray[np.int64]
    share: NDArray[np.float64]
    at: NDArray[np.float64]
    across: NDArray[np.float64]
    along: NDArray[np.float64]
    size: NDArray[np.float64]
    own: NDArray[np.float64]
    halo: NDArray[np.int64]
    inner: NDArray[np.int64]


def side_links(fluid: Fluid) -> SideLinks:
    """Links through the closed sides of a fluid's box."""
    bounds = Bounds(fluid.nx, fluid.ny, fluid.sides)
    number, cell, beside, share, at, across, along, size = [], [], [], [], [], [], [], []
    for k, link in enumerate(bounds.partners()):
        kind, owners = bounds.owner(link), bounds.owners(link)
        if not kind.closed:
            continue
        mirrored = kind.mirrors and len(owners) == 1
        cx, cy = float(CX[link.out]), float(CY[link.out])
        number.append(k)
        cell.append((link.x - 1, link.y - 1))
        ahead = (0 if link.across else int(cx)), (0 if link.along else int(cy))
        beside.append(((link.x - 1 + ahead[0]) % fluid.nx, (link.y - 1 + ahead[1]) % fluid.ny))
        share.append(0.5 if mirrored else 0.0)
        at.append((0.5 * cx, 0.5 * cy))
        across.append((-cx if link.across else 0.0, -cy if link.along else 0.0))
        along.append((0.0 if link.across or mirrored else -cx, 0.0 if link.along or mirrored else -cy))
        size.append(6 * WEIGHTS[OPPOSITE[link.out]])

    def pairs(values: list[Any], dtype: Any) -> NDArray[Any]:
        """Values in twos: (k, 2)."""
        return np.array(values, dtype).reshape(-1, 2)

    which = np.array(number, np.int64)
    rim = fluid.links
    return SideLinks(
        which, pairs(cell, np.int64), pairs(beside, np.int64), np.array(share, float), pairs(at, float),
        pairs(across, float), pairs(along, float), np.array(size, float), rim.added[which].astype(float),
        rim.halo[which], rim.inner[which],
    )  # fmt: skip


@inline
def fraction_of(n, x, y, grid, patches):
    """Solid fraction that body n has of cell (x, y): the sum over its images through periodic sides.

    grid: (nx, ny, whether x is periodic, whether y is).
    """
    nx, ny, periodic_x, periodic_y = grid
    found = 0.0
    j = y - patches.corner[n, 1]
    if periodic_y:
        j %= ny
    while 0 <= j < patches.height[n]:
        i = x - patches.corner[n, 0]
        if periodic_x:
            i %= nx
        while 0 <= i < patches.stride[n]:
            found += patches.fraction[patches.start[n] + j * patches.stride[n] + i]
            if not periodic_x:
                break
            i += nx
        if not periodic_y:
            break
        j += ny
    return found


@kernel
def move_sides(first, grid, patches, centre, velocity, spin, links, added, touching):
    """Let the sides move with the bodies from ``first`` on that reach through them; returns the mass that comes in.

    grid: see ``fraction_of``;  centre, velocity (n, 2), spin (n,): of all bodies, lattice units.  Overwrites added, of
    the box's links, and touching (bodies from ``first`` on,): whether they reach a side.
    """
    touching[:] = False
    mass = 0.0
    for k in range(links.link.shape[0]):
        x, y = links.cell[k, 0], links.cell[k, 1]
        covered = 0.0
        covered_along = 0.0
        pull = 0.0
        for n in range(first, patches.height.shape[0]):
            own = fraction_of(n, x, y, grid, patches)
            other = fraction_of(n, links.beside[k, 0], links.beside[k, 1], grid, patches)
            if own + other > 0.0:
                touching[n - first] = True
                e = min(own + links.share[k] * (other - own), 1.0 - covered)
                e_along = min(max(own, other), 1.0 - covered_along)
                vx = velocity[n, 0] - spin[n] * (y + 0.5 + links.at[k, 1] - centre[n, 1])
                vy = velocity[n, 1] + spin[n] * (x + 0.5 + links.at[k, 0] - centre[n, 0])
                pull += e * (vx * links.across[k, 0] + vy * links.across[k, 1])
                pull += e_along * (vx * links.along[k, 0] + vy * links.along[k, 1])
                covered += e
                covered_along += e_along
        added[links.link[k]] = links.own[k]
        if covered_along > 0.0:
            added[links.link[k]] = (1.0 - covered_along) * links.own[k] + links.size[k] * pull
        mass += added[links.link[k]] - links.own[k]
    return mass


@kernel
def side_loads(first, grid, patches, centre, velocity, spin, links, added, flat, borne):
    """What the sides gave, in the step just done, to what fills the bodies from ``first`` on that reach through them.

    flat: populations.  Overwrites borne (bodies from ``first`` on, 3): force along x and y, torque about the centre.
    """
    borne[:] = 0.0
    for k in range(links.link.shape[0]):
        x, y = links.cell[k, 0], links.cell[k, 1]
        covered = 0.0
        for n in range(first, patches.height.shape[0]):
            e = fraction_of(n, x, y, grid, patches)
            if links.share[k] > 0.0:
                other = fraction_of(n, links.beside[k, 0], links.beside[k, 1], grid, patches)
                e += links.share[k] * (other - e)
            if e > 0.0:
                e = min(e, 1.0 - covered)
                covered += e
                rx = x + 0.5 + links.at[k, 0] - centre[n, 0]
                ry = y + 0.5 + links.at[k, 1] - centre[n, 1]
                both = flat[links.halo[k]] + flat[links.inner[k]]
                gain = added[links.link[k]]
                fx = e * (both * (links.across[k, 0] + links.along[k, 0]) - gain * (velocity[n, 0] - spin[n] * ry))
                fy = e * (both * (links.across[k, 1] + links.along[k, 1]) - gain * (velocity[n, 1] + spin[n] * rx))
                borne[n - first, 0] += fx
                borne[n - first, 1] += fy
                borne[n - first, 2] += rx * fy - ry * fx


@kernel
def relax_density(n, share, weights, joined_x, joined_y, patches, f):
    """Lead the density of cells deep inside body n back to 1 by ``share`` of what is missing; returns the mass added.

    Deep: covered fully, and all cells around it too, or beyond a side.  Overwrites populations f (9, ny + 2, nx + 2),
    which must be those before an even step.
    """
    ny, nx = f.shape[1] - 2, f.shape[2] - 2
    height, stride = patches.height[n], patches.stride[n]
    start = patches.start[n]
    mass = 0.0
    for j in range(height):
        y = patches.corner[n, 1] + j
        if not joined_y and (y < 0 or y >= ny):
            continue
        for i in range(stride):
            x = patches.corner[n, 0] + i
            if patches.fraction[start + j * stride + i] < 1.0 or (not joined_x and (x < 0 or x >= nx)):
                continue
            deep = True
            for b in range(j - 1, j + 2):
                for a in range(i - 1, i + 2):
                    beyond = not joined_y and not 0 <= patches.corner[n, 1] + b < ny
                    beyond = beyond or (not joined_x and not 0 <= patches.corner[n, 0] + a < nx)
                    if not beyond:
                        within = 0 <= b < height and 0 <= a < stride
                        deep = deep and within and patches.fraction[start + b * stride + a] >= 1.0
            if deep:
                missing = 0.0
                for q in range(9):
                    missing -= f[q, y % ny + 1, x % nx + 1]
                for q in range(9):
                    f[q, y % ny + 1, x % nx + 1] += weights[q] * share * missing
                mass += share * missing
    return mass
