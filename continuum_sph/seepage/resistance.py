"""Resistance of pores to flow: β = n² ρ_f g/k, drag per volume and velocity, kg/(m³ s).

k is given at the porosity n0 of each soil: its water takes R = Σ_s ψ_is/k_s from the soil about it, s/m, which is
(1 - n)/k inside and falls to nothing outside, and with it

    constant          β = ρ_f g n² R/(1 - n0)
    Kozeny & Carman   β = ρ_f g R (1 - n) n²/m³ · m0³/(1 - n0)²,   k(n) = k0 m³/(1 - n)² · (1 - n0)²/m0³

(Kozeny 1927, Carman 1937).  The first is that of k for n = n0 and of k (1 - n0)/(1 - n) else.  m = 1 - s (1 - n) is the
porosity that flow finds where grains take up the share s of their volume in it: s = 1, or λ² of discs that the fluid
sees with λ of their radius (d ln K/dn 6.6 ± 0.6 of such, by this law 6.5, with s = 1 it would be 20; homogenise).

Kernels smear the surface of soil over 1.5 spacings to both sides, and drag is stiff: a hundredth of that inside,
0.01 n g/k, stops open water within 0.13 s at k = 5 mm/s, and it stands as a cliff where it should run over ground.  So
R is sharpened: with χ = Σ_s ψ_is/(1 - n_s), 1 inside and a half at a surface, n_s the porosity of soil s by its own
density,

    R → R s(χ)/χ,   s = 0 for χ <= 1/5, 1 for χ >= 4/5, linear between.

s is antisymmetric about a surface, as χ is, so that the sum of R over all rows of a lattice, the resistance that flow
across the surface finds, is what it was; inside R is (1 - n_s)/k, however dilute the soil.
"""

from dataclasses import dataclass
from typing import Any

from porescale.common.compiled.jit import inline
from porescale.common.compiled.simd import maximum, minimum
from porescale.common.core.constants import GRAVITY

CONSTANT, KOZENY_CARMAN = 0, 1
LAWS = ("constant", "kozeny-carman")
EDGE = 0.2, 0.8
"""χ below which water feels no drag, and above which all of it."""


@inline
def sharpened(chi):
    """s(χ)/χ, what sharpening makes of R where soil takes up the share ``chi`` > 0 of the volume."""
    return minimum(maximum((chi - EDGE[0]) * (1.0 / (EDGE[1] - EDGE[0])), 0.0), 1.0) / chi


@inline
def drag(law, porosity, sum_of, weight, factor, share):
    """β, kg/(m³ s), at a ``porosity``;  sum_of R, s/m;  weight ρ_f g, N/m³;  factor, share: of `Resistance`."""
    if law == KOZENY_CARMAN:
        grains = 1.0 - porosity
        left = 1.0 - share * grains
        return weight * sum_of * factor * grains * porosity * porosity / (left * left * left)
    return weight * sum_of * factor * porosity * porosity


@dataclass(frozen=True)
class Resistance:
    """porosity : n0, at which permeabilities are given;  law : one of `LAWS`;  gravity : g of k, m/s², whichever way
    things fall (k is a speed under a gradient of ρ_f g);  share : s, of the grains' volume in the flow, of Kozeny and
    Carman's law."""

    porosity: float
    law: str = "constant"
    gravity: float = GRAVITY
    share: float = 1.0

    @property
    def number(self) -> int:
        """Number of the law in kernels."""
        return LAWS.index(self.law)

    @property
    def factor(self) -> float:
        """What of β depends on n0 alone."""
        grains = 1.0 - self.porosity
        return (1.0 - self.share * grains) ** 3 / grains**2 if self.number == KOZENY_CARMAN else 1.0 / grains

    def permeability(self, given: Any, porosity: Any) -> Any:
        """k (m/s) at ``porosity`` of a soil ``given`` k (m/s) at n0, inside it; numbers or arrays."""
        grains = 1.0 - porosity
        if self.number == KOZENY_CARMAN:
            return given * (1.0 - self.share * grains) ** 3 / grains**2 / self.factor
        return given * (1.0 - self.porosity) / grains
