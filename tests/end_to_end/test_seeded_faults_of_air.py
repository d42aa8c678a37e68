"""Faults put into air trapped in soil below water: found within a hundred steps and before they are recorded."""

from collections.abc import Callable

import pytest

from continuum_sph.builders.simulation import Simulation
from continuum_sph.scene.sections import Scene
from continuum_sph.seepage.mixture import POROSITY
from porescale.common.schema.sections import load
from tests.reference.folders import ROOT
from tests.reference.seeded import INF, NAN, Running, coincide, put, running, step, times

pytestmark = pytest.mark.slow
CASE = ROOT / "cases" / "trapped_air"
SAND, WATER = "flow.ground.soil.", "flow.water.layer."
BOOKED = ("output.energy=true",)


@pytest.fixture(scope="module")
def sinking() -> Running:
    """Water that sinks into soil full of air."""
    return running(Simulation(load(CASE, Scene, overrides=BOOKED)), 100)


def air(simulation: Simulation) -> list[int]:
    """Particles of air."""
    layer = simulation.flow.water.layer
    return [int(k) for k in (layer.material[: layer.fluid] == 1).nonzero()[0]]


def at(name: str, index: tuple[int, ...], value: float) -> Callable[[Simulation], None]:
    """Writes ``value`` into an array of the layer, of one particle of air."""
    return put(f"{WATER}{name}", lambda simulation: (one(simulation), *index), value)


def one(simulation: Simulation) -> int:
    """The particle of air in the middle of the list."""
    own = air(simulation)
    return own[len(own) // 2]


def lost(simulation: Simulation) -> None:
    """Nobody knows how much room there is about a particle of air."""
    simulation.flow.water.pores[POROSITY, air(simulation)[0]] = NAN


FAULTS: dict[str, Callable[[Simulation], None]] = {
    **{f"air {name} {value:g}": at(name, index, value) for name, index, value in (
        ("x", (0,), NAN), ("x", (1,), INF), ("v", (0,), NAN), ("v", (1,), INF), ("v", (0,), 1e3), ("v", (1,), -1e4),
        ("density", (), NAN), ("density", (), INF), ("density", (), 0.0), ("density", (), -1.0), ("density", (), 5e3),
        ("mass", (), NAN), ("mass", (), -1.0), ("acceleration", (0,), NAN), ("acceleration", (1,), 1e9),
        ("rate_before", (), NAN), ("pressure", (), NAN), ("energy", (0,), NAN), ("drift", (0,), NAN),
        ("length", (), NAN))},
    "air a hundred times as dense": times(f"{WATER}density", air, 100.0),
    "air of no density": times(f"{WATER}density", air, 1e-6),
    "air of negative mass": times(f"{WATER}mass", air, -1.0),
    "air of a thousand times the mass": times(f"{WATER}mass", air, 1e3),
    "air thrown up": at("x", (1,), 5.0),
    "air thrown through the wall": at("x", (0,), -1.0),
    "air thrown through the floor": at("x", (1,), -1.0),
    "air: two in one place": coincide(f"{WATER}x", lambda simulation: air(simulation)[:2]),
    "air: ten in one place": coincide(f"{WATER}x", lambda simulation: air(simulation)[:10]),
    "porosity about air nan": lost,
    **{f"water {name} {value:g}": put(f"{WATER}{name}", index, value) for name, index, value in (
        ("x", (20, 0), NAN), ("v", (20, 0), 1e3), ("density", 20, NAN), ("density", 20, -1.0), ("mass", 20, NAN),
        ("mass", 20, -1.0))},
    **{f"soil {name} {value:g}": put(f"{SAND}{name}", index, value) for name, index, value in (
        ("x", (20, 0), NAN), ("stress", (20, 1), NAN), ("stress", (20, 1), 1e12), ("density", 20, -1.0),
        ("v", (20, 0), 1e3))},
    **{f"step times {factor:g}": step("both", factor) for factor in (100.0, 1e4, NAN, -1.0, 0.0)},
}  # fmt: skip


@pytest.mark.parametrize("name", FAULTS)
def test_a_fault_in_trapped_air_is_found(sinking, name):
    sinking.finds(FAULTS[name])


NAMED = {
    "air x nan": "position", "air v 1000": "speed", "air density -1": "density", "air density 0": "density",
    "air density 5000": "density", "air mass -1": "mass", "air pressure nan": "pressure", "air energy nan": "energy",
    "air thrown up": "way since the last look",
}  # fmt: skip


@pytest.mark.parametrize("name", NAMED)
def test_what_is_wrong_is_named(sinking, name):
    sinking.names(FAULTS[name], NAMED[name], one(sinking.simulation))


def test_nothing_is_found_where_nothing_is_wrong(sinking):  # the twin that must not fail
    sinking.finds_nothing(10)
