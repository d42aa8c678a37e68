"""What a column of aluminium rods leaves that is let go, against the experiment of Bui et al. 2008.  SI.

Rods are plane and have no side walls, which hold grains in channels the more the deeper they are.  Friction grows with
the rate of shear, as that of discs does, and damping is `bounded`, so that nothing else brakes the front.
"""

import functools
import math
from dataclasses import replace

import numpy as np

from continuum_sph.builders.parts.soil import geostatic
from continuum_sph.soil import Material, Rate
from continuum_sph.validation.soil.setups import in_tank, run_until
from porescale.common.core.types import Floats
from porescale.common.evidence.validations import Measured, Validations
from porescale.common.neighbors import square_lattice

VALIDATIONS = Validations()

RODS_DEPTHS = ((0.10, 0.078), (0.20, 0.047), (0.26, 0.031), (0.30, 0.021), (0.36, 0.011))
"""(place, depth), m, of what a column of rods left: Bui, Fukagawa, Sako & Ohno, Int. J. Numer. Anal. Meth. Geomech. 32
(2008) 1537, digitised by Wyser, Alkhimenkov, Jaboyedoff & Podladchikov, Geosci. Model Dev. 14 (2021) 7749."""
RODS = Material(0.84e6, 2040.0, sin_friction=math.sin(math.radians(19.8)))
"""Their rods, of aluminium, 0.1 m high and 0.2 m wide: K 0.7 MPa; 2650 kg/m³, and with pores 2040."""
FASTEST = math.sin(math.radians(80.0))  # sin φ∞: so steep that the line below is met, within what a scene may have
DISCS = Rate(FASTEST, (FASTEST - RODS.sin_friction) / 1.1 - 0.1, 1.25e-3)
"""Rods of 1 and 1.5 mm, whose friction grows as that of discs: by 1.1 I (da Cruz, Emam, Prochnow, Roux & Chevoir, Phys.
Rev. E 72 (2005) 021309, up to I = 0.2); this law crosses that line at I = 0.1."""
STRIP = 0.02  # m, over which depths are counted: four particles of 20 rows


def deposit(rows: int, rate: Rate | None = DISCS) -> tuple[Floats, float]:
    """(positions (n, 2) of what a column of rods left, its spacing), m;  rate : of its friction."""
    height, base = 0.1, 0.2
    spacing = height / rows
    material = replace(RODS, rate=rate)
    x = square_lattice((0.0, 0.0), (base, height), spacing)
    stress = geostatic(height - x[:, 1], material)
    flow = in_tank(x, stress, (0.7, 0.15), spacing, material, bounded=True)
    run_until(flow, 0.7)
    return flow.soil.x[: flow.soil.soil].copy(), spacing


def depths(x: Floats, spacing: float) -> Floats:
    """Depths (m) of a deposit of particles at ``x`` (n, 2) m at the places of `RODS_DEPTHS`."""
    places = np.array([place for place, _ in RODS_DEPTHS])
    inside = np.abs(x[:, :1] - places) < 0.5 * STRIP
    return np.asarray(inside.sum(axis=0) * spacing**2 / STRIP)


@functools.cache
def rods_error(rows: int, rate: Rate | None = DISCS) -> float:
    """Root mean square, m, of what the depths of a deposit differ by from those of the rods."""
    return float(np.sqrt(((depths(*deposit(rows, rate)) - [depth for _, depth in RODS_DEPTHS]) ** 2).mean()))


@VALIDATIONS.row(
    "continuum.soil_runs_out_as_rods",
    source="Bui et al. 2008: what a column of aluminium rods left, which no side wall held; their own angle of 19.8°, "
    "and friction that grows with the rate of shear as that of discs (da Cruz et al. 2005)",
    because="half a particle of 20 rows, as well as a depth is counted, and a millimetre of the digitised ones",
    tolerance=math.hypot(0.5 * 0.1 / 20, 1e-3),
    slow=True,
)
def rods_row() -> Measured:
    """Root mean square of the errors of five depths, with 20 and 40 rows, m."""
    return Measured.absolute(0.0, [rods_error(rows) for rows in (20, 40)])
