"""Resistance of pores to flow: β = n² ρ_f g/k, drag per volume and velocity, kg/(m³ s).

k is given at the porosity n0 of each soil: its water takes R = Σ_s ψ_is/k_s from the soil about it, s/m, which is
(1 - n)/k inside and falls to nothing outside, and with it

    constant          β = ρ_f g n² R/(1 - n0)
    Kozeny & Carman   β = ρ_f g R (1 - n)/n · n0³/(1 - n0)²,   k(n) = k0 n³/(1 - n)² · (1 - n0)²/n0³

(Kozeny 1927, Carman 1937).  The first is that of k for n = n0 and of k (1 - n0)/(1 - n) else.
"""

from dataclasses import dataclass

from porescale.common.compiled.jit import inline
from porescale.common.compiled.simd import maximum
from porescale.common.core.constants import GRAVITY

CONSTANT, KOZENY_CARMAN = 0, 1
LAWS = ("constant", "kozeny-carman")
LEAST_GRAINS = 1e-16
"""Share of the volume, less than any 1 - n but 0.  Where n rounds to 1 with grains in reach, 1 - n = 0 would make
`exchange.apply_drag` divide 0 by 0."""


@inline
def drag(law, porosity, sum_of, weight, factor):
    """β, kg/(m³ s), at a ``porosity``;  sum_of R, s/m;  weight ρ_f g, N/m³;  factor: of `Resistance`."""
    if law == KOZENY_CARMAN:
        return weight * sum_of * factor * maximum(1.0 - porosity, LEAST_GRAINS) / porosity
    return weight * sum_of * factor * porosity * porosity


@dataclass(frozen=True)
class Resistance:
    """porosity : n0, at which permeabilities are given;  law : one of `LAWS`;  gravity : g of k, m/s², whichever way
    things fall (k is a speed under a gradient of ρ_f g)."""

    porosity: float
    law: str = "constant"
    gravity: float = GRAVITY

    @property
    def number(self) -> int:
        """Number of the law in kernels."""
        return LAWS.index(self.law)

    @property
    def factor(self) -> float:
        """What of β depends on n0 alone."""
        grains = 1.0 - self.porosity
        return self.porosity**3 / grains**2 if self.number == KOZENY_CARMAN else 1.0 / grains

    def permeability(self, given: float, porosity: float) -> float:
        """k (m/s) at ``porosity`` of a soil ``given`` k (m/s) at n0, inside it."""
        if self.number == KOZENY_CARMAN:
            return given * porosity**3 / (1.0 - porosity) ** 2 / self.factor
        return given * (1.0 - self.porosity) / (1.0 - porosity)
