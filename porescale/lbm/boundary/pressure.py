"""Links through sides with a given pressure: the fluid goes on outside as it is inside, but at the side's density.

What comes in along -c_i is what the boundary cell of the row where it starts sends that way, brought from its density
rho to 2 rho_w - rho, that of a mirror image half a cell outside:

    f_-i(t+1) = f*_-i + 2 w_i (rho_w - rho) (1 + 9/2 (c_i.u)² - 3/2 u²)

Equilibrium for the side's density, the rest extrapolated (Guo, Zheng & Shi 2002, Phys. Fluids 14, 2007), here half-way
between cells.  A parabola between two such sides is exact but for compressibility, and vortices leave through one.
Anti-bounce-back (Ginzburg, Verhaeghe & d'Humieres 2008) was measured beside it: without the viscous term that makes it
second order it lengthens a channel by a cell (5 % of the flow at 20 cells), and lets a vortex blow up at tau 0.5005.
"""

from typing import Any

import numpy as np
from numpy.typing import DTypeLike, NDArray

from porescale.common.compiled.jit import kernel
from porescale.common.core.types import Integers
from porescale.lbm.boundary.law import Boundary, Link
from porescale.lbm.boundary.sides import NAMES, Bounds
from porescale.lbm.collision.law import moments, numbers
from porescale.lbm.lattice import CX, CY, OPPOSITE, WEIGHTS, direction


class OpenLinks:
    """The links of all pressure sides; k of them.

    even, odd (k, 9): slots in which the cell that a link continues leaves its collided populations after an even and
    an odd step;  source (k,): which of the nine;  halo, inner (k,): slots that get it;  along (k, 2): c_i;
    weight (k,): 2 w_i;  excess (k,): rho_w - 1.
    """

    def __init__(self, bounds: Bounds, dtype: DTypeLike) -> None:
        links = [link for link in bounds.links() if bounds.owner(link) is BOUNDARY]
        self.bounds = bounds
        self._owners = [bounds.owners(link) for link in links]
        origins = [_origin(bounds, link) for link in links]
        self.source: Integers = np.array([slot for slot, _ in origins], np.int64)
        self.even = _table([[bounds.flat(int(OPPOSITE[i]), at) for i in range(9)] for _, at in origins])
        self.odd = _table(
            [[bounds.flat(i, (x + int(CX[i]), y + int(CY[i]))) for i in range(9)] for _, (x, y) in origins]
        )
        self.halo: Integers = np.array([bounds.flat(k.out, k.to) for k in links], np.int64)
        self.inner: Integers = np.array([bounds.flat(int(OPPOSITE[k.out]), (k.x, k.y)) for k in links], np.int64)
        self.along = np.stack([CX[self.source], CY[self.source]], 1).astype(dtype)
        self.weight = (2 * WEIGHTS[self.source]).astype(dtype)
        self.excess: NDArray[np.floating] = np.zeros(len(links), dtype)
        self.force: NDArray[np.floating] = np.zeros((2, len(links)), dtype)
        self._rows, self._columns = np.array([(y - 1, x - 1) for _, (x, y) in origins], np.int64).reshape(-1, 2).T
        self.density = {side: float(getattr(bounds.sides, f"{side}_density")) for side in NAMES}
        self.write()

    def set(self, side: str, density: float) -> None:
        """Give a side another density; ValueError unless it is a pressure side and the density positive."""
        if self.bounds.sides.boundary(side) is not BOUNDARY:
            raise ValueError(f"the {side} side is of kind {self.bounds.sides.kind(side)}, not pressure")
        if not density > 0:
            raise ValueError(f"density of the {side} side: {density} is not positive")
        self.density[side] = density
        self.write()

    def write(self) -> None:
        """Overwrite the density excess of every link: that of its side, or the mean of two."""
        for k, owners in enumerate(self._owners):
            self.excess[k] = sum(self.density[side] for side in owners) / len(owners) - 1

    def close(self, flat: NDArray[np.floating], parity: int, force: tuple[Any, Any]) -> None:
        """After a step of that parity, what comes in; ``force``: body force density, numbers or (ny, nx)."""
        slots, to = (self.odd, self.inner) if parity else (self.even, self.halo)
        for a, one in enumerate(force):
            self.force[a] = one if np.ndim(one) == 0 else one[self._rows, self._columns]
        let_in(flat, slots, to, self.source, self.along, self.weight, self.excess, self.force)

    def state(self) -> dict[str, Any]:
        """Prescribed densities of the pressure sides, by side; empty without such a side."""
        return {"density": dict(self.density)} if self.source.size else {}

    def restore(self, state: dict[str, Any]) -> None:
        """Overwrite the densities of the sides with those of ``state``."""
        if "density" in state:
            self.density |= {side: float(value) for side, value in state["density"].items()}
            self.write()


def _origin(bounds: Bounds, link: Link) -> tuple[int, tuple[int, int]]:
    """Direction and cell whose collided population a link continues: that of the boundary cell beside its halo cell.

    Beyond a periodic side that is the wrapped cell, beyond free slip the image of the link's own, and where two
    pressure sides join its own.
    """
    back = int(OPPOSITE[link.out])
    across = bounds.sides.boundary(link.across) if link.across else None
    along = bounds.sides.boundary(link.along) if link.along else None
    if across is along is BOUNDARY:
        return back, (link.x, link.y)
    if across is BOUNDARY:
        if along is not None and along.mirrors:
            return direction(CX[back], -CY[back]), (link.x, link.y)
        return back, (link.x, (link.to[1] - 1) % bounds.ny + 1)
    if across is not None and across.mirrors:
        return direction(-CX[back], CY[back]), (link.x, link.y)
    return back, ((link.to[0] - 1) % bounds.nx + 1, link.y)


def _table(rows: list[list[int]]) -> Integers:
    return np.array(rows, np.int64).reshape(-1, 9)


@kernel
def let_in(flat, slots, to, source, along, weight, excess, force):
    """flat[to] <- f*_i + 2 w_i (rho_w - rho)(1 + 9/2 (c_i.u)² - 3/2 u²), of shifted collided populations.

    u: before the collision, which added the force (2, k): half of it too much.
    """
    for k in range(to.shape[0]):
        s = slots[k]
        f = (flat[s[0]], flat[s[1]], flat[s[2]], flat[s[3]], flat[s[4]], flat[s[5]], flat[s[6]], flat[s[7]], flat[s[8]])
        d, jx, jy = moments(f)
        c = numbers(d)
        ux = (jx - c.half * force[0, k]) / (c.one + d)
        uy = (jy - c.half * force[1, k]) / (c.one + d)
        cu = along[k, 0] * ux + along[k, 1] * uy
        size = c.one + c.c45 * cu * cu - c.c15 * (ux * ux + uy * uy)
        flat[to[k]] = flat[s[source[k]]] + weight[k] * (excess[k] - d) * size


class PressureSide(Boundary):
    """A given density, with the velocity of the cells inside."""

    name = "pressure"
    purpose = "holds a pressure and lets the fluid in or out"
    order, precedence = 4, 2
    numbers = ("pressure",)
    passes = settles = True

    def own_links(self, bounds: Any, dtype: DTypeLike) -> OpenLinks:
        """All links of the pressure sides of the box."""
        return OpenLinks(bounds, dtype)


BOUNDARY = PressureSide()
