"""Solid operators by name."""

from typing import Any

import numpy as np
from numpy.typing import DTypeLike

from porescale.coupling.solid.sc1 import OddSc1, Sc1

SOLID_OPERATORS = {
    "odd-SC1": "the odd half of SC1: as accurate, and nothing drifts inside grains",
    "SC1": "bounce-back of the non-equilibrium part, as published: drifts where grains stay",
}
"""Name of each solid operator and what it is good for."""


def choose_solid(name: str, dtype: DTypeLike) -> Any:
    """The law of a solid operator by name; ValueError if there is none of that name."""
    laws: dict[str, Any] = {"odd-SC1": OddSc1, "SC1": Sc1}
    if name not in laws:
        raise ValueError(f"unknown solid operator {name!r}: choose from {', '.join(SOLID_OPERATORS)}")
    return laws[name](np.dtype(dtype).type(1))
