"""Faults put among grains that sleep under water, and among polygons in it: found in time, too."""

from collections.abc import Callable

import numpy as np
import pytest

from porescale import Scene, build
from porescale.builders.simulation import Simulation
from porescale.common.schema.sections import validate
from tests.reference.faults.killing import ASLEEP
from tests.reference.faults.seeded import INF, NAN, Running, put, running, times
from tests.reference.scenes import column, grain

pytestmark = pytest.mark.slow
SQUARES = {
    "sides": 4,
    "diameter": 0.0014,
    "thickness": 2e-5,
    "at": [[0.004, 0.005], [0.004, 0.0034]],
    "angle": [0.3, 0.1],
}


@pytest.fixture(scope="module")
def sleeping() -> Running:
    """Grains that sleep while another sinks towards them."""
    made = running(build(validate(Scene, ASLEEP)), 400)
    assert made.simulation.grains.sleep.count > 10
    return made


@pytest.fixture(scope="module")
def sinking() -> Running:
    """Two squares and a grain that sink."""
    water = {"gate": None, "grains__packing": None, "domain__top": "wall"}
    return running(build(column(**water, polygon=[SQUARES], grains__grain=[grain(0.008, 0.005)])), 60)


def onto(one: int, other: int) -> Callable[[Simulation], None]:
    """A sleeper is put into another."""

    def fault(simulation: Simulation) -> None:
        x = simulation.grains.discs.position
        x[one] = 0.7 * x[other] + 0.3 * x[one]

    return fault


def deepest(simulation: Simulation) -> None:
    """The sleeper that lies lowest loses its way."""
    x = simulation.grains.discs.position
    x[int(np.argmin(x[:, 1])), 0] = NAN


DISC, BODY = "grains.discs.", "coupled.polygons.polygons."
SLEEPERS: dict[str, Callable[[Simulation], None]] = {
    "deepest sleeper nowhere": deepest,
    "position nan": put(f"{DISC}position", (5, 0), NAN),
    "velocity nan": put(f"{DISC}velocity", (5, 1), NAN),
    "spin nan": put(f"{DISC}spin", 5, NAN),
    "angle nan": put(f"{DISC}angle", 5, NAN),
    "velocity": put(f"{DISC}velocity", (5, 1), 50.0),
    "thrown out": put(f"{DISC}position", (5, 0), -0.001),
    "radius explodes": times(f"{DISC}radius", 5, 4.0),
    "one into another": onto(5, 6),
    "load nan": put("coupled.force", (5, 0), NAN),
    "torque nan": put("coupled.torque", 5, NAN),
    "load inf": put("coupled.force", (5, 0), INF),
    "weight nan": put("coupled.weight", (5, 1), NAN),
    "population nan": put("fluid.populations", (3, 8, 10), NAN),
    "energy taken nan": put("grains.sleep.removed", 5, NAN),
}  # fmt: skip
POLYGONS: dict[str, Callable[[Simulation], None]] = {
    "corner nowhere": put(f"{DISC}position", (-1, 0), NAN),
    "velocity nan": put("coupled.polygons.velocity", (0, 0), NAN),
    "spin nan": put("coupled.polygons.spin", 0, NAN),
    "angle nan": put("coupled.polygons.angle", 0, NAN),
    "position nan": put("coupled.polygons.position", (0, 1), NAN),
    "thrown out": put("coupled.polygons.position", (0, 1), -0.01),
    "velocity": put("coupled.polygons.velocity", (0, 1), 50.0),
    "one into the other": put("coupled.polygons.position", (0, 1), 0.0036),
    "grain into it": put(f"{DISC}position", 0, (0.004, 0.005)),
    "load nan": put("coupled.polygons.force", (0, 0), NAN),
    "torque nan": put("coupled.polygons.torque", 0, NAN),
    "inner velocity nan": put("coupled.polygons.inner_velocity", (0, 0), NAN),
    "population nan": put("fluid.populations", (3, 22, 20), NAN),
}  # fmt: skip


@pytest.mark.parametrize("name", SLEEPERS)
def test_a_fault_among_sleepers_is_found(sleeping, name):
    simulation = sleeping.simulation
    weight, radius = simulation.coupled.weight.copy(), simulation.grains.discs.radius.copy()
    try:
        sleeping.finds(SLEEPERS[name])
    finally:  # what no state holds
        simulation.coupled.weight[:], simulation.grains.discs.radius[:] = weight, radius


@pytest.mark.parametrize("name", POLYGONS)
def test_a_fault_among_polygons_is_found(sinking, name):
    sinking.finds(POLYGONS[name])


def test_nothing_is_found_where_nothing_is_wrong(sleeping, sinking):  # the twin that must not fail
    for sound in (sleeping, sinking):
        sound.finds_nothing(5)
