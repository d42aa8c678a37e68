"""Liquid: p = B {(ρ/ρ0)^γ - 1}, B = ρ0 c0²/γ.

Source: Tait's equation in the form of Cole 1948 and Monaghan 1994, eq. 41 of Maeda & Sakai 2004.  There B is the
pressure of the air p0 = 100 kPa, which makes water as soft as c0 = √(γ p0/ρ0) = 26 m/s; here B follows from the speed
of sound c0, which must exceed ten times the fastest flow for a Mach number below 0.1 and density changes below 1 %.
"""

from dataclasses import dataclass
from typing import ClassVar, NamedTuple, Self

import numpy as np

from continuum_sph.water.eos.law import Given, pressure_of
from porescale.common.compiled.jit import inline
from porescale.common.core.ranges import Range, require_in_range
from porescale.common.core.types import Floats

EXPONENT = 7.0
RANGES = {"density": Range("kg/m^3", gt=0), "sound_speed": Range("m/s", gt=0), "exponent": Range(gt=1)}
"""What the numbers may be.  The work of compression and the density at rest are not those of γ = 1."""
FLOOR = 0.8  # of ρ0: least density, far below any that water at Mach 0.1 has


class TaitNumbers(NamedTuple):
    """ρ0 kg/m³, c0 m/s, least density kg/m³, B Pa, γ."""

    density: float
    sound_speed: float
    least_density: float
    stiffness: float
    exponent: float


@inline
def tait(ratio, stiffness, exponent):
    """Pressure (Pa) and (ρ/ρ0)^(γ-1), which is (c/c0)², at ``ratio`` ρ/ρ0;  ``stiffness`` B, Pa."""
    if exponent == 7.0:
        square = ratio * ratio
        power = square * square * square
    else:
        power = ratio ** (exponent - 1.0)
    return stiffness * (power * ratio - 1.0), power


@pressure_of.of(TaitNumbers)
def pressure_of_tait(ratio, law):
    """Pressure above that of the air (Pa) and (c/c0)² at ``ratio`` ρ/ρ0, see `tait`."""
    return tait(ratio, law.stiffness, law.exponent)


@dataclass(frozen=True)
class Tait:
    """density : ρ0, kg/m³, > 0;  sound_speed : c0, m/s, at ρ0, > 0;  exponent : γ, > 1.  InputError for others."""

    gas: ClassVar[bool] = False

    density: float
    sound_speed: float
    exponent: float = EXPONENT

    def __post_init__(self) -> None:
        require_in_range("liquid", vars(self), RANGES)

    @classmethod
    def of(cls, given: Given) -> Self:
        """A liquid with the stiffness of the water where no speed of sound is given."""
        exponent = given.exponent or EXPONENT
        as_stiff = (given.stiffness * exponent / given.density) ** 0.5
        return cls(given.density, given.sound_speed or as_stiff, exponent)

    @property
    def stiffness(self) -> float:
        """Stiffness of the equation of state, B = ρ0 c0²/γ, Pa."""
        return self.density * self.sound_speed**2 / self.exponent

    @property
    def least_density(self) -> float:
        """Least density of the fluid, kg/m³."""
        return FLOOR * self.density

    @property
    def numbers(self) -> TaitNumbers:
        """The numbers of this equation of state that kernels take."""
        return TaitNumbers(self.density, self.sound_speed, self.least_density, self.stiffness, self.exponent)

    def pressure(self, density: Floats) -> Floats:
        """Pressure above that of the air, Pa."""
        return self.stiffness * ((density / self.density) ** self.exponent - 1.0)

    def density_at(self, pressure: Floats) -> Floats:
        """Density (kg/m³) at a pressure (Pa) above that of the air."""
        return self.density * (1.0 + pressure / self.stiffness) ** (1.0 / self.exponent)

    def sound_speed_at(self, density: Floats) -> Floats:
        """Speed of sound at a density (kg/m³): c0 (ρ/ρ0)^((γ-1)/2), m/s."""
        speed: Floats = self.sound_speed * np.maximum(density / self.density, 0.0) ** (0.5 * (self.exponent - 1.0))
        return speed

    def energy(self, density: Floats) -> Floats:
        """Work of compression per mass from ρ0 on, ∫ p/ρ² dρ, J/kg: B/{ρ0(γ-1)} {r^(γ-1) + (γ-1)/r - γ}."""
        ratio, more = density / self.density, self.exponent - 1.0
        work: Floats = self.stiffness / (self.density * more) * (ratio**more + more / ratio - self.exponent)
        return work

    def settled_density(self, depth: Floats, gravity: float) -> Floats:
        """Density (kg/m³) at rest exactly: dp = ρ g d(depth) integrates to ρ0 (1 + (γ-1) g depth/c0²)^(1/(γ-1))."""
        base = 1.0 + (self.exponent - 1.0) * gravity * depth / self.sound_speed**2
        return self.density * base ** (1.0 / (self.exponent - 1.0))


LAW = Tait
