"""Faults put into bubbles of gas and of liquid in water: found in a hundred steps and before they are recorded."""

from collections.abc import Callable

import numpy as np
import pytest
from numpy.typing import NDArray

from continuum_sph.builders.simulation import Simulation
from continuum_sph.scene.sections import Scene
from porescale.common.schema.sections import load
from tests.reference.folders import CASES
from tests.reference.seeded import INF, NAN, Running, coincide, put, running, step, times

pytestmark = pytest.mark.slow
COARSE = {
    "bubble_in_water": ("numerics.spacing=0.02", "output.energy=true"),
    "rising_bubble": ("numerics.spacing=0.0625", "output.energy=true"),
}
"""The two cases with bubbles of a few particles across."""


@pytest.fixture(scope="module", params=COARSE)
def rising(request) -> Running:
    """A bubble on its way up."""
    return running(Simulation(load(CASES / request.param, Scene, overrides=COARSE[request.param])), 100)


def bubble(simulation: Simulation) -> NDArray[np.int64]:
    """Particles of the bubble."""
    layer = simulation.flow.layer
    return (layer.material[: layer.fluid] == 1).nonzero()[0]


def one(simulation: Simulation) -> int:
    """The particle of the bubble in the middle of its list."""
    own = bubble(simulation)
    return int(own[len(own) // 2])


def at(name: str, index: tuple[int, ...], value: float) -> Callable[[Simulation], None]:
    """Writes ``value`` into an array of the layer, of one particle of the bubble."""
    return put(f"{LAYER}{name}", lambda simulation: (one(simulation), *index), value)


LAYER = "flow.layer."
FAULTS: dict[str, Callable[[Simulation], None]] = {
    **{f"{name} {value:g}": at(name, index, value) for name, index, value in (
        ("x", (0,), NAN), ("x", (1,), INF), ("v", (0,), NAN), ("v", (1,), INF), ("v", (0,), 1e3), ("v", (1,), -1e4),
        ("density", (), NAN), ("density", (), INF), ("density", (), 0.0), ("density", (), -1.0), ("density", (), 5e3),
        ("density", (), -100.0), ("mass", (), NAN), ("mass", (), -1.0), ("acceleration", (0,), NAN),
        ("acceleration", (1,), 1e9), ("rate_before", (), NAN), ("rate_before", (), 1e9), ("drift", (0,), NAN),
        ("length", (), NAN), ("energy", (0,), NAN))},
    "mass times a thousand": times(f"{LAYER}mass", one, 1e3),
    "bubble a hundred times as dense": times(f"{LAYER}density", bubble, 100.0),
    "bubble of no density": times(f"{LAYER}density", bubble, 1e-6),
    "bubble of negative mass": times(f"{LAYER}mass", bubble, -1.0),
    "thrown up": at("x", (1,), 5.0),
    "thrown through the wall": at("x", (0,), -1.0),
    "thrown through the floor": at("x", (1,), -1.0),
    "two in one place": coincide(f"{LAYER}x", lambda simulation: bubble(simulation)[:2]),
    "ten in one place": coincide(f"{LAYER}x", lambda simulation: bubble(simulation)[:10]),
    **{f"step times {factor:g}": step("flow", factor) for factor in (100.0, 1e4, NAN, -1.0, 0.0)},
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
