"""Validations of grains that the fluid passes fast, near tau = 1/2."""

from __future__ import annotations

import numpy as np

from porescale.common.evidence.validations import Measured, Validations
from porescale.validation.coupling.fast_trials import STARTED, started

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
    because="2.5 %, half of what was asked for: the constants of the soft rim leave up to 1.2 % where they were chosen"
    " (10 and 15 cells, speed 0.04), the box of 40 by 30 diameters 0.3 % (its mirror images hold back (pi/2)(d/W)²"
    " = 0.1 to 0.2 %), the place in the cell and the speed the rest; noise at most 2 %, or the row fails",
    tolerance=0.025,
)
def fast() -> Measured:
    """Mean drag coefficient over 1 <= t U/D <= 3, 15 cells per diameter."""
    return fast_starts(((100, 0.05, 11.0), (500, 0.05, 11.0)))


@VALIDATIONS.row(
    "coupling.fast_starts",
    source="the same for Re 50 to 500, tau 0.52 to 0.5005, in directions that no constant was chosen for",
    because="5 %: what was asked for; at a given Reynolds number it grows as the speed falls, as central moments damp"
    " short waves at a rate that does not fall with the viscosity; noise at most 2 %, or the row fails",
    tolerance=0.05,
    slow=True,
)
def fast_in_all_directions() -> Measured:
    """Mean drag coefficients of ``SLOW_STARTS``."""
    return fast_starts(SLOW_STARTS)
