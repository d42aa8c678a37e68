"""Validations of ground between prescribed levels and of ground being wetted under a constant head."""

from __future__ import annotations

import functools

from continuum_sph.validation.dam_trials import STATIONS, Dam, steady
from continuum_sph.validation.infiltration_trials import Imbibition
from porescale.common.evidence.validations import Measured, Validations

VALIDATIONS = Validations()

DAM = Dam()
SPAN = (3.5, 7.0)  # s, over which the flow is taken for steady


@functools.cache
def dam(given: Dam = DAM, span: tuple[float, float] = SPAN) -> tuple[float, float, list[float]]:
    """(discharge into and out of a dam over k (H1² - H2²)/2L, heights of its surface over the exact ones)."""
    rows = given.course(given.build(), span[1], 0.05)
    into, out, heights = steady(rows, span[0])
    return into / given.discharge, out / given.discharge, list(map(float, heights / given.surface))


@VALIDATIONS.row(
    "continuum.dam",
    source="q = k (H1² - H2²)/2L (Charny 1951); free surface by Baiocchi's inequality, H1 = L = 1, H2 = 0",
    because="held to 3 %; water is booked in particles of H1²/400, what q lets through in 0.05 s, at both ends of "
    "3.5 s: 1.4 % of either discharge, 1 % of their mean; the surface is a row of particles, in pores 1/(20 √n) = 0.08 "
    "apart, whose place is known to a fifth of that, 2.5 % of the least height",
    tolerance=0.03,
    slow=True,
)
def dam_row() -> Measured:
    """Mean of the discharges in and out, and heights at L/4, L/2, 3L/4, over the exact ones; 20 particles over H1."""
    into, out, heights = dam()
    found = [0.5 * (into + out), *heights]
    return Measured([1.0] * (1 + len(STATIONS)), found, max(abs(value - 1.0) for value in found))


DRAWN = Imbibition(rows=30)
WATCHED = (0.3, 0.6, 0.9)  # s


def fronts(given: Imbibition = DRAWN, times: tuple[float, ...] = WATCHED) -> list[float]:
    """Way of the wetting front over √(2 k h0 t/n) at rising ``times`` (s)."""
    both, found = given.build(), []
    for time in times:
        while both.time < time:
            given.advance(both)
        found.append(given.reached(both) / given.front(both.time))
    return found


@VALIDATIONS.row(
    "continuum.imbibition",
    source="Green & Ampt 1911 without capillarity and gravity: x_f = √(2 k h0 t/n)",
    because="held to 3 %; water starts at rest and is late by 0.01 s, 1.7 % of the way at 0.3 s, 0.6 % at 0.9 s; "
    "a row in pores is 2.5 spacings high and its place known to a tenth of that: 0.25 of 12 to 20 spacings",
    tolerance=0.03,
    slow=True,
)
def imbibition_row() -> Measured:
    """Way of the front over the exact one at 0.3, 0.6 and 0.9 s, 30 particles over the height of the soil."""
    found = fronts()
    return Measured(1.0, found, max(abs(value - 1.0) for value in found))


BOOKINGS = 1000  # particles in the tank, and those that come and go, at most


def unbooked(steps: int = 2400) -> float:
    """Change of the mass of a dam's water that no reservoir has booked, over its mass."""
    both = Dam(rows=9, length=0.5).build()
    layer, supply = both.water.layer, both.supply
    assert supply is not None
    water = layer.mass[: layer.fluid]
    start = float(water.sum()) - sum(pool.let_in - pool.let_out for pool in supply.reservoirs)
    for _ in range(steps):
        both.advance()
    booked = sum(pool.let_in - pool.let_out for pool in supply.reservoirs)
    return abs(float(water.sum()) - start - booked) / float(water.sum())


@VALIDATIONS.row(
    "continuum.mass_between_levels",
    source="exact: mass of the water is what was there and what reservoirs let in and out",
    because="sums of some hundred masses of particles and of as many bookings, a round-off of 2.3e-16 each",
    tolerance=2.3e-16 * BOOKINGS,
    slow=True,
)
def mass_row() -> Measured:
    """Mass gained beside the books over the mass of the water, let in on one side of a dam and out on the other."""
    found = unbooked()
    return Measured(0.0, found, found)
