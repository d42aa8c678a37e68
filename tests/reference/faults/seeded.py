"""Faults put into running simulations, and how soon these say so."""

import copy
import re
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import pytest

from porescale.common.core.errors import Unstable
from porescale.common.record.drive import CHECK_EVERY

NAN, INF = float("nan"), float("inf")


def named(simulation: Any, place: str) -> Any:
    """What a dotted ``place`` names."""
    for part in place.split("."):
        simulation = getattr(simulation, part)
    return simulation


def rows(simulation: Any, index: Any) -> Any:
    """An ``index``, or what it says of the simulation if it is a function."""
    return index(simulation) if callable(index) else index


def put(place: str, index: Any, value: float) -> Callable[[Any], None]:
    """Writes ``value`` at ``index``, see `rows`, of the array that a dotted ``place`` names."""

    def fault(simulation: Any) -> None:
        named(simulation, place)[rows(simulation, index)] = value

    return fault


def times(place: str, index: Any, factor: float) -> Callable[[Any], None]:
    """Multiplies what is there."""

    def fault(simulation: Any) -> None:
        named(simulation, place)[rows(simulation, index)] *= factor

    return fault


def coincide(place: str, index: Any) -> Callable[[Any], None]:
    """Puts the particles at ``index``, see `rows`, where the first of them is; ``place``: of their places."""

    def fault(simulation: Any) -> None:
        x, own = named(simulation, place), rows(simulation, index)
        x[own] = x[own][0]

    return fault


def step(place: str, factor: float) -> Callable[[Any], None]:
    """The next step of what a dotted ``place`` names takes ``factor`` times as long."""

    def fault(simulation: Any) -> None:
        named(simulation, place).next_step *= factor

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


@dataclass(frozen=True)
class Running:
    """A sound simulation, and the state that it goes back to before every fault."""

    simulation: Any
    state: dict[str, Any]

    def anew(self) -> Any:
        """The simulation as it was, looked at as a run looks that goes on."""
        self.simulation.restore(copy.deepcopy(self.state))
        self.simulation.check()
        return self.simulation

    def finds(self, fault: Callable[[Any], None]) -> None:
        """AssertionError unless the fault is found in time."""
        simulation = self.anew()
        fault(simulation)
        assert 0 <= found(simulation) <= CHECK_EVERY

    def names(self, fault: Callable[[Any], None], quantity: str, particle: int) -> None:
        """AssertionError unless the fault is found at once and said to be of that ``quantity`` of that ``particle``."""
        simulation = self.anew()
        fault(simulation)
        with pytest.raises(Unstable) as caught:
            simulation.check()
        error = caught.value
        assert (error.quantity, error.step, error.time) == (quantity, simulation.step, simulation.time)
        assert re.search(rf"particle {particle}\b", error.where), error.where
        assert f"at step {simulation.step} " in str(error)
        assert error.cause

    def finds_nothing(self, times: int) -> None:
        """AssertionError where something is found, asked ``times`` times, though nothing is wrong."""
        simulation = self.anew()
        for _ in range(times):
            assert found(simulation) == -1


def running(simulation: Any, steps: int) -> Running:
    """A simulation after so many ``steps``."""
    simulation.advance(steps)
    simulation.check()
    return Running(simulation, copy.deepcopy(simulation.state()))
