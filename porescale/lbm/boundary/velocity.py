"""Sides with a given velocity, which may change between steps: an inlet, an outlet, a wall that pushes.

Half-way bounce-back that adds 6 w_i c_i . u (Ladd 1994) at the density 1 of rest, so that the mass that passes is the
sum of the velocities, exactly, and two sides of equal velocity balance.

u is wanted where the link crosses the side: on a diagonal half a cell beside its own cell, so there it is the mean of
the two cells' that it joins.  With its own cell's alone two diagonals c = (1, 1) and (1, -1) that come in lack
-+ 1/2 du/dy of c . u, as if the side also slid along itself at 1/2 du/dy: first order, and beside a wall 3/n of the
mean of a parabola of n cells.  In a corner with a side that holds the fluid its own cell's is taken, without the part
that would pass that side: else mass would.

What a link brings back from a step's collision is late by k = 1/s - 1/2 steps, s the rate of the antisymmetric moments
that are not momentum (with central moments by tau - 1/2).  So half-way bounce-back alone holds, at the middle of a link
c that comes in,

    c.u = c.u_w - k N(c),    N(c) = 3 (c.u)(c.S.c) - 2 c.S.u,

S the strain rate: the gradient of the convective equilibrium along the link that no pressure balances (derived in
docs/theory/boundaries.md).  k |u| is 1/16 of the cell Reynolds number |u|/nu at a magic parameter of 3/16, so fluid
that enters as a parabola would be turned towards the middle by k d(u²)/dy.  Of N, what follows from the given velocity
is given back, per link: with u across the side, v along it, y along it, of links that come in along (1, 0), (1, +-1)

    N = -d(uv)/dy,    N = 2 d(uv)/dy +- d(u² - v²)/dy,

whose mass, 4 (-1) + 2 + 2 parts of the first and none of the second, is none over a side.  dv/dx, how v changes on the
way in, the side does not know: it takes it for none, as where a stream comes in along itself.
"""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from porescale.common.compiled.jit import kernel
from porescale.lbm.boundary.law import Boundary, Link
from porescale.lbm.boundary.sides import NAMES, Bounds
from porescale.lbm.lattice import CX, CY, OPPOSITE, WEIGHTS


class VelocityLinks:
    """Every share that a velocity side has in a link: two halves (``_joined``); a corner link of two such sides is half
    of each.

    velocity (2 ny + 2 nx, 2): of the cells along left, right, bottom, top, lattice units; of velocity sides only.
    """

    def __init__(self, bounds: Bounds, links: list[Link], delay: float) -> None:
        """links: those of which ``added`` is a list (links.py);  delay: k of the module's text, steps."""
        self.bounds = bounds
        starts = np.cumsum([0, *(bounds.length(side) for side in NAMES)])
        self._start = dict(zip(NAMES, starts[:-1].tolist(), strict=True))
        self.velocity = np.zeros((int(starts[-1]), 2))
        shares: list[tuple[int, int, float, float]] = []
        turns: list[tuple[int, int, int, float, float]] = []
        for k, link in enumerate(links):
            if not bounds.owner(link).prescribes_velocity:
                continue
            owners = bounds.owners(link)
            back = OPPOSITE[link.out]
            size = 3 * WEIGHTS[back] / len(owners)
            for side in owners:
                places, along = _joined(bounds, side, link)
                x, y = (1.0, along) if side in ("left", "right") else (along, 1.0)
                shares += [
                    (k, self._start[side] + at, float(size * CX[back] * x), float(size * CY[back] * y)) for at in places
                ]
                turns += [
                    (
                        k,
                        self._start[side] + own,
                        self._start[side] + other,
                        float(size * delay * a),
                        float(size * delay * b),
                    )
                    for own, other, a, b in _turned(bounds, side, link)
                ]
        self._link = np.array([share[0] for share in shares], np.int64)
        self._at = np.array([share[1] for share in shares], np.int64)
        self._along = np.array([share[2:] for share in shares], float).reshape(-1, 2)
        self._turn = np.array([turn[:3] for turn in turns], np.int64).reshape(-1, 3)
        self._turned = np.array([turn[3:] for turn in turns], float).reshape(-1, 2)
        for side in NAMES:
            if bounds.sides.boundary(side).prescribes_velocity:
                self.set(side, getattr(bounds.sides, f"{side}_velocity"))

    def __bool__(self) -> bool:
        return bool(self._link.size)

    def of(self, side: str) -> NDArray[np.float64]:
        """Velocity of the cells along a side, (n, 2), a view."""
        return self.velocity[self._start[side] : self._start[side] + self.bounds.length(side)]

    def set(self, side: str, velocity: Any) -> None:
        """Give a side another velocity, (2,) or (n, 2); ValueError unless it is a velocity side and the shape fits."""
        if not self.bounds.sides.boundary(side).prescribes_velocity:
            raise ValueError(f"the {side} side is of kind {self.bounds.sides.kind(side)}, not velocity")
        n = self.bounds.length(side)
        if np.shape(velocity) not in ((2,), (n, 2)):
            raise ValueError(f"velocity of the {side} side: shape {np.shape(velocity)}, not (2,) or ({n}, 2)")
        self.of(side)[:] = velocity

    def write(self, added: NDArray[np.floating]) -> None:
        """Overwrite in ``added`` what the links of velocity sides add to reflected populations; without such sides no
        kernel is compiled."""
        if self:
            _add(added, self._link, self._at, self._along, self.velocity)
            _turn(added, self._turn, self._turned, self.velocity)


def _joined(bounds: Bounds, side: str, link: Link) -> tuple[tuple[int, int], float]:
    """Numbers along a side, from 0, of the cell of a link and of that beside it where the link leads to, and the share
    of the velocity along the side.  In a corner of two sides: its own cell twice, and none beside a closed one."""
    across = side in ("left", "right")
    own, other = bounds.place(side, link), link.along if across else link.across
    kind = bounds.sides.boundary(other) if other else None
    if kind is not None and not kind.periodic:
        return (own, own), float(not kind.closed)
    return (own, bounds.beyond(link)[1 if across else 0] - 1), 1.0


def _turned(bounds: Bounds, side: str, link: Link) -> list[tuple[int, int, float, float]]:
    """The parts of -2 N of a link that comes in: two numbers along a side, from 0, and by how much the differences from
    the first cell to the second of ux² - uy² and of ux uy count."""
    upright = side in ("left", "right")
    back = OPPOSITE[link.out]
    normal, tangent = (int(CX[back]), int(CY[back])) if upright else (int(CY[back]), int(CX[back]))
    if tangent:
        (own, other), _ = _joined(bounds, side, link)
        return [(own, other, 2.0 if upright else -2.0, 4.0 * tangent * normal)] if own != other else []
    own, n = bounds.place(side, link), bounds.length(side)
    wraps = bounds.sides.boundary("bottom" if upright else "left").periodic
    beside = [(own + step, step) for step in (-1, 1) if wraps or 0 <= own + step < n]
    return [(own, other % n, 0.0, float(normal * step)) for other, step in beside]


@kernel
def _add(added, link, at, along, velocity):
    """added[link] <- sum over its shares of along . velocity[at];  along (k, 2): 6 w c times the share."""
    for k in range(link.shape[0]):
        added[link[k]] = 0
    for k in range(link.shape[0]):
        added[link[k]] += along[k, 0] * velocity[at[k], 0] + along[k, 1] * velocity[at[k], 1]


@kernel
def _turn(added, turn, size, velocity):
    """added[turn[., 0]] += size . (differences of ux² - uy² and ux uy from cell turn[., 1] to turn[., 2])."""
    for k in range(turn.shape[0]):
        a, b = turn[k, 1], turn[k, 2]
        ax, ay, bx, by = velocity[a, 0], velocity[a, 1], velocity[b, 0], velocity[b, 1]
        added[turn[k, 0]] += size[k, 0] * ((bx * bx - by * by) - (ax * ax - ay * ay)) + size[k, 1] * (bx * by - ax * ay)


class VelocitySide(Boundary):
    """Bounce-back at a given velocity, (ux, uy) or one for each cell: ``VelocityLinks`` overwrites what is added."""

    name = "velocity"
    purpose = "lets the fluid in or out with a given velocity"
    order, precedence = 3, 0
    numbers, required = ("velocity", "profile"), ("velocity",)
    passes = prescribes_velocity = True


BOUNDARY = VelocitySide()
