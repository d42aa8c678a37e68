"""What experiments with soil share: soil in a tank, a free body of it, columns and layers on a slope.  SI."""

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from continuum_sph.builders.parts.soil import placed
from continuum_sph.soil import Material, Soil, SoilFlow, SoilLaw
from continuum_sph.soil.steadying import WEIGHTLESS, steadied
from continuum_sph.water.smoothing import RATIO, Smoothing
from porescale.common.core.constants import GRAVITY
from porescale.common.core.types import Floats
from porescale.common.neighbors import PairList

SKIN = 0.15  # of the pair list, over the smoothing length
TAN_PHI = 0.5  # of Maeda & Sakai 2004: τ_f = p tan φ; sin 30°
DENSITY, STIFFNESS, POISSON = 1590.0, 2e6, 0.3  # kg/m³: grains of 2650 at n = 0.4; Pa
COLUMN = STIFFNESS * (1.0 - POISSON) / ((1.0 + POISSON) * (1.0 - 2.0 * POISSON))  # Pa, modulus M of a column
AREA = STIFFNESS / (2.0 * (1.0 + POISSON) * (1.0 - 2.0 * POISSON))  # Pa, area modulus B


def in_tank(
    x: Floats,
    stress: Floats,
    tank: tuple[float, float],
    spacing: float,
    material: Material,
    *,
    gravity: float = GRAVITY,
    tilt: float = 0.0,
    floor: str = "hold",
    sides: str = "slip",
    **law: Any,
) -> SoilFlow:
    """Soil at ``x`` (n, 2) m with ``stress`` (n, 4) Pa in a tank (width, height), m, lower left corner at the origin.

    tilt : rad, of the floor: gravity leans to the right;  floor, sides : "hold" the soil or let it "slip", sides
    "none": endless soil, periodic across;  law : more of `SoilLaw`, with damping and diffusion as in a scene where not
    given, bounded or not.  Wendland C2, h of ``RATIO`` spacings.
    """
    lean = (gravity * math.sin(tilt), -gravity * math.cos(tilt))
    damping, diffusion = steadied(material, gravity, float(x[:, 1].max()) + 0.5 * spacing, RATIO * spacing)
    law = {"damping": WEIGHTLESS[0] if law.get("bounded") else damping, "diffusion": diffusion} | law
    given = SoilLaw(Smoothing("wendland", RATIO * spacing), spacing, (material,), lean, **law)
    return placed(x, stress, tank, given, floor=floor, sides=sides, skin=SKIN)


def run_until(flow: SoilFlow, time: float) -> SoilFlow:
    """Advance ``flow`` to ``time`` (s) or just beyond."""
    while flow.time < time:
        flow.advance()
    return flow


def mean_acceleration(
    flow: SoilFlow, between: tuple[float, float], which: NDArray[np.bool_] | slice = slice(None)
) -> float:
    """Mean acceleration (m/s²) along x of the soil of a ``flow``, which goes on, ``between`` two times, s;  which : of
    its particles, all unless given."""
    n, marks = flow.soil.soil, []
    for time in between:
        run_until(flow, time)
        marks.append((flow.time, float(flow.soil.v[:n, 0][which].mean())))
    (t0, v0), (t1, v1) = marks
    return (v1 - v0) / (t1 - t0)


def body(
    x: Floats, spacing: float, material: Material, stress: tuple[float, float, float, float], **law: Any
) -> SoilFlow:
    """Soil at ``x`` (n, 2) m without walls and weight, under one ``stress`` (4,) Pa, free on all sides."""
    n = len(x)
    smoothing = Smoothing("wendland", RATIO * spacing)
    soil = Soil(
        n, x.copy(), np.zeros((n, 2)), np.full(n, material.density * spacing**2), np.full(n, material.density),
        np.tile(np.array(stress), (n, 1)),
    )  # fmt: skip
    reach = float(np.abs(x).max()) + 4.0 * spacing
    pairs = PairList(n, SKIN * smoothing.length, (-reach, -reach), (reach, reach), full=True)
    flow = SoilFlow(soil, SoilLaw(smoothing, spacing, (material,), (0.0, 0.0), **law), pairs)
    flow.start()
    return flow
