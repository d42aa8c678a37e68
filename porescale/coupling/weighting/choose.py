"""Weights by name: the register of this folder, and which solid operator goes with which."""

from typing import Any

import numpy as np
from numpy.typing import DTypeLike

from porescale.common.core.register import discover
from porescale.coupling.solid.choose import solid_operator
from porescale.coupling.weighting.entry import Weighting

WEIGHTINGS: dict[str, Weighting] = discover(__package__, "WEIGHTING")
"""Every ``WEIGHTING`` of a file of this folder, by name."""


def fitting_weights(solid: str) -> list[str]:
    """The weights that go with a solid operator, the usual one first; ValueError if there is no such operator."""
    own = solid_operator(solid).weight
    return [own] if own else [name for name, weighting in WEIGHTINGS.items() if weighting.general]


def fitting_weight(solid: str, weighting: str | None) -> str:
    """The weight that a solid operator is used with where none is named; ValueError if the one named does not fit."""
    fitting = fitting_weights(solid)
    if weighting is not None and weighting not in fitting:
        fits = " or ".join(map(repr, fitting))
        raise ValueError(f"weight {weighting!r} does not go with the solid operator {solid!r}: take {fits}")
    return weighting or fitting[0]


def choose_weight(name: str, relaxation_time: float, dtype: DTypeLike, *, soft: bool = False) -> Any:
    """The law of a weight by name;  soft: of bodies with soft rims.  ValueError if there is none of that name."""
    if name not in WEIGHTINGS:
        raise ValueError(f"unknown weight {name!r}: choose from {', '.join(WEIGHTINGS)}")
    found = WEIGHTINGS[name]
    kind = found.soft_law if soft and found.soft_law else found.law
    real: Any = np.dtype(dtype).type
    values = {"k": relaxation_time - 0.5, **found.constants}
    return kind(**{field: real(values[field]) for field in kind._fields})
