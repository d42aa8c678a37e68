"""Water at rest in a tank: hydrostatic pressure, and no motion.  SI."""

import functools

import numpy as np

from continuum_sph.builders.parts.water import water_flow
from continuum_sph.validation.water.kernels import LATTICE
from continuum_sph.validation.water.setups import column_scene, run_until
from continuum_sph.water.eos.liquid import Tait
from continuum_sph.water.smoothing import RATIO
from porescale.common.core.constants import GRAVITY
from porescale.common.evidence.validations import Measured, Validations

VALIDATIONS = Validations()


@functools.cache
def hydrostatic(seconds: float, gravity_assumed: float = GRAVITY, rows: int = 20) -> tuple[float, float]:
    """A column of 1 m after ``seconds``: largest error of pressure over that at the floor, and fastest over c0."""
    scene = column_scene(1.0 / rows, tank=(0.5, 1.2), column=(0.5, 1.0), gradient="corrected")
    flow = run_until(water_flow(scene), seconds)
    layer, tait = flow.layer, flow.law.state
    assert isinstance(tait, Tait)
    exact = tait.pressure(tait.settled_density(1.0 - layer.x[: layer.fluid, 1], gravity_assumed))
    speed = np.hypot(layer.v[: layer.fluid, 0], layer.v[: layer.fluid, 1]).max()
    error = np.abs(tait.pressure(layer.density) - exact).max() / (tait.density * GRAVITY)
    return float(error), float(speed) / tait.sound_speed


SURFACE_ROW = (
    "gradients are corrected but for the row at the surface, so the pressure is right to the weight of half of it"
)


@VALIDATIONS.row(
    "continuum.hydrostatic_pressure",
    source="exact: dp = ρ g d(depth) with the Tait law; Maeda & Sakai 2004's figure 6 at rest",
    because=SURFACE_ROW + ", 1/40 of the depth",
    tolerance=1 / 40,
)
def hydrostatic_row() -> Measured:
    """Largest departure of pressure over that at the floor, after 2 s, 20 rows of particles."""
    return Measured.absolute(0.0, hydrostatic(2.0)[0])


@VALIDATIONS.row(
    "continuum.water_stays_at_rest",
    source="exact: no motion; scale the speed of sound, 10 √(2 g H)",
    because="a settling lattice leaves at most 1.3 % of g unbalanced; the widest pattern of a start that is its own "
    "mirror image, k² = (2π/W)² + (π/H)², has 0.013 g/(ν k²), ν = α h c0/16 (half the pairs approach); c0² = 200 g H",
    tolerance=LATTICE * 16.0 / (0.1 * 0.05 * RATIO * 200.0) / ((2.0 * np.pi / 0.5) ** 2 + np.pi**2),
)
def rest_row() -> Measured:
    """Fastest particle over the speed of sound after 2 s."""
    return Measured.absolute(0.0, hydrostatic(2.0)[1])


@VALIDATIONS.row(
    "continuum.hydrostatic_pressure_for_ten_seconds",
    source="exact: dp = ρ g d(depth) with the Tait law",
    because=SURFACE_ROW + ", 1/100 of the depth",
    tolerance=1 / 100,
    slow=True,
)
def long_hydrostatic_row() -> Measured:
    """Largest departure of pressure over that at the floor, after 10 s, 50 rows."""
    return Measured.absolute(0.0, hydrostatic(10.0, rows=50)[0])


@VALIDATIONS.row(
    "continuum.water_stays_at_rest_for_ten_seconds",
    source="exact: no motion; scale the speed of sound, 10 √(2 g H)",
    because="as continuum.water_stays_at_rest, h 2.5 times smaller: with ν = α h c0/16 as much more speed is left",
    tolerance=2.5 * LATTICE * 16.0 / (0.1 * 0.05 * RATIO * 200.0) / ((2.0 * np.pi / 0.5) ** 2 + np.pi**2),
    slow=True,
)
def long_rest_row() -> Measured:
    """Fastest particle over the speed of sound after 10 s, 50 rows of particles."""
    return Measured.absolute(0.0, hydrostatic(10.0, rows=50)[1])
