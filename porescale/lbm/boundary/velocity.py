"""Links through sides with a given velocity: what each adds, changeable between steps."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from porescale.common.compiled.jit import kernel
from porescale.lbm.boundary.sides import NAMES, Bounds, Link
from porescale.lbm.lattice import CX, CY, OPPOSITE, WEIGHTS


class VelocityLinks:
    """Every share that a velocity side has in a link of the rim (a corner link of two such sides is half of each).

    velocity (2 ny + 2 nx, 2): of the cells along left, right, bottom, top, lattice units; of velocity sides only.
    """

    def __init__(self, bounds: Bounds, links: list[Link]) -> None:
        """links: those of which ``added`` is a list (rim.py)."""
        self.bounds = bounds
        starts = np.cumsum([0, *(bounds.length(side) for side in NAMES)])
        self._start = dict(zip(NAMES, starts[:-1].tolist(), strict=True))
        self.velocity = np.zeros((int(starts[-1]), 2))
        shares: list[tuple[int, int, float, float]] = []
        for k, link in enumerate(links):
            if bounds.owner(link) != "velocity":
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
            if bounds.sides.kind(side) == "velocity":
                self.set(side, getattr(bounds.sides, f"{side}_velocity"))

    def __bool__(self) -> bool:
        return bool(self._link.size)

    def of(self, side: str) -> NDArray[np.float64]:
        """Velocity of the cells along a side, (n, 2), a view."""
        return self.velocity[self._start[side] : self._start[side] + self.bounds.length(side)]

    def set(self, side: str, velocity: Any) -> None:
        """Give a side another velocity, (2,) or (n, 2); ValueError unless it is a velocity side and the shape fits."""
        if self.bounds.sides.kind(side) != "velocity":
            raise ValueError(f"the {side} side is of kind {self.bounds.sides.kind(side)}, not velocity")
        n = self.bounds.length(side)
        if np.shape(velocity) not in ((2,), (n, 2)):
            raise ValueError(f"velocity of the {side} side: shape {np.shape(velocity)}, not (2,) or ({n}, 2)")
        self.of(side)[:] = velocity

    def write(self, added: NDArray[np.floating]) -> None:
        """Overwrite what these links add."""
        _add(added, self._link, self._at, self._along, self.velocity)


@kernel
def _add(added, link, at, along, velocity):
    """added[link] <- sum over its shares of along . velocity[at];  along (k, 2): 6 w c times the share."""
    for k in range(link.shape[0]):
        added[link[k]] = 0
    for k in range(link.shape[0]):
        added[link[k]] += along[k, 0] * velocity[at[k], 0] + along[k, 1] * velocity[at[k], 1]
