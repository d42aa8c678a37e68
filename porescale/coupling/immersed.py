"""The equation of motion of bodies in fluid: what moves each, and the fluid inside it.

The fluid inside a disc is dragged along, so the sum over its cells contains -m_f dU/dt, m_f = rho0 pi R_h²; it is given
back with the acceleration of the step before, likewise for rotation with m_f R_h²/2 (a rigid disc of fluid).  Of the
inside no more than S, the sum of B rho, takes the disc's velocity within a step; more given back at once drives light
discs.  So the velocity V of the fluid inside follows,  V += beta (U - V), beta = 0.9 min(1, S/m_f),  and m_f dV/dt is
given back.

The layer of fluid around a light disc that responds within a step makes it oscillate.  It is given that layer as a
virtual mass on both sides of its equation of motion, on the right with the acceleration of the step before (Schwarz,
Kempe & Froehlich 2015, J. Comput. Phys. 281, 591):  (m_p + m_v) a^n = F + m_v a^(n-1);  m_v = 2 pi R_h times 3/4 of a
cell, less m_p.  The force m_p a^n that moves it then changes by a share m_p/(m_p + m_v) a step; heavier discs, with
m_v <= 0, take up all of it.

All of it is in ``total_load``, line by line: follows is beta, response_share is m_p/(m_p + m_v).

Where full cells turn populations back (b = 2) what their momentum j lacks of rho v, d = j - rho v, changes sign each
step, d' = -d - rho dv, and the load is 2 d a cell.  It moves a body of density ratio s by dv = 2 d/s: then
d' = -(1 + 2/s) d grows whatever s is, and with a virtual mass too.  With a share p of the step's load and 1 - p of that
before it, dv = 2 (p d + (1 - p) d_before)/s, the roots of x² + (1 + 2p/s) x + 2 (1 - p)/s = 0 are within 1 where
p < 1/2 and s > 2 (1 - p); for lighter ones the virtual mass is raised until m_p + m_v is some mass of the fluid inside,
which all answers.  These are NOW and INSIDE; from HEAVY on p = 1/2, with roots -1 and -1/s, and where a body is
held, which drives nothing.  What is still under way is momentum, 1 - p of the last load.
"""

from typing import Any, NamedTuple

import numpy as np

from porescale.common.compiled.jit import kernel
from porescale.common.core.types import AnyArray, Reals

FOLLOWING = 0.9
"""Share of S/m_f with which the fluid inside follows: 1 lets discs of density ratio 0.1 run away."""
LAYER = 0.75
"""Thickness in cells of the layer that answers within a step: sound's 0.58, and what viscosity adds.  Without it discs
of density ratio 0.3 run away at 6 cells per diameter, 0.2 at 10, 0.1 at 16."""
NOW = 0.45
"""Share p of a step's load that acts in it where full cells turn populations back: 1/2 and more damps nothing."""
HEAVY = 10.0
"""Density ratio from which on p is 1/2: such a body hardly damps the change of sign; its load is free of it then."""
INSIDE = 1.5
"""Least m_p + m_v over the mass of the fluid inside, there, and of moments of inertia: with 1 a disc of density ratio
0.8, shot at Mach 0.1 at tau 0.505, runs away."""
CARRIED = ("inner_velocity", "inner_spin", "inner_momentum", "force", "fluid_force", "torque", "fluid_torque")
"""What goes on from step to step, and its keys in a checkpoint."""


class CellLoad(NamedTuple):
    """Sums over the cells of bodies, lattice units: force (n, 2), torque (n,), and entrained (n, 2), mass and moment of
    inertia of the fluid that answers within a step."""

    force: Reals
    torque: Reals
    entrained: Reals


class InnerFluid(NamedTuple):
    """The fluid inside bodies: mass (n,) kg/m, inertia (n,) kg m²/m, velocity (n, 2) m/s, spin (n,) rad/s and
    momentum (n, 2) kg/s."""

    mass: Reals
    inertia: Reals
    velocity: Reals
    spin: Reals
    momentum: Reals


class BodyLoad(NamedTuple):
    """Loads on bodies: of the fluid, fluid_force (n, 2) N/m and fluid_torque (n,) N m/m, and what moves them, force and
    torque."""

    fluid_force: Reals
    fluid_torque: Reals
    force: Reals
    torque: Reals


@kernel
def to_lattice(position, velocity, spin, spacing, step, centre, lattice_velocity, lattice_spin):
    """SI position (n, 2) m, velocity m/s, spin rad/s into cells and lattice units; overwrites the last three."""
    scale = step / spacing
    for n in range(spin.shape[0]):
        for a in range(2):
            centre[n, a] = position[n, a] / spacing
            lattice_velocity[n, a] = velocity[n, a] * scale
        lattice_spin[n] = spin[n] * step


@kernel
def part_of_two_steps(force, torque, now, held, under_way, acting):
    """Load that acts in a step: a share ``now`` (n,) of its own, half of a ``held`` component's, and what is under way.

    force (n, 2), torque (n,): of the step;  held: (n, 3) flags, or none.  Overwrites acting (n, 3) and, with
    what comes next, under_way (n, 3).
    """
    for n in range(torque.shape[0]):
        for a in range(3):
            own = force[n, a] if a < 2 else torque[n]
            share = 0.5 if n < held.shape[0] and held[n, a] != 0 else now[n]
            acting[n, a] = share * own + under_way[n, a]
            under_way[n, a] = (1.0 - share) * own


@kernel
def total_load(cells, units, velocity, spin, given, response_share, step, inner, load):
    """What the fluid does to every body, the inner mass given back, and with the weight.

    cells: ``CellLoad``, lattice units, of ``units`` (4,) N/m, N m/m, kg/m, kg m²/m;  velocity (n, 2) m/s, spin (n,)
    rad/s;  given: weight and push, each (n, 2) N/m;  response_share (n, 2): share of a change of force, and of torque,
    taken up in a step;  step s.  Overwrites velocity, spin and momentum of inner, ``InnerFluid``, and load,
    ``BodyLoad``.
    """
    entrained = cells.entrained
    weight, push = given
    for n in range(spin.shape[0]):
        mass, inertia = inner.mass[n], inner.inertia[n]
        follows = FOLLOWING * min(1.0, entrained[n, 0] * units[2] / mass) if mass > 0.0 else 1.0
        for a in range(2):
            change = follows * (velocity[n, a] - inner.velocity[n, a])
            load.fluid_force[n, a] = cells.force[n, a] * units[0] + mass * change / step
            acting = weight[n, a] + (load.fluid_force[n, a] + push[n, a])
            load.force[n, a] += response_share[n, 0] * (acting - load.force[n, a])
            inner.velocity[n, a] += change
            inner.momentum[n, a] += mass * change
        follows = FOLLOWING * min(1.0, entrained[n, 1] * units[3] / inertia) if inertia > 0.0 else 1.0
        change = follows * (spin[n] - inner.spin[n])
        load.fluid_torque[n] = cells.torque[n] * units[1] + inertia * change / step
        load.torque[n] += response_share[n, 1] * (load.fluid_torque[n] - load.torque[n])
        inner.spin[n] += change


class Immersed:
    """Bodies in fluid, all discs or all polygons, as their equation of motion has them; SI units.

    weight (n, 2) N/m, less buoyancy;  response_share (n, 2);  inner_mass, inner_inertia (n,), inner_velocity,
    inner_spin, inner_momentum: see ``InnerFluid``;  push (n, 2) N/m: what the body force on the fluid does to
    bodies, set by the owner before each ``respond``;  fluid_force, fluid_torque, force, torque: see ``BodyLoad``;
    under_way (n, 3) lattice units: what of the cells' last load acts with the next step, 0 unless ``turns_back``.
    """

    def __init__(
        self, mass: Reals, inertia: Reals, velocity: Reals, spin: Reals, weight: Reals, response_share: Reals
    ) -> None:
        """mass, inertia (n,): of the fluid inside, which starts with the velocity and spin of the bodies."""
        n = len(mass)
        self.weight, self.response_share = weight, response_share
        self.inner_mass, self.inner_inertia = mass, inertia
        self.inner_velocity, self.inner_spin = velocity.copy(), spin.copy()
        self.inner_momentum = mass[:, None] * velocity
        self.fluid_force, self.fluid_torque = np.zeros((n, 2)), np.zeros(n)
        self.push = np.zeros((n, 2))
        self.force, self.torque = np.zeros((n, 2)), np.zeros(n)
        self.under_way, self._acting, self._now = np.zeros((n, 3)), np.zeros((n, 3)), np.ones(n)
        self.turns_back = False
        self._inner = InnerFluid(
            self.inner_mass, self.inner_inertia, self.inner_velocity, self.inner_spin, self.inner_momentum
        )
        self._load = BodyLoad(self.fluid_force, self.fluid_torque, self.force, self.torque)

    def turn_back(self, ratio: Reals) -> None:
        """From now on a part of two steps' loads acts;  ratio (n,): mass over that of the fluid inside."""
        self.turns_back, self._now[: len(ratio)] = True, np.where(ratio < HEAVY, NOW, 0.5)

    def respond(self, cells: CellLoad, units: Reals, velocity: Reals, spin: Reals, step: float, held: AnyArray) -> None:
        """The loads of a fluid step, from the cells' sums and the bodies' motion (m/s, rad/s); step: s;  held: flags of
        their components, (n, 3), or none."""
        if self.turns_back:
            part_of_two_steps(cells.force, cells.torque, self._now, held, self.under_way, self._acting)
            cells = CellLoad(self._acting[:, :2], self._acting[:, 2], cells.entrained)
        total_load(
            cells, units, velocity, spin, (self.weight, self.push), self.response_share, step, self._inner, self._load
        )  # fmt: skip

    def virtual_momentum(self, units: Reals, step: float) -> Reals:
        """Momentum of the virtual masses, m_v a dt, and what is under way, (2,) kg/s;  units: of ``total_load``."""
        coming = units[0] * self.under_way[:, :2].sum(axis=0)
        return np.asarray(((1 / self.response_share[:, 0] - 1) @ self.force + coming) * step)

    def state(self) -> dict[str, Any]:
        """What the next step takes from those before."""
        state = {name: getattr(self, name) for name in CARRIED}
        return state | ({"load_under_way": self.under_way} if self.turns_back else {})

    def restore(self, state: dict[str, Any]) -> None:
        """Restore a state of the same bodies."""
        for name in CARRIED:
            getattr(self, name)[...] = state[name]
        if self.turns_back:
            self.under_way[...] = state["load_under_way"]
