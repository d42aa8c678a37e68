"""Faults put into a levee with water in and beside it: found within a hundred steps and before they are recorded."""

from collections.abc import Callable

import numpy as np
import pytest

from continuum_sph.builders.simulation import Simulation
from continuum_sph.scene.sections import Scene
from continuum_sph.seepage.mixture import POROSITY
from continuum_sph.validation.seepage.levee import Levee
from tests.reference.faults.seeded import INF, NAN, Running, coincide, put, running, times

pytestmark = pytest.mark.slow


@pytest.fixture(scope="module")
def levee() -> Running:
    """A saturated levee between a river and land that drains."""
    table = Levee(rows=8).table()
    table["output"]["energy"] = True
    return running(Simulation(Scene.model_validate(table)), 60)


def level(value: float) -> Callable[[Simulation], None]:
    """The river stands at ``value``, m, it says."""

    def fault(simulation: Simulation) -> None:
        assert simulation.flow.supply
        simulation.flow.supply.reservoirs[0].level = value

    return fault


def flood(simulation: Simulation) -> None:
    """The river is to rise over the tank."""
    assert simulation.flow.supply
    simulation.flow.supply.reservoirs[0].levels[:] = 5.0


def thrown_out(count: int) -> Callable[[Simulation], None]:
    """So many particles of water in the soil are thrown out over the levee, the tank, or beneath its floor."""

    def fault(simulation: Simulation) -> None:
        flow = simulation.flow.water
        wet = np.flatnonzero((flow.porosity < 1.0) & (flow.layer.mass[: flow.layer.fluid] > 0.0))
        flow.layer.x[wet[:count]] += (0.0, 1.2)

    return fault


LEVELS = np.array([row[1] for row in Levee(rows=8).table()["reservoir"][0]["rise"]])
"""Of the river."""
SOIL, WATER = "flow.ground.soil.", "flow.water.layer."
FAULTS: dict[str, Callable[[Simulation], None]] = {
    **{f"soil stress {k} nan": put(f"{SOIL}stress", (50, k), NAN) for k in range(4)},
    "soil stress inf": put(f"{SOIL}stress", (50, 1), INF),
    **{f"soil {name} {value:g}": put(f"{SOIL}{name}", at, value) for name, at, value in (
        ("x", (50, 0), NAN), ("x", (50, 1), INF), ("v", (50, 0), NAN), ("v", (50, 1), -1e4), ("density", 50, NAN),
        ("density", 50, 0.0), ("density", 50, 5e3), ("mass", 50, NAN), ("plastic_shear", 50, NAN),
        ("separation_strain", 50, NAN), ("acceleration", (50, 0), NAN), ("drift", (50, 0), NAN))},
    "soil thrown up": put(f"{SOIL}x", (50, 1), 3.0),
    "soil thrown through the wall": put(f"{SOIL}x", (50, 0), -1.0),
    "soil thrown aside": put(f"{SOIL}x", (50, 0), 1.0),
    "soil crowded": coincide(f"{SOIL}x", slice(40, 60)),
    "porosity runs away": times(f"{SOIL}density", slice(30, 60), 3.0),
    "water thrown out of the levee": thrown_out(1),
    "much water thrown out of the levee": thrown_out(30),
    "water thrown through the wall": put(f"{WATER}x", (20, 0), -1.0),
    "water thrown through the floor": put(f"{WATER}x", (20, 1), -1.0),
    **{f"water {name} {value:g}": put(f"{WATER}{name}", at, value) for name, at, value in (
        ("x", (20, 0), NAN), ("v", (20, 0), 1e3), ("density", 20, NAN), ("density", 20, 5e3), ("mass", 20, NAN),
        ("pressure", 20, NAN), ("energy", (20, 0), NAN))},
    "porosity about water nan": put("flow.water.pores", (POROSITY, 20), NAN),
    "porosity about water gone": put("flow.water.pores", (POROSITY, 20), -0.2),
    "heat of drag nan": put("flow.water.heat", 20, NAN),
    "slip nan": put("flow.water.slip", (20, 0), NAN),
    "river beyond the tank": level(5.0),
    "river nowhere": level(NAN),
    "river that rises over the tank": flood,
}  # fmt: skip


def heal(simulation: Simulation) -> None:
    """Put right what no state holds."""
    assert simulation.flow.supply
    simulation.flow.supply.reservoirs[0].levels[:] = LEVELS
    simulation.flow.water.slip[:] = 0.0


@pytest.mark.parametrize("name", FAULTS)
def test_a_fault_in_a_levee_is_found(levee, name):
    heal(levee.simulation)
    levee.finds(FAULTS[name])


def test_nothing_is_found_where_nothing_is_wrong(levee):  # the twin that must not fail
    heal(levee.simulation)
    levee.finds_nothing(8)
