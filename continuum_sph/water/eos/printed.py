"""Gas as Maeda & Sakai 2004 print it, eqs 39 and 40: p_d = γ p (ρ/ρ0 - 1) with p = p0 + p_d.

Hence p_d = p0/{1 - γ(ρ/ρ0 - 1)} - p0, which has no value at ρ/ρ0 = 1 + 1/γ = 1.71 and beyond.
"""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from continuum_sph.water.eos.adiabatic import AdiabaticGas
from continuum_sph.water.eos.law import pressure_of
from porescale.common.compiled.jit import inline
from porescale.common.core.types import Floats


class PrintedNumbers(NamedTuple):
    """ρ0 kg/m³, c0 m/s, least density kg/m³, p0 Pa, γ."""

    density: float
    sound_speed: float
    least_density: float
    base: float
    exponent: float


@inline
def printed_gas(ratio, pressure0, exponent):
    """Pressure above p0 (Pa) of eqs 39, 40 and (c/c0)² at ``ratio`` ρ/ρ0;  infinite from 1 + 1/γ on.

    c² = dp/dρ = γ p²/(p0 ρ0), c0² = γ p0/ρ0.
    """
    rest = 1.0 - exponent * (ratio - 1.0)
    if rest <= 0.0:
        return np.inf, np.inf
    return pressure0 * (1.0 / rest - 1.0), 1.0 / (rest * rest)


@pressure_of.of(PrintedNumbers)
def pressure_of_printed(ratio, law):
    """Pressure above p0 (Pa) and (c/c0)² at ``ratio`` ρ/ρ0, see `printed_gas`."""
    return printed_gas(ratio, law.base, law.exponent)


@dataclass(frozen=True)
class PrintedGas(AdiabaticGas):
    """density : ρ0, kg/m³, at the pressure p0;  base : p0, Pa;  exponent : γ.  Sound at ρ0 is as of `AdiabaticGas`."""

    @property
    def numbers(self) -> PrintedNumbers:  # type: ignore[override]
        """The numbers of this equation of state that kernels take."""
        return PrintedNumbers(self.density, self.sound_speed, self.least_density, self.base, self.exponent)

    def pressure(self, density: Floats) -> Floats:
        """Pressure above p0, Pa; infinite where the law has none."""
        rest = 1.0 - self.exponent * (density / self.density - 1.0)
        with np.errstate(divide="ignore"):
            found: Floats = self.base * (np.where(rest > 0.0, 1.0 / np.maximum(rest, 0.0), np.inf) - 1.0)
        return found

    def density_at(self, pressure: Floats) -> Floats:
        """Density (kg/m³) at a pressure (Pa) above p0."""
        total = 1.0 + pressure / self.base
        return self.density * (1.0 + (1.0 - 1.0 / total) / self.exponent)

    def sound_speed_at(self, density: Floats) -> Floats:
        """c0/{1 - γ(ρ/ρ0 - 1)}, m/s."""
        rest = 1.0 - self.exponent * (density / self.density - 1.0)
        speed: Floats = self.sound_speed / np.maximum(rest, np.finfo(np.float64).tiny)
        return speed

    def energy(self, density: Floats) -> Floats:
        """Work of compression against p0 per mass from ρ0 on, J/kg.

        p0/ρ0 [-1/(a r) + (γ/a²) ln{r/(a - γ r)} + 1/r] from 1 to r, a = 1 + γ.
        """
        ratio, a = density / self.density, 1.0 + self.exponent
        logarithm = self.exponent / (a * a) * np.log(ratio / (a - self.exponent * ratio))
        work: Floats = self.base / self.density * ((1.0 - 1.0 / a) * (1.0 / ratio - 1.0) + logarithm)
        return work


LAW = PrintedGas
