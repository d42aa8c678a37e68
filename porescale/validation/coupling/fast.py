"""A cylinder towed fast from rest near tau = 1/2, where the viscous layer is thinner than a cell.  Lattice units."""

import math

import numpy as np
from numpy.typing import NDArray

from porescale.common.evidence.validations import Measured, Validations
from porescale.coupling.psm import SaturatedCells
from porescale.lbm.boundary.sides import Sides
from porescale.lbm.fluid import Fluid
from porescale.lbm.lattice import relaxation_time

STARTED = {50: 1.80894, 100: 1.50316, 200: 1.32127, 500: 1.20376}
"""Mean drag coefficient over 1 <= t U/D <= 3 of a cylinder started impulsively in unbounded fluid, by Reynolds number
U D/nu: tests/reference/cylinder_start.py, a body-fitted solution that shares nothing with the lattice; sums over 0.25,
good to 1e-4."""
WIDE = 40
"""Diameters across the periodic box: sound does not come round within the time looked at."""


def potential_start(fluid: Fluid, x: float, y: float, radius: float, u: float, v: float) -> None:
    """Set the flow of a cylinder that has just been set moving: potential outside, its own velocity inside."""
    at_y, at_x = np.mgrid[: fluid.ny, : fluid.nx] + 0.5
    dx, dy = at_x - x, at_y - y
    far = np.maximum(dx**2 + dy**2, radius**2)
    along = 2 * (dx * u + dy * v) / far
    inside = dx**2 + dy**2 < radius**2
    share = radius**2 / far
    fluid.set_flow(np.where(inside, u, share * (along * dx - u)), np.where(inside, v, share * (along * dy - v)))


def started(
    reynolds: float,
    diameter: float = 15.0,
    speed: float = 0.05,
    *,
    degrees: float = 11.0,
    operator: str = "central",
    soft_rim: bool = True,
    solid_operator: str = "exact-wall",
    held: bool = False,
    stands: bool = False,
    wide: int = WIDE,
) -> tuple[float, float]:
    """Mean drag coefficient over 1 <= t U/D <= 3, and the noise: rms about a smooth curve over the mean.

    degrees: between the direction and the lattice;  held: the cylinder stays and the fluid comes;  stands: and its rim
    is that of a disc that never moves.
    """
    across, along = round(wide * diameter), round(0.75 * wide * diameter)
    periodic = Sides("periodic", "periodic", "periodic", "periodic")
    fluid = Fluid(across, along, relaxation_time(speed * diameter / reynolds), operator=operator, sides=periodic)
    wet = SaturatedCells(fluid, np.array([diameter / 2]), solid_operator=solid_operator, soft_rim=soft_rim)
    direction = np.array([math.cos(math.radians(degrees)), math.sin(math.radians(degrees))])
    motion = speed * direction[None]
    if wet.soft_rim:
        wet.soft_rim.stands[:] = stands
    place = np.array([[across / 2 + 0.3, along / 2 + 0.1]]) - (0 if held else 1.5 * diameter * direction)
    (x, y), (u, v) = place[0], motion[0]
    potential_start(fluid, x, y, diameter / 2, u, v)
    if held:
        _, ux, uy = fluid.fields()
        fluid.set_flow(ux - motion[0, 0], uy - motion[0, 1])
    own, none = (0 * motion if held else motion), np.zeros(1)
    steps = round(3 * diameter / speed)
    force: NDArray[np.floating] = np.zeros(steps)
    for step in range(steps):
        wet.advance(fluid, place, own, none)
        place += own
        force[step] = -wet.force[0] @ direction
    time = (np.arange(steps) + 0.5) * speed / diameter
    late = time >= 1
    drag = force[late] / (0.5 * speed**2 * diameter)
    curve = np.polyval(np.polyfit(time[late], drag, 4), time[late])
    return float(drag.mean()), float(np.std(drag - curve) / drag.mean())


VALIDATIONS = Validations()

NOISE = 0.02
"""Largest rms of the drag about a smooth curve, over the mean."""
SLOW_STARTS = (
    (50, 0.0222, 11.0), (100, 0.0444, 33.0), (200, 0.0444, 45.0), (500, 0.0556, 33.0), (500, 0.0222, 0.0),
    (500, 0.0111, 11.0), (500, 0.0056, 11.0),
)  # fmt: skip
"""Reynolds number, speed and direction: tau 0.52, 0.52, 0.51, 0.505, 0.502, 0.501 and 0.5005 at 15 cells."""


def fast_starts(cases: tuple[tuple[float, float, float], ...], **options: bool | str) -> Measured:
    """Mean drag coefficients, and the largest error; infinite if one is noisier than ``NOISE``."""
    found = [started(re, speed=u, degrees=turn, **options) for re, u, turn in cases]  # type: ignore[arg-type]
    reference = [STARTED[int(re)] for re, _, _ in cases]
    drags = [drag for drag, _ in found]
    error = float(np.abs(np.divide(drags, reference) - 1).max())
    return Measured(reference, drags, error if max(noise for _, noise in found) <= NOISE else float("inf"))


@VALIDATIONS.row(
    "coupling.fast_start",
    source="a cylinder set moving at once, Re 100 and 500, tau 0.5225 and 0.5045: body-fitted solution in the tests",
    because="2.5 %, half of what was required: the constants of the soft rim leave up to 1.2 % where they were chosen"
    " (10 and 15 cells, speed 0.04), the box of 40 by 30 diameters 0.3 % (its mirror images hold back (pi/2)(d/W)²"
    " = 0.1 to 0.2 %), the place in the cell and the speed the rest; noise at most 2 %, or the row fails",
    tolerance=0.025,
)
def fast() -> Measured:
    """Mean drag coefficient over 1 <= t U/D <= 3, 15 cells per diameter."""
    return fast_starts(((100, 0.05, 11.0), (500, 0.05, 11.0)))


@VALIDATIONS.row(
    "coupling.fast_start_of_what_stands",
    source="the same cylinder stands and the fluid comes at once, Re 100 and 500, and 200 at 45 degrees",
    because="2.5 %, as for one that moves: the two constants by which it is drawn in leave up to 1.2 % where they were"
    " chosen (10 and 15 cells, 11 degrees), the box 0.3 %, directions the rest; noise at most 2 %, or the row fails",
    tolerance=0.025,
    slow=True,
)
def fast_and_held() -> Measured:
    """Mean drag coefficient over 1 <= t U/D <= 3, 15 cells per diameter."""
    return fast_starts(((100, 0.05, 11.0), (500, 0.05, 11.0), (200, 0.0444, 45.0)), held=True, stands=True)


@VALIDATIONS.row(
    "coupling.fast_starts",
    source="the same for Re 50 to 500, tau 0.52 to 0.5005, in directions that no constant was chosen for",
    because="5 %: what was required; at a given Reynolds number it grows as the speed falls, as central moments damp"
    " short waves at a rate that does not fall with the viscosity; noise at most 2 %, or the row fails",
    tolerance=0.05,
    slow=True,
)
def fast_in_all_directions() -> Measured:
    """Mean drag coefficients of the runs in ``SLOW_STARTS``."""
    return fast_starts(SLOW_STARTS)
