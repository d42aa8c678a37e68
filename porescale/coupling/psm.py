"""Partially saturated cells (Noble & Torczynski 1998): one fluid step with bodies in the lattice.

    e_n      area fraction of each cell that body n covers, exactly       coverage/
    v        velocity of the solid in a cell, sum e_n v_n/sum e_n         coverage/rows.py, psm_kernels.py
    B        weight of the cell, from e and tau                           weighting/
    f_i*     collided populations, of fluid and solid operator            lbm/collision/, solid/
    F_n,T_n  sum over cells of the momentum that the solid gains          load.py
    v_n      corrected by half a step where cells are full                load.py, ``half_step_correction``

``SaturatedCells.advance`` is that step.
"""

import math
from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from porescale.common.compiled.jit import most_threads
from porescale.common.core.aligned import aligned_zeros
from porescale.common.core.types import Reals
from porescale.coupling.coverage.bodies import Bodies
from porescale.coupling.coverage.discs import CHUNKS, SCRATCH, cover
from porescale.coupling.coverage.overlap import subtract_overlap
from porescale.coupling.coverage.polygon import Polygons
from porescale.coupling.coverage.rectangle import Rectangle
from porescale.coupling.coverage.ring import Ring
from porescale.coupling.coverage.rows import BLOCK, Motion, list_bands, make_bands, make_patches, rasterize
from porescale.coupling.coverage.shape import Shape
from porescale.coupling.coverage.shared import keep_open
from porescale.coupling.coverage.soft_rim import MARGIN, SoftRim
from porescale.coupling.load import add_rows, half_step_correction
from porescale.coupling.psm_kernels import AT_ONCE, RowWork, sweep
from porescale.coupling.push import covered_area, held_area
from porescale.coupling.solid.choose import SOLID_OPERATORS, choose_solid
from porescale.coupling.solid.choose import solid_operator as solid_operator_of
from porescale.coupling.weighting.choose import choose_weight, fitting_weight
from porescale.coupling.weighting.law import weights_of
from porescale.lbm.collision.choose import third_order_rate
from porescale.lbm.fluid import Fluid
from porescale.lbm.moments import moment_fields

LOW_PASS = 0.1
"""Share of a step's load in the one that the half-step correction is made from; 1 lets light discs run away."""
BAND_HEIGHT = 8
"""Rows that one thread does at a time, with the bodies in them; any value gives the same bits."""
BANDS_READ = 8
"""Bands that `SaturatedCells.flow` collides and takes back at a time."""
SPREAD = 0.6180339887498949
"""Golden section: bands in the order of the multiples of it, modulo 1, are spread evenly over any number of threads,
though the grains lie at the bottom."""


def row_work(nx: int, height: int, row_load: NDArray[np.float64], dtype: np.dtype[Any], *, soft: bool) -> RowWork:
    """Scratch of all threads for bands of ``height`` rows of nx cells, and the given loads of rows."""
    threads = most_threads()
    scratch = aligned_zeros((threads, 4 if soft else 3, height * (BLOCK + nx + BLOCK)), dtype)
    weights = aligned_zeros((threads, 4, min(nx, AT_ONCE)), dtype)
    return RowWork(row_load, scratch, weights, np.zeros((threads, 2 * height), np.int64))


class SaturatedCells:
    """Discs of given radii (cells), convex polygons, rectangles and rings that cover cells of the fluid.

    force (n, 2), torque (n,): loads of the last step on the discs, lattice units; rectangle_force (m, 2), ring_force,
    ring_torque: on the others, what the fluid inside them takes already given back;  push (discs + polygons + others,
    2): what the body force does to all of them, not in those loads (push.py), and of each kind disc_push, polygon_push,
    rectangle_push, ring_push;  beyond (of its length): areas, cells², that cover no cells but are pushed, set by the
    owner, and joined, joined_area: discs that are pushed by such an area alone, as others cover their cells too;
    driven: whether there is a body force;  entrained (n, 2): mass and moment of inertia of the fluid that took the
    discs' velocity.  Discs cover cells with ``covering_radius``, larger by ``radius_shift`` (cells²) over the radius.
    Rectangles and rings go as their owner says between steps; where they reach through a side of the box it moves with
    them, and ``mass_through_sides`` is what came in (coverage/through_sides.py).  pairs: (p, 2) discs of one rigid body
    that overlap, see coverage/overlap.py.  body: the first disc of each disc's rigid body, set by the owner where cells
    that two bodies share are to stay open (coverage/shared.py), else None.  polygon_load (p, 3), polygon_entrained (p,
    2): of the polygons, as of discs; they go as their owner says.  operator: the row of the solid operator.  cut:
    numbers of the discs that a free-slip side across y cuts, set by the owner: with what the side mirrors such a disc
    makes one body that goes along x alone.  A step allocates no array of the size of anything.
    """

    def __init__(
        self,
        fluid: Fluid,
        radius: Reals,
        *,
        solid_operator: str = "exact-wall",
        weighting: str | None = None,
        rectangles: Sequence[Rectangle] = (),
        rings: Sequence[Ring] = (),
        polygons: Polygons | None = None,
        soft_rim: bool = False,
    ) -> None:
        self.radius = np.ascontiguousarray(radius, float)
        self.periodic_x, self.periodic_y = fluid.sides.periodic
        self._shape = fluid.ny, fluid.nx
        self.operator = solid_operator_of(solid_operator)
        if soft_rim and self.operator.soft_law is None:
            able = " or ".join(name for name, other in SOLID_OPERATORS.items() if other.soft_law)
            raise ValueError(f"soft rims go with the solid operator {able}")
        tau, third_order, dtype = fluid.relaxation_time, third_order_rate(fluid.law), fluid.populations.dtype
        self._laws = (
            choose_weight(fitting_weight(solid_operator, weighting), tau, dtype, soft=soft_rim),
            choose_solid(solid_operator, tau, third_order, dtype, soft=soft_rim),
        )
        self._half_rate = 0.5 * third_order
        shift = self.radius_shift = self.operator.radius_shift * (tau - 0.5) * (1 / third_order - 0.5)
        self._set_covering_radius(shift)
        self.polygons = polygons
        self.bodies: Bodies | None = None
        high, wide = self._sizes(fluid, shift, [*rectangles, *rings], len(rectangles), MARGIN * soft_rim)
        discs, count = len(self.radius), len(high)
        self._patches = make_patches(wide, high, dtype)
        self._bands = make_bands(self._patches, fluid.ny, BAND_HEIGHT)
        widest = int(self._patches.stride[:discs].max(initial=BLOCK))
        self._lines = aligned_zeros((CHUNKS, SCRATCH, widest + BLOCK), np.float64)
        row_load = np.zeros((count, int(high.max(initial=0)), 7 if soft_rim else 5))
        self._work = row_work(fluid.nx, BAND_HEIGHT, row_load, dtype, soft=soft_rim)
        bands = len(self._bands.start) - 1
        self._band_order = np.argsort(np.arange(bands) * SPREAD % 1).astype(np.int64)
        self.pairs = np.zeros((0, 2), np.int64)
        self.body: NDArray[np.int64] | None = None
        self._placed = np.full((discs, 2), np.nan)  # centres for which the patches are filled
        self._stands = np.zeros(self._placed.shape, np.bool_)
        self._summed = False  # whether the areas that the body force pushes are those of the patches
        self._covered: Reals | None = None
        self._set_loads(count, np.asarray(fluid.force, float))
        self._theta = np.zeros(count)
        self.soft_rim = SoftRim(self.radius, shift, tau, self._theta[:discs]) if soft_rim else None

    def _set_covering_radius(self, shift: float) -> None:
        """The radii that the lattice is covered with;  shift: what they lack times the radius, cells².

        ValueError where a disc does not fit into the periodic box.
        """
        ny, nx = self._shape
        widest = 0.5 * min(nx if self.periodic_x else math.inf, ny if self.periodic_y else math.inf)
        if self.radius.max(initial=0) > widest * (1 + 1e-12):
            raise ValueError("a disc is wider than the periodic box")
        self.covering_radius = np.minimum(self.radius + shift / np.maximum(self.radius, 1.0), widest)

    def _sizes(
        self, fluid: Fluid, shift: float, shapes: list[Shape], rectangles: int, margin: int
    ) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
        """Height and width in cells of the patches of all bodies: discs, polygons, and ``shapes``, rectangles first."""
        width = (np.floor(2 * self.covering_radius) + 2).astype(np.int64) + margin
        high, wide = width, width + 1
        if self.polygons:
            cells = self.polygons.fit(fluid, shift, len(self.radius))
            high, wide = np.append(high, cells), np.append(wide, cells)
        if shapes:
            sizes = [shape.size(fluid, shift) for shape in shapes]
            self.bodies = Bodies(fluid, len(high), shapes, rectangles, turns_back=self.operator.turns_back)
            wide, high = (np.append(it, [size[k] for size in sizes]) for k, it in enumerate((wide, high)))
        return high, wide

    def _set_loads(self, count: int, force: Reals) -> None:
        """Arrays of the loads of ``count`` bodies, and what the body force on the fluid adds to each at once."""
        discs = len(self.radius)
        movers = discs + (self.polygons.count if self.polygons else 0)
        self.push, self.driven = np.zeros((count, 2)), bool(force.any())
        self.disc_push, self.polygon_push = self.push[:discs], self.push[discs:movers]
        self._push_of_others = self.push[movers:]
        self.joined, self.joined_area = np.zeros(0, np.int64), np.zeros(0)
        self.beyond, self._taken, self._drive = np.zeros(count), np.zeros(count), np.tile(force, (count, 1))
        self._load, self._entrained = np.zeros((count, 3)), np.zeros((count, 2))
        self.force, self.torque, self.entrained = self._load[:discs, :2], self._load[:discs, 2], self._entrained[:discs]
        self.polygon_load, self.polygon_entrained = self._load[discs:movers], self._entrained[discs:movers]
        self._slow_load, self._shift = np.zeros((count, 3)), np.zeros((count, 3))
        self.cut = np.zeros(0, np.int64)
        self._direct = np.zeros((count, 2))
        self._set_direct()

    def _set_direct(self) -> None:
        """What the body force adds at once to the loads of discs and polygons."""
        covered = np.pi * self.covering_radius**2
        if self.polygons:
            covered = np.append(covered, self.polygons.covered_area)
        self._direct[: len(covered)] = -covered[:, None] * self._drive[: len(covered)]

    def _follow_force(self, force: Reals, centre: Reals) -> None:
        """What a body force of every cell (2, ny, nx) does to bodies at once: as if it were that at their centres."""
        wide, at = self._shape[::-1], np.floor(centre).astype(np.int64)
        within = np.clip(at, 0, np.subtract(wide, 1))
        x, y = np.where((self.periodic_x, self.periodic_y), at % wide, within).T
        self.driven, self._drive[:] = True, force[:, y, x].T
        self._set_direct()

    def _push_bodies(self) -> None:
        """What the body force would do to the fluid where the bodies are, which is theirs to bear (push.py).

        The areas are summed where a patch was filled since.
        """
        if not self._summed:
            where = self._patches, (self.periodic_x, self.periodic_y), self._shape
            if self.operator.force_everywhere:
                covered_area(*where, self._taken)
            else:
                held_area(*where, self._half_rate, self._laws[0], self._taken)
            self._taken += self.beyond
            self._taken[self.joined] = self.joined_area
            self._summed = True
        np.multiply(self._taken[:, None], self._drive, out=self.push)

    def find_push(self, fluid: Fluid, centre: Reals, velocity: Reals, spin: Reals) -> None:
        """Set ``push`` as a step does that begins with the discs there; the state is as before, to the bit."""
        motion = self._place(centre, velocity, spin)
        if fluid.force_field is not None:
            self._follow_force(fluid.force_field, motion.centre)
        if self.driven:
            self._push_bodies()

    @property
    def covered(self) -> Reals:
        """Sum of the solid fractions, and of fraction times velocity (x, y), (3, ny, nx); computed on request."""
        if self._covered is None:
            self._covered = np.zeros((3, *self._shape), self._work.scratch.dtype)
        return self._covered

    @property
    def solid(self) -> Reals:
        """Sum of the solid fractions right after ``cover``, (ny, nx)."""
        return np.asarray(self.covered[0])

    @property
    def rectangle_force(self) -> Reals:
        """Force on the rectangles, (m, 2); (0, 2) without any."""
        return self.bodies.load[: self.bodies.rectangles, :2] if self.bodies else np.zeros((0, 2))

    @property
    def ring_force(self) -> Reals:
        """Force on the rings, (m, 2); (0, 2) without any."""
        return self.bodies.load[self.bodies.rectangles :, :2] if self.bodies else np.zeros((0, 2))

    @property
    def rectangle_push(self) -> Reals:
        """What the body force does to the rectangles, (m, 2); (0, 2) without any."""
        return self._push_of_others[: self.bodies.rectangles if self.bodies else 0]

    @property
    def ring_push(self) -> Reals:
        """What the body force does to the rings, (m, 2); (0, 2) without any."""
        return self._push_of_others[self.bodies.rectangles if self.bodies else 0 :]

    @property
    def ring_torque(self) -> Reals:
        """Torque on the rings about their centres, (m,); (0,) without any."""
        return self.bodies.load[self.bodies.rectangles :, 2] if self.bodies else np.zeros(0)

    @property
    def mass_through_sides(self) -> float:
        """Mass that has come in through sides with what fills rectangles and rings, cells of density 1.

        A gate that leaves a closed box through its lid takes its area with it, and the mean density falls by the gate's
        share of the box: let water in through a side, or call ``restore_mass``.
        """
        return self.bodies.mass if self.bodies else 0.0

    def restore_mass(self, fluid: Fluid) -> float:
        """Take that mass out of all cells evenly and count anew; returns it.  Does nothing before an odd step."""
        return self.bodies.restore_mass(fluid, self._patches) if self.bodies else 0.0

    def _place(self, centre: Reals, velocity: Reals, spin: Reals) -> Motion:
        """Fill the bodies' patches, list them by bands, and return how they all move.

        Where there are discs only and none has moved since, all of that is there already.
        """
        others = self.soft_rim or self.polygons or self.bodies
        if not others and np.equal(centre, self._placed, out=self._stands).all():
            return Motion(centre, velocity, spin, self._shift, self._theta)
        self._placed[:] = centre
        if self.soft_rim:
            self.soft_rim.soften(self.covering_radius)
        motion = self._rasterized(centre, velocity, spin, self.covering_radius, self.soft_rim)
        if self.body is not None:
            keep_open(self._bands, self._patches, self.body, self.periodic_x, self._work.scratch)
        return motion

    def _rasterized(self, centre: Reals, velocity: Reals, spin: Reals, radius: Reals, rim: SoftRim | None) -> Motion:
        """The same, with discs of ``radius`` (n,) cells."""
        self._summed = False
        cover(centre, radius, self._patches, self._lines)
        if len(self.pairs):
            subtract_overlap(centre, radius, self.pairs, self._patches)
        if rim:
            rim.filter(self._patches)
        if self.polygons:
            self.polygons.cover(self._patches, len(self.radius))
        if self.bodies:
            self.bodies.place(self._patches)
        list_bands(self._patches, self.periodic_y, self._bands)
        return Motion(*self._gathered(centre, velocity, spin), self._shift, self._theta)

    def _gathered(self, centre: Reals, velocity: Reals, spin: Reals) -> tuple[Reals, Reals, Reals]:
        """Centre, velocity and spin of all bodies, discs first."""
        motion = self.polygons.gather(centre, velocity, spin) if self.polygons else (centre, velocity, spin)
        return self.bodies.gather(*motion) if self.bodies else motion

    def cover(self, centre: Reals, velocity: Reals, spin: Reals, *, bare: bool = False) -> None:
        """Fill the solid fields for discs at centre (n, 2), cells, with velocity and spin in lattice units.

        bare: with the radii, outlines and velocities that were given, without what the lattice needs of them.
        """
        if bare:
            if self.polygons:
                self.polygons.bare = True
            motion = self._rasterized(centre, velocity, spin, self.radius, None)
            motion = motion._replace(shift=np.zeros_like(self._shift))
            if self.polygons:
                self.polygons.bare = False
        else:
            self._placed[:] = np.nan
            motion = self._place(centre, velocity, spin)
        self._placed[:] = np.nan  # the patches are none that a step may use again
        work = self._work
        rasterize(self._bands, self._patches, motion, self.periodic_x, work.scratch, work.extent, self.covered)

    def weights(self) -> Reals:
        """Weight B of every cell (ny, nx), right after ``cover``."""
        return weights_of(self.solid, self._laws[0])

    def advance(self, fluid: Fluid, centre: Reals, velocity: Reals, spin: Reals) -> None:
        """One fluid step with the bodies where they are; fills the loads."""
        motion = self._place(centre, velocity, spin)
        if fluid.force_field is not None:
            self._follow_force(fluid.force_field, motion.centre)
        if self.bodies:
            self.bodies.before(fluid, self._patches, self._shift, self._slow_load)
        fluid.advance(
            sweep, self._band_order, self._bands, self._patches, motion, self.periodic_x, self._work, *self._laws,
        )  # fmt: skip
        self._sum_loads(fluid)
        self._respond()

    def _respond(self) -> None:
        """What follows from the loads: the push beside them, and the half-step correction of the next step."""
        if self.driven:
            self._push_bodies()
        if self.operator.half_step_correction:
            cut = self.cut
            if len(cut):
                self._direct[cut] = -self._taken[cut, None] * self._drive[cut]  # of the part of a disc that is there
            half_step_correction(self._load, self._entrained, self._direct, LOW_PASS, self._slow_load, self._shift)
            if len(cut):
                # Of a part, to move and to turn about the disc's centre are much the same: corrected for both, it is
                # corrected twice, and runs away.
                self._shift[cut, 1:] = 0.0

    def _sum_loads(self, fluid: Fluid) -> None:
        """The loads of the bodies from those of their rows."""
        patches, row_load = self._patches, self._work.row_load
        add_rows(patches.corner, patches.height, fluid.ny, self.periodic_y, row_load, self._load, self._entrained)
        if self.soft_rim:
            self.soft_rim.follow(patches, fluid.ny, self.periodic_y, row_load)
        if self.bodies:
            self.bodies.after(fluid, patches, self._load, self._drive, self._direct)

    def flow(self, fluid: Fluid, centre: Reals, velocity: Reals, spin: Reals) -> tuple[NDArray[np.floating], ...]:
        """Density and momentum (rho, jx, jy) of every cell halfway through its collision, each (ny, nx): what flows.

        Half of what the collision to come gives to the bodies, and takes from the body force, is in it.  Populations
        come into a cell before its collision and leave after it, so that the mean of its first moments before and after
        is the mean of what crosses its faces: in a steady flow the same through every section of the box.  The state
        is as before, to the bit.  Allocates three fields and a few rows.
        """
        motion, law, f = self._place(centre, velocity, spin), fluid.law_of_sweep, fluid.padded
        parity, ny, nx = fluid.step % 2, fluid.ny, fluid.nx
        with fluid.readable():
            rho, jx, jy = moment_fields(f, nx, parity)
            height = self._bands.height
            for first in range(0, ny, BANDS_READ * height):
                last = min(first + BANDS_READ * height, ny)
                order = np.arange(first // height, -(-last // height))
                here = f[:, first : last + 2]
                kept = here.copy()
                try:
                    sweep(f, parity, order, self._bands, self._patches, motion, self.periodic_x, self._work,
                          *self._laws, law)  # fmt: skip
                    _, kx, ky = moment_fields(np.ascontiguousarray(here), nx, parity)  # slots of opposite populations
                finally:
                    here[...] = kept
                for j, k in ((jx, kx), (jy, ky)):
                    j[first:last] -= k
                    j[first:last] *= 0.5
        return rho, jx, jy

    def state(self) -> dict[str, Any]:
        """What the next step takes from those before."""
        state: dict[str, Any] = {"slow_load": self._slow_load, "shift": self._shift}
        if self.soft_rim:
            state["rim_slip"] = self.soft_rim.slip
        return state | ({"bodies": self.bodies.state()} if self.bodies else {})

    def restore(self, state: dict[str, Any]) -> None:
        """Restore a state of the same discs."""
        self._slow_load[...], self._shift[...] = state["slow_load"], state["shift"]
        if self.soft_rim:
            self.soft_rim.slip[...] = state["rim_slip"]
        if self.bodies:
            self.bodies.restore(state["bodies"])
