"""Faults put into dry soil that slides: found within a hundred steps, named, and before they are recorded."""

from collections.abc import Callable

import numpy as np
import pytest

from continuum_sph.builders.simulation import Simulation
from continuum_sph.scene.sections import Scene
from tests.reference.faults.seeded import INF, NAN, Running, coincide, put, running, step, times
from tests.reference.programs import SOIL

AT = 50
"""The particle that most faults are put at: within the pile, on its way down."""


@pytest.fixture(scope="module")
def sliding() -> Running:
    """A pile of sand that runs out."""
    return running(Simulation(Scene.model_validate(SOIL)), 100)


def near(simulation: Simulation) -> None:
    """Particles of soil are drawn to a tenth of the distance that they have from one of them."""
    x = simulation.flow.soil.x
    x[40:60] = x[AT] + 0.1 * (x[40:60] - x[AT])


SAND = "flow.soil."
FAULTS: dict[str, Callable[[Simulation], None]] = {
    **{f"{name} {value:g}": put(f"{SAND}{name}", at, value) for name, at, value in (
        ("x", (AT, 0), NAN), ("x", (AT, 1), INF), ("v", (AT, 0), NAN), ("v", (AT, 1), INF), ("v", (AT, 0), 1e3),
        ("v", (AT, 1), -1e4), ("density", AT, NAN), ("density", AT, INF), ("density", AT, 0.0), ("density", AT, -1.0),
        ("density", AT, -1600.0), ("density", AT, 1.0), ("density", AT, 5e3), ("mass", AT, NAN), ("mass", AT, -1.0),
        ("mass", AT, 0.0), ("acceleration", (AT, 0), NAN), ("acceleration", (AT, 1), 1e9), ("drift", (AT, 0), NAN),
        ("drift", (AT, 0), 1e3), ("force", (AT, 0), NAN), ("spread", (AT, 0), NAN), ("plastic_shear", AT, NAN),
        ("separation_strain", AT, NAN), ("separation_strain", AT, -2.0), ("length", AT, NAN))},
    **{f"stress {k} {value:g}": put(f"{SAND}stress", (AT, k), value) for k in range(4) for value in (NAN, 1e12)},
    "stress inf": put(f"{SAND}stress", (AT, 1), INF),
    "stress pulls": put(f"{SAND}stress", (AT, 1), -1e9),
    "mass times a hundred": times(f"{SAND}mass", AT, 100.0),
    **{f"thrown {where}": put(f"{SAND}x", (AT, axis), value) for where, axis, value in (
        ("up", 1, 3.0), ("through the wall", 0, -1.0), ("through the floor", 1, -1.0), ("aside", 0, 0.28))},
    "two in one place": coincide(f"{SAND}x", slice(AT, AT + 2)),
    "twenty in one place": coincide(f"{SAND}x", slice(AT, AT + 20)),
    "twenty drawn together": near,
    **{f"step times {factor:g}": step("flow", factor) for factor in (100.0, 1e4, NAN, -1.0, 0.0)},
}  # fmt: skip


@pytest.mark.parametrize("name", FAULTS)
def test_a_fault_in_dry_soil_is_found(sliding, name):
    sliding.finds(FAULTS[name])


NAMED = {
    "x nan": "position", "v inf": "velocity", "v 1000": "speed", "density nan": "density", "density -1": "density",
    "density 5000": "porosity", "mass -1": "mass", "mass 0": "mass", "acceleration nan": "acceleration",
    "plastic_shear nan": "plastic strain", "separation_strain -2": "opening", "stress 0 nan": "stress",
    "stress 2 1e+12": "stress", "stress pulls": "stress", "thrown up": "way since the last look",
}  # fmt: skip


@pytest.mark.parametrize("name", NAMED)
def test_what_is_wrong_is_named(sliding, name):
    sliding.names(FAULTS[name], NAMED[name], AT)


def test_nothing_is_found_where_nothing_is_wrong(sliding):  # the twin that must not fail
    sliding.finds_nothing(10)
    assert np.isfinite(sliding.simulation.flow.soil.stress).all()
