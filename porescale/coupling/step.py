"""One coupled step: cover, stream and collide, load, and the contact steps under the held load.

The fluid inside a disc is dragged along, so the sum over its cells contains -m_f dU/dt, m_f = rho0 pi R_h²; it is given
back with an acceleration known from before, likewise for rotation with m_f R_h²/2 (a rigid disc of fluid).  Of the
inside no more than S, the sum of B rho, takes the disc's velocity within a step; more given back at once drives light
discs.  So the velocity V of the fluid inside follows,  V += beta (U - V), beta = 0.9 min(1, S/m_f),  and m_f dV/dt is
given back.

The layer of fluid around a light disc that answers within a step throws it to and fro.  It is given that layer as a
virtual mass on both sides of its equation of motion, on the right with the acceleration of the step before (Schwarz,
Kempe & Froehlich 2015, J. Comput. Phys. 281, 591):  (m_p + m_v) a^n = F + m_v a^(n-1);  m_v = 2 pi R_h times 3/4 of a
cell, less m_p.  The force m_p a^n that moves it then changes by a share m_p/(m_p + m_v) a step; heavier discs, with
m_v <= 0, take up all of it.

The conserved momentum is  sum rho u + sum (m_p U - m_f V + m_v a dt).  The pressure is the reduced one, p + rho0 g y:
the fluid carries no weight, and each disc that of its mechanical area less the fluid's, (rho_s - rho0) A g.
"""

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from porescale.common.compiled.jit import kernel
from porescale.common.core.errors import Fault, InputError
from porescale.coupling.coverage.overlap import overlapping
from porescale.coupling.coverage.rectangle import Rectangle
from porescale.coupling.displaced import displaced, whole
from porescale.coupling.immersed_polygons import ImmersedPolygons, corners_of
from porescale.coupling.lubrication import CELLS, Lubrication
from porescale.coupling.psm import Saturated
from porescale.dem.grains import Grains
from porescale.lbm.fluid import Fluid
from porescale.lbm.scales import Scales

Array = NDArray[np.floating]

FOLLOWING = 0.9
"""Share of S/m_f with which the fluid inside follows: 1 lets discs of density ratio 0.1 run away."""
LAYER = 0.75
"""Thickness in cells of the layer that answers within a step: sound's 0.58, and what viscosity adds.  Without it discs
of density ratio 0.3 run away at 6 cells per diameter, 0.2 at 10, 0.1 at 16."""


@kernel
def to_lattice(position, velocity, spin, spacing, step, centre, lattice_velocity, lattice_spin):
    """SI position (n, 2) m, velocity m/s, spin rad/s into cells and lattice units; overwrites the last three."""
    pace = step / spacing
    for n in range(spin.shape[0]):
        for a in range(2):
            centre[n, a] = position[n, a] / spacing
            lattice_velocity[n, a] = velocity[n, a] * pace
        lattice_spin[n] = spin[n] * step


@kernel
def total_load(
    load, load_torque, inside, weight, velocity, spin, inner_velocity, inner_spin, inner_mass, inner_inertia, uptake,
    step, units, inner_momentum, fluid_force, fluid_torque, force, torque,
):  # fmt: skip
    """What the fluid does to every disc, the inner mass given back, and with the weight.

    load (n, 2), load_torque (n,), inside (n, 2) mass and moment of inertia that answer within a step: lattice units,
    of ``units`` (4,) N/m, N m/m, kg/m, kg m²/m;  weight (n, 2) N/m;  velocity m/s, spin rad/s;  inner_mass (n,) kg/m,
    inner_inertia (n,) kg m²/m;  uptake (n, 2): share of a change of force, and of torque, taken up in a step;  step s.
    Overwrites inner_velocity (n, 2) m/s, inner_spin (n,) rad/s and inner_momentum (n, 2) kg/s of the fluid inside;
    fluid_force (n, 2) N/m and
    fluid_torque (n,) N m/m;  force and torque, likewise, which move the disc.
    """
    for n in range(spin.shape[0]):
        follows = FOLLOWING * min(1.0, inside[n, 0] * units[2] / inner_mass[n]) if inner_mass[n] > 0.0 else 1.0
        for a in range(2):
            change = follows * (velocity[n, a] - inner_velocity[n, a])
            fluid_force[n, a] = load[n, a] * units[0] + inner_mass[n] * change / step
            force[n, a] += uptake[n, 0] * (weight[n, a] + fluid_force[n, a] - force[n, a])
            inner_velocity[n, a] += change
            inner_momentum[n, a] += inner_mass[n] * change
        follows = FOLLOWING * min(1.0, inside[n, 1] * units[3] / inner_inertia[n]) if inner_inertia[n] > 0.0 else 1.0
        change = follows * (spin[n] - inner_spin[n])
        fluid_torque[n] = load_torque[n] * units[1] + inner_inertia[n] * change / step
        torque[n] += uptake[n, 1] * (fluid_torque[n] - torque[n])
        inner_spin[n] += change


class Coupled:
    """Fluid and grains in one box, lower left corner at the origin.

    hydraulic_ratio : lambda, radius the fluid sees over mechanical radius;  contact_steps : per fluid step;
    acceleration : of free fall, m/s²;  solid_operator, weighting : by name, see solid/choose.py and weighting.py;
    soft_rim : for what the fluid passes fast near tau = 1/2 (rim.py; the fluid inside is then that in the shrunk disc);
    lubrication : whether films below ``film_gap`` cells are corrected, between the radii the fluid sees.

    After a step: fluid_force (n, 2) N/m and fluid_torque (n,) N m/m, films not included: drag and lift;  force (n, 2)
    N/m, with the weight, and torque (n,) N m/m as the contact steps hold them;  contact_load(): of other discs, walls
    and plates.
    polygons : those among the frames of ``grains`` (immersed_polygons.py), None without; their corners, the last discs,
    have shares of force and torque, and none of the fluid inside.
    Held discs (grains.hold) go as the owner says; the fluid inside follows, ``inner_velocity`` and ``inner_spin``, and
    is given back as for free ones.  A step allocates no array but for a rebuild of the pair list, which looks for
    numbers that are none and may grow its buffers.
    """

    def __init__(
        self,
        fluid: Fluid,
        grains: Grains,
        scales: Scales,
        *,
        hydraulic_ratio: float,
        contact_steps: int,
        acceleration: tuple[float, float],
        solid_operator: str = "exact-wall",
        weighting: str | None = None,
        lubrication: bool = False,
        film_gap: float = CELLS,
        rectangles: Sequence[Rectangle] = (),
        soft_rim: bool = False,
    ) -> None:
        discs = grains.discs
        self.fluid, self.grains, self.scales, self.contact_steps = fluid, grains, scales, contact_steps
        self.hydraulic_radius = hydraulic_ratio * discs.radius
        self.polygons: ImmersedPolygons | None = None
        self._seen = seen = slice(discs.count - corners_of(grains))  # the discs that are no corners
        if seen.stop < discs.count:
            self.hydraulic_radius[seen.stop :] = 0.0
            self.polygons = ImmersedPolygons(
                grains, scales.spacing, scales.density, acceleration, LAYER * scales.spacing
            )  # fmt: skip
            if lubrication:
                raise InputError(Fault("lubrication", True, "knows no films between polygons", repair="leave it out"))
        self.saturated = Saturated(
            fluid, self.hydraulic_radius[seen] / scales.spacing, solid_operator=solid_operator, weighting=weighting,
            rectangles=rectangles, polygons=self.polygons.polygons if self.polygons else None, soft_rim=soft_rim,
        )  # fmt: skip
        covering = np.zeros(discs.count)
        covering[seen] = self.saturated.covering_radius * scales.spacing
        self.saturated.pairs = overlapping(grains, covering)
        inside = displaced(grains, self.hydraulic_radius, scales.density)
        self.inner_mass, self.inner_inertia = inside.mass.copy(), inside.inertia.copy()
        self.inner_mass[seen.stop :] = self.inner_inertia[seen.stop :] = 0.0
        self._inside = inside
        self.weight = buoyant_weight(grains, scales.density, acceleration)
        self.inner_velocity, self.inner_spin = discs.velocity.copy(), discs.spin.copy()
        self.inner_momentum = self.inner_mass[:, None] * discs.velocity
        self._centre, self._velocity = np.zeros((discs.count, 2)), np.zeros((discs.count, 2))
        self._spin = np.zeros(discs.count)
        self.force, self.fluid_force = np.zeros((discs.count, 2)), np.zeros((discs.count, 2))
        self.torque, self.fluid_torque = np.zeros(discs.count), np.zeros(discs.count)
        layer = LAYER * scales.spacing * inside.thinness[seen]
        solid, fluid_inside = whole(grains, discs.mass, discs.inertia), whole(grains, inside.mass, inside.inertia)
        lightness = np.column_stack([one / other for one, other in zip(solid, fluid_inside, strict=True)])
        self.uptake = np.ones((discs.count, 2))
        self.uptake[seen] = np.minimum(1.0, lightness[seen] / layer[:, None])
        mass_unit = scales.density * scales.spacing**2
        self._units = np.array([scales.force, scales.torque, mass_unit, mass_unit * scales.spacing**2])
        self.lubrication: Lubrication | None = None
        if lubrication:
            self.lubrication = Lubrication(
                grains, self.hydraulic_radius, viscosity=scales.density * scales.viscosity,
                cut=film_gap * scales.spacing, dt=scales.step / contact_steps,
            )  # fmt: skip

    def advance(self) -> None:
        """One fluid step and its contact steps."""
        discs, scales, wet, seen = self.grains.discs, self.scales, self.saturated, self._seen
        self._to_lattice()
        wet.advance(self.fluid, self._centre[seen], self._velocity[seen], self._spin[seen])
        if wet.rim is not None:
            square = (wet.covering_radius / wet.radius) ** 2
            self.inner_mass[seen] = self._inside.mass[seen] * square
            self.inner_inertia[seen] = self._inside.inertia[seen] * square**2
        total_load(
            wet.force, wet.torque, wet.inside, self.weight, discs.velocity, discs.spin[seen], self.inner_velocity,
            self.inner_spin, self.inner_mass, self.inner_inertia, self.uptake, scales.step, self._units,
            self.inner_momentum, self.fluid_force, self.fluid_torque, self.force, self.torque,
        )  # fmt: skip
        if self.polygons:
            p = self.polygons
            total_load(
                wet.polygon_load[:, :2], wet.polygon_load[:, 2], wet.polygon_inside, p.weight, p.velocity, p.spin,
                p.inner_velocity, p.inner_spin, p.inner_mass, p.inner_inertia, p.uptake, scales.step, self._units,
                p.inner_momentum, p.fluid_force, p.fluid_torque, p.force, p.torque,
            )  # fmt: skip
            p.hand_on(self.force, self.torque, self.fluid_force, self.fluid_torque)
        if self.lubrication is None:
            self.grains.step(scales.step / self.contact_steps, self.force, self.torque, self.contact_steps)
        else:
            self.lubrication.step(self.grains, self.force, self.torque, self.contact_steps)

    def _to_lattice(self) -> None:
        d, s = self.grains.discs, self.scales
        to_lattice(d.position, d.velocity, d.spin, s.spacing, s.step, self._centre, self._velocity, self._spin)
        if self.polygons:
            p, own = self.polygons, self.polygons.polygons
            to_lattice(p.position, p.velocity, p.spin, s.spacing, s.step, own.centre, own.velocity, own.spin)
            own.angle[:] = p.angle

    def contact_load(self) -> Array:
        """Force and torque of contacts on every disc, (n, 3) N/m, N/m, N m/m; a copy.

        Of the last contact step, and the mean over those of a fluid step where a component is held.
        """
        grains, d = self.grains, self.grains.discs
        met = np.column_stack((d.force, d.torque)) - np.column_stack((grains.external_force, grains.external_torque))
        if len(grains.held):
            given = np.column_stack((self.force, self.torque))
            if self.lubrication is not None:
                given[:, :2] += self.lubrication.force
            met = np.where(grains.held != 0, grains.withheld - given, met)
        return np.asarray(met)

    @property
    def rectangle_force(self) -> Array:
        """Force of the fluid on the rectangles, (m, 2) N/m, the fluid inside them given back."""
        return np.asarray(self.saturated.rectangle_force * self.scales.force)

    def fields(self) -> tuple[Array, Array, Array, Array]:
        """Density excess (kg/m³), velocity (m/s, two arrays) and solid fraction of every cell, each (ny, nx).

        Solid are the discs at the radius that the fluid sees, without what their rims need in the lattice.
        """
        self._to_lattice()
        wet, s = self.saturated, self.scales
        kept = wet.covering_radius, wet.rim
        wet.covering_radius, wet.rim = wet.radius, None
        if wet.polygons:
            wet.polygons.bare = True
        wet.cover(self._centre[self._seen], self._velocity[self._seen], self._spin[self._seen])
        wet.covering_radius, wet.rim = kept
        if wet.polygons:
            wet.polygons.bare = False
        solid = np.minimum(wet.solid, 1)
        rho, ux, uy = self.fluid.fields(None if wet.operator.force_everywhere else wet.weights())
        return (rho - 1) * s.density, ux * s.velocity, uy * s.velocity, solid

    def momentum(self) -> Array:
        """Conserved momentum, kg/s (per metre), (2,): fluid + discs - the fluid inside them and + virtual masses."""
        with_inside = self.grains.discs.mass @ self.grains.discs.velocity - self.inner_momentum.sum(axis=0)
        with_inside = with_inside + (1 / self.uptake[:, 0] - 1) @ self.force * self.scales.step
        if self.polygons:
            with_inside = with_inside + self.polygons.momentum(self.scales.step)
        px, py = self.fluid.momentum()
        unit = self.scales.density * self.scales.spacing**2 * self.scales.velocity
        return np.asarray(with_inside + unit * np.array([px, py]))

    def state(self) -> dict[str, Any]:
        """Everything needed to go on bit for bit; the cells are covered anew each step."""
        state = {
            "fluid": self.fluid.state(),
            "grains": self.grains.state(),
            "inner_velocity": self.inner_velocity,
            "inner_spin": self.inner_spin,
            "inner_momentum": self.inner_momentum,
            "force": self.force,
            "fluid_force": self.fluid_force,
            "torque": self.torque,
            "fluid_torque": self.fluid_torque,
            "saturated": self.saturated.state(),
        }
        return state | ({"polygons": self.polygons.state()} if self.polygons else {})

    def restore(self, state: dict[str, Any]) -> None:
        """Take up a state of a system made alike."""
        self.fluid.restore(state["fluid"])
        self.grains.restore(state["grains"])
        self.saturated.restore(state["saturated"])
        for name in (
            "inner_velocity",
            "inner_spin",
            "inner_momentum",
            "force",
            "fluid_force",
            "torque",
            "fluid_torque",
        ):
            getattr(self, name)[...] = state[name]
        if self.polygons:
            self.polygons.restore(state["polygons"])


def buoyant_weight(grains: Grains, fluid_density: float, acceleration: tuple[float, float]) -> Array:
    """(m - rho0 A) g of every disc with its mechanical area A, or its share of its clump's, (n, 2) N/m."""
    if fluid_density == 0.0:
        less = grains.discs.mass
    else:
        less = grains.discs.mass - displaced(grains, grains.discs.radius, fluid_density).mass
    return np.asarray(less[:, None] * np.asarray(acceleration, float))
