"""One coupled step: cover, stream and collide, load, and the contact steps under the held load.

The fluid inside a disc is dragged along, so the sum over its cells contains -m_f dU/dt, m_f = rho0 pi R_h²; it is given
back with the last known acceleration, (U^n - U^(n-1))/dt, likewise for rotation with m_f R_h²/2 (a rigid disc of
fluid).  The conserved momentum is then  sum rho u + sum (m_p U^n - m_f U^(n-1)).  The pressure is the reduced one,
p + rho0 g y: the fluid carries no weight, and each disc that of its mechanical area less the fluid's,
(rho_s - rho0) A g.
"""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from porescale.coupling.lubrication import CELLS, Lubrication
from porescale.coupling.saturated import Saturated
from porescale.dem.system import Grains
from porescale.ground.jit import kernel
from porescale.lbm.fluid import Fluid
from porescale.lbm.scales import Scales

Array = NDArray[np.floating]


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
    load, load_torque, weight, velocity, spin, old_velocity, old_spin, inner_mass, inner_inertia, step, force_unit,
    torque_unit, fluid_force, torque, force,
):  # fmt: skip
    """What the fluid does to every disc, the inner mass given back, and with the weight; then remember the velocity.

    load (n, 2), load_torque (n,): lattice units, of force_unit N/m and torque_unit N m/m;  weight (n, 2) N/m;
    velocity m/s, spin rad/s;  inner_mass (n,) kg/m, inner_inertia (n,) kg m²/m;  step s.  Overwrites fluid_force and
    force (n, 2) N/m, torque (n,) N m/m, old_velocity and old_spin.
    """
    for n in range(spin.shape[0]):
        for a in range(2):
            rate = (velocity[n, a] - old_velocity[n, a]) / step
            fluid_force[n, a] = load[n, a] * force_unit + inner_mass[n] * rate
            force[n, a] = weight[n, a] + fluid_force[n, a]
            old_velocity[n, a] = velocity[n, a]
        torque[n] = load_torque[n] * torque_unit + inner_inertia[n] * (spin[n] - old_spin[n]) / step
        old_spin[n] = spin[n]


class Coupled:
    """Fluid and grains in one box, lower left corner at the origin.

    hydraulic_ratio : lambda, radius the fluid sees over mechanical radius;  contact_steps : per fluid step;
    acceleration : of free fall, m/s²;  solid_operator, weighting : by name, see solid/choose.py and weighting.py;
    lubrication : whether films below ``film_gap`` cells are corrected, between the radii the fluid sees.

    After a step: fluid_force (n, 2) N/m and torque (n,) N m/m of the fluid, films not included: drag and lift;
    force (n, 2) N/m: with the weight, as the contact steps hold it;  contact_load(): of other discs, walls and plates.
    Held discs (grains.hold) go as the owner says; ``old_velocity`` knows what they did before, so that the fluid inside
    them is given back as for free ones.  A step allocates no array but for a rebuild of the pair list, which looks for
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
    ) -> None:
        discs = grains.discs
        self.fluid, self.grains, self.scales, self.contact_steps = fluid, grains, scales, contact_steps
        self.hydraulic_radius = hydraulic_ratio * discs.radius
        self.saturated = Saturated(
            fluid, self.hydraulic_radius / scales.spacing, solid_operator=solid_operator, weighting=weighting
        )
        self.inner_mass = scales.density * np.pi * self.hydraulic_radius**2
        self.inner_inertia = 0.5 * self.inner_mass * self.hydraulic_radius**2
        self.weight = buoyant_weight(grains, scales.density, acceleration)
        self.old_velocity, self.old_spin = discs.velocity.copy(), discs.spin.copy()
        self._centre, self._velocity = np.zeros((discs.count, 2)), np.zeros((discs.count, 2))
        self._spin = np.zeros(discs.count)
        self.force, self.fluid_force = np.zeros((discs.count, 2)), np.zeros((discs.count, 2))
        self.torque = np.zeros(discs.count)
        self.lubrication: Lubrication | None = None
        if lubrication:
            self.lubrication = Lubrication(
                grains, self.hydraulic_radius, viscosity=scales.density * scales.viscosity,
                cut=film_gap * scales.spacing, dt=scales.step / contact_steps,
            )  # fmt: skip

    def advance(self) -> None:
        """One fluid step and its contact steps."""
        discs, scales, wet = self.grains.discs, self.scales, self.saturated
        self._to_lattice()
        wet.advance(self.fluid, self._centre, self._velocity, self._spin)
        total_load(
            wet.force, wet.torque, self.weight, discs.velocity, discs.spin, self.old_velocity, self.old_spin,
            self.inner_mass, self.inner_inertia, scales.step, scales.force, scales.torque, self.fluid_force,
            self.torque, self.force,
        )  # fmt: skip
        if self.lubrication is None:
            self.grains.step(scales.step / self.contact_steps, self.force, self.torque, self.contact_steps)
        else:
            self.lubrication.step(self.grains, self.force, self.torque, self.contact_steps)

    def _to_lattice(self) -> None:
        d, s = self.grains.discs, self.scales
        to_lattice(d.position, d.velocity, d.spin, s.spacing, s.step, self._centre, self._velocity, self._spin)

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

    def fields(self) -> tuple[Array, Array, Array, Array]:
        """Density excess (kg/m³), velocity (m/s, two arrays) and solid fraction of every cell, each (ny, nx)."""
        self._to_lattice()
        self.saturated.cover(self._centre, self._velocity, self._spin)
        solid = np.minimum(self.saturated.solid, 1)
        rho, ux, uy = self.fluid.fields(self.saturated.weights())
        s = self.scales
        return (rho - 1) * s.density, ux * s.velocity, uy * s.velocity, solid

    def momentum(self) -> Array:
        """Conserved momentum, kg/s (per metre): fluid + discs - the fluid inside them at the last step, (2,)."""
        with_inside = self.grains.discs.mass @ self.grains.discs.velocity - self.inner_mass @ self.old_velocity
        px, py = self.fluid.momentum()
        unit = self.scales.density * self.scales.spacing**2 * self.scales.velocity
        return np.asarray(with_inside + unit * np.array([px, py]))

    def state(self) -> dict[str, Any]:
        """Everything needed to go on bit for bit; the cells are covered anew each step."""
        return {
            "fluid": self.fluid.state(),
            "grains": self.grains.state(),
            "old_velocity": self.old_velocity,
            "old_spin": self.old_spin,
            "force": self.force,
            "fluid_force": self.fluid_force,
            "torque": self.torque,
            "saturated": self.saturated.state(),
        }

    def restore(self, state: dict[str, Any]) -> None:
        """Take up a state of a system made alike."""
        self.fluid.restore(state["fluid"])
        self.grains.restore(state["grains"])
        self.saturated.restore(state["saturated"])
        for name in ("old_velocity", "old_spin", "force", "fluid_force", "torque"):
            getattr(self, name)[...] = state[name]


def buoyant_weight(grains: Grains, fluid_density: float, acceleration: tuple[float, float]) -> Array:
    """(m - rho0 A) g of every disc with its mechanical area A, (n, 2) N/m."""
    less = grains.discs.mass - fluid_density * grains.discs.area
    return np.asarray(less[:, None] * np.asarray(acceleration, float))
