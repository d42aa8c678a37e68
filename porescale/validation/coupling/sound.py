"""Validations of motion that changes with time, which sound must have the time to follow."""

from porescale.common.evidence.validations import Measured, Validations
from porescale.lbm.lattice import viscosity
from porescale.validation.coupling.moving import oscillation, oscillation_in_a_box

VALIDATIONS = Validations()

FREQUENCY, RADIUS, WIDTH, SLOW = 5.0, 5.0, 14.0, 0.53
"""a² w/nu;  radius in cells;  of the box, in radii;  tau."""


def turn(relaxation_time: float) -> float:
    """By how much (rad) it swings while sound crosses the box: w W/c."""
    return float(FREQUENCY * viscosity(relaxation_time) / RADIUS**2 * WIDTH * RADIUS * 3**0.5)


def damping(relaxation_time: float) -> float:
    """Damping of the disc over that of linear theory without sound."""
    found = oscillation(FREQUENCY, radius=RADIUS, width=WIDTH, relaxation_time=relaxation_time)
    return found.imag / oscillation_in_a_box(FREQUENCY, WIDTH).imag


@VALIDATIONS.row(
    "coupling.damping_at_ten_cells",
    source="Stokes 1851: damping of an oscillating cylinder, 1.637 at a² w/nu 5; images of its dipole in the box added",
    because="required: 5 %. The rim is a cell thick where the viscous layer has three, 1.1 % of the radius is its"
    " shift, and sound that crosses the box in 0.24 rad adds its square by 0.15, 0.9 %",
    tolerance=0.05,
)
def slow_enough() -> Measured:
    """Damping over the theory's, 10 cells per diameter in a box of 70, tau 0.53."""
    return Measured.absolute(1.0, damping(SLOW))
