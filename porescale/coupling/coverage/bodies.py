"""The bodies of a lattice that are no discs, together: their patches, the sides they reach through, their loads."""

from collections.abc import Sequence
from typing import Any

import numpy as np

from porescale.common.compiled.jit import kernel
from porescale.common.core.types import Reals
from porescale.coupling.coverage.rows import Patches
from porescale.coupling.coverage.shape import Shape
from porescale.coupling.coverage.through_sides import move_sides, relax_density, side_links, side_loads
from porescale.lbm.fluid import Fluid
from porescale.lbm.lattice import WEIGHTS

DENSITY_SHARE = 0.1
"""Share by which the density inside a body that passes a side is led back to 1 every other step."""


class Bodies:
    """Shapes beside ``discs`` discs, after which they come in all arrays of bodies.

    centre, velocity (n, 2), spin (n,): of all bodies, as kernels read them.
    load (m, 3): force and torque of the fluid on the shapes in the last step, of which cells give the mean of two steps
    where full ones turn populations back (immersed.py);  mass: what has come in through sides with them and was not
    taken out again.  Lattice units.  A step allocates a few bytes, and more where a ring moves.
    """

    def __init__(
        self, fluid: Fluid, discs: int, shapes: Sequence[Shape], rectangles: int, *, turns_back: bool = False
    ) -> None:
        """rectangles: how many of the shapes, the first ones, are such;  turns_back: whether full cells do so."""
        self.shapes, self.discs, self.rectangles = list(shapes), discs, rectangles
        self._fluid = fluid
        count, m = discs + len(shapes), len(shapes)
        self.centre, self.velocity, self.spin = np.zeros((count, 2)), np.zeros((count, 2)), np.zeros(count)
        self.load, self.touching = np.zeros((m, 3)), np.zeros(m, np.bool_)
        self.mass = 0.0
        self._links = side_links(fluid)
        self._grid = fluid.nx, fluid.ny, *fluid.sides.periodic
        self._filled: list[Reals | None] = [None] * m
        self._inside, self._borne = np.zeros((m, 2)), np.zeros((m, 3))
        self._before, self._under_way = np.zeros((m, 3)), np.zeros((m, 3))
        self._turns_back, self._now = turns_back, 0.5 if turns_back else 1.0
        for k, shape in enumerate(self.shapes):
            self._before[k] = *shape.velocity, shape.spin

    def gather(self, centre: Reals, velocity: Reals, spin: Reals) -> tuple[Reals, Reals, Reals]:
        """Centre, velocity and spin of all bodies: the discs' as given, and the shapes'."""
        n = self.discs
        self.centre[:n], self.velocity[:n], self.spin[:n] = centre, velocity, spin
        for k, shape in enumerate(self.shapes, n):
            self.centre[k], self.velocity[k], self.spin[k] = shape.centre, shape.velocity, shape.spin
        return self.centre, self.velocity, self.spin

    def place(self, patches: Patches) -> None:
        """Fill the patches of the shapes that have moved."""
        for k, shape in enumerate(self.shapes):
            filled, n = self._filled[k], self.discs + k
            if filled is not None and np.array_equal(filled, shape.place):
                continue
            self._filled[k] = np.array(shape.place)
            start, stride, height = (int(a[n]) for a in (patches.start, patches.stride, patches.height))
            fraction = patches.fraction[start : start + stride * height].reshape(height, stride)
            shape.fill(self._fluid, patches.corner[n], fraction)
            inside_of(fraction, patches.corner[n], shape.centre, self._inside[k])

    def before(self, fluid: Fluid, patches: Patches, shift: Reals, slow_load: Reals) -> None:
        """Let the sides move with what reaches through them in the step to come.

        A body that a side carries needs no half-step correction, and its load has none: shift and slow_load (n, 3)
        are cleared for it.
        """
        self.mass += move_sides(
            self.discs, self._grid, patches, self.centre, self.velocity, self.spin, self._links,
            fluid.links.added, self.touching,
        )  # fmt: skip
        for k in range(len(self.shapes)):
            if self.touching[k]:
                shift[self.discs + k] = slow_load[self.discs + k] = 0.0
                if fluid.step % 2 == 0 and self.shapes[k].velocity.any():
                    self.mass += relax_density(
                        self.discs + k, DENSITY_SHARE, WEIGHTS, *self._grid[2:], patches, fluid.populations
                    )  # fmt: skip

    def hold_sides(self) -> None:
        """Let no side move with what reaches through it from now on: the common mistake, for comparison."""
        self._links.size[:] = 0.0

    def after(self, fluid: Fluid, patches: Patches, load: Reals, force: Reals, direct: Reals) -> None:
        """The shapes' loads: ``load`` (n, 3) of all bodies' cells, less what sides bear, and the rate at which the
        velocity of the fluid inside changes, given back.  Of two steps, where full cells turn populations back.

        force (n, 2): the body force at each body.  Overwrites the shapes' rows of direct (n, 2), what it adds at once.
        """
        side_loads(
            self.discs, self._grid, patches, self.centre, self.velocity, self.spin, self._links, fluid.links.added,
            fluid.flat, self._borne,
        )  # fmt: skip
        shape_loads(load[self.discs :], self._borne, self._inside, self.velocity[self.discs :],
                    self.spin[self.discs :], self._before, self._now, self._under_way, self.load)  # fmt: skip
        direct[self.discs :] = -self._inside[:, :1] * force[self.discs :]

    def restore_mass(self, fluid: Fluid, patches: Patches) -> float:
        """Take ``mass`` out of the fluid evenly, at rest and in equilibrium; returns it and counts anew.

        A uniform pressure moves nothing: it is as if the water's level followed a gate that leaves.  What fills the
        shapes is left as it is.  Between an odd and an even step only; else nothing is done and 0 returned.
        """
        if fluid.step % 2 or self.mass == 0.0:
            return 0.0
        mass, self.mass = self.mass, 0.0
        change = -mass / (fluid.nx * fluid.ny - float(self._inside[:, 0].sum()))
        for plane, weight in zip(fluid.populations, WEIGHTS, strict=True):
            plane[1:-1, 1:-1] += plane.dtype.type(weight * change)
        add_inside(self.discs, patches, fluid.populations, WEIGHTS * -change)
        return mass

    def state(self) -> dict[str, Any]:
        """What the next step takes from those before; places are the owner's."""
        state = {"before": self._before, "mass": self.mass}
        return state | ({"load_under_way": self._under_way} if self._turns_back else {})

    def restore(self, state: dict[str, Any]) -> None:
        """Restore a state of the same shapes."""
        self._before[...], self.mass = state["before"], float(state["mass"])
        if self._turns_back:
            self._under_way[...] = state["load_under_way"]


@kernel
def add_inside(first, patches, f, amount):
    """Add amount (9,) times the solid fraction to every cell of bodies from ``first`` on; overwrites populations f."""
    ny, nx = f.shape[1] - 2, f.shape[2] - 2
    for n in range(first, patches.height.shape[0]):
        for j in range(patches.height[n]):
            at = patches.start[n] + j * patches.stride[n]
            y = (patches.corner[n, 1] + j) % ny + 1
            for i in range(patches.stride[n]):
                x = (patches.corner[n, 0] + i) % nx + 1
                e = patches.fraction[at + i]
                if e > 0.0:
                    for q in range(9):
                        f[q, y, x] += e * amount[q]


@kernel
def inside_of(fraction, corner, centre, out):
    """Area in the box of a patch (height, stride) and its polar moment about the centre, into out (2,)."""
    area = 0.0
    inertia = 0.0
    for j in range(fraction.shape[0]):
        y = corner[1] + j + 0.5 - centre[1]
        for i in range(fraction.shape[1]):
            x = corner[0] + i + 0.5 - centre[0]
            area += fraction[j, i]
            inertia += fraction[j, i] * (x * x + y * y)
    out[0] = area
    out[1] = inertia


@kernel
def shape_loads(cells, borne, inside, velocity, spin, before, now, under_way, load):
    """load (m, 3) <- own + inside dv/dt, and the same with the spin; before (m, 3) <- velocity and spin.

    own: a share ``now`` of cells - borne, and what is under way of the step before; overwrites under_way (m, 3) with
    the rest.  cells, borne (m, 3);  inside (m, 2): area and polar moment;  velocity (m, 2), spin (m,).
    """
    for k in range(load.shape[0]):
        for a in range(3):
            own = cells[k, a] - borne[k, a]
            moves = velocity[k, a] if a < 2 else spin[k]
            load[k, a] = now * own + under_way[k, a] + inside[k, 0 if a < 2 else 1] * (moves - before[k, a])
            under_way[k, a] = (1.0 - now) * own
            before[k, a] = moves
