"""Validations of soil, water and air in one place; each measuring function takes what its failing twin changes."""

from __future__ import annotations

import functools

from continuum_sph.build.air_build import AIR
from continuum_sph.validation.air_trials import TrappedAir, air_pressure
from porescale.common.evidence.validations import Measured, Validations

VALIDATIONS = Validations()

CLOSED, OPEN = TrappedAir(), TrappedAir(chamber=0.15)
WATCHED = 0.3  # s: the air bears less than the water on the soil, so the front is level
PLACE = 0.25  # spacings to which a front is known: a tenth of the 2.5 between rows of water in pores


@functools.cache
def sunk(given: TrappedAir, time: float = WATCHED) -> tuple[float, float, float]:
    """(depth of the front, m, mean pressure of the air, Pa, change of the masses of water and air over their own)."""
    both = given.build()
    layer, n = both.water.layer, both.water.layer.fluid
    air = layer.material[:n] == AIR
    before = layer.mass[:n][~air].sum(), layer.mass[:n][air].sum()
    while both.time < time:
        both.advance()
    after = layer.mass[:n][~air].sum(), layer.mass[:n][air].sum()
    lost = max(abs(b - a) / a for a, b in zip(before, after, strict=True) if a > 0.0)
    return given.reached(both), air_pressure(both) if given.filled else 0.0, float(lost)


def late(given: TrappedAir, law: TrappedAir | None = None) -> tuple[float, float]:
    """(exact, found) depth of the front by the ``law`` of one column in another, m."""
    return (law or given).front(WATCHED), sunk(given)[0]


@VALIDATIONS.row(
    "continuum.infiltration_into_trapped_air",
    source="derived: momentum of the water that stands and of that in the soil, Darcy's drag, p V^γ of the air below "
    "(`continuum_sph.validation.air_trials`); without air and inertia Green & Ampt 1911",
    because="a front is a row of particles, 2.5 spacings apart in pores, whose place is known to a tenth of that: 0.25 "
    "of a way of 6.3 spacings",
    tolerance=PLACE / 6.3,
    slow=True,
)
def closed_row() -> Measured:
    """Depth of the front after 0.3 s where air cannot leave, m; error over the exact one."""
    exact, found = late(CLOSED)
    return Measured(exact, found, abs(found / exact - 1.0))


@VALIDATIONS.row(
    "continuum.infiltration_that_drives_air_out",
    source="derived: the same, air leaving through the floor against its own drag, μ_a/μ_w of the water's",
    because="a quarter of a spacing, as above, of a way of 8.9 spacings",
    tolerance=PLACE / 8.9,
    slow=True,
)
def open_row() -> Measured:
    """Depth of the front after 0.3 s where air leaves below, m; error over the exact one."""
    exact, found = late(OPEN)
    return Measured(exact, found, abs(found / exact - 1.0))


def squeezed(given: TrappedAir, exponent: float | None = None) -> float:
    """(p0 + p) V^γ over p0 V0^γ, V what the front leaves of the soil;  exponent: γ."""
    depth, pressure, _ = sunk(given)
    power = given.gas.exponent if exponent is None else exponent
    return float((1.0 + pressure / given.gas.base) * (1.0 - depth / given.height) ** power)


@VALIDATIONS.row(
    "continuum.trapped_air_is_compressed",
    source="exact: p V^γ of a gas that keeps its heat, V by the place of the front",
    because="a quarter of a spacing in the 13.7 that the front leaves, times γ = 1.403",
    tolerance=1.403 * PLACE / 13.7,
    slow=True,
)
def squeezed_row() -> Measured:
    """(p0 + p) V^γ over that at the start, after 0.3 s."""
    found = squeezed(CLOSED)
    return Measured(1.0, found, abs(found - 1.0))


@VALIDATIONS.row(
    "continuum.mass_of_three_phases",
    source="exact: particles keep their mass, grains their volume",
    because="sums of at most 370 masses, in the same order: none",
    tolerance=0.0,
    slow=True,
)
def mass_row() -> Measured:
    """Change of the mass of water and of air in 0.3 s, the larger, over their own."""
    found = max(sunk(CLOSED)[2], sunk(OPEN)[2])
    return Measured(0.0, found, found)
