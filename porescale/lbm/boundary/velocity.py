"""Sides with a given velocity, which may change between steps: an inlet, an outlet, a wall that pushes.

Half-way bounce-back that adds 6 w_i c_i . u (Ladd 1994) at the density 1 of rest, so that the mass that passes is the
sum of the velocities, exactly, and two sides of equal velocity balance.
"""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from porescale.common.compiled.jit import kernel
from porescale.lbm.boundary.law import Boundary, Link
from porescale.lbm.boundary.sides import NAMES, Bounds
from porescale.lbm.lattice import CX, CY, OPPOSITE, WEIGHTS


class VelocityLinks:
    """Every share that a velocity side has in a link (a corner link of two such sides is half of each).

    velocity (2 ny + 2 nx, 2): of the cells along left, right, bottom, top, lattice units; of velocity sides only.
    """

    def __init__(self, bounds: Bounds, links: list[Link]) -> None:
        """links: those of which ``added`` is a list (links.py)."""
        self.bounds = bounds
        starts = np.cumsum([0, *(bounds.length(side) for side in NAMES)])
        self._start = dict(zip(NAMES, starts[:-1].tolist(), strict=True))
        self.velocity = np.zeros((int(starts[-1]), 2))
        shares: list[tuple[int, int, float, float]] = []
        for k, link in enumerate(links):
            if not bounds.owner(link).prescribes_velocity:
                continue
            owners = bounds.owners(link)
            back = OPPOSITE[link.out]
            size = 6 * WEIGHTS[back] / len(owners)
            for side in owners:
                at = self._start[side] + bounds.place(side, link)
                shares.append((k, at, float(size * CX[back]), float(size * CY[back])))
        self._link = np.array([share[0] for share in shares], np.int64)
        self._at = np.array([share[1] for share in shares], np.int64)
        self._along = np.array([share[2:] for share in shares], float).reshape(-1, 2)
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
        """Overwrite in ``added`` what the links of velocity sides add to reflected populations."""
        _add(added, self._link, self._at, self._along, self.velocity)


@kernel
def _add(added, link, at, along, velocity):
    """added[link] <- sum over its shares of along . velocity[at];  along (k, 2): 6 w c times the share."""
    for k in range(link.shape[0]):
        added[link[k]] = 0
    for k in range(link.shape[0]):
        added[link[k]] += along[k, 0] * velocity[at[k], 0] + along[k, 1] * velocity[at[k], 1]


class VelocitySide(Boundary):
    """Bounce-back at a given velocity, (ux, uy) or one for each cell: ``VelocityLinks`` overwrites what is added."""

    name = "velocity"
    purpose = "lets the fluid in or out with a given velocity"
    order, precedence = 3, 0
    numbers, required = ("velocity", "profile"), ("velocity",)
    passes = prescribes_velocity = True


BOUNDARY = VelocitySide()
