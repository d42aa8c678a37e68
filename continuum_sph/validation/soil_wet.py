"""Validations of slopes under water and of permeability; each function takes what its failing twin changes."""

from __future__ import annotations

import functools
import math

from continuum_sph.validation.seepage_trials import discharge, permeated
from continuum_sph.validation.soil_wet_trials import WetSlope
from porescale.common.core.constants import GRAVITY
from porescale.common.evidence.validations import Measured, Validations

VALIDATIONS = Validations()

STILL, SEEPING = WetSlope(28.0, False), WetSlope(16.0, True)
RESTING = (WetSlope(25.0, False), WetSlope(12.0, True))


@functools.cache
def slides(given: WetSlope) -> tuple[float, float]:
    """(acceleration, m/s², and speed, m/s) of a wet layer on a slope."""
    return given.slides()


def off(given: WetSlope, seeping: bool | None = None) -> tuple[float, float, float]:
    """(exact, found acceleration, m/s², their difference over what drives);  seeping: as if it were so."""
    exact, found = given.acceleration(seeping), slides(given)[0]
    part = given.whole if given.seeping else given.buoyant
    return exact, found, abs(found - exact) / (GRAVITY * math.sin(math.radians(given.degrees)) * part / given.whole)


@VALIDATIONS.row(
    "continuum.soil_slides_under_water",
    source="exact: buoyancy takes the same share of what drives and of what holds: limit atan(sin φ) = 26.6° as in "
    "air; slope of 28°: γ'/γ_sat g (sin β - sin φ cos β)",
    because="half of the row at the floor, of 20, is held by it: 0.5/20 of what drives",
    tolerance=0.5 / 20,
    slow=True,
)
def still_row() -> Measured:
    """Acceleration of an endless layer on a slope in still water, m/s²; error over what drives."""
    exact, found, error = off(STILL)
    return Measured(exact, found, error)


@VALIDATIONS.row(
    "continuum.soil_slides_with_seepage",
    source="exact: water that flows along a slope bears none of its weight: limit tan β = γ'/γ_sat sin φ, 14.0°; slope "
    "of 16°: g (sin β - γ'/γ_sat sin φ cos β)",
    because="half of the row at the floor, of 20, is held by it: 0.5/20 of what drives",
    tolerance=0.5 / 20,
    slow=True,
)
def seeping_row() -> Measured:
    """Acceleration of an endless layer with water flowing along it, m/s²; error over what drives."""
    exact, found, error = off(SEEPING)
    return Measured(exact, found, error)


@VALIDATIONS.row(
    "continuum.soil_rests_below_its_wet_limits",
    source="exact: 25° in still water and 12° with seepage lie below 26.6° and 14.0°",
    because="speed of what slides for 0.6 s at a fortieth of g sin 12°: half of the row at the floor is soft",
    tolerance=0.6 * GRAVITY * math.sin(math.radians(12.0)) / 40,
    slow=True,
)
def resting_row() -> Measured:
    """Speed of two layers below their limits after 0.6 s, m/s."""
    found = [abs(slides(given)[1]) for given in RESTING]
    return Measured(0.0, found, max(found))


GIVEN, CHANGED = 0.4, (0.3, 0.5)  # porosities: at which k is given, and of the soil
K, GRADIENT = 1e-3, 0.5  # m/s


@functools.cache
def passed(law: str, porosity: float) -> float:
    """Flux through soil of a ``porosity`` by a ``law`` of `Resistance`, over k given at another porosity and i."""
    both = permeated(K, GRADIENT, law=law, porosity=porosity)
    for _ in range(100):  # 600 of the times in which drag stops water
        both.advance()
    return discharge(both) / (K * GRADIENT)


@VALIDATIONS.row(
    "continuum.permeability_follows_porosity",
    source="Kozeny 1927, Carman 1937: k(n)/k(n0) = n³ (1 - n0)²/{n0³ (1 - n)²}, n 0.3 and 0.5, n0 0.4",
    because="grains are summed over a lattice to 0.0011 of themselves, n so to 0.0011 (1 - n), and k to 3/n + "
    "2/(1 - n) times that",
    tolerance=0.0011 * 0.7 * (3.0 / 0.3 + 2.0 / 0.7),
    slow=True,
)
def kozeny_carman_row() -> Measured:
    """Flux over that of the porosity at which k is given; error over the exact one."""
    exact = [n**3 * (1.0 - GIVEN) ** 2 / (GIVEN**3 * (1.0 - n) ** 2) for n in CHANGED]
    found = [passed("kozeny-carman", n) for n in CHANGED]
    return Measured(exact, found, max(abs(a / b - 1.0) for a, b in zip(found, exact, strict=True)))
