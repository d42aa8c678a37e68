"""Kinds of sides by name: the register of this folder."""

from functools import cache

from porescale.common.core.register import discover
from porescale.lbm.boundary.law import Boundary


@cache
def boundaries() -> dict[str, Boundary]:
    """Every ``BOUNDARY`` of a file of this folder, by name."""
    return discover(__package__, "BOUNDARY")


def boundary(name: str) -> Boundary:
    """The kind of that name; ValueError if there is none."""
    if name not in boundaries():
        raise ValueError(f"unknown kind of side {name!r}: choose from {', '.join(boundaries())}")
    return boundaries()[name]
