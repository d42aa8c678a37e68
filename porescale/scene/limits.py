"""What is known of where a computation is right and where it is stable: every threshold that ``check`` warns from.

A table on purpose: what a study of stability finds is entered here, and the warnings follow.
"""

from __future__ import annotations

from dataclasses import dataclass

DENSITY_WARN, DENSITY_REFUSE = 0.05, 0.3
"""Density variation by the weight of a column: measured runs varied by twice this estimate (0.05: 4-10 %)."""
MACH_WARN, MACH_REFUSE = 0.1, 0.3
"""Errors of compressibility grow as the square of the Mach number: 1 % and 9 %."""
TAU_COARSE = 1.5
"""Relaxation time above which the drag at 10 cells per diameter is more than a tenth too small."""
CELLS_COARSE = 4.0
"""Cells per hydraulic diameter below which drag is off by a tenth or more."""
LIGHT, LIGHT_CELLS = 0.5, 16.0
"""Density ratio below which free grains need so many cells: 0.3 is stable at 16 and diverges at 10 (measured)."""
SINGLE_PRECISION = 1e-5
"""Speed in cells per step at which the round-off of float32, 6e-8 of populations of order 0.1 and collected over a
momentum's memory of some hundred steps, is about a hundredth of it."""


@dataclass(frozen=True)
class Stability:
    """floor : relaxation time below which fast flow (cell Reynolds numbers of tens) goes wrong;  words : how;
    repair : what helps."""

    floor: float
    words: str
    repair: str


FINER = "refine the spacing or raise the viscosity"
STABILITY = {
    "trt": Stability(0.505, "two relaxation times ring", f"{FINER}, or take operator = 'central'"),
    "bgk": Stability(0.505, "a single relaxation time blows up", f"{FINER}, or take operator = 'central'"),
    "mrt": Stability(0.505, "multiple relaxation times ring", f"{FINER}, or take operator = 'central'"),
    "central": Stability(0.5005, "nothing has been tried", FINER),
}
"""By operator.  Double shear layer and impulsive lid on 128² at Reynolds 10⁴: at 0.5005 central moments hold where two
relaxation times and one do not."""
EDDY = Stability(0.5005, "nothing has been tried", FINER)
"""With an eddy viscosity: a column collapse at 0.5005 with Smagorinsky's constant 0.1 survived."""
UNKNOWN = Stability(0.505, "this operator has not been tried", FINER)


def stability(operator: str, *, eddy: bool) -> Stability:
    """What is known of an operator, with or without an eddy viscosity: the lower floor of the two."""
    own = STABILITY.get(operator, UNKNOWN)
    return EDDY if eddy and EDDY.floor < own.floor else own
