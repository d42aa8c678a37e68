"""Flows through open sides: a channel between two pressures, a plug that comes and goes.  Lattice units."""

import numpy as np

from porescale.common.core.types import Reals
from porescale.common.evidence.validations import Measured, Validations
from porescale.lbm.boundary.sides import Sides
from porescale.lbm.fluid import Fluid
from porescale.lbm.lattice import relaxation_time
from porescale.validation.lbm.channels import run


def pressure_channel(
    height: int, length: int, viscosity: float, drop: float, operator: str = "trt"
) -> tuple[Reals, Reals]:
    """Velocity between two pressure sides over the exact peak, (height, length), and the exact parabola, (height,).

    drop: of density from left to right.  Started from rest, run until 20 of its memories height²/(pi² viscosity) and
    of the sound's, (2 length/pi)²/viscosity, have passed.
    """
    sides = Sides("pressure", "pressure", left_density=1 + drop / 2, right_density=1 - drop / 2)
    fluid = Fluid(length, height, relaxation_time(viscosity), operator=operator, sides=sides)
    run(fluid.advance, round(20 * height**2 / (np.pi**2 * viscosity)) + 20 * length)
    y = np.arange(height) + 0.5
    peak = drop / 3 / length * height**2 / (8 * viscosity)
    return fluid.fields()[1] / peak, 4 * y * (height - y) / height**2


def plug(length: int, height: int, speed_in: float, speed_out: float, steps: int) -> tuple[float, float]:
    """Mass gained in ``steps`` by a box between walls that fluid enters at the left and leaves at the right, and what
    the given speeds are."""
    sides = Sides("velocity", "velocity", left_velocity=(speed_in, 0.0), right_velocity=(speed_out, 0.0))
    fluid = Fluid(length, height, 0.8, sides=sides)
    before = fluid.mass_excess()
    run(fluid.advance, steps)
    return fluid.mass_excess() - before, steps * height * (speed_in - speed_out)


def inlet(
    height: int, viscosity: float = 1 / 6, peak: float = 1e-5, *, memories: float = 20, operator: str = "trt"
) -> float:
    """Root mean square over a square behind a velocity side that gives a parabola, of the velocity less the parabola,
    over its peak.  So slow that the density changes by less than 1e-4 of that, or by what ``fast_inlet_row`` says.

    Run until so many of the memories named in ``pressure_channel`` have passed.
    """
    y, length = np.arange(height) + 0.5, 2 * height
    u = 4 * y * (height - y) / height**2
    given = np.stack([peak * u, 0 * y], 1)
    sides = Sides("velocity", "pressure", left_velocity=given)
    fluid = Fluid(length, height, relaxation_time(viscosity), operator=operator, sides=sides)
    fluid.set_flow(np.tile(given[:, :1], (1, length)), np.zeros((height, length)))
    run(fluid.advance, round(memories * height**2 / (np.pi**2 * viscosity)) + 20 * length)
    _, ux, uy = (field[:, :height] for field in fluid.fields())
    return float(np.sqrt(np.mean((ux / peak - u[:, None]) ** 2 + (uy / peak) ** 2)))


VALIDATIONS = Validations()

HEIGHT, LENGTH = 10, 20
DROP = 1e-4
VISCOSITIES = (1 / 30, 1 / 6, 1.0)
SPEED, STEPS = 0.05, 1000
MASS_ROUND_OFF = 9 * 0.05 * float(np.finfo(float).eps) * HEIGHT * LENGTH * STEPS


@VALIDATIONS.row(
    "lbm.poiseuille_between_pressures",
    source="exact parabola, walls midway at magic 3/16; u rho is the same in every section",
    because="density, and with it 1/u, changes by half the drop to either side; the same again for its convection",
    tolerance=DROP,
)
def pressure_channel_row() -> Measured:
    """Largest deviation from the parabola in any section over the peak, tau 0.6, 1 and 3.5."""
    pairs = [pressure_channel(HEIGHT, LENGTH, viscosity, DROP) for viscosity in VISCOSITIES]
    worst = max(float(np.abs(found - parabola[:, None]).max()) for found, parabola in pairs)
    return Measured([float(exact.max()) for _, exact in pairs], [float(found.max()) for found, _ in pairs], worst)


@VALIDATIONS.row(
    "lbm.parabola_from_an_inlet",
    source="a parabola that enters a channel is the channel's own: it goes on as it is, walls midway at magic 3/16",
    because="1/n² at n cells: between two cells the mean lies 1/n² of the peak below the parabola; in the two corners a"
    " link brings 2/n too much with a share 1/6, which four cells each feel: sqrt(8) 1/(3 n)/n = 0.94/n² as the"
    " root mean square over n² cells",
    tolerance=1.0,
)
def inlet_row() -> Measured:
    """Root mean square of the error over the peak, times n², at 8 and 16 cells."""
    return Measured.absolute([0.0, 0.0], [n**2 * inlet(n) for n in (8, 16)])


@VALIDATIONS.row(
    "lbm.parabola_from_a_fast_inlet",
    source="as lbm.parabola_from_an_inlet: a parabola is the channel's own at any Reynolds number",
    because="1/n² at n cells as there, whatever the cell Reynolds number; the density's drop, 2 n of 24 nu peak/n², is"
    " 0.04 and 0.07/n² of the peak on top at most",
    tolerance=1.11,
)
def fast_inlet_row() -> Measured:
    """As ``inlet_row`` where fluid passes ten cells in the viscous time of one, tau 0.509.

    Begun as a parabola, so that two memories of viscosity are enough: the fluid passes the channel 14 times and more.
    """
    return Measured.absolute([0.0, 0.0], [n**2 * inlet(n, 0.003, 0.03, memories=2) for n in (8, 16)])


@VALIDATIONS.row(
    "lbm.plug_balances",
    source="mass: what enters at one speed and leaves at another",
    because="round-off: nine populations of size 0.05 of each cell in each step, all one way",
    tolerance=MASS_ROUND_OFF,
)
def plug_row() -> Measured:
    """Mass gained in 1000 steps when as much leaves as enters, and in 20 when a tenth less leaves."""
    even, none = plug(LENGTH, HEIGHT, SPEED, SPEED, STEPS)
    more, expected = plug(LENGTH, HEIGHT, SPEED, 0.9 * SPEED, 20)
    return Measured.absolute([none, expected], [even, more])
