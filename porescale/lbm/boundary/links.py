"""What happens around the rim of the box at each step: all links that leave it."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import DTypeLike, NDArray

from porescale.lbm.boundary.pressure import OpenLinks
from porescale.lbm.boundary.sides import Bounds, Sides, empty_halo, fill_halo
from porescale.lbm.boundary.velocity import VelocityLinks


class Rim:
    """The links out of a box of nx by ny cells (cells 1 to n, halo 0 and n + 1).

    halo, inner (k,): flat slots of each link but those of pressure sides;  added (k,): what it adds on the way in.
    What comes in through the rim is settled at the end of each step, so a side that is changed between two steps acts
    from the next one on.
    """

    def __init__(self, nx: int, ny: int, sides: Sides, dtype: DTypeLike) -> None:
        bounds = Bounds(nx, ny, sides)
        links = [link for link in bounds.links() if bounds.owner(link) != "pressure"]
        partners = [bounds.partner(link) for link in links]
        self.halo: NDArray[np.int64] = np.array([bounds.flat(link.out, link.to) for link in links], np.int64)
        self.inner: NDArray[np.int64] = np.array([slot for slot, _ in partners], np.int64)
        self.added: NDArray[np.floating] = np.array([added for _, added in partners], dtype)
        self.velocity = VelocityLinks(bounds, links)
        self.velocity.write(self.added)
        self.open = OpenLinks(bounds, dtype)

    def close(self, flat: NDArray[np.floating], parity: int, force: tuple[np.floating, np.floating]) -> None:
        """After the sweep of a step.  Overwrites the halo after an even step, inner slots after an odd one."""
        (empty_halo if parity else fill_halo)(flat, self.halo, self.inner, self.added)
        self.open.let_in(flat, parity, force)

    def set_velocity(self, side: str, velocity: Any) -> None:
        """See Fluid.set_side_velocity."""
        self.velocity.set(side, velocity)
        self.velocity.write(self.added)

    def state(self) -> dict[str, Any]:
        """What can change: velocities and densities of sides that have them."""
        found: dict[str, Any] = {}
        if self.velocity:
            found["velocity"] = self.velocity.velocity
        if self.open.source.size:
            found["density"] = dict(self.open.density)
        return found

    def restore(self, state: dict[str, Any]) -> None:
        """Take up a state."""
        if "velocity" in state:
            self.velocity.velocity[...] = state["velocity"]
            self.velocity.write(self.added)
        if "density" in state:
            self.open.density |= {side: float(value) for side, value in state["density"].items()}
            self.open.write()
