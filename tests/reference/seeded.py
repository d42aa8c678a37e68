"""Faults put into running simulations, and how soon these say so."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from porescale.ground.check import Unstable
from porescale.runs.drive import CHECK_EVERY

NAN, INF = float("nan"), float("inf")


def put(place: str, index: Any, value: float) -> Callable[[Any], None]:
    """Writes ``value`` at ``index`` of the array that a dotted ``place`` names."""

    def fault(simulation: Any) -> None:
        array = simulation
        for part in place.split("."):
            array = getattr(array, part)
        array[index] = value

    return fault


def times(place: str, index: Any, factor: float) -> Callable[[Any], None]:
    """Multiplies what is there."""

    def fault(simulation: Any) -> None:
        array = simulation
        for part in place.split("."):
            array = getattr(array, part)
        array[index] *= factor

    return fault


def found(simulation: Any) -> int:
    """Steps until the simulation says that something is wrong, asked as a run asks; -1 if it never does.

    Every snapshot is preceded by a check, so that what is found at once is never recorded; what is not yet wrong then,
    a force that only the next step adds, say, changes nothing that a snapshot holds.
    """
    error, begun = None, int(simulation.step)
    try:
        simulation.check()
        for step in range(1, CHECK_EVERY + 1):
            simulation.advance(1)
            if step in (1, 2, 5, 20, CHECK_EVERY):
                simulation.check()
    except Unstable as raised:
        error = raised
    if error is None:
        return -1
    assert error.where
    assert error.cause
    return int(simulation.step) - begun
