"""Equations of state: pressure above that of the air from density.

Liquid (Tait), eq. 41 of Maeda & Sakai 2004 (Cole 1948, Monaghan 1994): p = B {(ρ/ρ0)^γ - 1}, B = ρ0 c0²/γ.  There B is
the air pressure p0 = 100 kPa, which makes water as soft as c0 = √(γ p0/ρ0) = 26 m/s; here B follows from the speed of
sound c0, which must exceed ten times the fastest flow for a Mach number below 0.1 and density changes below 1 %.

Gas, adiabatic: the same with B = p0, the pressure at ρ0.  Gas as printed, eqs 39 and 40: p_d = γ p (ρ/ρ0 - 1) with
p = p0 + p_d, hence p_d = p0/{1 - γ(ρ/ρ0 - 1)} - p0, which has no value at ρ/ρ0 = 1 + 1/γ = 1.71 and beyond.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from porescale.common.compiled.jit import inline

Floats = NDArray[np.float64]


@inline
def tait(ratio, stiffness, exponent):
    """Pressure (Pa) and (ρ/ρ0)^(γ-1), which is (c/c0)², at ``ratio`` ρ/ρ0;  ``stiffness`` B, Pa."""
    if exponent == 7.0:
        square = ratio * ratio
        power = square * square * square
    else:
        power = ratio ** (exponent - 1.0)
    return stiffness * (power * ratio - 1.0), power


@inline
def printed_gas(ratio, pressure0, exponent):
    """Pressure above p0 (Pa) of eqs 39, 40 and (c/c0)² at ``ratio`` ρ/ρ0;  infinite from 1 + 1/γ on.

    c² = dp/dρ = γ p²/(p0 ρ0), c0² = γ p0/ρ0.
    """
    rest = 1.0 - exponent * (ratio - 1.0)
    if rest <= 0.0:
        return np.inf, np.inf
    return pressure0 * (1.0 / rest - 1.0), 1.0 / (rest * rest)


@inline
def tait_density(pressure, stiffness, exponent, density):
    """Density (kg/m³) at ``pressure`` (Pa, above -B): ρ0 (1 + p/B)^(1/γ)."""
    return density * (1.0 + pressure / stiffness) ** (1.0 / exponent)


@dataclass(frozen=True)
class Tait:
    """density : ρ0, kg/m³;  sound_speed : c0, m/s, at ρ0;  exponent : γ."""

    density: float
    sound_speed: float
    exponent: float = 7.0

    @property
    def stiffness(self) -> float:
        """B, Pa."""
        return self.density * self.sound_speed**2 / self.exponent

    def pressure(self, density: Floats) -> Floats:
        """Pressure above that of the air, Pa."""
        return self.stiffness * ((density / self.density) ** self.exponent - 1.0)

    def density_at(self, pressure: Floats) -> Floats:
        """Density (kg/m³) at a pressure (Pa) above that of the air."""
        return self.density * (1.0 + pressure / self.stiffness) ** (1.0 / self.exponent)

    def energy(self, density: Floats) -> Floats:
        """Work of compression per mass from ρ0 on, ∫ p/ρ² dρ, J/kg: B/{ρ0(γ-1)} {r^(γ-1) + (γ-1)/r - γ}."""
        ratio, more = density / self.density, self.exponent - 1.0
        work: Floats = self.stiffness / (self.density * more) * (ratio**more + more / ratio - self.exponent)
        return work

    def hydrostatic_density(self, depth: Floats, gravity: float) -> Floats:
        """Density (kg/m³) of water at rest, ρ0 (1 + ρ0 g depth/B)^(1/γ).

        It takes the pressure as ρ0 g depth, without the weight of what the compression adds (a part
        g depth/2c0² of it, 0.25 % at c0 = 10 √(2 g depth)).
        """
        return self.density_at(self.density * gravity * depth)

    def settled_density(self, depth: Floats, gravity: float) -> Floats:
        """Density (kg/m³) at rest exactly: dp = ρ g d(depth) integrates to ρ0 (1 + (γ-1) g depth/c0²)^(1/(γ-1))."""
        base = 1.0 + (self.exponent - 1.0) * gravity * depth / self.sound_speed**2
        return self.density * base ** (1.0 / (self.exponent - 1.0))


@dataclass(frozen=True)
class Gas:
    """density : ρ0, kg/m³, at the pressure p0;  base : p0, Pa;  exponent : γ;  printed : eqs 39, 40 as they stand,
    else adiabatic."""

    density: float
    base: float
    exponent: float = 1.403
    printed: bool = False

    @property
    def sound_speed(self) -> float:
        """c0, m/s, at ρ0: √(γ p0/ρ0) in both laws."""
        return float((self.exponent * self.base / self.density) ** 0.5)

    @property
    def stiffness(self) -> float:
        """p0, Pa, which stands where a liquid has B."""
        return self.base

    def pressure(self, density: Floats) -> Floats:
        """Pressure above p0, Pa; infinite where the printed law has none."""
        ratio = density / self.density
        if not self.printed:
            return self.base * (ratio**self.exponent - 1.0)
        rest = 1.0 - self.exponent * (ratio - 1.0)
        with np.errstate(divide="ignore"):
            return self.base * (np.where(rest > 0.0, 1.0 / np.maximum(rest, 0.0), np.inf) - 1.0)

    def density_at(self, pressure: Floats) -> Floats:
        """Density (kg/m³) at a pressure (Pa) above p0."""
        total = 1.0 + pressure / self.base
        if self.printed:
            return self.density * (1.0 + (1.0 - 1.0 / total) / self.exponent)
        return self.density * total ** (1.0 / self.exponent)

    def energy(self, density: Floats) -> Floats:
        """Work of compression against p0 per mass from ρ0 on, J/kg.

        Adiabatic as `Tait`;  printed: p0/ρ0 [-1/(a r) + (γ/a²) ln{r/(a - γ r)} + 1/r] from 1 to r, a = 1 + γ.
        """
        ratio, more, a = density / self.density, self.exponent - 1.0, 1.0 + self.exponent
        scale = self.base / self.density
        if not self.printed:
            adiabatic: Floats = scale / more * (ratio**more + more / ratio - self.exponent)
            return adiabatic
        logarithm = self.exponent / (a * a) * np.log(ratio / (a - self.exponent * ratio))
        work: Floats = scale * ((1.0 - 1.0 / a) * (1.0 / ratio - 1.0) + logarithm)
        return work
