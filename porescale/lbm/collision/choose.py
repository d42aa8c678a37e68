"""Collision operators by name: the register of this folder."""

import math
from typing import Any

import numpy as np
from numpy.typing import DTypeLike

from porescale.common.core.register import discover
from porescale.lbm.collision.entry import MAGIC_MIDWAY_WALL, Operator

OPERATORS: dict[str, Operator] = discover(__package__, "OPERATOR")
"""Every ``OPERATOR`` of a file of this folder, by name."""

_OF_LAW = {law: operator for operator in OPERATORS.values() for law in (operator.law, operator.eddy_law)}


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
    if operator not in OPERATORS:
        raise ValueError(f"unknown collision operator {operator!r}: choose from {', '.join(OPERATORS)}")
    found = OPERATORS[operator]
    kind = found.eddy_law if smagorinsky > 0 else found.law
    values = {
        "rate": 1 / relaxation_time,
        "fx": force[0],
        "fy": force[1],
        "magic": magic,
        "strain_factor": 18 * math.sqrt(2) * smagorinsky**2,
        **found.constants,
    }
    real: Any = np.dtype(dtype).type
    return kind(**{name: real(values[name]) for name in kind._fields})


def without_force(law: Any) -> Any:
    """The law of the same numbers that computes nothing of a body force that is zero, where there is one."""
    operator = _OF_LAW.get(type(law))
    free = operator.law_without_force if operator and type(law) is operator.law else None
    return law if free is None or law.fx or law.fy else free(*law)


def third_order_rate(law: Any) -> float:
    """Rate of the antisymmetric moments that are not momentum, at the molecular viscosity, of an operator's law."""
    return _OF_LAW[type(law)].third_order_rate(law)


def convective_delay(law: Any) -> float:
    """By how many steps convection is late at a half-way wall that fluid passes, at the molecular viscosity."""
    delay = _OF_LAW[type(law)].convective_delay
    return 1 / third_order_rate(law) - 0.5 if delay is None else delay(law)
