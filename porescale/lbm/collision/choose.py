"""Collision operators by name."""

import math
from typing import Any

import numpy as np
from numpy.typing import DTypeLike

from porescale.lbm.collision.bgk import Bgk, EddyBgk
from porescale.lbm.collision.central import Central, EddyCentral
from porescale.lbm.collision.mrt import ENERGY_RATE, SQUARE_RATE, EddyMrt, Mrt
from porescale.lbm.collision.trt import MAGIC_MIDWAY_WALL, EddyTrt, FreeTrt, Trt, odd_rate

OPERATORS = {
    "trt": "two relaxation times: walls stay where they are at every viscosity",
    "mrt": "multiple relaxation times: walls as with trt, and sound is damped faster",
    "central": "central moments: stable as the viscosity goes to zero, and the same in every moving frame",
    "bgk": "one relaxation time: the textbook's, for comparison",
}
"""Name of each operator and what it is good for."""


def choose(
    operator: str,
    relaxation_time: float,
    force: tuple[float, float],
    dtype: DTypeLike,
    *,
    magic: float = MAGIC_MIDWAY_WALL,
    smagorinsky: float = 0.0,
) -> Any:
    """The law of an operator;  magic: of those that have it;  smagorinsky: constant of an eddy viscosity, 0 for none.

    ValueError if there is no operator of that name.
    """
    plain: dict[str, Any] = {"trt": Trt, "mrt": Mrt, "central": Central, "bgk": Bgk}
    eddy: dict[str, Any] = {"trt": EddyTrt, "mrt": EddyMrt, "central": EddyCentral, "bgk": EddyBgk}
    if operator not in OPERATORS:
        raise ValueError(f"unknown collision operator {operator!r}: choose from {', '.join(OPERATORS)}")
    kind = eddy[operator] if smagorinsky > 0 else plain[operator]
    values = {
        "rate": 1 / relaxation_time,
        "fx": force[0],
        "fy": force[1],
        "magic": magic,
        "energy": ENERGY_RATE,
        "square": SQUARE_RATE,
        "strain_factor": 18 * math.sqrt(2) * smagorinsky**2,
    }
    real: Any = np.dtype(dtype).type
    return kind(**{name: real(values[name]) for name in kind._fields})


def lean(law: Any) -> Any:
    """The law of the same numbers that computes nothing of a body force that is not there, where there is one."""
    return FreeTrt(*law) if isinstance(law, Trt) and not (law.fx or law.fy) else law


def third_order_rate(law: Any) -> float:
    """Rate of the odd moments that are not momentum, at the molecular viscosity, of an operator's law."""
    if isinstance(law, Central | EddyCentral):
        return 1.0
    if isinstance(law, Bgk | EddyBgk):
        return float(law.rate)
    return odd_rate(1 / float(law.rate), float(law.magic))
