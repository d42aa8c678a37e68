"""The fluid's state and one step of it (lattice Boltzmann, D2Q9: Qian, d'Humieres & Lallemand 1992).

    f_i(x + c_i, t + 1) = f_i(x, t) + Omega_i(f) + S_i(F)

    Omega + S   collision with the body force F       collision/, one operator a file
    x + c_i     streaming, in place                   stream.py, slots explained in lattice.py
    at sides    what comes back into the box          boundary/links.py, one kind of side a file
    at plates   links cut half-way                    boundary/thin_plate.py
    rho, u      moments of f, half the force in u     moments.py, ``Fluid.fields``

Collision and streaming are one sweep over the cells; ``Fluid.advance`` is the step.
"""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

import numpy as np
from numpy.typing import DTypeLike, NDArray

from porescale.lbm.boundary.links import BoundaryLinks
from porescale.lbm.boundary.sides import Sides
from porescale.lbm.boundary.thin_plate import Plate, exchange
from porescale.lbm.collision.choose import choose, convective_delay, without_force
from porescale.lbm.collision.entry import MAGIC_MIDWAY_WALL
from porescale.lbm.collision.field import field_version
from porescale.lbm.equilibrium import equilibrium
from porescale.lbm.lattice import padded_populations
from porescale.lbm.moments import moment_fields
from porescale.lbm.stream import sweep
from porescale.lbm.totals import START, Totals, add_blocks, blocks_of, force_rows, totals_of

Sweep = Callable[..., None]

ROWS_AT_ONCE = 64
"""Rows whose equilibrium is worked out at a time: in double precision all at once would be larger than the fluid."""


class Fluid:
    """A box of nx by ny cells of fluid in lattice units, at rest with density 1 until ``set_flow``.

    force_field (2, ny, nx): force density of every cell, None where it is uniform;
    populations (9, ny + 2, nx + 2): slots, see lattice.py, a part of ``padded``, the same with rows as long as they are
    in memory, and of ``flat``, in one dimension;  step: steps done;  plates: of no thickness, see
    boundary/thin_plate.py;  on_device: whether a graphics device steps it.  A step allocates nothing.
    """

    on_device = False

    def __init__(
        self,
        nx: int,
        ny: int,
        relaxation_time: float,
        *,
        operator: str = "trt",
        magic: float = MAGIC_MIDWAY_WALL,
        smagorinsky: float = 0.0,
        force: tuple[float, float] = (0.0, 0.0),
        sides: Sides | None = None,
        dtype: DTypeLike = np.float64,
    ) -> None:
        if relaxation_time <= 0.5:
            raise ValueError(f"relaxation time {relaxation_time} must be above 1/2")
        self.nx, self.ny, self.relaxation_time = nx, ny, relaxation_time
        self.sides = sides or Sides()
        self.law = choose(operator, relaxation_time, force, dtype, magic=magic, smagorinsky=smagorinsky)
        self.force = force
        self.force_field: NDArray[np.floating] | None = None
        self._law_of_cells: Any = None
        self.padded = padded_populations(nx, ny, dtype)
        self.populations: NDArray[np.floating] = self.padded[:, :, : nx + 2]
        self.flat = self.padded.reshape(-1)
        self.links = BoundaryLinks(nx, ny, self.sides, dtype, convective_delay(self.law))
        self.plates: list[Plate] = []
        self.step = 0

    def add_plate(self, column: int) -> Plate:
        """Put a plate over the whole height left of cell ``column``; remove it from ``plates`` to take it away."""
        plate = Plate(self.nx, self.ny, column, self.sides, self.populations.dtype)
        self.plates.append(plate)
        return plate

    def set_flow(self, ux: Any, uy: Any, density: Any = 1.0) -> None:
        """Start from local equilibrium with velocity and density (numbers or (ny, nx)) and step 0."""
        shape = (self.ny, self.nx)
        rho, ux, uy = (np.broadcast_to(np.asarray(values, float), shape) for values in (density, ux, uy))
        inside = self.populations[:, 1:-1, 1:-1]
        for low in range(0, self.ny, ROWS_AT_ONCE):
            rows = slice(low, low + ROWS_AT_ONCE)
            inside[:, rows] = equilibrium(rho[rows], ux[rows], uy[rows], rho[rows].shape)
        self.step = 0

    def advance(self, cells: Sweep = sweep, *extra: Any) -> None:
        """One step: collide and stream all cells, then settle what crosses plates and sides.

        cells: the sweep, called with ``padded``, the step's parity, ``extra`` (nx where there is none) and the law of
        collision; that of partially saturated cells is psm_kernels.py of the coupling.
        """
        odd = self.step % 2
        if odd:
            self._bounce_off_plates(+1.0)
        cells(self.padded, odd, *(extra or (self.nx,)), self.law_of_sweep)
        if odd:
            self._bounce_off_plates(-1.0)
        field = self.force_field
        self.links.close(self.flat, odd, (self.law.fx, self.law.fy) if field is None else (field[0], field[1]))
        self.step += 1

    def wait(self) -> None:
        """Wait until the steps asked for are done: at once here, where they are done when ``advance`` returns."""

    @property
    def law_of_sweep(self) -> Any:
        """The law of collision as sweeps take it: without a force that is zero, or with the force of every cell."""
        return without_force(self.law) if self._law_of_cells is None else self._law_of_cells

    def _bounce_off_plates(self, sign: float) -> None:
        """Exchange the slots of all links that plates cut, before an odd sweep (+1) and after it (-1)."""
        for p in self.plates:
            exchange(self.flat, p.first, p.second, p.pull, p.links_from(), p.signed_speed(sign))

    def set_force_field(self, force: NDArray[np.floating]) -> None:
        """Give every cell a force density of its own, (2, ny, nx) of the populations' type.

        The array is kept and read in every step: its owner may change it between two.  Raises ValueError at another
        shape or type, or where there is a uniform force.
        """
        if force.shape != (2, self.ny, self.nx) or force.dtype != self.populations.dtype:
            raise ValueError(f"force of every cell: {force.shape} of {force.dtype}")
        if any(self.force):
            raise ValueError("a fluid has a uniform force or one of every cell")
        self.force_field = force
        self._law_of_cells = field_version(type(self.law))(*self.law, force[0], force[1])

    def set_side_velocity(self, side: str, velocity: Any) -> None:
        """Give a velocity side another velocity, (ux, uy) or (n, 2), from the next step on.

        ValueError if the side is of another kind or the shape does not fit.
        """
        self.links.set_velocity(side, velocity)

    def set_side_density(self, side: str, density: float) -> None:
        """Give a pressure side another density from the next step on; ValueError if the side is of another kind."""
        self.links.set_density(side, density)

    @contextmanager
    def readable(self) -> Iterator[None]:
        """Within this, every cell's slots can be read at any step; afterwards the state is as before, to the bit."""
        if self.step % 2 == 0:
            yield
            return
        kept = [(p, self.flat[p.first].copy(), self.flat[p.second].copy()) for p in self.plates]
        self._bounce_off_plates(+1.0)
        try:
            yield
        finally:
            for plate, first, second in kept:
                self.flat[plate.first], self.flat[plate.second] = first, second

    def fields(self, solid: NDArray[np.floating] | None = None) -> tuple[NDArray[np.floating], ...]:
        """Density and velocity (rho, ux, uy), each (ny, nx), lattice units.

        ``solid`` (ny, nx): the weight B of partially saturated cells, in which only (1 - B) of the body force acts.
        """
        rho, jx, jy = self.moments()
        rho += 1
        forces: Any = self.force if self.force_field is None else self.force_field
        for j, force in ((jx, forces[0]), (jy, forces[1])):
            if np.any(force):
                j += 0.5 * force if solid is None else 0.5 * force * (1.0 - solid)
            j /= rho
        return rho, jx, jy

    def moments(self) -> tuple[NDArray[np.floating], NDArray[np.floating], NDArray[np.floating]]:
        """Density - 1 and first moments of every cell, each (ny, nx), lattice units; new arrays."""
        with self.readable():
            return moment_fields(self.padded, self.nx, self.step % 2, shifted=True)

    def totals(self) -> Totals:
        """Mass, momentum, energy, largest speed and extremes of density over all cells, see `Totals`."""
        blocks = blocks_of(self.nx, self.ny)
        force = force_rows(self.force, self.force_field, self.nx, self.populations.dtype)
        with self.readable():
            add_blocks(self.padded, self.nx, self.step % 2, force, START, blocks)
        return totals_of(blocks)

    def mass_excess(self) -> float:
        """Sum over cells of density - 1, lattice units: a small number, so that a leak of 1e-12 shows."""
        return float(np.sum(self.moments()[0]))

    def momentum(self) -> tuple[float, float]:
        """Sum over cells of the first moments, lattice units."""
        _, jx, jy = self.moments()
        return float(np.sum(jx)), float(np.sum(jy))

    def state(self) -> dict[str, Any]:
        """Everything needed to go on bit for bit (plates' heights included; the list of plates is the owner's).

        Arrays are those of the fluid, not copies.
        """
        return {
            "populations": self.populations,
            "step": self.step,
            "plates": {str(k): {"edge": p.lower_edge, "speed": p.speed} for k, p in enumerate(self.plates)},
            **({"rim": rim} if (rim := self.links.state()) else {}),
        }

    def restore(self, state: dict[str, Any]) -> None:
        """Restore a state; the same number of plates must be in place."""
        self.populations[...] = state["populations"]
        self.step = int(state["step"])
        self.links.restore(state.get("rim", {}))
        for k, plate in enumerate(self.plates):
            plate.lower_edge = float(state["plates"][str(k)]["edge"])
            plate.speed = float(state["plates"][str(k)]["speed"])
