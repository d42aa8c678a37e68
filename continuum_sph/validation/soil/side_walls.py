"""A layer that slides on a slope between side walls, which brake it the more the deeper it lies.  SI."""

import functools
import math

from continuum_sph.validation.soil.setups import TAN_PHI, mean_acceleration
from continuum_sph.validation.soil.slopes import GRAVITY, HALF_DEGREE, layer
from porescale.common.evidence.validations import Measured, Validations

VALIDATIONS = Validations()

SLOPE = 40.0  # degrees
DEEP = 0.5  # m, of a layer of 1 m: how far down it slides
SPARE = math.tan(math.radians(SLOPE)) - TAN_PHI  # tan β - sin φ
BRAKE = SPARE / DEEP  # 2 tan δ/W, 1/m
BETWEEN = 0.5, 1.0  # s
EXACT = GRAVITY * math.cos(math.radians(SLOPE)) * BRAKE * DEEP**2 / 2.0
"""Mean acceleration of the whole layer, m/s²: g cos β 2 tan δ/W (d0 - d) at a depth d down to d0."""


@functools.cache
def acceleration(rows: int, brake: float = BRAKE, *, bounded: bool = False) -> float:
    """Mean acceleration (m/s²) of a strewn layer on its slope, `BETWEEN` two times;  brake : 2 tan δ/W, 1/m;
    bounded : its damping."""
    flow = layer(SLOPE, rows, columns=16, strewn=0.2, side_friction=brake, bounded=bounded)
    return mean_acceleration(flow, BETWEEN)


@VALIDATIONS.row(
    "continuum.soil_between_side_walls",
    source="exact: walls that rub by tan δ p brake a depth d by 2 tan δ/W g cos β d, so a layer slides down to "
    "d0 = W (tan β - sin φ)/2 tan δ, half of it here, with speeds linear in depth (p as of Taberlet et al. 2003, Jop "
    "et al. 2005); slope of 40°",
    because="half a degree of slope, to which slopes are read from pictures, of what tan β is over sin φ, squared",
    tolerance=2.0 * HALF_DEGREE * TAN_PHI / SPARE,
    slow=True,
)
def side_walls_row() -> Measured:
    """Mean acceleration of the layer over the exact one, with 20 and 40 rows, and 20 and 40 with bounded damping."""
    found = [acceleration(rows, bounded=bounded) for bounded in (False, True) for rows in (20, 40)]
    return Measured.absolute(1.0, [it / EXACT for it in found])
