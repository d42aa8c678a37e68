"""A scene builds what it has sections for, and nothing else: no lattice when dry, no pair list without grains."""

import copy
import math
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any, NoReturn

import numpy as np
import pytest

import porescale.builders.build
import porescale.common.neighbors.pair_list
import porescale.coupling.psm
import porescale.coupling.step
import porescale.dem.grains
import porescale.lbm.boundary.thin_plate
import porescale.lbm.fluid
from porescale.builders.parts.gate import GatePart
from porescale.builders.simulation import Simulation
from porescale.common.core.errors import InputError
from porescale.dem.forces.batch import scratch
from porescale.dem.forces.walls import HIGH, LOW
from tests.reference.same_run import leaves
from tests.reference.scenes import column, dry, grain, table, water

build = porescale.builders.build.build
ROOT = Path(__file__).resolve().parents[2]
STEPS = 60
"""Past the opening of the gate, a rebuild of the list and an odd and even step."""


class Built(Exception):
    """A part was made that the scene did not ask for."""


def forbid(monkeypatch: pytest.MonkeyPatch, *names: str) -> None:
    """Making a part of one of these classes raises, wherever its name was imported to."""

    def refuse(self: Any, *args: Any, **options: Any) -> NoReturn:
        raise Built(type(self).__name__)

    found = set()
    for module in [it for name, it in sys.modules.items() if name.startswith("porescale.")]:
        for name in names:
            part = getattr(module, name, None)
            if isinstance(part, type):
                monkeypatch.setattr(part, "__init__", refuse)
                found.add(name)
    assert found == set(names)


def arrays(root: Any) -> Iterator[tuple[str, np.ndarray]]:
    """Every array that can be reached from ``root`` through attributes, containers and closures, with its path."""
    seen: set[int] = set()
    stack: list[tuple[str, Any]] = [("simulation", root)]
    while stack:
        path, item = stack.pop()
        if id(item) in seen or isinstance(item, str | bytes | int | float | type | np.generic) or item is None:
            continue
        seen.add(id(item))
        if isinstance(item, np.ndarray):
            yield path, item
            if item.base is not None:
                stack.append((f"{path}.base", item.base))
        elif isinstance(item, dict):
            stack += [(f"{path}[{key!r}]", value) for key, value in item.items()]
        elif isinstance(item, list | tuple | set | frozenset):
            stack += [(f"{path}[{number}]", value) for number, value in enumerate(item)]
        elif type(item).__module__.startswith("porescale"):
            held = dict(getattr(item, "__dict__", {}))
            slots = [name for kind in type(item).__mro__ for name in getattr(kind, "__slots__", ())]
            held |= {name: getattr(item, name) for name in slots if hasattr(item, name)}
            stack += [(f"{path}.{name}", value) for name, value in held.items()]
        else:
            cells = getattr(item, "__closure__", None) or ()
            stack += [(f"{path}.closure", cell.cell_contents) for cell in cells]
            if getattr(item, "__self__", None) is not None:
                stack.append((f"{path}.self", item.__self__))


def lattices(simulation: Simulation, cells: int) -> list[str]:
    """Paths of arrays with at least as many floating-point numbers as there are cells."""
    return [path for path, it in arrays(simulation) if it.size >= cells and np.issubdtype(it.dtype, np.floating)]


def test_a_dry_scene_makes_no_lattice(monkeypatch):
    forbid(monkeypatch, "Fluid", "SaturatedCells", "Coupled", "Sides", "Scales")
    simulation = build(dry(gate={"x": 0.008, "opens_at": 0.0005}))
    simulation.advance(STEPS)
    assert (simulation.fluid, simulation.coupled) == (None, None)
    assert set(simulation.snapshot().grids) == set()
    assert not any("fluid" in name or "Mach" in name for name in simulation.series())


def test_a_dry_scene_holds_no_array_of_lattice_size():
    # 60 x 40 cells at the column's own spacing; 32 grains hold at most a few hundred numbers in an array.
    simulation = build(dry(gate={"x": 0.008}))
    simulation.advance(STEPS)
    assert lattices(simulation, 60 * 40) == []
    batch = sum(it.nbytes for it in scratch(1))  # of contacts that are answered at once: the same in every scene
    assert sum(it.nbytes for _, it in arrays(simulation)) < 60 * 40 * 8 + batch


def test_the_walk_finds_the_lattice_of_a_wet_scene():
    # The twin that must fail: populations, and per cell the weights of solids, are found by the same walk.
    found = lattices(build(column()), 60 * 40)
    assert any("fluid" in path for path in found)
    assert any("saturated" in path for path in found)
    assert lattices(build(water()), 60 * 40)


@pytest.mark.parametrize("part", ["Fluid", "SaturatedCells", "PairList", "Plate"])
def test_a_forbidden_part_is_noticed_where_it_is_needed(monkeypatch, part):
    # The twin of the constructors that raise: the wet column behind a gate needs them all.
    forbid(monkeypatch, part)
    with pytest.raises(Built):
        build(column(grains__packing__settle=False))


def test_a_scene_without_grains_makes_no_pair_list_and_covers_no_cell(monkeypatch):
    forbid(monkeypatch, "PairList", "Grains", "SaturatedCells", "Coupled", "Discs", "Linear")
    simulation = build(water())
    simulation.advance(STEPS)
    assert (simulation.grains, simulation.coupled, simulation.weight) == (None, None, None)
    assert set(simulation.snapshot().clouds) == set()
    assert "solid_fraction" not in simulation.snapshot().grids["fields"].cells
    assert not any("grain" in name or "overlap" in name for name in simulation.series())
    assert simulation.series()["largest fluid speed (m/s)"] > 0


ASKED = """
import sys
from porescale import Scene, build
from tests.reference import scenes
build(getattr(scenes, sys.argv[1])(**eval(sys.argv[2])))
print(*sorted(it.rpartition(".")[2] for it in sys.modules if it.startswith("porescale.builders.parts.")))
"""
HAND = {"grains": {"density": 2500, "grain": [grain(0.004, 0.002)]}, "gravity": [0.0, 0.0]}
ALL_OF_WATER = {"flow_fields", "flow_series", "fluid"}
ALL_OF_GRAINS = {"clouds", "frame_measures", "grain_series", "grains"}


@pytest.mark.parametrize(
    ("base", "changes", "parts"),
    [
        ("water", {}, ALL_OF_WATER),
        ("water", {"probe": [{"x": 0.003, "y": 0.003}]}, ALL_OF_WATER | {"flow_instruments"}),
        ("dry", HAND, ALL_OF_GRAINS),
        ("dry", HAND | {"gate": {"x": 0.008}, "output__energy": True}, ALL_OF_GRAINS | {"energy", "gate"}),
    ],
)
def test_parts_of_absent_sections_are_not_even_imported(base, changes, parts):
    words = [sys.executable, "-c", ASKED, base, repr(changes)]
    done = subprocess.run(words, cwd=ROOT, capture_output=True, text=True, timeout=600, check=True)
    assert set(done.stdout.split()) == parts


@pytest.mark.parametrize("scene", [dry, water, column], ids=lambda it: it.__name__)
def test_a_simulation_has_the_parts_that_its_sections_ask_for_and_no_other(scene):
    loose = {"grains__packing__settle": False} if scene is column else {}
    made = {type(it).__name__ for it in build(scene(gate=None, **loose)).parts}
    fluid, both = {"FlowSeries"}, {"GrainSeries", "GrainCloud"}
    assert made == {
        dry: {"GrainsPart", *both}, water: {"FluidPart", *fluid}, column: {"CoupledPart", *fluid, *both}
    }[scene]  # fmt: skip


def test_without_a_gate_there_is_no_plate(monkeypatch):
    forbid(monkeypatch, "Plate")
    for scene in (column(gate=None, grains__packing__settle=False), dry(), water()):
        simulation = build(scene)
        with pytest.raises(InputError, match=r"part = 'GatePart': is not built by this scene \(allowed: .*Part"):
            simulation.part(GatePart)
        assert simulation.fluid is None or simulation.fluid.plates == []
        assert simulation.grains is None or len(simulation.grains.plates) == 0


def test_a_gate_stands_in_fluid_and_grains_alike():
    simulation = build(column(grains__packing__settle=False))
    assert len(simulation.fluid.plates) == 1
    assert simulation.grains.plates[0, : HIGH + 1].tolist() == [0.008, 0.0, 0.008]
    dry_one, wet_one = build(dry(gate={"x": 0.008})), build(water(gate={"x": 0.004}, domain=table()["domain"]))
    assert len(dry_one.grains.plates) == 1
    assert len(wet_one.fluid.plates) == 1


def test_the_gate_opens_at_its_time_and_rises_alike_in_fluid_and_grains():
    simulation = build(column(grains__packing__settle=False))
    (plate,) = simulation.fluid.plates
    simulation.advance(50)  # opens_at 2 ms = 50 steps of 40 us
    assert (plate.lower_edge, simulation.grains.plates[0, LOW]) == (0.0, 0.0)
    simulation.advance(25)
    # 0.4 m/s over 25 steps of 4e-5 s is 0.4 mm = 2 cells; sums of 25 roundings.
    assert plate.lower_edge == pytest.approx(2.0, rel=25 * 2**-52)
    assert simulation.grains.plates[0, LOW] == pytest.approx(0.0004, rel=100 * 2**-52)


def test_a_gate_without_lift_speed_vanishes_at_its_time():
    simulation = build(column(grains__packing__settle=False, gate__lift_speed=None))
    simulation.advance(50)
    assert len(simulation.fluid.plates) == 1
    simulation.advance(1)
    assert simulation.fluid.plates == []


def test_a_restored_run_goes_on_to_the_same_bits_before_and_after_its_gate_vanished():
    scene = column(grains__packing__settle=False, gate__lift_speed=None)
    whole = build(scene)
    states = []
    for _ in range(3):  # the gate vanishes in the step after the 50th: restored at 33 it stands, at 66 it does not
        whole.advance(33)
        states.append(copy.deepcopy(whole.state()))
    for number, state in enumerate(states[:2]):
        resumed = build(scene)
        resumed.restore(copy.deepcopy(state))
        assert len(resumed.fluid.plates) == 1 - number
        resumed.advance(99 - 33 * (number + 1))
        assert dict(leaves(resumed.state())) == dict(leaves(states[2]))
    assert dict(leaves(states[1])) != dict(leaves(states[2]))


def test_a_gate_holds_water_and_grains_until_it_opens():
    simulation = build(column(gate__opens_at=1.0))
    simulation.advance(100)
    row = simulation.series()
    # Held, the grains stay at rest: their packing was brought to net forces of 3e-3 of the weight, which moves
    # nothing by more than 3e-3 * 6 m/s^2 * (4 ms)^2/2 = 1.4e-7 m = 2e-4 diameters.
    assert row["run-out (m)"] < 1e-6
    free = build(column(gate=None, grains__packing__settle=False))  # the twin: without the gate the water moves
    free.advance(100)
    assert free.series()["kinetic energy of fluid (J/m)"] > 100 * row["kinetic energy of fluid (J/m)"]


def test_a_grain_leaves_through_a_periodic_side_and_is_recorded_inside():
    sides = {"domain__left": "periodic", "domain__right": "periodic", "gate": None, "gravity": [0.0, 0.0]}
    grains = {"density": 2500, "hydraulic_radius_ratio": 1.0, "grain": [grain(0.0118, 0.004, velocity=[0.5, 0.0])]}
    simulation = build(column(**sides, grains=grains))
    simulation.advance(60)
    own = simulation.grains.discs.position[0, 0]
    assert own > 0.012  # the model's own position runs on, and with it the run-out
    snapshot = simulation.snapshot()
    assert snapshot.clouds["grains"].position[0, 0] == own % 0.012
    solid = snapshot.grids["fields"].cells["solid_fraction"]
    # The disc lies across the side and is all there: area to single precision.
    assert solid[:, 0].max() > 0.5
    assert solid[:, -1].max() > 0.5
    assert solid.sum() * 0.0002**2 == pytest.approx(math.pi / 4 * 0.001**2, rel=1e-5)
