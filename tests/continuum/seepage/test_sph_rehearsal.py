"""What the second process builds of water in soil: it comes to the kernels of the water first."""

from pathlib import Path

import pytest

from continuum_sph import load
from continuum_sph.builders import rehearsal
from continuum_sph.builders.parts.pore_water import ground_of
from porescale.common.api import run_scene

CASES = Path(__file__).parents[3] / "cases"


def test_the_soil_waits_for_the_water():
    ground, _ = ground_of(load(CASES / "saturated_levee"), hasty=True)
    assert ground.pairs.builds == 0


def test_a_run_begins_with_the_soil():  # the twin
    ground, _ = ground_of(load(CASES / "saturated_levee"))
    assert ground.pairs.builds == 1


@pytest.mark.parametrize(("case", "twice"), [("saturated_levee", True), ("dry_slope", False), ("sheet_pile", False)])
def test_only_water_in_soil_that_moves_is_begun_twice(monkeypatch: pytest.MonkeyPatch, case: str, twice: bool) -> None:
    found = []
    monkeypatch.setattr(run_scene, "rehearsed", lambda module, scene, fits: found.append(fits()))
    rehearsal.rehearsed(load(CASES / case))
    assert found == [twice]


def test_much_of_it_is_not_held_twice(monkeypatch: pytest.MonkeyPatch) -> None:
    found = []
    monkeypatch.setattr(run_scene, "rehearsed", lambda module, scene, fits: found.append(fits()))
    rehearsal.rehearsed(load(CASES / "saturated_levee", settings=["numerics.spacing=0.001"]))
    assert found == [False]
