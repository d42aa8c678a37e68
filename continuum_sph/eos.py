"""Equation of state of a weakly compressible liquid.  p = B {(ρ/ρ0)^γ - 1},  B = ρ0 c0²/γ.

Source: eq. 41 of Maeda & Sakai 2004 (Cole 1948, Monaghan 1994).  There B is the air pressure p0 = 100 kPa, which
makes water as soft as c0 = √(γ p0/ρ0) = 26 m/s; here B follows from the speed of sound c0, which must exceed ten
times the fastest flow for a Mach number below 0.1 and density changes below 1 %.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from porescale.ground.jit import inline

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

    def hydrostatic_density(self, depth: Floats, gravity: float) -> Floats:
        """Density (kg/m³) of water at rest, ρ0 (1 + ρ0 g depth/B)^(1/γ).

        It takes the pressure as ρ0 g depth, without the weight of what the compression adds (a part
        g depth/2c0² of it, 0.25 % at c0 = 10 √(2 g depth)).
        """
        base = 1.0 + self.density * gravity * depth / self.stiffness
        return self.density * base ** (1.0 / self.exponent)

    def settled_density(self, depth: Floats, gravity: float) -> Floats:
        """Density (kg/m³) at rest exactly: dp = ρ g d(depth) integrates to ρ0 (1 + (γ-1) g depth/c0²)^(1/(γ-1))."""
        base = 1.0 + (self.exponent - 1.0) * gravity * depth / self.sound_speed**2
        return self.density * base ** (1.0 / (self.exponent - 1.0))
