"""Solid operators by name."""

from typing import Any

import numpy as np
from numpy.typing import DTypeLike

from porescale.coupling.coverage.soft_rim import SLIP_FACTOR
from porescale.coupling.solid.exact_wall import ONSET, SMOOTHING, ExactWall, SoftWall
from porescale.coupling.solid.sc1 import OddSc1, Sc1
from porescale.coupling.solid.sc2 import Sc2
from porescale.coupling.solid.sc3 import Sc3

SOLID_OPERATORS = {
    "exact-wall": "holds walls where they are at every viscosity, the most accurate: the default; with weight wall",
    "odd-SC1": "the odd half of SC1: as accurate, and nothing drifts inside grains",
    "SC1": "bounce-back of the non-equilibrium part, as published: drifts where grains stay",
    "SC2": "superposition: smooth inside grains, but converges at first order only; for comparison",
    "SC3": "bounce-back from the grain: for grains that are held still; moving ones are noisy, and free ones run away",
}
"""Name of each solid operator and what it is good for."""


def choose_solid(name: str, relaxation_time: float, third_order: float, dtype: DTypeLike, *, soft: bool = False) -> Any:
    """The law of a solid operator by name;  third_order: rate of the fluid operator's odd moments but momentum.

    soft: with soft rims (rim.py), which go with exact walls only.  ValueError if there is none of that name.
    """
    laws: dict[str, Any] = {"exact-wall": ExactWall, "odd-SC1": OddSc1, "SC1": Sc1, "SC2": Sc2, "SC3": Sc3}
    if name not in laws:
        raise ValueError(f"unknown solid operator {name!r}: choose from {', '.join(SOLID_OPERATORS)}")
    kind = SoftWall if soft and name == "exact-wall" else laws[name]
    real: Any = np.dtype(dtype).type
    values = {
        "one": 1.0,
        "k": relaxation_time - 0.5,
        "third_order": third_order,
        "onset": ONSET,
        "smoothing": SMOOTHING**2,
        "slip_factor": SLIP_FACTOR,
    }
    return kind(**{field: real(values[field]) for field in kind._fields})
