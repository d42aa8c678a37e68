"""Sixty and more faults put into running scenes: each is found within a hundred steps and before it is recorded."""

from collections.abc import Callable

import numpy as np
import pytest

from continuum_sph.builders.simulation import Simulation as Continuum
from continuum_sph.scene.sections import Scene as Tank
from porescale import build
from porescale.builders.simulation import Simulation
from porescale.common.schema.sections import validate
from tests.reference.faults.seeded import INF, NAN, Running, put, running, times
from tests.reference.scenes import column

TANK = {
    "tank": {"width": 0.4, "height": 0.3},
    "water": {"viscosity": 1e-3, "column": [{"width": 0.2, "height": 0.2}]},
    "numerics": {"spacing": 0.01}, "time": {"end": 1.0},
    "output": {"snapshot_interval": 0.1, "series_interval": 0.1},
}  # fmt: skip


@pytest.fixture(scope="module")
def lifting() -> Running:
    """The column while its gate lifts and grains slide."""
    return running(build(column()), 80)


@pytest.fixture(scope="module")
def flowing() -> Running:
    """A collapsing column of water."""
    return running(Continuum(validate(Tank, TANK)), 60)


def onto(one: int, other: int, share: float) -> Callable[[Simulation], None]:
    """Moves a grain to a place between itself and another, its centre within the other."""

    def fault(simulation: Simulation) -> None:
        x = simulation.grains.discs.position
        x[one] = x[other] + share * (x[one] - x[other]) / np.hypot(*(x[one] - x[other])) * 4e-4

    return fault


def wind(rows: slice, columns: slice, speed: float) -> Callable[[Simulation], None]:
    """Sets the fluid of a block of cells in motion, ``speed`` cells a step along x, its density kept."""

    def fault(simulation: Simulation) -> None:
        f = simulation.fluid.populations
        f[1, rows, columns] += 0.5 * speed
        f[3, rows, columns] -= 0.5 * speed

    return fault


def clump(count: int) -> Callable[[Continuum], None]:
    """Puts particles into one place."""

    def fault(simulation: Continuum) -> None:
        simulation.flow.layer.x[100 : 100 + count] = simulation.flow.layer.x[100]

    return fault


CELLS = {"corner": (0, 1, 1), "lid": (4, 40, 30), "water": (5, 20, 15), "bed": (2, 5, 50), "gate": (7, 20, 41),
         "last": (8, 40, 60)}  # fmt: skip
GRAINS = "grains.discs."
FAULTS: dict[str, Callable[[Simulation], None]] = {
    **{f"population nan, {name}": put("fluid.populations", at, NAN) for name, at in CELLS.items()},
    **{f"population inf, {name}": put("fluid.populations", CELLS[name], INF) for name in ("water", "bed")},
    **{f"population {value:g}, {name}": put("fluid.populations", CELLS[name], value)
       for name in ("water", "bed") for value in (-5.0, 1e3)},
    "wind in the water": wind(slice(15, 25), slice(10, 20), 0.8),
    "wind along the bottom": wind(slice(2, 5), slice(5, 40), 0.9),
    **{f"position nan of {k}": put(f"{GRAINS}position", (k, k % 2), NAN) for k in (0, 15, 30)},
    **{f"velocity nan of {k}": put(f"{GRAINS}velocity", (k, k % 2), NAN) for k in (0, 15, 30)},
    **{f"spin nan of {k}": put(f"{GRAINS}spin", k, NAN) for k in (0, 15, 30)},
    "spin inf": put(f"{GRAINS}spin", 7, INF),
    "angle nan": put(f"{GRAINS}angle", 7, NAN),
    "mass nan": put(f"{GRAINS}mass", 7, NAN),
    "mass vanishes": times(f"{GRAINS}mass", 7, 1e-6),
    "all masses vanish": times(f"{GRAINS}mass", slice(None), 1e-4),
    "inertia nan": put(f"{GRAINS}inertia", 7, NAN),
    "radius nan": put(f"{GRAINS}radius", 7, NAN),
    "radius explodes": times(f"{GRAINS}radius", 7, 4.0),
    **{f"thrown out, {side}": put(f"{GRAINS}position", (12, axis), at)
       for side, axis, at in (("left", 0, -0.001), ("right", 0, 0.02), ("bottom", 1, -0.001), ("top", 1, 0.02))},
    **{f"speed {value:g}, {axis}": put(f"{GRAINS}velocity", (12, axis), value)
       for axis in (0, 1) for value in (-50.0, 50.0)},
    **{f"{one} upon {other}": onto(one, other, share) for one, other, share in
       ((3, 20, 0.1), (0, 30, 0.5), (8, 9, 1.0))},
    "spring nan": put("grains.pairs.carried", slice(None), NAN),
    "spring of a wall nan": put("grains.wall_spring", slice(None), NAN),
    "load on a grain nan": put("coupled.force", (7, 0), NAN),
    "gate nowhere": put("grains.plates", (0, 2), NAN),
}  # fmt: skip
LAYER = "flow.layer."
WATER_FAULTS: dict[str, Callable[[Continuum], None]] = {
    **{f"{name} {value:g}": put(f"{LAYER}{name}", at, value) for name, at, value in (
        ("x", (150, 0), NAN), ("x", (150, 1), INF), ("v", (150, 0), NAN), ("v", (150, 1), INF), ("v", (150, 0), 1e3),
        ("v", (150, 1), -1e4), ("density", 150, NAN), ("density", 150, -1.0), ("density", 150, 5e3),
        ("density", 150, INF), ("acceleration", (150, 0), NAN), ("rate_before", 150, NAN), ("mass", 150, NAN))},
    "mass times a hundred": times(f"{LAYER}mass", 150, 100.0),
    "clump of ten": clump(10),
    "clump of sixty": clump(60),
}  # fmt: skip


@pytest.mark.parametrize("name", FAULTS)
def test_a_fault_among_grains_and_water_is_found(lifting, name):
    lifting.finds(FAULTS[name])


@pytest.mark.parametrize("name", WATER_FAULTS)
def test_a_fault_in_a_layer_is_found(flowing, name):
    flowing.finds(WATER_FAULTS[name])


def test_there_are_sixty_of_them():
    assert len(FAULTS) + len(WATER_FAULTS) >= 60


def test_nothing_is_found_where_nothing_is_wrong(lifting, flowing):  # the twin that must not fail
    for sound in (lifting, flowing):
        sound.finds_nothing(6)
