"""Columns, level ground and slopes of soil: what stays at rest, and what slides.  SI."""

import functools
import math
from typing import Any

import numpy as np

from continuum_sph.builders.parts.soil import geostatic
from continuum_sph.soil import Material, Rate, SoilFlow
from continuum_sph.soil.stress import GROWN
from continuum_sph.validation.soil.setups import (
    AREA,
    COLUMN,
    DENSITY,
    POISSON,
    STIFFNESS,
    TAN_PHI,
    in_tank,
    mean_acceleration,
    run_until,
)
from porescale.common.evidence.validations import Measured, Validations
from porescale.common.neighbors import square_lattice

VALIDATIONS = Validations()

GRAVITY = 9.8  # m/s², of Maeda & Sakai 2004


def column(height: float, rows: int, material: Material, stressed: bool = True, **law: Any) -> SoilFlow:
    """A column of soil ``rows`` high and half as wide between slippery sides, with the stress of rest or none."""
    spacing = height / rows
    width = spacing * max(8, rows // 2)
    x = square_lattice((0.0, 0.0), (width, height), spacing)
    stress = geostatic(height - x[:, 1], material, GRAVITY) if stressed else np.zeros((len(x), 4))
    return in_tank(x, stress, (width, 1.2 * height), spacing, material, gravity=GRAVITY, **law)


def crossing(modulus: str, rows: int) -> float:
    """Time after which a column that is let go without stress is lowest, over 2 H/√(M/ρ) with M = B + G."""
    material = Material(STIFFNESS, DENSITY, POISSON, modulus=modulus, yields=False)
    flow = column(1.0, rows, material, stressed=False)
    top = flow.soil.x[: flow.soil.soil, 1] > 1.0 - 1.0 / rows
    before, after, time = 0.0, -1.0, 0.0
    while after < 0.0 or flow.step < 10:
        time, before = flow.time, after
        flow.advance()
        after = float(flow.soil.v[: flow.soil.soil, 1][top].mean())
    at = time - before * (flow.time - time) / (after - before)
    return at / (2.0 / math.sqrt(material.column_modulus / DENSITY))


@VALIDATIONS.row(
    "continuum.soil_column_modulus",
    source="exact: a confined column let go without stress is lowest after 2 H/√(M/ρ), M = B + G: 1.88 E/2(1 - ν) in "
    "plane strain, 1.54 with eq. 43",
    because="surface and floor lie half a spacing beyond the last particles, which the stress there does not know: "
    "half a spacing of 20 in the height",
    tolerance=0.5 / 20,
)
def modulus_row() -> Measured:
    """That time over the exact one, for both area moduli, 20 particles high."""
    return Measured.absolute(1.0, [crossing("plane strain", 20), crossing("printed", 20)])


@functools.cache
def rest(seconds: float, restless: float = 0.0) -> tuple[float, float]:
    """(largest displacement, m, fastest, m/s) of level ground 1 m deep, 20 particles, after ``seconds``."""
    flow = column(1.0, 20, Material(STIFFNESS, DENSITY, POISSON, sin_friction=TAN_PHI), sound_diffusion=restless)
    first = flow.soil.x[: flow.soil.soil].copy()
    run_until(flow, seconds)
    return float(np.hypot(*(flow.soil.x[: flow.soil.soil] - first).T).max()), flow.max_speed


HALF_ROW = DENSITY * GRAVITY * 0.025 / COLUMN  # m: weight of half a row of 0.05 m that 1 m of soil carries wrongly


@VALIDATIONS.row(
    "continuum.soil_at_rest_stays",
    source="exact: level ground with the stress of its weight does not move",
    because="weight of half a row over M in a height of 1 m: what the missing support of the surface is worth",
    tolerance=HALF_ROW,
    slow=True,
)
def rest_row_of_ten_seconds() -> Measured:
    """Largest displacement of a particle in 10 s, m."""
    return Measured.absolute(0.0, rest(10.0)[0])


@functools.cache
def slope(degrees: float, seconds: float = 10.0, rows: int = 10, **law: Any) -> float:
    """Largest displacement (m) in ``seconds`` of a slope 1 m high, once braked for 1 s, on 0.2 m of ground.

    rows : particles over its height;  law : more of `SoilLaw`.
    """
    spacing, height, base, crest = 1.0 / rows, 1.0, 0.2, 0.5
    foot = crest + height / math.tan(math.radians(degrees))
    width = math.ceil((foot + 0.5) / spacing) * spacing
    lattice = square_lattice((0.0, 0.0), (width, base + height), spacing)
    top = base + np.clip((foot - lattice[:, 0]) * math.tan(math.radians(degrees)), 0.0, height)
    inside = lattice[:, 1] < top
    material = Material(STIFFNESS, DENSITY, POISSON, sin_friction=TAN_PHI)
    stress = geostatic((top - lattice[:, 1])[inside], material, GRAVITY)
    braked = 0.5 * math.pi * math.sqrt(COLUMN / DENSITY) / height
    flow = in_tank(
        lattice[inside], stress, (width, 1.5), spacing, material,
        gravity=GRAVITY, drag=braked, settle=1.0, **law,
    )  # fmt: skip
    run_until(flow, 1.0)
    first = flow.soil.x[: flow.soil.soil].copy()
    run_until(flow, 1.0 + seconds)
    return float(np.hypot(*(flow.soil.x[: flow.soil.soil] - first).T).max())


@VALIDATIONS.row(
    "continuum.soil_slope_below_its_limit_stays",
    source="exact: below atan(sin φ) = 26.6° no layer of soil without dilatancy shears; slope of 22°",
    because="a tenth of what a height of 1 m settles by under its own weight, ρ g H²/2M: a creep that anyone would see",
    tolerance=0.1 * DENSITY * GRAVITY / (2.0 * COLUMN),
    slow=True,
)
def slope_row() -> Measured:
    """Largest displacement of a particle in 10 s, m."""
    return Measured.absolute(0.0, slope(22.0))


NEAR = math.degrees(math.atan(TAN_PHI)) - 2.0
"""Slope (degrees) two below its limit."""


@VALIDATIONS.row(
    "continuum.soil_slope_near_its_limit_stays",
    source="exact: below atan(sin φ) = 26.6° no layer of soil without dilatancy shears; slope of 24.6°",
    because="a mean shear strain of 1e-3, a sixth of what its own weight strains it by, ρ g H/M",
    tolerance=1e-3,
    slow=True,
)
def near_row() -> Measured:
    """Largest displacement of a particle in 5 s, with 20 and 40 rows over the slope, m."""
    return Measured.absolute(0.0, [slope(NEAR, 5.0, rows) for rows in (20, 40)])


def layer(
    degrees: float,
    rows: int = 20,
    friction: float = TAN_PHI,
    *,
    columns: int = 8,
    strewn: float = 0.0,
    rate: Rate | None = None,
    **law: Any,
) -> SoilFlow:
    """An endless layer 1 m deep on a slope, with the stress of rest.

    strewn : largest distance of a particle from its place in the lattice along each axis, spacings;  rate : how its
    friction grows with the rate of shear;  law : more of `SoilLaw`.
    """
    tilt, spacing = math.radians(degrees), 1.0 / rows
    width = columns * spacing
    material = Material(STIFFNESS, DENSITY, POISSON, sin_friction=friction, rate=rate)
    x = square_lattice((0.0, 0.0), (width, 1.0), spacing)
    x += np.random.default_rng(1).uniform(-strewn, strewn, x.shape) * spacing
    x[:, 0] %= width
    stress = geostatic(1.0 - x[:, 1], material, GRAVITY * math.cos(tilt))
    return in_tank(x, stress, (width, 2.0), spacing, material, gravity=GRAVITY, tilt=tilt, sides="none", **law)


@functools.cache
def left_speed(rows: int, degrees: float = NEAR, seconds: float = 1.5) -> float:
    """Mean speed (m/s) that an endless strewn layer on a slope has after ``seconds``.

    It starts without shear and with K0 < 1: it bears less than its limit while its stress turns, and slides at first.
    """
    flow = run_until(layer(degrees, rows, strewn=0.2), seconds)
    return abs(float(flow.soil.v[: flow.soil.soil, 0].mean()))


SHEAR = STIFFNESS / (2.0 * (1.0 + POISSON))  # Pa, G
BRAKED = GRAVITY * (TAN_PHI * math.cos(math.radians(NEAR)) - math.sin(math.radians(NEAR)))  # m/s², what slides


@VALIDATIONS.row(
    "continuum.soil_layer_near_its_limit_stops",
    source="exact: below atan(sin φ) = 26.6° no layer of soil without dilatancy goes on sliding; from rest without "
    "shear, 20, 40 and 80 rows on 24.6°",
    because="what braked it while it slid, g (sin φ cos β - sin β), is left over when it stops, and lets it swing "
    "about its place with its slowest period, 4 H/√(G/ρ): by that over π √(G/ρ)/2H",
    tolerance=BRAKED / (0.5 * math.pi * math.sqrt(SHEAR / DENSITY)),
    slow=True,
)
def stop_row() -> Measured:
    """Mean speed 1.5 s after the start, m/s."""
    return Measured.absolute(0.0, [left_speed(rows) for rows in (20, 40, 80)])


@functools.cache
def strewn_friction(
    rows: int, *, degrees: float = 30.0, friction: float = TAN_PHI, between: tuple[float, float] = (0.75, 1.5)
) -> float:
    """Friction that slows a layer of strewn particles on a slope: (g sin β - a)/(g cos β), a (m/s²) its mean
    acceleration ``between`` two times, s.

    friction : sin φ of the soil.
    """
    found = mean_acceleration(layer(degrees, rows, friction, columns=16, strewn=0.2), between)
    tilt = math.radians(degrees)
    return (GRAVITY * math.sin(tilt) - found) / (GRAVITY * math.cos(tilt))


HALF_DEGREE = math.radians(0.5) * (1.0 + TAN_PHI**2) / TAN_PHI
"""Share of tan β = 0.5 that half a degree is worth: as well as slopes are read from pictures."""


@VALIDATIONS.row(
    "continuum.soil_friction_at_three_spacings",
    source="exact: an endless layer without dilatancy shears where τ = σ_n sin φ, so at atan 0.5 = 26.6°, not 30° "
    "(Davis 1968), and goes with g (sin β - 0.5 cos β); from a strewn lattice of 20, 40 and 80 rows, slope of 30°",
    because="half a degree of slope, to which slopes are read from pictures.  What is left is half of the row at "
    "the floor, which is held, and upright columns that rotate side by side: they are weaker (de Josselin de Jong, "
    "Géotechnique 21 (1971) 155: down to sin φ cos φ/(1 + sin² φ) = 0.35), and form the easier the finer the soil",
    tolerance=HALF_DEGREE,
    slow=True,
)
def strewn_row() -> Measured:
    """Friction of the layers over the exact one."""
    return Measured.relative(TAN_PHI, [strewn_friction(rows) for rows in (20, 40, 80)])


FAR, LONG, LEVELS = 32.0, 4.0, (20, 40, 80)
"""Slope (degrees), time (s) and rows of layers that slide by 8 m on their floor."""


@functools.cache
def sunk(rows: int) -> float:
    """By how much (m) the mean height of a strewn layer is less than it was, once it has slid for `LONG`."""
    flow = layer(FAR, rows, columns=16, strewn=0.2)
    n, first = flow.soil.soil, float(flow.soil.x[: flow.soil.soil, 1].mean())
    run_until(flow, LONG)
    return first - float(flow.soil.x[:n, 1].mean())


@VALIDATIONS.row(
    "continuum.soil_that_slides_keeps_its_height",
    source="exact: without dilatancy shear changes no volume; an endless layer on a slope of 32°, which slides 8 m on "
    "its floor, a shear strain of 80 and more in two rows",
    because="half of a row of 20: where surface and floor lie is known to that.  Densities that follow velocities do "
    "not see particles that crowd, so the height is measured",
    tolerance=0.5 / 20,
    slow=True,
)
def height_row() -> Measured:
    """How far the middle of a layer 1 m deep sinks, with 20, 40 and 80 rows, m."""
    return Measured.absolute(0.0, [sunk(rows) for rows in LEVELS])


STEEP = 35.0  # degrees


def departure(*, seconds: float = 2.0, exchanged: bool = True) -> float:
    """Largest share by which a particle's density ever departs from that at the start, of a layer that slides.

    exchanged : particles exchange volume, as in `continuum_sph.soil.momentum`.
    """
    flow = layer(STEEP)
    start, largest = flow.soil.density.copy(), 0.0
    while flow.time < seconds:
        if not exchanged:
            flow.soil.spread[:, GROWN] = 0.0
        flow.advance()
        largest = max(largest, float(np.abs(flow.soil.density / start - 1.0).max()))
    return largest


@VALIDATIONS.row(
    "continuum.soil_that_slides_keeps_its_density",
    source="exact: without dilatancy shear changes no volume; an endless layer on a slope of 35°, which slides 3 m in "
    "2 s, by a shear strain of 30 at its floor",
    because="shear along the floor takes σ_xx from K0 σ_yy to σ_yy and mean stress from (1 + K0)/2 of the weight to "
    "all of it, at once, so by twice that in the swing; over the area modulus B",
    tolerance=2.0 * 0.5 * (1.0 - POISSON / (1.0 - POISSON)) * DENSITY * GRAVITY * math.cos(math.radians(STEEP)) / AREA,
    slow=True,
)
def density_row() -> Measured:
    """Largest departure of a particle's density over the run, over its density."""
    return Measured.absolute(0.0, departure())
