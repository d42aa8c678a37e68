"""A layer on a slope whose friction grows with the rate of shear: Bagnold's profile.  SI.

Endless and without dilatancy the layer has p = ρ g (H - y) cos β and τ = p tan β, so the inertial number is the same in
all depths, I = I0 (tan β - sin φ)/(sin φ∞ - tan β), and with γ' = I √(p/ρs)/d (Jop, Forterre & Pouliquen, Nature 441
(2006) 727; GDR MiDi, Eur. Phys. J. E 14 (2004) 341)

    u = (2 I/3 d) √(ρ/ρs g cos β) [H^(3/2) - (H - y)^(3/2)]
"""

import functools
import math

import numpy as np

from continuum_sph.soil import Rate, SoilFlow
from continuum_sph.validation.soil.setups import DENSITY, TAN_PHI, run_until
from continuum_sph.validation.soil.slopes import GRAVITY, layer
from porescale.common.core.types import Floats
from porescale.common.evidence.validations import Measured, Validations

VALIDATIONS = Validations()

DEGREES = 32.0
FAST = Rate(sin_friction=0.8, inertial_number=0.3, grain_diameter=0.2)
"""Of a layer 1 m deep: I is 0.21.  Flow comes to its profile as exp(-t/τ), τ = H²/ν (2/π)² = 2.3 s of the viscosity
ν = (sin φ∞ - sin φ) I0/(I0 + I)² d √(ρs p)/ρ = 0.18 m²/s at half its depth: 3 % are left after 8 s."""
SECONDS = 8.0
GRAINS = DENSITY / 0.6  # kg/m³, of the default porosity
LEVELS = (20, 40)


def profile(y: Floats, rate: Rate = FAST) -> Floats:
    """Speeds (n,) m/s of the steady flow at heights ``y`` (n,) m over the floor of a layer 1 m deep."""
    beta = math.radians(DEGREES)
    inertial = rate.inertial_number * (math.tan(beta) - TAN_PHI) / (rate.sin_friction - math.tan(beta))
    scale = 2.0 * inertial / (3.0 * rate.grain_diameter) * math.sqrt(DENSITY / GRAINS * GRAVITY * math.cos(beta))
    speeds: Floats = scale * (1.0 - (1.0 - np.clip(y, 0.0, 1.0)) ** 1.5)
    return speeds


@functools.cache
def flowing(rows: int, rate: Rate | None = FAST) -> SoilFlow:
    """A strewn layer that was let go on the slope `SECONDS` ago."""
    return run_until(layer(DEGREES, rows, columns=16, strewn=0.2, rate=rate), SECONDS)


def error(rows: int, rate: Rate | None = FAST) -> float:
    """Root mean square of a flow's speeds less those of the profile of `FAST`, over that of the profile."""
    soil = flowing(rows, rate).soil
    exact = profile(soil.x[: soil.soil, 1])
    return math.sqrt(float(((soil.v[: soil.soil, 0] - exact) ** 2).mean() / (exact**2).mean()))


@VALIDATIONS.row(
    "continuum.soil_flows_as_bagnold",
    source="exact: Bagnold's profile of a layer on a slope with friction that grows with the inertial number (GDR MiDi "
    "2004; Jop, Forterre & Pouliquen 2006); slope of 32°, I 0.21, 20 and 40 rows from rest",
    because="the floor holds half of its row: there the profile has 3/2 of the fastest speed a depth, so all goes "
    "faster by 0.75/20 of it, over a root mean square of 0.67 of it",
    tolerance=0.75 / 20 / 0.67,
    slow=True,
)
def bagnold_row() -> Measured:
    """Root mean square error of the speeds over that of the profile."""
    return Measured.absolute(0.0, [error(rows) for rows in LEVELS])
