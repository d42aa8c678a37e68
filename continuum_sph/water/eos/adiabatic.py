"""Adiabatic gas: p = p0 {(ρ/ρ0)^γ - 1}, p0 the pressure of the air, at which it has its density ρ0.

Source: the same form as a liquid's with B = p0; γ is the ratio of the specific heats.
"""

from dataclasses import dataclass
from typing import ClassVar, NamedTuple, Self

import numpy as np

from continuum_sph.water.eos.law import Given, pressure_of
from continuum_sph.water.eos.liquid import tait
from porescale.common.core.ranges import Range, require_in_range
from porescale.common.core.types import Floats

EXPONENT = 1.403
RANGES = {"density": Range("kg/m^3", gt=0), "base": Range("Pa", gt=0), "exponent": Range(gt=1)}
"""What the numbers may be."""
FLOOR = 0.01  # of ρ0: a bubble that has left the water keeps spreading; pressures stay numbers


class AdiabaticNumbers(NamedTuple):
    """ρ0 kg/m³, c0 m/s, least density kg/m³, p0 Pa, γ."""

    density: float
    sound_speed: float
    least_density: float
    base: float
    exponent: float


@pressure_of.of(AdiabaticNumbers)
def pressure_of_gas(ratio, law):
    """Pressure above p0 (Pa) and (c/c0)² at ``ratio`` ρ/ρ0, see `liquid.tait`."""
    return tait(ratio, law.base, law.exponent)


@dataclass(frozen=True)
class AdiabaticGas:
    """density : ρ0, kg/m³, > 0, at the pressure p0;  base : p0, Pa, > 0;  exponent : γ, > 1.  InputError for others."""

    gas: ClassVar[bool] = True

    density: float
    base: float
    exponent: float = EXPONENT

    def __post_init__(self) -> None:
        require_in_range("gas", vars(self), RANGES)

    @classmethod
    def of(cls, given: Given) -> Self:
        """A gas under the pressure of the air."""
        return cls(given.density, given.pressure, given.exponent or EXPONENT)

    @property
    def sound_speed(self) -> float:
        """c0, m/s, at ρ0: √(γ p0/ρ0)."""
        return float((self.exponent * self.base / self.density) ** 0.5)

    @property
    def stiffness(self) -> float:
        """p0, Pa, which stands where a liquid has B."""
        return self.base

    @property
    def least_density(self) -> float:
        """Least density of the fluid, kg/m³."""
        return FLOOR * self.density

    @property
    def numbers(self) -> AdiabaticNumbers:
        """The numbers of this equation of state that kernels take."""
        return AdiabaticNumbers(self.density, self.sound_speed, self.least_density, self.base, self.exponent)

    def pressure(self, density: Floats) -> Floats:
        """Pressure above p0, Pa."""
        found: Floats = self.base * ((density / self.density) ** self.exponent - 1.0)
        return found

    def density_at(self, pressure: Floats) -> Floats:
        """Density (kg/m³) at a pressure (Pa) above p0."""
        found: Floats = self.density * (1.0 + pressure / self.base) ** (1.0 / self.exponent)
        return found

    def sound_speed_at(self, density: Floats) -> Floats:
        """Speed of sound at a density (kg/m³): c0 (ρ/ρ0)^((γ-1)/2), m/s."""
        speed: Floats = self.sound_speed * np.maximum(density / self.density, 0.0) ** (0.5 * (self.exponent - 1.0))
        return speed

    def energy(self, density: Floats) -> Floats:
        """Work of compression against p0 per mass from ρ0 on, J/kg: p0/{ρ0(γ-1)} {r^(γ-1) + (γ-1)/r - γ}."""
        ratio, more = density / self.density, self.exponent - 1.0
        work: Floats = self.base / self.density / more * (ratio**more + more / ratio - self.exponent)
        return work


LAW = AdiabaticGas
