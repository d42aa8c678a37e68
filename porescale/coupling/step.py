"""One coupled step: cover, stream and collide, load, and the contact steps under the held load.

    1. the bodies' places and motion in lattice units           ``to_lattice``, immersed.py
    2. one step of the lattice with the bodies in it            ``SaturatedCells.advance``, psm.py
    3. what moves each body: the cells' sum, the fluid inside   ``total_load``, immersed.py
       given back, the weight less buoyancy
    4. contact steps under that load, films in each             ``Grains.step`` or ``Lubrication.step``

Partially saturated cells: Noble & Torczynski 1998; the held load between fluid steps: Feng, Han & Owen 2007.

The conserved momentum is  sum rho u + sum (m_p U - m_f V + m_v a dt).  The pressure is the reduced one, p + rho0 g y:
the fluid carries no weight, and each disc that of its mechanical area less the fluid's, (rho_s - rho0) A g.
"""

from collections.abc import Sequence
from typing import Any

import numpy as np

from porescale.common.core.errors import Fault, InputError
from porescale.common.core.types import AnyArray, Floats, Reals
from porescale.coupling.coverage.overlap import overlapping
from porescale.coupling.coverage.rectangle import Rectangle
from porescale.coupling.coverage.ring import Ring
from porescale.coupling.displaced import Displaced, displaced, of_whole_bodies
from porescale.coupling.immersed import INSIDE, LAYER, CellLoad, Immersed, to_lattice
from porescale.coupling.immersed_polygons import ImmersedPolygons, corners_of
from porescale.coupling.lubrication import CELLS, Lubrication
from porescale.coupling.psm import SaturatedCells
from porescale.coupling.solid.choose import solid_operator as solid_operator_of
from porescale.dem.bodies.rigid import body_of, clumps_of
from porescale.dem.grains import Grains
from porescale.lbm.boundary.sides import NAMES
from porescale.lbm.fluid import Fluid
from porescale.lbm.scales import Scales


class Coupled:
    """Fluid and grains in one box, lower left corner at the origin.

    hydraulic_ratio : lambda, hydraulic over mechanical radius;  contact_steps : per fluid step;
    acceleration : of free fall, m/s²;  solid_operator, weighting : by name, see solid/choose.py and
    weighting/choose.py;  soft_rim : for what the fluid passes fast near tau = 1/2 (coverage/soft_rim.py; the fluid
    inside is then that in the shrunk disc);  lubrication : whether films below ``film_gap`` cells are corrected,
    between the hydraulic radii.

    After a step: fluid_force (n, 2) N/m and fluid_torque (n,) N m/m, films not included: drag and lift;  push (n, 2)
    N/m: what a body force on the fluid does to the discs (push.py), on the area of the mechanical radius;  force (n, 2)
    N/m, with both and the weight, and torque (n,) N m/m as the contact steps hold them;  contact_load(): of other
    discs, walls and plates.
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
        rings: Sequence[Ring] = (),
        soft_rim: bool = False,
    ) -> None:
        self.fluid, self.grains, self.scales, self.contact_steps = fluid, grains, scales, contact_steps
        discs = grains.discs
        self._seen = seen = slice(discs.count - corners_of(grains))  # the discs that are no corners
        self.hydraulic_radius = hydraulic_ratio * discs.radius
        self.hydraulic_radius[seen.stop :] = 0.0
        self._least = INSIDE if solid_operator_of(solid_operator).turns_back else 0.0
        self.polygons = ImmersedPolygons(grains, scales, acceleration, self._least) if seen.stop < discs.count else None
        self.saturated = cells_of(fluid)(
            fluid, self.hydraulic_radius[seen] / scales.spacing, solid_operator=solid_operator, weighting=weighting,
            rectangles=rectangles, rings=rings, polygons=self.polygons.polygons if self.polygons else None,
            soft_rim=soft_rim,
        )  # fmt: skip
        covering = np.zeros(discs.count)
        covering[seen] = self.saturated.covering_radius * scales.spacing
        self.saturated.pairs = overlapping(grains, covering)
        self._displaced = displaced(grains, self.hydraulic_radius, scales.density)
        whole, thin = (displaced(grains, r, 1.0).mass[seen] for r in (discs.radius, self.hydraulic_radius))
        self.saturated.beyond[seen] = (whole - thin) / scales.spacing**2
        self._join(covering)
        self._set_immersed(buoyant_weight(grains, scales.density, acceleration))
        self._centre, self._velocity = np.zeros((discs.count, 2)), np.zeros((discs.count, 2))
        self._spin = np.zeros(discs.count)
        mass_unit = scales.density * scales.spacing**2
        self._units = np.array([scales.force, scales.torque, mass_unit, mass_unit * scales.spacing**2])
        self.lubrication: Lubrication | None = None
        if lubrication:
            if self.polygons:
                problem = "has no films between polygons: what the lattice lacks was measured between round surfaces"
                raise InputError(Fault("lubrication", True, problem, repair="leave it out"))
            self.saturated.body = body_of(grains)[seen]
            self.lubrication = Lubrication(
                grains, self.hydraulic_radius, viscosity=scales.density * scales.viscosity,
                spacing=scales.spacing, cut=film_gap * scales.spacing, dt=scales.step / contact_steps,
                shift=self.saturated.radius_shift * scales.spacing**2,
            )  # fmt: skip
            # Where fluid passes or slips the film is another one, and so is what the lattice lacks of it.
            sides = [name for name in NAMES if fluid.sides.boundary(name).no_slip]
            self.lubrication.walls = grains.walls[np.isin(grains.wall_names, sides)]

    def _join(self, covering: Floats) -> None:
        """Have a body force push clumps whose members overlap by their union: its cells are those of several members.

        Where the operator takes a force of its own share of a cell alone (push.py), clumps keep the sum of their cells,
        1.2 % of all that drives too much where a fifth of a clump overlaps.

        covering : (n,) m, the radii that the lattice is covered with.
        """
        wet, clumps = self.saturated, clumps_of(self.grains)
        members = [clumps.discs_of(c) for c in range(clumps.count)] if clumps and wet.operator.force_everywhere else []
        members = [own for own in members if np.isin(own, wet.pairs).any()]
        if members:
            wet.joined = np.concatenate(members)
            union = displaced(self.grains, covering, 1.0).mass[wet.joined] / self.scales.spacing**2
            wet.joined_area = union + wet.beyond[wet.joined]

    def _set_immersed(self, weight: Reals) -> None:
        """The discs' equation of motion, its arrays as this object's own."""
        discs, seen, inside = self.grains.discs, self._seen, self._displaced
        mass, inertia = inside.mass.copy(), inside.inertia.copy()
        mass[seen.stop :] = inertia[seen.stop :] = 0.0
        share = np.ones((discs.count, 2))
        share[seen] = response_share(self.grains, inside, self.scales.spacing, seen, self._least)
        self.immersed = it = Immersed(mass, inertia, discs.velocity, discs.spin, weight, share)
        if self._least > 0.0:
            whole = of_whole_bodies(self.grains, discs.mass, discs.inertia)[0]
            it.turn_back(whole[seen] / of_whole_bodies(self.grains, inside.mass, inside.inertia)[0][seen])
        self.weight, self.response_share = it.weight, it.response_share
        self.inner_mass, self.inner_inertia, self.inner_momentum = it.inner_mass, it.inner_inertia, it.inner_momentum
        self.inner_velocity, self.inner_spin = it.inner_velocity, it.inner_spin
        self.force, self.torque = it.force, it.torque
        self.fluid_force, self.fluid_torque, self.push = it.fluid_force, it.fluid_torque, it.push

    def advance(self) -> None:
        """Advance by one fluid step and its contact steps."""
        self.saturated.advance(self.fluid, *self._seen_motion())
        self._load_bodies()
        self._move_bodies()

    def _to_lattice(self) -> None:
        """Where the bodies are and how they move, in cells and steps."""
        d, s = self.grains.discs, self.scales
        to_lattice(d.position, d.velocity, d.spin, s.spacing, s.step, self._centre, self._velocity, self._spin)
        if self.polygons:
            p, own = self.polygons, self.polygons.polygons
            to_lattice(p.position, p.velocity, p.spin, s.spacing, s.step, own.centre, own.velocity, own.spin)
            own.angle[:] = p.angle

    def _load_bodies(self) -> None:
        """What moves every body, from the loads of its cells."""
        discs, wet, seen, step = self.grains.discs, self.saturated, self._seen, self.scales.step
        if wet.soft_rim is not None:
            square = (wet.covering_radius / wet.radius) ** 2
            self.inner_mass[seen] = self._displaced.mass[seen] * square
            self.inner_inertia[seen] = self._displaced.inertia[seen] * square**2
        self._take_push()
        cells = CellLoad(wet.force, wet.torque, wet.entrained)
        self.immersed.respond(cells, self._units, discs.velocity, discs.spin[seen], step, self.grains.held)
        if self.polygons:
            p = self.polygons
            cells = CellLoad(wet.polygon_load[:, :2], wet.polygon_load[:, 2], wet.polygon_entrained)
            p.respond(cells, self._units, p.velocity, p.spin, step, p.held)
            p.distribute(self.immersed)

    def _take_push(self) -> None:
        """What the body force on the fluid does to discs and polygons, N/m."""
        wet = self.saturated
        if wet.driven:
            np.multiply(wet.disc_push, self._units[0], out=self.push[self._seen])
            if self.polygons:
                np.multiply(wet.polygon_push, self._units[0], out=self.polygons.push)

    def _move_bodies(self) -> None:
        """The contact steps, under the load of the fluid step."""
        if self.lubrication is None:
            self.grains.step(self.scales.step / self.contact_steps, self.force, self.torque, self.contact_steps)
        else:
            self.lubrication.step(self.grains, self.force, self.torque, self.contact_steps)

    def contact_load(self) -> Reals:
        """Force and torque of contacts on every disc, (n, 3) N/m, N/m, N m/m; a copy.

        Of the last contact step, and the mean over those of a fluid step where a component is held.
        """
        grains, d = self.grains, self.grains.discs
        load = np.column_stack((d.force, d.torque)) - np.column_stack((grains.external_force, grains.external_torque))
        if len(grains.held):
            given = np.column_stack((self.force, self.torque))
            if self.lubrication is not None:
                given[:, :2] += self.lubrication.force
            load = np.where(grains.held != 0, grains.withheld - given, load)
        return np.asarray(load)

    @property
    def rectangle_force(self) -> Reals:
        """Force of the fluid on the rectangles with the push, (m, 2) N/m, the fluid inside them given back."""
        wet = self.saturated
        return np.asarray((wet.rectangle_force + wet.rectangle_push) * self.scales.force)

    @property
    def ring_load(self) -> Reals:
        """Force, with the push, and torque of the fluid on the rings, (m, 3) N/m, N/m, N m/m, inside given back."""
        wet, s = self.saturated, self.scales
        return np.column_stack(((wet.ring_force + wet.ring_push) * s.force, wet.ring_torque * s.torque))

    def fields(self) -> tuple[Reals, Reals, Reals, Reals]:
        """Density excess (kg/m³), velocity (m/s, two arrays) and solid fraction of every cell, each (ny, nx).

        Velocities are those of fluid and solid together, halfway through a step (`SaturatedCells.flow`).  Solid are the
        discs at the hydraulic radius, without what their rims need in the lattice.
        """
        s = self.scales
        motion = self._seen_motion()
        rho, jx, jy = self.saturated.flow(self.fluid, *motion)
        self.saturated.cover(*motion, bare=True)
        solid = np.minimum(self.saturated.solid, 1)
        return (rho - 1) * s.density, jx / rho * s.velocity, jy / rho * s.velocity, solid

    def solid_flow(self) -> tuple[Reals, Reals]:
        """Solid fraction times velocity of the solid in every cell, m/s, two arrays (ny, nx); discs as in `fields`."""
        self.saturated.cover(*self._seen_motion(), bare=True)
        share = self.scales.velocity / np.maximum(self.saturated.solid, 1)  # grains that overlap fill a cell once
        return self.saturated.covered[1] * share, self.saturated.covered[2] * share

    def start_inside(self, velocity: tuple[float, float]) -> None:
        """Start from fluid that goes at ``velocity``, m/s, and within bodies with them, as ``inner_velocity`` has it.

        Where it stood still instead, a body let go would lose to it, in the first steps, the share of its momentum and
        spin that this fluid takes: all of them at the density of the fluid.
        """
        inside = self.solid_flow()
        free = 1 - np.minimum(self.saturated.solid, 1)
        speed = self.scales.velocity
        self.fluid.set_flow(*((free * u + v) / speed for u, v in zip(velocity, inside, strict=True)))

    def set_free_apart(self, velocity: tuple[float, float]) -> bool:
        """Whether some body that is free starts with a spin, or not with the ``velocity`` of the fluid, m/s."""
        discs, seen = self.grains.discs, self._seen
        apart = starts_apart(discs.velocity[seen], discs.spin[seen], self.grains.held, velocity)
        p = self.polygons
        return apart or (p is not None and starts_apart(p.velocity, p.spin, p.held, velocity))

    def _seen_motion(self) -> tuple[Reals, Reals, Reals]:
        """Centre (n, 2), velocity (n, 2) and spin (n,) of the discs in the lattice, lattice units."""
        self._to_lattice()
        return self._centre[self._seen], self._velocity[self._seen], self._spin[self._seen]

    def momentum(self) -> Reals:
        """Conserved momentum, kg/s (per metre), (2,): fluid + discs - the fluid inside + virtual masses + load under
        way."""
        with_inside = self.grains.discs.mass @ self.grains.discs.velocity - self.inner_momentum.sum(axis=0)
        with_inside = with_inside + self.immersed.virtual_momentum(self._units, self.scales.step)
        if self.polygons:
            with_inside = with_inside + self.polygons.momentum(self._units, self.scales.step)
        px, py = self.fluid.momentum()
        unit = self.scales.density * self.scales.spacing**2 * self.scales.velocity
        return np.asarray(with_inside + unit * np.array([px, py]))

    def state(self) -> dict[str, Any]:
        """Everything needed to go on bit for bit; the cells are covered anew each step."""
        state = {
            "fluid": self.fluid.state(),
            "grains": self.grains.state(),
            "saturated": self.saturated.state(),
            **self.immersed.state(),
        }
        return state | ({"polygons": self.polygons.state()} if self.polygons else {})

    def restore(self, state: dict[str, Any]) -> None:
        """Restore a state of a system with the same setup.

        The push is found anew, where the bodies are: a step's is that where they began it, which is the same but for
        the motion of one step.  Of rectangles and rings, the rest of the load is 0 until the next step.
        """
        self.fluid.restore(state["fluid"])
        self.grains.restore(state["grains"])
        self.saturated.restore(state["saturated"])
        self.immersed.restore(state)
        if self.polygons:
            self.polygons.restore(state["polygons"])
        if self.fluid.step:
            self.saturated.find_push(self.fluid, *self._seen_motion())
            self._take_push()
            if self.polygons:
                self.polygons.distribute(self.immersed)


def starts_apart(velocity: Reals, spin: Reals, held: AnyArray, flow: tuple[float, float]) -> bool:
    """Whether a component that is not held of bodies' velocity (n, 2), m/s, and spin (n,), rad/s, differs from that of
    a uniform ``flow``;  held: (n or more, 3) flags, or none."""
    differs = np.column_stack((np.not_equal(velocity, flow), np.not_equal(spin, 0.0)))
    return bool((differs & (held[: len(spin)] == 0) if len(held) else differs).any())


def cells_of(fluid: Fluid) -> type[SaturatedCells]:
    """The class of partially saturated cells of a fluid; nothing of a GPU is imported for one on the CPU."""
    if not fluid.on_device:
        return SaturatedCells
    from porescale.coupling.device.cells import DeviceSaturatedCells

    return DeviceSaturatedCells


def response_share(grains: Grains, inside: Displaced, spacing: float, seen: slice, least: float) -> Reals:
    """Share m_p/(m_p + m_v) of a change of force, and of torque, that each of the discs ``seen`` takes up in a step,
    (n, 2).

    spacing m, of cells;  least: of all the fluid inside, see immersed.py.  Cells act at their middles: discs smaller
    than a cell have fluid half a diagonal off, whose moment of inertia is more than that of their own area.
    """
    thick = np.maximum(LAYER * spacing * inside.thinness[seen], least)
    solid = of_whole_bodies(grains, grains.discs.mass, grains.discs.inertia)
    fluid = of_whole_bodies(grains, inside.mass, np.maximum(inside.inertia, 0.5 * inside.mass * spacing**2))
    ratio = np.column_stack([one / other for one, other in zip(solid, fluid, strict=True)])
    return np.asarray(np.minimum(1.0, ratio[seen] / thick[:, None]))


def buoyant_weight(grains: Grains, fluid_density: float, acceleration: tuple[float, float]) -> Reals:
    """(m - rho0 A) g of every disc with its mechanical area A, or its share of its clump's, (n, 2) N/m."""
    if fluid_density == 0.0:
        less = grains.discs.mass
    else:
        less = grains.discs.mass - displaced(grains, grains.discs.radius, fluid_density).mass
    return np.asarray(less[:, None] * np.asarray(acceleration, float))
