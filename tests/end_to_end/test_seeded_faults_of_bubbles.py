"""Faults put into bubbles of gas and of liquid in water: found in a hundred steps and before they are recorded."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from continuum_sph.scene.model import Simulation
from continuum_sph.scene.sections import Scene
from porescale.workbench.sections import load
from tests.reference.seeded import INF, NAN, Running, put, running, times

pytestmark = pytest.mark.slow
CASES = Path(__file__).resolve().parents[2] / "cases"
COARSE = {
    "bubble_in_water": ("numerics.spacing=0.02", "output.energy=true"),
    "rising_bubble": ("numerics.spacing=0.0625", "output.energy=true"),
}
"""The two cases with bubbles of a few particles across."""


@pytest.fixture(scope="module", params=COARSE)
def rising(request) -> Running:
    """A bubble on its way up."""
    return running(Simulation(load(CASES / request.param, Scene, overrides=COARSE[request.param])), 100)


def one(simulation: Simulation) -> int:
    """The particle of the bubble in the middle of its list."""
    own = (simulation.flow.layer.material[: simulation.flow.layer.fluid] == 1).nonzero()[0]
    return int(own[len(own) // 2])


def at(name: str, index: tuple[int, ...], value: float) -> Callable[[Simulation], None]:
    """Writes ``value`` into an array of the layer, of one particle of the bubble."""

    def fault(simulation: Simulation) -> None:
        put(f"flow.layer.{name}", (one(simulation), *index), value)(simulation)

    return fault


def scaled(name: str, factor: float) -> Callable[[Simulation], None]:
    """Multiplies what is there of one particle of the bubble."""

    def fault(simulation: Simulation) -> None:
        times(f"flow.layer.{name}", one(simulation), factor)(simulation)

    return fault


def all_of(name: str, factor: float) -> Callable[[Simulation], None]:
    """Multiplies what is there of the whole bubble."""

    def fault(simulation: Simulation) -> None:
        layer = simulation.flow.layer
        times(f"flow.layer.{name}", (layer.material[: layer.fluid] == 1).nonzero()[0], factor)(simulation)

    return fault


def crowd(count: int) -> Callable[[Simulation], None]:
    """So many particles of the bubble are put into one place."""

    def fault(simulation: Simulation) -> None:
        layer = simulation.flow.layer
        own = (layer.material[: layer.fluid] == 1).nonzero()[0][:count]
        layer.x[own] = layer.x[own[0]]

    return fault


def step(factor: float) -> Callable[[Any], None]:
    """The next step takes ``factor`` times as long."""

    def fault(simulation: Any) -> None:
        simulation.flow.next_step *= factor

    return fault


FAULTS: dict[str, Callable[[Simulation], None]] = {
    **{f"{name} {value:g}": at(name, index, value) for name, index, value in (
        ("x", (0,), NAN), ("x", (1,), INF), ("v", (0,), NAN), ("v", (1,), INF), ("v", (0,), 1e3), ("v", (1,), -1e4),
        ("density", (), NAN), ("density", (), INF), ("density", (), 0.0), ("density", (), -1.0), ("density", (), 5e3),
        ("density", (), -100.0), ("mass", (), NAN), ("mass", (), -1.0), ("acceleration", (0,), NAN),
        ("acceleration", (1,), 1e9), ("rate_before", (), NAN), ("rate_before", (), 1e9), ("drift", (0,), NAN),
        ("length", (), NAN), ("energy", (0,), NAN))},
    "mass times a thousand": scaled("mass", 1e3),
    "bubble a hundred times as dense": all_of("density", 100.0),
    "bubble of no density": all_of("density", 1e-6),
    "bubble of negative mass": all_of("mass", -1.0),
    "thrown up": at("x", (1,), 5.0),
    "thrown through the wall": at("x", (0,), -1.0),
    "thrown through the floor": at("x", (1,), -1.0),
    "two in one place": crowd(2),
    "ten in one place": crowd(10),
    **{f"step times {factor:g}": step(factor) for factor in (100.0, 1e4, NAN, -1.0, 0.0)},
}  # fmt: skip


@pytest.mark.parametrize("name", FAULTS)
def test_a_fault_in_a_bubble_is_found(rising, name):
    rising.finds(FAULTS[name])


NAMED = {
    "x nan": "position", "v inf": "velocity", "v 1000": "speed", "density nan": "density", "density -1": "density",
    "density 0": "density", "mass -1": "mass", "rate_before 1e+09": "density rate", "length nan": "smoothing length",
    "thrown up": "way since the last look",
}  # fmt: skip


@pytest.mark.parametrize("name", NAMED)
def test_what_is_wrong_is_named(rising, name):
    rising.names(FAULTS[name], NAMED[name], one(rising.simulation))


def test_nothing_is_found_where_nothing_is_wrong(rising):  # the twin that must not fail
    rising.finds_nothing(10)
