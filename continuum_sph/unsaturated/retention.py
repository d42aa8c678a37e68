"""Retention of water in pores: suction ψ against effective saturation S_e.

    S_e = [1 + (α ψ)^n]^-m,   m = 1 - 1/n,   S = S_r + (1 - S_r) S_e        (ψ > 0, in metres of water; S = 1 below)

Source: van Genuchten, Soil Sci. Soc. Am. J. 44 (1980) 892, eqs 3, 21, 22.

The state variable is the filling w = m_w/(ρ_w n V): water in a piece of soil over what its pores hold.  ψ(S) is upright
at both ends, at S = 1 and S_r; there p(w) goes on as a straight line with the stiffness K_w of the water, which then is
also what compresses full pores:

    p = -ρ_w g ψ(S = w)          for w_dry < w < w_wet
    p = p_wet + K_w (w - w_wet)  beyond,   p = p_dry + K_w (w - w_dry)  below

w_wet and w_dry are where dp/dw = K_w: p and its slope are continuous, no piece of soil is stiffer than its water, and
p(w) needs no iteration.  1 - w_wet is of the order of 1e-4.
"""

import math
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np

from porescale.common.compiled.jit import inline
from porescale.common.core.errors import Fault, InputError
from porescale.common.core.ranges import Range, require_in_range
from porescale.common.core.types import Floats

LEAST = 1e-12
"""S_e and 1 - S_e from which on the ends of the curve are looked for."""


class RetentionNumbers(NamedTuple):
    """1/n, 1/m, S_r;  ρ_w g/α, Pa;  w and p (Pa) of the ends of the curve;  K_w, Pa."""

    inverse_n: float
    inverse_m: float
    residual: float
    scale: float
    wet: float
    wet_pressure: float
    dry: float
    dry_pressure: float
    stiffness: float


@inline
def pressure_and_slope(filling, law):
    """(p above that of the air, dp/dw), Pa, at a ``filling`` w;  law: `RetentionNumbers`."""
    if filling >= law.wet:
        return law.wet_pressure + law.stiffness * (filling - law.wet), law.stiffness
    if filling <= law.dry:
        return law.dry_pressure + law.stiffness * (filling - law.dry), law.stiffness
    effective = (filling - law.residual) / (1.0 - law.residual)
    power = effective**-law.inverse_m
    suction = law.scale * (power - 1.0) ** law.inverse_n
    slope = suction * law.inverse_n * law.inverse_m * power / ((power - 1.0) * effective * (1.0 - law.residual))
    return -suction, slope


@inline
def effective_saturation(filling, law):
    """S_e at a ``filling`` w, between 0 and 1."""
    return min(1.0, max(0.0, (filling - law.residual) / (1.0 - law.residual)))


RANGES = {
    "alpha": Range("1/m", gt=0), "n": Range(gt=1), "residual": Range(ge=0, lt=1), "weight": Range("N/m^3", gt=0),
    "stiffness": Range("Pa", gt=0),
}  # fmt: skip
"""What the numbers may be: the curve falls and has a slope everywhere."""


@dataclass(frozen=True)
class VanGenuchten:
    """alpha : α, 1/m, > 0;  n : > 1;  residual : S_r, from 0 to less than 1;  weight : ρ_w g, N/m³, > 0;  stiffness :
    K_w, Pa, > 0.

    Raises InputError for others, and where ``numbers`` are read when the water is softer than the curve is anywhere.
    """

    alpha: float
    n: float
    residual: float
    weight: float
    stiffness: float

    def __post_init__(self) -> None:
        require_in_range("retention", vars(self), RANGES)

    @property
    def m(self) -> float:
        """van Genuchten's second exponent, 1 - 1/n (Mualem 1976)."""
        return 1.0 - 1.0 / self.n

    def suction(self, effective: Floats | float) -> Floats:
        """ψ, m, at an ``effective`` saturation in (0, 1]."""
        found: Floats = (np.asarray(effective) ** (-1.0 / self.m) - 1.0) ** (1.0 / self.n) / self.alpha
        return found

    def effective(self, suction: Floats | float) -> Floats:
        """S_e at a ``suction`` ψ, m; 1 where it is none."""
        found: Floats = (1.0 + (self.alpha * np.maximum(suction, 0.0)) ** self.n) ** -self.m
        return found

    def slope(self, effective: float) -> float:
        """dp/dw, Pa, of the curve at an ``effective`` saturation in (0, 1)."""
        power = effective ** (-1.0 / self.m)
        suction = self.weight * float(self.suction(effective))
        return float(suction / (self.n * self.m) * power / ((power - 1.0) * effective * (1.0 - self.residual)))

    @cached_property
    def numbers(self) -> RetentionNumbers:
        """The numbers that kernels take."""
        trial = np.linspace(0.0, 1.0, 2001)[1:-1]
        slopes = np.array([self.slope(at) for at in trial])
        middle = float(trial[slopes.argmin()])
        if slopes.min() >= self.stiffness:
            problem = f"makes water softer, {self.stiffness:.3g} Pa, than suction in its pores, {slopes.min():.3g} Pa"
            times = 1.005 * math.sqrt(slopes.min() / self.stiffness)  # more than what three digits round off
            repair = f"raise it more than {times:.3g} times, or soil.suction.alpha"
            raise InputError(Fault("water.sound_speed", None, problem, repair=repair))
        wet, dry = self._end(1.0 - middle, wet=True), self._end(middle, wet=False)
        filled, left = (self.residual + (1.0 - self.residual) * at for at in (wet, dry))
        return RetentionNumbers(
            1.0 / self.n, 1.0 / self.m, self.residual, self.weight / self.alpha,
            filled, -self.weight * float(self.suction(wet)), left, -self.weight * float(self.suction(dry)),
            self.stiffness,
        )  # fmt: skip

    def _end(self, farthest: float, *, wet: bool) -> float:
        """S_e, within ``farthest`` of its wet or of its dry end, where the curve is as steep as the water is stiff."""
        from scipy.optimize import brentq  # takes longer to import than a scene to be judged

        first, last = math.log(LEAST), math.log(farthest)
        if self.slope(_place(first, wet=wet)) <= self.stiffness:
            return _place(first, wet=wet)
        return _place(float(brentq(lambda at: self.slope(_place(at, wet=wet)) - self.stiffness, first, last)), wet=wet)

    def filling(self, pressure: Floats) -> Floats:
        """w at a ``pressure`` (Pa, above that of the air), the inverse of p(w)."""
        law = self.numbers
        curve = self.residual + (1.0 - self.residual) * self.effective(-pressure / self.weight)
        found: Floats = np.where(pressure >= law.wet_pressure, law.wet + (pressure - law.wet_pressure) / law.stiffness,
                         np.where(pressure <= law.dry_pressure,
                                  law.dry + (pressure - law.dry_pressure) / law.stiffness, curve))  # fmt: skip
        return found


def _place(logarithm: float, *, wet: bool) -> float:
    """S_e whose distance from its wet end, or from its dry end, has this ``logarithm``."""
    return 1.0 - math.exp(logarithm) if wet else math.exp(logarithm)
