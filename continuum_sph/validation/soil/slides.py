"""A slab of strong soil that slides on a weak seam: how fast, against Newton's law.

An endless layer 1 m deep on a slope has a seam in its middle, a tenth as thick, whose strength does not bear the slope;
that of the soil above and below does.  Once the seam yields, what lies over it slides with g (sin β - sin φ cos β) of
the seam's sin φ, as a layer on a floor does.  Whatever else holds the particles of one row to those of the next, as
damping does, slows it: here it is `bounded`.
"""

import functools
import math
from typing import Any

import numpy as np

from continuum_sph.builders.parts.soil import geostatic, placed
from continuum_sph.soil import Material, SoilLaw
from continuum_sph.soil.momentum import HELD_BACK
from continuum_sph.soil.steadying import WEIGHTLESS, steadied
from continuum_sph.validation.soil.setups import DENSITY, POISSON, SKIN, STIFFNESS, mean_acceleration
from continuum_sph.water.smoothing import RATIO, Smoothing
from porescale.common.core.constants import GRAVITY
from porescale.common.evidence.validations import Measured, Validations
from porescale.common.neighbors import square_lattice

VALIDATIONS = Validations()

DEGREES, STRONG, WEAK = 30.0, 0.7, 0.4
"""Slope; sin φ of the soil, which rests up to 35°, and of the seam, up to 21.8°."""
THICK = 0.1  # m
BETWEEN = 0.75, 1.5  # s
EXACT = GRAVITY * (math.sin(math.radians(DEGREES)) - WEAK * math.cos(math.radians(DEGREES)))  # m/s²
LEVELS = (20, 40, 80)
"""Rows of the layer; 2, 4 and 8 of the seam."""


@functools.cache
def acceleration(rows: int, *, bounded: bool = True, **law: Any) -> float:
    """Mean acceleration (m/s²) of what lies over the seam, `BETWEEN` two times;  bounded : damping;  law : more of
    `SoilLaw`."""
    tilt, spacing = math.radians(DEGREES), 1.0 / rows
    width = 8 * spacing
    strong, weak = (Material(STIFFNESS, DENSITY, POISSON, sin_friction=it) for it in (STRONG, WEAK))
    x = square_lattice((0.0, 0.0), (width, 1.0), spacing)
    stress = geostatic(1.0 - x[:, 1], strong, GRAVITY * math.cos(tilt))
    down = (GRAVITY * math.sin(tilt), -GRAVITY * math.cos(tilt))
    damping, diffusion = steadied(strong, GRAVITY, 1.0, RATIO * spacing)
    law = {"damping": WEIGHTLESS[0] if bounded else damping, "diffusion": diffusion, "bounded": bounded} | law
    given = SoilLaw(Smoothing("wendland", RATIO * spacing), spacing, (strong, weak), down, **law)
    flow = placed(x, stress, (width, 2.0), given, sides="none", skin=SKIN, hasty=True)
    depth = x[:, 1] - 0.5
    flow.soil.material[: len(x)] = np.abs(depth) < 0.5 * THICK
    flow.start()
    return mean_acceleration(flow, BETWEEN, depth > 0.5 * THICK)


BRAKED = HELD_BACK * WEAK * GRAVITY * math.cos(math.radians(DEGREES)) / EXACT
"""Share of the acceleration that damping may take in the seam."""
MIDDLE = 0.5 / min(LEVELS) / 0.5
"""Share of the mass over the seam that half of a spacing is, as well as the height where it slips is known."""


@VALIDATIONS.row(
    "continuum.soil_slides_on_a_seam",
    source="exact: Newton's law of a slab on a weak seam of a slope of 30°, g (sin β - sin φ cos β)",
    because="damping bears a share of the strength across a plane that slips, `momentum.HELD_BACK`; where the seam "
    "slips is known to half a spacing of what lies over it",
    tolerance=BRAKED + MIDDLE,
    slow=True,
)
def seam_row() -> Measured:
    """Acceleration over the exact one."""
    return Measured.relative(EXACT, [acceleration(rows) for rows in LEVELS])
