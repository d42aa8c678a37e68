"""SI at the door: one lattice spacing, one step and one density turn SI into lattice units and back.

Spacing h, step dt, relaxation time tau and viscosity nu are tied by  nu = (tau - 1/2)/3 · h²/dt:  any three give the
fourth, and four must agree.
"""

from dataclasses import dataclass

AGREEMENT = 1e-3
"""Relative difference up to which four given values count as the same: input rounded to four digits."""

NAMES = ("spacing", "step", "relaxation_time", "viscosity")


@dataclass(frozen=True)
class Scales:
    """spacing : h, m;  step : dt, s;  relaxation_time : tau;  density : of the fluid at rest, kg/m³."""

    spacing: float
    step: float
    relaxation_time: float
    density: float = 1000.0

    @property
    def viscosity(self) -> float:
        """Kinematic viscosity of the fluid, m²/s."""
        return (self.relaxation_time - 0.5) / 3 * self.spacing**2 / self.step

    @property
    def velocity(self) -> float:
        """m/s of one lattice unit of velocity, h/dt."""
        return self.spacing / self.step

    @property
    def sound_speed(self) -> float:
        """Speed of sound on the lattice, m/s."""
        return self.velocity / 3**0.5

    @property
    def pressure(self) -> float:
        """Pa of one lattice unit of density: rho0 c_s²."""
        return self.density * self.velocity**2 / 3

    @property
    def force(self) -> float:
        """N/m (per metre of depth) of one lattice unit of force, rho0 h³/dt²."""
        return self.density * self.spacing**3 / self.step**2

    @property
    def torque(self) -> float:
        """N m/m of one lattice unit of torque, rho0 h⁴/dt²."""
        return self.force * self.spacing

    @property
    def body_force(self) -> float:
        """N/m³ of one lattice unit of force density, rho0 h/dt²."""
        return self.density * self.spacing / self.step**2


def implied(
    *,
    spacing: float | None = None,
    step: float | None = None,
    relaxation_time: float | None = None,
    viscosity: float | None = None,
) -> dict[str, float]:
    """Each of the four that the other three imply, where those three are given (SI; tau without unit).

    A relaxation time of at most 1/2 implies no spacing, step or viscosity.
    """
    out: dict[str, float] = {}
    spread = None if relaxation_time is None else relaxation_time - 0.5
    if spread is not None and spread > 0:
        if spacing and step:
            out["viscosity"] = spread / 3 * spacing**2 / step
        if spacing and viscosity:
            out["step"] = spread / 3 * spacing**2 / viscosity
        if step and viscosity:
            out["spacing"] = (3 * viscosity * step / spread) ** 0.5
    if spacing and step and viscosity:
        out["relaxation_time"] = 0.5 + 3 * viscosity * step / spacing**2
    return out
