"""Validations of soil: what one element does, what turns and what stays at rest; each takes what its twin changes."""

from __future__ import annotations

import functools
import math
from typing import Any

import numpy as np

from continuum_sph.build.soil import geostatic
from continuum_sph.soil import Material, SoilFlow
from continuum_sph.soil.state import GROWN, XX, YY
from continuum_sph.validation.soil_element_trials import biaxial, confined, squeezed
from continuum_sph.validation.soil_energy_trials import collapse, run_out
from continuum_sph.validation.soil_trials import body, in_tank, run_until, spun, turn
from porescale.common.evidence.validations import Measured, Validations
from porescale.common.neighbors import square_lattice

VALIDATIONS = Validations()

PAPER = 0.5  # tan φ of the paper's τ_f = p tan φ: sin 30°
GRAVITY = 9.8  # m/s², of the paper
EPS = float(np.finfo(np.float64).eps)
DENSITY, STIFFNESS, POISSON = 1590.0, 2e6, 0.3  # kg/m³: grains of 2650 at n = 0.4; Pa
COLUMN = STIFFNESS * (1.0 - POISSON) / ((1.0 + POISSON) * (1.0 - 2.0 * POISSON))  # Pa, modulus M of a column
AREA = STIFFNESS / (2.0 * (1.0 + POISSON) * (1.0 - 2.0 * POISSON))  # Pa, area modulus B


def failure_ratio(friction: float, dilatancy: float = 0.0) -> float:
    """σ1/σ3 of an element pressed to failure under 100 kPa; sines of the angles."""
    element, _ = biaxial(Material(1e7, DENSITY, sin_friction=friction, sin_dilatancy=dilatancy), 1e5, 0.05)
    return element.stress[YY] / element.stress[XX]


@VALIDATIONS.row(
    "continuum.soil_fails_at_three_to_one",
    source="Maeda & Sakai 2004: τ_f = p tan φ, tan φ = 0.5; Mohr-Coulomb, φ = 30°: (1 + sin φ)/(1 - sin φ)",
    because="the way back to yield is exact; the strain across is halved down to 1e-18 of 5e-4, which leaves the "
    "stress across round-off, in 400 steps",
    tolerance=3.0 * 400 * 2.0 * EPS,
)
def biaxial_row() -> Measured:
    """σ1/σ3 of a biaxial element at failure, without dilatancy and with ψ = φ."""
    found = [failure_ratio(PAPER), failure_ratio(PAPER, PAPER)]
    return Measured(3.0, found, max(abs(value - 3.0) for value in found))


def dilation(dilatancy: float) -> float:
    """-dε_v/dγ of an element that fails in a biaxial test with ψ of that sine."""
    _, rows = biaxial(Material(1e7, DENSITY, sin_friction=PAPER, sin_dilatancy=dilatancy), 1e5)
    upright, across = rows[-1, :2] - rows[-11, :2]
    return float(-(upright + across) / (upright - across))


@VALIDATIONS.row(
    "continuum.soil_dilates_as_told",
    source="definition of the angle of dilatancy in plane strain: dε_v = -sin ψ dγ",
    because="strains of ten steps of 5e-5, each across found to 1e-18 of 2e-4 but added up to 0.02: round-off of that, "
    "over ten steps",
    tolerance=0.02 * 20.0 * EPS / (10 * 5e-5),
)
def dilation_row() -> Measured:
    """-dε_v/dγ at failure for sin ψ = 0, 0.2, 0.5."""
    wanted = [0.0, 0.2, 0.5]
    found = [dilation(value) for value in wanted]
    return Measured(wanted, found, max(abs(a - b) for a, b in zip(found, wanted, strict=True)))


def rest_ratio(modulus: str, yields: bool = True) -> float:
    """K0 of an element that is pressed and cannot widen."""
    element = confined(Material(1e7, DENSITY, sin_friction=PAPER, modulus=modulus, yields=yields))
    return element.stress[XX] / element.stress[YY]


@VALIDATIONS.row(
    "continuum.soil_pressure_at_rest",
    source="derived: plane strain ν/(1 - ν), elastic (G/B = 0.4 < 0.5); eq. 43's modulus has G/B = 0.538 > 0.5, yields "
    "at once and keeps (1 - 0.5)/(1 + 0.5); elastic it would keep ν",
    because="100 equal steps: round-off of each",
    tolerance=100 * EPS,
)
def rest_row() -> Measured:
    """K0 with the plane-strain modulus, with the printed one, and with the printed one without yield."""
    wanted = [POISSON / (1.0 - POISSON), 1.0 / 3.0, POISSON]
    found = [rest_ratio("plane strain"), rest_ratio("printed"), rest_ratio("printed", yields=False)]
    return Measured(wanted, found, max(abs(a - b) for a, b in zip(found, wanted, strict=True)))


def turned_error(steps: int = 90, **law: bool) -> float:
    """Largest change of stress, over its largest component, in the frame of a block of 10 by 6 particles turned rigidly
    by 90° in ``steps``, at any time on the way."""
    spacing = 0.1
    x = square_lattice((-0.5, -0.3), (0.5, 0.3), spacing)
    flow = body(x, spacing, Material(1e7, DENSITY, yields=False), (3e3, 1e4, 2e3, 4e3), **law)
    return float(turn(flow, 0.5 * math.pi, steps)[1].max())


@VALIDATIONS.row(
    "continuum.soil_turned_keeps_its_stress",
    source="exact: rigid rotation does not strain; eq. 45 of Maeda & Sakai 2004 with the sign of eq. 19",
    because="velocities of places of 0.6 m have round-off 0.6 eps over neighbours 0.13 m away, times E/σ = 1e3 in "
    "stress, over 4 and 90 steps, whose errors add at worst; K magnifies up to fourfold",
    tolerance=4.0 * 1e3 * 0.6 / 0.13 * 90 * EPS,
)
def turned_row() -> Measured:
    """Largest change of stress in the block's frame, turned by 90° in 4 steps and in 90, corners included."""
    found = [turned_error(4), turned_error(90)]
    return Measured(0.0, found, max(found))


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
    found = [crossing("plane strain", 20), crossing("printed", 20)]
    return Measured(1.0, found, max(abs(value - 1.0) for value in found))


@functools.cache
def rest(seconds: float, restless: float = 0.0) -> tuple[float, float]:
    """(largest displacement, m, fastest, m/s) of level ground 1 m deep, 20 particles, after ``seconds``."""
    flow = column(1.0, 20, Material(STIFFNESS, DENSITY, POISSON, sin_friction=PAPER), sound_diffusion=restless)
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
    found = rest(10.0)[0]
    return Measured(0.0, found, found)


@functools.cache
def slope(degrees: float, seconds: float = 10.0, restless: float = 0.0) -> float:
    """Largest displacement (m) in ``seconds`` of a slope 1 m high, 10 rows, once braked for 1 s, on 0.2 m of ground."""
    spacing, height, base, crest = 0.1, 1.0, 0.2, 0.5
    foot = crest + height / math.tan(math.radians(degrees))
    width = math.ceil((foot + 0.5) / spacing) * spacing
    lattice = square_lattice((0.0, 0.0), (width, base + height), spacing)
    top = base + np.clip((foot - lattice[:, 0]) * math.tan(math.radians(degrees)), 0.0, height)
    inside = lattice[:, 1] < top
    material = Material(STIFFNESS, DENSITY, POISSON, sin_friction=PAPER)
    stress = geostatic((top - lattice[:, 1])[inside], material, GRAVITY)
    braked = 0.5 * math.pi * math.sqrt(COLUMN / DENSITY) / height
    flow = in_tank(
        lattice[inside], stress, (width, 1.5), spacing, material,
        gravity=GRAVITY, drag=braked, settle=1.0, sound_diffusion=restless,
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
    found = slope(22.0)
    return Measured(0.0, found, found)


def layer(degrees: float, rows: int = 20, friction: float = PAPER) -> SoilFlow:
    """An endless layer 1 m deep on a slope, with the stress of rest."""
    tilt, spacing = math.radians(degrees), 1.0 / rows
    material = Material(STIFFNESS, DENSITY, POISSON, sin_friction=friction)
    x = square_lattice((0.0, 0.0), (8 * spacing, 1.0), spacing)
    stress = geostatic(1.0 - x[:, 1], material, GRAVITY * math.cos(tilt))
    return in_tank(x, stress, (8 * spacing, 2.0), spacing, material, gravity=GRAVITY, tilt=tilt, sides="none")


def sliding(degrees: float, rows: int = 20, friction: float = PAPER) -> tuple[float, float]:
    """(mean acceleration between 0.5 s and 1 s, m/s², of such a layer; the one that `PAPER` gives it)."""
    flow, tilt = layer(degrees, rows, friction), math.radians(degrees)
    n, marks = flow.soil.soil, []
    for time in (0.5, 1.0):
        run_until(flow, time)
        marks.append((flow.time, float(flow.soil.v[:n, 0].mean())))
    (t0, v0), (t1, v1) = marks
    return (v1 - v0) / (t1 - t0), GRAVITY * (math.sin(tilt) - PAPER * math.cos(tilt))


@VALIDATIONS.row(
    "continuum.soil_slides_beyond_its_limit",
    source="exact: an endless layer without dilatancy shears where τ = σ_n sin φ, so at atan 0.5 = 26.6°, not 30° "
    "(Davis 1968), and goes with g (sin β - 0.5 cos β); slope of 28°",
    because="half of the row at the floor, of 20, is held by it and stays",
    tolerance=0.5 / 20,
    slow=True,
)
def sliding_row() -> Measured:
    """Acceleration of the layer over the exact one."""
    found, exact = sliding(28.0)
    return Measured(exact, found, abs(found / exact - 1.0))


STEEP = 35.0  # degrees


def departure(*, seconds: float = 2.0, exchanged: bool = True) -> float:
    """Largest share by which a particle's density ever departs from that at the start, of a layer that slides.

    exchanged : particles exchange volume, as `continuum_sph.soil.momentum` says.
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
)
def density_row() -> Measured:
    """Largest departure of a particle's density over the run, over its density."""
    found = departure()
    return Measured(0.0, found, found)


def kept(corrected: bool = True, seconds: float = 0.1, one_sided: bool = False) -> tuple[float, float]:
    """(change of linear momentum over Σ m |v|, change of angular momentum over its start) of a stressed block of 10 by
    6 particles that is let go spinning at 20 rad/s.

    one_sided : forget half of the forces on the first particle.
    """
    spacing = 0.1
    x = square_lattice((-0.5, -0.3), (0.5, 0.3), spacing)
    flow = body(
        x,
        spacing,
        Material(1e7, DENSITY, yields=False),
        (3e3, 1e4, 2e3, 4e3),
        corrected=corrected,
        spacing_recovery=0.0,
    )
    soil = flow.soil
    soil.v[:, 0], soil.v[:, 1] = -20.0 * x[:, 1], 20.0 * x[:, 0]

    def momenta() -> tuple[float, float, float]:
        """Momentum x, y and angular momentum about the origin."""
        px, py = (soil.mass[:, None] * soil.v).sum(axis=0)
        return px, py, float((soil.mass * (soil.x[:, 0] * soil.v[:, 1] - soil.x[:, 1] * soil.v[:, 0])).sum())

    scale, start = float((soil.mass * np.hypot(soil.v[:, 0], soil.v[:, 1])).sum()), momenta()
    while flow.time < seconds:
        if one_sided:
            soil.acceleration[0] *= 0.5
        flow.advance()
    end = momenta()
    return math.hypot(end[0] - start[0], end[1] - start[1]) / scale, abs(end[2] / start[2] - 1.0)


@VALIDATIONS.row(
    "continuum.soil_momentum",
    source="exact: forces of a pair are opposite, and stress does no work in rigid turning (Bonet & Lok 1999)",
    because="about 300 steps, each of which rounds velocities of 60 particles: 300 eps at worst, tenfold for forces "
    "that are large beside their sum",
    tolerance=10 * 300 * EPS,
)
def momentum_row() -> Measured:
    """Change of linear and of angular momentum of a spinning stressed block, 0.1 s."""
    found = list(kept())
    return Measured(0.0, found, max(found))


GROWING = Material(1e7, DENSITY, exponent=0.5, yields=False)
SQUEEZE = (1e5, 0.004, 100)  # Pa, strain both ways, steps


def stiffened(material: Material = GROWING) -> tuple[float, float]:
    """(exact mean stress, Pa, of an element of `GROWING` squeezed from all sides, the one that ``material`` finds)."""
    pressure, strain, steps = SQUEEZE
    slope = 0.5 * GROWING.area_modulus * GROWING.stiffness / math.sqrt(GROWING.reference)
    return (math.sqrt(pressure) + slope * 2.0 * strain) ** 2, squeezed(material, pressure, strain, steps)


@VALIDATIONS.row(
    "continuum.soil_stiffens_with_pressure",
    source="exact: dp = B0 (p/p0)^m dε_v of eq. 42 with m = 0.5: √p grows evenly",
    because="midpoints: a step h misses -h² a²/4 (ln √p)' of p, a = (√p)': 1.48/4 ln(438/316) Pa of 0.19 MPa, and as "
    "much again for the next order",
    tolerance=2.0 * 0.12 / 1.9e5,
)
def stiffness_row() -> Measured:
    """Mean stress of an element squeezed from all sides, 0.1 MPa to 0.19 MPa in 100 steps."""
    exact, found = stiffened()
    return Measured(exact, found, abs(found / exact - 1.0))


@VALIDATIONS.row(
    "continuum.soil_energy",
    source="exact: what soil loses of height and speed goes into the work of stress, damping and stops, less what "
    "parting and walls give",
    because="steps in time leave (ω Δt)²/8, ω Δt up to 0.5, of the finest waves, which hold no more than damping takes "
    "from them, a fifth",
    tolerance=0.5**2 / 8 / 5,
    slow=True,
)
def energy_row() -> Measured:
    """What is missing in the book of a collapse, 0.3 s, over what was lost."""
    found = collapse().missing()
    return Measured(0.0, found, abs(found))


PULL = 0.0045  # of the stiffness: a strong clay


@VALIDATIONS.row(
    "continuum.soil_under_tension_holds_together",
    source="exact: a bar that spins bears ρ ω² (L² - 4 x²)/8 and is longer by ρ ω² L³/12 E'",
    because="ends known to half a spacing of 30 over the length, of which the elongation is a cube",
    tolerance=3 * 0.5 / 30,
    slow=True,
)
def spinning_row() -> Measured:
    """Elongation of a cohesive bar over a turn and a half, over the exact one; tension 0.45 % of the stiffness."""
    found = spun(1.5, PULL, rows=30)
    return Measured(1.0, found, abs(found - 1.0))


SOFT, STIFF = 1e6, 5.84e6  # Pa
THICK = 0.08  # m²/s, α c h of the damping: what cases/soil_column_collapse has


def run_outs(viscosity: float | None = THICK) -> tuple[float, float]:
    """Fronts (m) of a column of soft and of stiff soil, once collapsed, 10 rows."""
    return run_out(SOFT, viscosity), run_out(STIFF, viscosity)


@VALIDATIONS.row(
    "continuum.soil_runs_out_alike_at_any_stiffness",
    source="derived: strains of 1e-3 change no run-out; what damping takes is the same where α c h is",
    because="a front is a particle of 0.01 m: half of it",
    tolerance=0.005,
    slow=True,
)
def run_out_row() -> Measured:
    """Front of a column of soil of 1 MPa against that of 5.84 MPa, m."""
    soft, stiff = run_outs()
    return Measured(stiff, soft, abs(soft - stiff))
