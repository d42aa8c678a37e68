"""Soil whose strength falls as it shears: one element, and a band across a layer that is sheared.  SI."""

import functools
import math

import numpy as np
from scipy.optimize import brentq

from continuum_sph.soil import Material, Softening
from continuum_sph.soil.momentum import BRAKED_BY
from continuum_sph.soil.softening import band_width
from continuum_sph.soil.steadying import steadied
from continuum_sph.soil.stress import XY
from continuum_sph.validation.soil.element import biaxial
from continuum_sph.validation.soil.setups import DENSITY, STIFFNESS, TAN_PHI, in_tank
from continuum_sph.water.smoothing import RATIO, Smoothing
from porescale.common.core.constants import GRAVITY
from porescale.common.core.types import Floats
from porescale.common.evidence.validations import Measured, Validations
from porescale.common.neighbors import square_lattice

VALIDATIONS = Validations()

LOOSE, DILATANCY, STRAIN = 0.35, 0.2, 0.02
"""sin φ after large strains, sin ψ before them and γs of the element."""
SAND = Material(1e7, DENSITY, sin_friction=TAN_PHI, sin_dilatancy=DILATANCY, softening=Softening(LOOSE, 0.0, STRAIN))
PRESSURE, PRESSED, STEPS = 1e5, 0.06, 1500  # Pa; upright strain


def exact_element(upright: float) -> tuple[float, float]:
    """(σ1/σ3, volume strain, dilation positive) of a biaxial element under PRESSURE at an ``upright`` strain beyond
    failure.

    With σ3 kept r = σ3 s/(1 - s) of s = sin φ(γ), the elastic shear strain is r/G, the volume strain (p - σ3)/B, p - σ3
    = r, less ∫ sin ψ dγ: all of the plastic shear strain γ, which is found where both add up to the upright strain.
    """
    soft = SAND.softening
    assert soft is not None
    area, shear = (it * SAND.stiffness for it in (SAND.area_modulus, SAND.shear_modulus))

    def at(plastic: float) -> tuple[float, float]:
        """(r, Pa, volume strain, compression positive)."""
        left = math.exp(-plastic / soft.shear_strain)
        sine = soft.sin_friction + (SAND.sin_friction - soft.sin_friction) * left
        radius = PRESSURE * sine / (1.0 - sine)
        return radius, radius / area - SAND.sin_dilatancy * soft.shear_strain * (1.0 - left)

    def lacks(plastic: float) -> float:
        """Twice the upright strain less that which is asked for."""
        radius, volume = at(plastic)
        return radius / shear + plastic + volume - 2.0 * upright

    plastic = brentq(lacks, 0.0, 4.0 * upright, xtol=1e-15)
    radius, volume = at(plastic)
    return (PRESSURE + 2.0 * radius) / PRESSURE, -volume


def element(material: Material = SAND) -> tuple[float, float]:
    """(σ1/σ3, volume strain, dilation positive) that the law has at PRESSED."""
    _, rows = biaxial(material, PRESSURE, PRESSED, STEPS)
    upright, across, along, beside = rows[-1]
    return along / beside, -(upright + across)


LAG = 2.0 * PRESSED / STEPS * (TAN_PHI - LOOSE) / STRAIN
"""By how much sin φ is ahead of itself for a step, whose γ is twice its upright strain, at the start."""


@VALIDATIONS.row(
    "continuum.soil_softens_as_told",
    source="exact: a biaxial element whose sin φ and sin ψ go with exp(-γ/γs); elastic and plastic strains add up",
    because="strength is that before a step: by what it changes in one, largest at the start, whose stress ratio has "
    "2/(1 - sin φ)² of it there, and whose volume strain is off by sin ψ of a step's γ",
    tolerance=2.0 / (1.0 - TAN_PHI) ** 2 * LAG,
)
def element_row() -> Measured:
    """σ1/σ3 and dilation of an element pressed to 6 %."""
    return Measured.absolute(list(exact_element(PRESSED)), list(element()))


DEEP, HELD, PACE, FAR = 1.0, 3, 0.005, 0.1  # m of the layer; rows of a platen; m/s and m of the slip
FIRM, WEAK, SLIP = 5e3, 1e3, 0.05  # Pa before and after large strains; m, γs times the width of a band
CONFINED = 2e4  # Pa
AHEAD = 0.02  # of γs: what the rows of the band begin with
LEVELS = (20, 40)


def band_of_particles(spacing: float) -> float:
    """Width (m) of a band of particles at ``spacing`` (m) with the kernel of scenes that name none."""
    return band_width(Smoothing("wendland", RATIO * spacing), spacing)


def clay(spacing: float, band: float | None = None) -> Material:
    """Clay whose bands soften by SLIP;  band : their width, m (left out: of particles)."""
    width = band_of_particles(spacing) if band is None else band
    return Material(
        STIFFNESS, DENSITY, sin_friction=0.0, cohesion_intercept=FIRM, softening=Softening(0.0, WEAK, SLIP / width)
    )


def sheared(rows: int, *, pace: float = PACE, band: float | None = None) -> tuple[Floats, Floats]:
    """(slip between the platens, m, shear stress, Pa) as a layer of clay is sheared, both (m,).

    A layer 1 m deep, endless, without weight, under CONFINED from all sides.  Its uppermost and lowermost rows move
    apart at ``pace`` (m/s).  The two rows in its middle begin with AHEAD of γs, so that the band forms there.
    """
    spacing = DEEP / rows
    width, material = 8 * spacing, clay(spacing, band)
    x = square_lattice((0.0, 0.0), (width, DEEP), spacing)
    stress = np.tile(np.array([1.0, 1.0, 0.0, 2.0 * material.poisson]) * CONFINED, (len(x), 1))
    flow = in_tank(x, stress, (width, 4.0 * DEEP), spacing, material, gravity=0.0, sides="none", floor="slip",
                   **in_weight(material, spacing))  # fmt: skip
    soil, n, first = flow.soil, flow.soil.soil, flow.soil.x[: flow.soil.soil, 1].copy()
    above, below = first > DEEP - HELD * spacing, first < HELD * spacing
    soil.plastic_shear[np.abs(first - 0.5 * DEEP) < spacing] = AHEAD * SLIP / band_of_particles(spacing)
    between = ~(above | below)
    slips, stresses, slip = [], [], 0.0
    while slip < FAR:
        for part, speed in ((above, 0.5 * pace), (below, -0.5 * pace)):
            soil.v[:n][part] = (speed, 0.0)
            soil.acceleration[part] = 0.0
        slip += pace * flow.next_step
        flow.advance()
        slips.append(slip)
        stresses.append(-float(soil.stress[:n, XY][between].mean()))
    return np.array(slips), np.array(stresses)


def in_weight(material: Material, spacing: float) -> dict[str, float]:
    """Damping and diffusion as ground of the layer's depth has them under its weight."""
    damping, diffusion = steadied(material, GRAVITY, DEEP, RATIO * spacing)
    return {"damping": damping, "diffusion": diffusion}


@functools.cache
def course(rows: int, pace: float = PACE, band: float | None = None) -> float:
    """Largest error of the shear stress of `sheared` over FIRM - WEAK, once it has slipped by twice the elastic slip.

    What slips in the band is all but the elastic slip between the inner rows of the platens, τ/G times their distance.
    """
    slip, stress = sheared(rows, pace=pace, band=band)
    free = (DEEP - (2 * HELD - 1) * DEEP / rows) / (clay(1.0).shear_modulus * STIFFNESS)
    late = slip > 2.0 * FIRM * free
    exact = WEAK + (FIRM - WEAK) * np.exp(-(slip - stress * free) / SLIP)
    return float(np.abs(stress - exact)[late].max() / (FIRM - WEAK))


BRAKE = BRAKED_BY * DENSITY * DEEP * math.sqrt(GRAVITY * DEEP) * PACE
"""Pa m: shear stress of damping between two rows that slip, over the spacing."""


@VALIDATIONS.row(
    "continuum.soil_softens_by_slip",
    source="exact: a band across a layer that is sheared slowly loses strength as exp(-slip/(γs w)), w its width, "
    "whatever the spacing (Pietruszczak & Mróz 1981)",
    because="the band begins with 0.02 of γs, which is as much of the strength that is lost; damping bears 0.055 "
    "ρ α c h v/Δx of the slip",
    tolerance=AHEAD + BRAKE * max(LEVELS) / (FIRM - WEAK),
    slow=True,
)
def band_row() -> Measured:
    """Largest error of the shear stress over the strength that is lost, with 20 and 40 rows."""
    return Measured.absolute(0.0, [course(rows) for rows in LEVELS])
