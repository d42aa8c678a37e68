"""Faults put into bubbles in water and air trapped in soil: found in a hundred steps and before they are recorded."""

from collections.abc import Callable
from functools import cache
from typing import Any

import pytest

from continuum_sph.builders.simulation import Simulation
from continuum_sph.scene.sections import Scene
from continuum_sph.seepage.mixture import POROSITY
from porescale.common.schema.sections import load
from tests.reference.faults.seeded import INF, NAN, Running, coincide, named, put, running, step, times
from tests.reference.folders import CASES

pytestmark = pytest.mark.slow
COARSE = {
    "bubble_in_water": ("numerics.spacing=0.02", "numerics.shifting=1", "output.energy=true"),  # or nothing drifts
    "rising_bubble": ("numerics.spacing=0.0625", "output.energy=true"),
    "trapped_air": ("numerics.shifting=1", "output.energy=true"),
}
"""Cases with a second fluid; the bubbles are a few particles across."""
LAYER, SAND, WATER = "flow.layer.", "flow.ground.soil.", "flow.water.layer."
BUBBLES = ("bubble_in_water", "rising_bubble")


@cache
def begun(case: str) -> Running:
    """The case after a hundred steps: a bubble on its way up, or water that sinks into soil full of air."""
    return running(Simulation(load(CASES / case, Scene, overrides=COARSE[case])), 100)


def second(place: str) -> Callable[[Any], list[int]]:
    """Gives the particles of the second fluid of the layer at ``place``."""

    def own(simulation: Simulation) -> list[int]:
        layer = named(simulation, place.rstrip("."))
        return [int(k) for k in (layer.material[: layer.fluid] == 1).nonzero()[0]]

    return own


def middle(place: str) -> Callable[[Any], int]:
    """Gives the particle of that fluid in the middle of its list."""

    def one(simulation: Simulation) -> int:
        own = second(place)(simulation)
        return own[len(own) // 2]

    return one


def faults_of(place: str) -> dict[str, Callable[[Simulation], None]]:
    """What can go wrong in the second fluid of the layer at ``place``."""
    own, one = second(place), middle(place)

    def at(name: str, index: tuple[int, ...], value: float) -> Callable[[Simulation], None]:
        return put(f"{place}{name}", lambda simulation: (one(simulation), *index), value)

    return {
        **{f"{name} {value:g}": at(name, index, value) for name, index, value in (
            ("x", (0,), NAN), ("x", (1,), INF), ("v", (0,), NAN), ("v", (1,), INF), ("v", (0,), 1e3),
            ("v", (1,), -1e4), ("density", (), NAN), ("density", (), INF), ("density", (), 0.0),
            ("density", (), -1.0), ("density", (), 5e3), ("mass", (), NAN), ("mass", (), -1.0),
            ("acceleration", (0,), NAN), ("acceleration", (1,), 1e9), ("rate_before", (), NAN),
            ("energy", (0,), NAN), ("drift", (0,), NAN), ("length", (), NAN))},
        "a hundred times as dense": times(f"{place}density", own, 100.0),
        "of no density": times(f"{place}density", own, 1e-6),
        "of negative mass": times(f"{place}mass", own, -1.0),
        "thrown up": at("x", (1,), 5.0),
        "thrown through the wall": at("x", (0,), -1.0),
        "thrown through the floor": at("x", (1,), -1.0),
        "two in one place": coincide(f"{place}x", lambda simulation: own(simulation)[:2]),
        "ten in one place": coincide(f"{place}x", lambda simulation: own(simulation)[:10]),
        **{f"step times {factor:g}": step("flow", factor) for factor in (100.0, 1e4, NAN, -1.0, 0.0)},
    }  # fmt: skip


def lost(simulation: Simulation) -> None:
    """Nobody knows how much room there is about a particle of air."""
    simulation.flow.water.pores[POROSITY, second(WATER)(simulation)[0]] = NAN


OF_BUBBLES: dict[str, Callable[[Simulation], None]] = {
    **faults_of(LAYER),
    "density -100": put(f"{LAYER}density", middle(LAYER), -100.0),
    "rate_before 1e+09": put(f"{LAYER}rate_before", middle(LAYER), 1e9),
    "mass times a thousand": times(f"{LAYER}mass", middle(LAYER), 1e3),
}
OF_AIR: dict[str, Callable[[Simulation], None]] = {
    **faults_of(WATER),
    "pressure nan": put(f"{WATER}pressure", middle(WATER), NAN),
    "of a thousand times the mass": times(f"{WATER}mass", second(WATER), 1e3),
    "porosity nan": lost,
    **{f"water {name} {value:g}": put(f"{WATER}{name}", index, value) for name, index, value in (
        ("x", (20, 0), NAN), ("v", (20, 0), 1e3), ("density", 20, NAN), ("density", 20, -1.0), ("mass", 20, NAN),
        ("mass", 20, -1.0))},
    **{f"soil {name} {value:g}": put(f"{SAND}{name}", index, value) for name, index, value in (
        ("x", (20, 0), NAN), ("stress", (20, 1), NAN), ("stress", (20, 1), 1e12), ("density", 20, -1.0),
        ("v", (20, 0), 1e3))},
}  # fmt: skip
FAULTS = {**dict.fromkeys(BUBBLES, OF_BUBBLES), "trapped_air": OF_AIR}


@pytest.mark.parametrize(("case", "name"), [(case, name) for case, faults in FAULTS.items() for name in faults])
def test_a_fault_in_a_second_fluid_is_found(case, name):
    begun(case).finds(FAULTS[case][name])


NAMED = {
    "x nan": "position", "v 1000": "speed", "density -1": "density", "density 0": "density", "mass -1": "mass",
    "thrown up": "way since the last look",
}  # fmt: skip
NAMED_IN_BUBBLES = {
    **NAMED, "v inf": "velocity", "density nan": "density", "rate_before 1e+09": "density rate",
    "length nan": "smoothing length",
}  # fmt: skip
NAMED_IN_AIR = {**NAMED, "density 5000": "density", "pressure nan": "pressure", "energy nan": "energy"}
NAMES = {**dict.fromkeys(BUBBLES, NAMED_IN_BUBBLES), "trapped_air": NAMED_IN_AIR}


@pytest.mark.parametrize(("case", "name"), [(case, name) for case, faults in NAMES.items() for name in faults])
def test_what_is_wrong_is_named(case, name):
    one = middle(LAYER if case in BUBBLES else WATER)(begun(case).simulation)
    begun(case).names(FAULTS[case][name], NAMES[case][name], one)


@pytest.mark.parametrize("case", COARSE)
def test_nothing_is_found_where_nothing_is_wrong(case):  # the twin that must not fail
    begun(case).finds_nothing(10)
