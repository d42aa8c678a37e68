"""Systems of grains compared as a whole, and one that is saved on the way and goes on from the file."""

from pathlib import Path
from typing import Any

import numpy as np

from porescale.dem.grains import Grains
from porescale.dem.prepare.on_disk import pack, unpack

OF_LAST_CALL = {"steering.given", "steering.watched_load", "steering.clumps.withheld"}
"""Sums and means over the last call of step, which differ where the steps were divided otherwise."""
NAN = {"bonds.broken"}
"""What is nan on purpose: bonds that have not broken have no time and place of it."""


def flat(state: Any, name: str = "") -> dict[str, Any]:
    """Every array and number of a nested state, by its place."""
    if not isinstance(state, dict):
        return {name: np.array(state)}
    return {key: value for part, own in state.items() for key, value in flat(own, f"{name}.{part}".strip(".")).items()}


def differing(one: Grains, other: Grains) -> set[str]:
    """Names of what differs between the states of two systems, which have the same parts."""
    a, b = flat(one.state()), flat(other.state())
    assert a.keys() == b.keys()
    return {name for name in a if not np.array_equal(a[name], b[name], equal_nan=name in NAN)}


def saved_on_the_way(first: Grains, second: Grains, dt: float, steps: int, before: int, folder: Path) -> Grains:
    """``second`` after ``steps`` steps of ``dt`` (s), of which ``first`` did those ``before`` it was saved."""
    first.step(dt, count=before)
    pack(folder / "state.npz", first.state())
    second.restore(unpack(folder / "state.npz"))
    assert not differing(first, second)
    second.step(dt, count=steps - before)
    return second
