"""Solid operators by name: the register of this folder."""

from typing import Any

import numpy as np
from numpy.typing import DTypeLike

from porescale.common.core.register import discover
from porescale.coupling.solid.entry import SolidOperator

SOLID_OPERATORS: dict[str, SolidOperator] = discover(__package__, "SOLID_OPERATOR")
"""Every ``SOLID_OPERATOR`` of a file of this folder, by name."""


def solid_operator(name: str) -> SolidOperator:
    """The row of an operator; ValueError if there is none of that name."""
    if name not in SOLID_OPERATORS:
        raise ValueError(f"unknown solid operator {name!r}: choose from {', '.join(SOLID_OPERATORS)}")
    return SOLID_OPERATORS[name]


def choose_solid(name: str, relaxation_time: float, third_order: float, dtype: DTypeLike, *, soft: bool = False) -> Any:
    """The law of a solid operator by name;  third_order: see law.py;  soft: with soft rims, where it has them.

    ValueError if there is none of that name.
    """
    found = solid_operator(name)
    kind = found.soft_law if soft and found.soft_law else found.law
    real: Any = np.dtype(dtype).type
    values = {"k": relaxation_time - 0.5, "third_order": third_order, **found.constants}
    return kind(**{field: real(values[field]) for field in kind._fields})
