"""A row of the register of weights: name, laws and what it goes with."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any


@dataclass(frozen=True)
class Weighting:
    """A row of the register.

    name : in scenes;  purpose : what it is good for, one line;  law : its NamedTuple, whose field ``k`` is tau - 1/2;
    others come from ``constants``;  soft_law : that of bodies with soft rims, where it has one;  general : whether it
    goes with every solid operator that has no weight of its own;  order : place in lists, the first general one is used
    where none is named.
    """

    name: str
    purpose: str
    law: Any
    constants: Mapping[str, float] = field(default_factory=dict)
    soft_law: Any = None
    general: bool = True
    order: int = 100
