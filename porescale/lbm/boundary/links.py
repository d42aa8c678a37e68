"""All links that leave the box, and what happens to them at the end of each step."""

from typing import Any

import numpy as np
from numpy.typing import DTypeLike, NDArray

from porescale.common.compiled.jit import inline, parallel_kernel, prange
from porescale.lbm.boundary.law import OwnLinks
from porescale.lbm.boundary.pressure import OpenLinks
from porescale.lbm.boundary.sides import NAMES, Bounds, Sides
from porescale.lbm.boundary.velocity import VelocityLinks


class BoundaryLinks:
    """The links out of a box of nx by ny cells (cells 1 to n, halo 0 and n + 1);  delay: see velocity.py.

    halo, inner (k,): flat slots of each link but those that a kind of side settles itself;  added (k,): what it adds on
    the way in;  own: those of kinds that settle them, by name.
    What comes in is settled at the end of each step, so a side that is changed between two steps acts from the next one
    on.
    """

    def __init__(self, nx: int, ny: int, sides: Sides, dtype: DTypeLike, delay: float) -> None:
        bounds = Bounds(nx, ny, sides)
        links = bounds.partners()
        partners = [bounds.owner(link).partner(bounds, link) for link in links]
        self.bounds = bounds
        self.halo: NDArray[np.int64] = np.array([bounds.flat(link.out, link.to) for link in links], np.int64)
        self.inner: NDArray[np.int64] = np.array([slot for slot, _ in partners], np.int64)
        self.added: NDArray[np.floating] = np.array([added for _, added in partners], dtype)
        self.velocity = VelocityLinks(bounds, links, delay)
        self.velocity.write(self.added)
        kinds = {sides.kind(side): sides.boundary(side) for side in NAMES}
        settled = {name: kind.own_links(bounds, dtype) for name, kind in kinds.items() if kind.settles}
        self.own: dict[str, OwnLinks] = {name: own for name, own in settled.items() if own is not None}

    def close(self, flat: NDArray[np.floating], parity: int, force: tuple[Any, Any]) -> None:
        """After the sweep of a step.  Overwrites the halo after an even step, inner slots after an odd one."""
        of, to = (self.halo, self.inner) if parity else (self.inner, self.halo)
        pass_on(flat, of, to, self.added)
        for own in self.own.values():
            own.close(flat, parity, force)

    def set_velocity(self, side: str, velocity: Any) -> None:
        """Prescribe the velocity of a side, lattice units; see Fluid.set_side_velocity."""
        self.velocity.set(side, velocity)
        self.velocity.write(self.added)

    def set_density(self, side: str, density: float) -> None:
        """Prescribe the density of a pressure side, lattice units; see Fluid.set_side_density."""
        kind = self.bounds.sides.kind(side)
        own = self.own.get(kind)
        if not isinstance(own, OpenLinks):
            raise ValueError(f"the {side} side is of kind {kind}, not pressure")
        own.set(side, density)

    def state(self) -> dict[str, Any]:
        """What can change: velocities and densities of sides that have them."""
        found: dict[str, Any] = {}
        if self.velocity:
            found["velocity"] = self.velocity.velocity
        for own in self.own.values():
            found |= own.state()
        return found

    def restore(self, state: dict[str, Any]) -> None:
        """Overwrite velocities and densities of the sides with those of ``state``."""
        if "velocity" in state:
            self.velocity.velocity[...] = state["velocity"]
            self.velocity.write(self.added)
        for own in self.own.values():
            own.restore(state)


@inline
def pass_one(flat, of, to, added, k):
    """Slot ``to[k]`` of flat populations, overwritten, gets what slot ``of[k]`` holds and what link k adds."""
    flat[to[k]] = flat[of[k]] + added[k]


@parallel_kernel
def pass_on(flat, of, to, added):
    """All links: after an even step halo slots get what comes back in, after an odd one what went out comes in.

    Overwrites flat populations at ``to``.  Spread over the threads as the rows of the sweep are: a slot that another
    core has in its cache is fetched from there, and again in the next sweep, a seventh of a step of 512 x 512 cells.
    """
    for k in prange(to.shape[0]):
        pass_one(flat, of, to, added, k)
