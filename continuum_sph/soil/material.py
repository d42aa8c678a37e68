"""Kinds of soil: stiffness, strength, weight, each one row of a table of numbers that kernels read.

E = E0 (p/p0)^m and G = E/2(1+ν) with the mean stress p = (σ_xx + σ_yy)/2 (eq. 42 of Maeda & Sakai 2004).  Of the area
modulus B, dp = B dε_v, there are two: "plane strain", E/2(1+ν)(1-2ν), which keeps σ_zz = 2ν p as plane strain does, and
"printed", E/2(1-ν) of eq. 43, which is that of plane stress.  A column that cannot widen has the modulus B + G and the
stress ratio K0 = (B - G)/(B + G): ν/(1-ν) in plane strain, ν with the modulus of eq. 43 as long as soil stays elastic.

Strength: τ_f = p sin φ + c cos φ for the radius τ of Mohr's circle in the plane, Mohr-Coulomb while σ_zz lies between
the other two.  That of Maeda & Sakai 2004, τ_f = p tan φ_d, is the same with
sin φ = tan φ_d: their 0.5 is φ = 30°.

Grains that are sheared fast rub more.  With the inertial number I = γ' d √(ρs/p), γ' the rate of shear strain, d and ρs
diameter and density of the grains, sin φ(I) = sin φ + (sin φ∞ - sin φ) I/(I0 + I) (Jop, Forterre & Pouliquen,
Nature 441 (2006) 727, whose μ is τ/p).  A soil without a `Rate` has none of it.

Dense or cemented soil softens: with the plastic shear strain γ its strength goes to that of large strains,
sin φ = sin φ_l + (sin φ - sin φ_l) e^(-γ/γs), c cos φ in the same way, sin ψ to 0, where volume no longer changes.  A
soil without a `Softening` has none of it.  With a `Rate`, friction grows from that of large strains.
"""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from porescale.common.compiled.jit import inline
from porescale.common.core.errors import Fault, InputError
from porescale.common.core.ranges import Range, require_in_range
from porescale.common.core.types import Floats

(
    AREA,
    SHEAR,
    ACROSS,
    EXPONENT,
    REFERENCE,
    LEAST,
    SIN_FRICTION,
    COHESION_INTERCEPT,
    SIN_DILATANCY,
    TENSION,
    YIELDS,
    DENSITY,
    GRAINS,
    RATE_STRENGTH,
    RATE_PACE,
    SOFTENED_FRICTION,
    SOFTENED_COHESION,
    SOFTENED_STRAIN,
) = range(18)
"""Columns of the table: B/E and G/E, dσ_zz/dp; m; p0 Pa; least p for stiffness, Pa; sin φ; c cos φ, Pa; sin ψ; largest
tension, Pa; 1 if it yields; density at the start, share of grains 1 - n at the start; sin φ of the fastest flow less
sin φ; rate of shear over √p at which half of that is there, 1/(s √Pa); sin φ and c cos φ (Pa) less those after large
strains; γs, 0 where nothing softens.  B and G are times E0."""


MODULI = ("plane strain", "printed")
RANGES = {
    "stiffness": Range("Pa", gt=0), "density": Range("kg/m^3", gt=0), "poisson": Range(gt=-1, lt=0.5),
    "exponent": Range(), "reference": Range("Pa", gt=0), "least": Range("Pa", ge=0), "sin_friction": Range(ge=0, le=1),
    "cohesion_intercept": Range("Pa", ge=0), "sin_dilatancy": Range(ge=-1, le=1), "tension": Range("Pa", ge=0),
    "porosity": Range(ge=0, lt=1),
}  # fmt: skip
"""What the numbers of a material may be: moduli are positive and finite at -1 < ν < 1/2."""


RATE_RANGES = {
    "grain_diameter": Range("m", gt=0), "inertial_number": Range(gt=0), "sin_friction": Range(ge=0, le=1)
}  # fmt: skip
"""What the numbers of a rate may be."""


@dataclass(frozen=True)
class Rate:
    """How friction grows with the rate of shear.

    sin_friction : sin φ∞ of the fastest flow;  inertial_number : I0, at which half of the growth is there;
    grain_diameter : d, m.  Raises InputError for values that no grains have, see RATE_RANGES.
    """

    sin_friction: float
    inertial_number: float
    grain_diameter: float

    def __post_init__(self) -> None:
        require_in_range("material.rate", vars(self), RATE_RANGES)


SOFTENING_RANGES = {
    "sin_friction": Range(ge=0, le=1), "cohesion_intercept": Range("Pa", ge=0), "shear_strain": Range(gt=0)
}  # fmt: skip
"""What the numbers of a softening may be."""


@dataclass(frozen=True)
class Softening:
    """What strength goes to with the plastic shear strain.

    sin_friction : sin φ_l after large strains;  cohesion_intercept : c cos φ then, Pa;  shear_strain : γs, at which 1/e
    of the difference is left.  Raises InputError for values that no soil has, see SOFTENING_RANGES.
    """

    sin_friction: float
    cohesion_intercept: float
    shear_strain: float

    def __post_init__(self) -> None:
        require_in_range("material.softening", vars(self), SOFTENING_RANGES)


def unconfined(modulus: float, poisson: float) -> float:
    """E (Pa) of what has the ``modulus`` M = E (1 - ν)/{(1 + ν)(1 - 2ν)} (Pa) where it cannot widen."""
    return modulus * (1.0 + poisson) * (1.0 - 2.0 * poisson) / (1.0 - poisson)


@dataclass(frozen=True)
class Material:
    """stiffness : E0, Pa at the mean stress ``reference`` (p0, Pa);  exponent : m;  poisson : ν;  modulus : "plane
    strain" or "printed";  sin_friction : sin φ;  cohesion_intercept : c cos φ, Pa;  sin_dilatancy : sin ψ;
    tension : largest, Pa;  yields : else elastic for ever;  density : of grains per whole volume at the start, kg/m³;
    porosity : n then;  least : mean stress (Pa) below which soil gets no softer;  rate : how friction grows with the
    rate of shear, None where it does not;  softening : how strength falls with plastic shear strain, None where it does
    not.  Raises InputError for values that no material has, see RANGES.
    """

    stiffness: float
    density: float
    poisson: float = 0.3
    exponent: float = 0.0
    reference: float = 1e5
    least: float = 10.0
    modulus: str = "plane strain"
    sin_friction: float = 0.5
    cohesion_intercept: float = 0.0
    sin_dilatancy: float = 0.0
    tension: float = 0.0
    yields: bool = True
    porosity: float = 0.4
    rate: Rate | None = None
    softening: Softening | None = None

    def __post_init__(self) -> None:
        require_in_range("material", vars(self), RANGES, {"modulus": MODULI})
        for name in ("sin_friction", "cohesion_intercept") if self.softening else ():
            found, most = getattr(self.softening, name), getattr(self, name)
            if found > most:
                raise InputError(Fault(f"material.softening.{name}", found, "is more than before", "", f"<= {most:g}"))
        if self.rate and self.rate.sin_friction < self.slow_friction:
            problem, limits = "is less than at rest", f">= {self.slow_friction:g}"
            raise InputError(Fault("material.rate.sin_friction", self.rate.sin_friction, problem, "", limits))

    @property
    def slow_friction(self) -> float:
        """sin φ after large strains, without what grows with the rate of shear."""
        return self.softening.sin_friction if self.softening else self.sin_friction

    @property
    def printed(self) -> bool:
        """Whether the area modulus is that of eq. 43."""
        return self.modulus == "printed"

    @property
    def area_modulus(self) -> float:
        """Area modulus over Young's modulus, B/E."""
        if self.printed:
            return 0.5 / (1.0 - self.poisson)
        return 0.5 / ((1.0 + self.poisson) * (1.0 - 2.0 * self.poisson))

    @property
    def shear_modulus(self) -> float:
        """Shear modulus over Young's modulus, G/E."""
        return 0.5 / (1.0 + self.poisson)

    @property
    def column_modulus(self) -> float:
        """(B + G) at E0, Pa: stiffness of a column that cannot widen, and of its sound."""
        return (self.area_modulus + self.shear_modulus) * self.stiffness

    @property
    def rest(self) -> float:
        """K0 of a column that settles under its weight from no stress: elastic, or as yielding leaves it."""
        elastic = (self.area_modulus - self.shear_modulus) / (self.area_modulus + self.shear_modulus)
        if self.yields and self.cohesion_intercept == 0.0:
            return max(elastic, (1.0 - self.sin_friction) / (1.0 + self.sin_friction))
        return elastic

    def stiffness_at(self, pressure: float) -> float:
        """E (Pa) at a mean stress (Pa)."""
        return float(self.stiffness * (max(pressure, self.least) / self.reference) ** self.exponent)

    def row(self) -> Floats:
        """The material's row of the table that kernels take, (18,)."""
        across = 0.0 if self.printed else 2.0 * self.poisson
        # Tension beyond the tip of the cone, c cot φ, cannot be.
        tension = min(
            self.tension, self.cohesion_intercept / self.sin_friction if self.sin_friction > 0.0 else math.inf
        )
        growth, pace = 0.0, 0.0
        if self.rate:
            growth = self.rate.sin_friction - self.slow_friction
            grains = self.density / (1.0 - self.porosity)
            pace = self.rate.inertial_number / (self.rate.grain_diameter * math.sqrt(grains))
        softened = 0.0, 0.0, 0.0
        if it := self.softening:
            softened = (
                self.sin_friction - it.sin_friction, self.cohesion_intercept - it.cohesion_intercept, it.shear_strain
            )  # fmt: skip
        return np.array(
            [
                self.area_modulus * self.stiffness, self.shear_modulus * self.stiffness, across, self.exponent,
                self.reference, self.least, self.sin_friction, self.cohesion_intercept, self.sin_dilatancy, tension,
                float(self.yields),
                self.density, 1.0 - self.porosity, growth, pace, *softened,
            ]
        )  # fmt: skip


def table(materials: tuple[Material, ...]) -> Floats:
    """The table of all materials, (m, 18)."""
    return np.array([material.row() for material in materials])


def porosity(density: Floats, material: NDArray[np.int64], rows: Floats) -> Floats:
    """Porosity of particles: grains keep their volume.  density kg/m³, material: (soil,);  rows: the table."""
    own = rows[material]
    result: Floats = 1.0 - own[:, GRAINS] * density / own[:, DENSITY]
    return result


@inline
def stiffness_share(p, row):
    """E/E0 at the mean stress p (Pa), eq. 42."""
    if row[EXPONENT] == 0.0:
        return 1.0
    return (max(p, row[LEAST]) / row[REFERENCE]) ** row[EXPONENT]
