"""Polygons of the contact model in fluid: their position, the load of the fluid, and how it acts on them.

A polygon is a frame (dem/bodies/frames.py), a rigid body whose corners are rows among the discs.  Cells are covered by
its outline, without the thickness of its segments: bodies that touch keep a film of both thicknesses between them.
Load, fluid inside and layer around are those of the body (immersed.py), and so is the equation of motion; what moves it
is distributed over its corners in shares like those of its mass, which add up to the force and the torque about the
centroid however the body turns in the contact steps.
"""

import numpy as np

from porescale.common.compiled.jit import kernel
from porescale.common.core.errors import Fault, InputError
from porescale.common.core.types import AnyArray, Floats
from porescale.coupling.coverage.polygon import Polygons
from porescale.coupling.immersed import LAYER, Immersed
from porescale.dem.bodies.clumps import Clumps
from porescale.dem.bodies.frames import Frame, polygon_moments
from porescale.dem.bodies.rigid import clumps_of
from porescale.dem.grains import Grains
from porescale.lbm.scales import Scales

OFF_CENTRE = 1e-9
"""Of a polygon's size: how far its centre of mass may lie from the middle of its area."""


@kernel
def distribute_load(first, start, member, mass, body_mass, force, torque, disc_force, disc_torque):
    """Distribute the force (m, 2) and torque (m,) on polygons over their corners, in proportion to their mass.

    Polygon n is clump first + n with the discs member[start[first + n]] to member[start[first + n + 1] - 1];
    mass (discs,), body_mass (clumps,) kg/m.  Overwrites these rows of disc_force (discs, 2) and disc_torque (discs,).
    """
    for n in range(torque.shape[0]):
        for k in range(start[first + n], start[first + n + 1]):
            i = member[k]
            share = mass[i] / body_mass[first + n]
            disc_force[i, 0] = share * force[n, 0]
            disc_force[i, 1] = share * force[n, 1]
            disc_torque[i] = share * torque[n]


def corners_of(grains: Grains) -> int:
    """How many of the last discs of ``grains`` are corners of frames, which the fluid does not see."""
    return 0 if grains.segments is None else int(np.count_nonzero(grains.segments.is_corner))


def outlines(grains: Grains) -> tuple[int, list[Floats]]:
    """Number of the first frame among the clumps, and corners (k, 2) m of every frame about its centroid, at angle 0.

    Raises InputError at a frame that is no polygon, or whose centre of mass is not the middle of its area.
    """
    clumps, found = clumps_of(grains), []
    first = 0 if clumps is None else clumps.count
    if grains.segments is None or clumps is None:
        return first, []
    ends, corner = grains.segments.ends, grains.segments.is_corner
    first = int(np.flatnonzero(corner[clumps.member[clumps.start[:-1]]])[0])
    for c in range(first, clumps.count):
        own = clumps.discs_of(c)
        at = clumps.offset[clumps.start[c] : clumps.start[c + 1]]
        mine = ends[np.isin(ends[:, 0], own)] - own[0]
        shape = Frame(tuple(map(tuple, at.tolist())), tuple(map(tuple, mine.tolist())), float(clumps.radius.max()), 1.0)
        name = f"frame[{c - first}]"
        if not shape.closed:
            raise InputError(Fault(name, len(at), "is no polygon, and fluid would pass between its segments",
                                   repair="close it, or make polygons of its rods"))  # fmt: skip
        found.append(at[shape.loop])
        _, middle, _ = polygon_moments(found[-1])
        if np.abs(middle).max() > OFF_CENTRE * np.abs(at).max():
            problem = "lies off its centre of mass: the middle of the area, where it is pushed up"
            raise InputError(Fault(f"{name}.body", tuple(middle.tolist()), problem, "m", "(0, 0)"))
    return first, found


def _outline_moments(corners: Floats) -> tuple[float, float]:
    """Length (m) of the outline of corners (k, 2) m, and its second moment (m³) about 0: the layer of a disc has twice
    the share of the disc's moment of inertia that it has of its mass, and polygons run away without that too."""
    ahead = np.roll(corners, -1, axis=0)
    length = np.hypot(*(ahead - corners).T)
    return float(length.sum()), float(length @ np.sum(corners**2 + corners * ahead + ahead**2, axis=1)) / 3.0


class ImmersedPolygons(Immersed):
    """The polygons of ``grains``, in the order of the frames, and their equation of motion.

    polygons : of the lattice, in cells;  outlines : corners of each, (k, 2) m about its centroid, at angle 0.
    Raises InputError at a frame that is no convex polygon, or whose centre of mass is off.
    """

    def __init__(self, grains: Grains, scales: Scales, acceleration: tuple[float, float], least: float) -> None:
        """least : answering mass over that of the fluid inside (immersed.py); not 0: loads are those of two steps."""
        clumps = clumps_of(grains)
        assert clumps is not None
        self._grains = grains
        self.first, corners = outlines(grains)
        self.outlines = corners
        self.polygons = Polygons([each / scales.spacing for each in corners])
        moments = np.array([[area, second] for area, _, second in map(polygon_moments, corners)])
        inner_mass, inner_inertia = scales.density * moments[:, 0], scales.density * moments[:, 1]
        mass, inertia = clumps.mass[self.first :], clumps.inertia[self.first :]
        weight = (mass - inner_mass)[:, None] * np.asarray(acceleration, float)
        around = scales.density * (LAYER * scales.spacing) * np.array([_outline_moments(each) for each in corners])
        around = np.maximum(around, least * np.column_stack((inner_mass, inner_inertia)))
        share = np.minimum(1.0, np.column_stack((mass, inertia)) / around)
        super().__init__(
            inner_mass, inner_inertia, clumps.velocity[self.first :], clumps.spin[self.first :], weight, share
        )
        if least > 0.0:
            self.turn_back(mass / inner_mass)
        self._no_torque = np.zeros(len(mass))

    @property
    def _clumps(self) -> Clumps:
        return self._grains.steering.clumps

    @property
    def held(self) -> AnyArray:
        """Flags of held components, (m, 3)."""
        return self._clumps.held[self.first :]

    @property
    def position(self) -> Floats:
        """Centroids, (m, 2) m."""
        return self._clumps.position[self.first :]

    @property
    def angle(self) -> Floats:
        """Angles turned since the start, (m,) rad."""
        return self._clumps.angle[self.first :]

    @property
    def velocity(self) -> Floats:
        """(m, 2) m/s, half a step back."""
        return self._clumps.velocity[self.first :]

    @property
    def spin(self) -> Floats:
        """(m,) rad/s, half a step back."""
        return self._clumps.spin[self.first :]

    def distribute(self, discs: Immersed) -> None:
        """Overwrite the corners' rows of force, torque and what the fluid does in ``discs`` with shares of the
        polygons' own."""
        clumps, mass = self._clumps, self._grains.discs.mass
        for own, turning, rows, turns in (
            (self.force, self.torque, discs.force, discs.torque),
            (self.push, self._no_torque, discs.push, discs.fluid_torque),
            (self.fluid_force, self.fluid_torque, discs.fluid_force, discs.fluid_torque),
        ):
            distribute_load(self.first, clumps.start, clumps.member, mass, clumps.mass, own, turning, rows, turns)

    def momentum(self, units: Floats, step: float) -> Floats:
        """What polygons add to the conserved momentum beside their own: virtual masses and load under way, less the
        fluid inside, (2,)."""
        return np.asarray(self.virtual_momentum(units, step) - self.inner_momentum.sum(axis=0))
