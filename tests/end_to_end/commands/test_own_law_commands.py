"""A user's own law through the commands: run, card, resume, and what is wrong with its file."""

import json
import shutil
from collections.abc import Callable
from pathlib import Path
from typing import Any

import h5py
import numpy as np
import pytest

from porescale import open_run
from tests.reference.folders import CASES
from tests.reference.own_laws import write_laws

pytestmark = pytest.mark.usefixtures("without_pictures")

LAW = """
import porescale as ps


@ps.contact_law(keys={{"stiffness": "N/m", "adhesion": "N/m"}})
def sticky(overlap, closing, radius, mass, p):
    return {force}
"""
FORCE = "p.stiffness * overlap - p.adhesion * overlap / radius"
SCENE = """
title = "A grain that falls on the floor"
[domain]
width = 0.01
height = 0.01
[time]
end = 0.02
[output]
snapshot_interval = 0.01
series_interval = 0.01
[grains]
density = 2500
[[grains.grain]]
x = 0.005
y = 0.0012
diameter = 0.002
[contact]
law = "laws.py:sticky"
stiffness = "10 kN/m"
adhesion = 0.2
"""


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """A scene with laws.py beside it."""
    write_laws(tmp_path / "own", LAW.format(force=FORCE))
    (tmp_path / "own" / "scene.toml").write_text(SCENE, encoding="utf-8")
    return tmp_path / "own"


def states(run: Path) -> dict[str, bytes]:
    """Every array of the last checkpoint of a run (positions, velocities, springs), by its name."""
    found: dict[str, bytes] = {}

    def keep(name: str, item: Any) -> None:
        if isinstance(item, h5py.Dataset) and name != "tree":  # which also tells the steps of either part
            found[name] = np.asarray(item[()]).tobytes()

    with h5py.File(run / "checkpoint.h5") as file:
        file.visititems(keep)
    return found


@pytest.mark.slow
def test_a_run_names_its_law_and_goes_on_with_no_other(
    folder: Path, porescale: Callable[..., int], complaints: Callable[[], list[str]]
) -> None:
    run = ["run", folder, "--out", folder / "run", "--quiet"]
    assert porescale(*run) == 0
    card = json.loads((folder / "run" / "card.json").read_text(encoding="utf-8"))
    law = card["laws"]["contact.law"]
    assert card["scene"]["contact"]["law"] == law["law"] == "laws.py:sticky"
    assert law["sources"] == {"laws.py": LAW.format(force=FORCE)}
    rows = (folder / "run" / "series.csv").read_text(encoding="utf-8")
    assert porescale(*run, "--resume", "--set", "time.end=0.03") == 0
    assert complaints() == []
    write_laws(folder, LAW.format(force=f"2.0 * {FORCE}"))
    assert porescale(*run, "--resume", "--set", "time.end=0.04") == 2
    (line,) = complaints()
    assert f"contact.law = 'laws.py:sticky': has changed since the run began (hash {law['hash']}" in line
    assert porescale("run", folder, "--out", folder / "anew", "--quiet") == 0  # the edited file, another result
    assert (folder / "anew" / "series.csv").read_text(encoding="utf-8") != rows


@pytest.mark.parametrize(
    ("force", "said"),
    [
        ("p.stiffness * (", "laws.py, line 7: '(' was never closed"),
        ("p.stifness * overlap", "laws.py, line 7: "),
        ("0.0 * overlap / 0.0", "the force is nan at an overlap of 2e-11 m"),
        ("p.stiffness * overlap - p.adhesion", "pulls with 0.2 N/m at an overlap of 2e-11 m"),
    ],
)
def test_what_is_wrong_with_the_file_is_one_line_and_exit_code_2(
    folder: Path, force: str, said: str, porescale: Callable[..., int], complaints: Callable[[], list[str]]
) -> None:
    write_laws(folder, LAW.format(force=force))
    assert porescale("check", folder) == 2
    (line,) = complaints()
    assert said in line


def test_check_says_what_follows_from_it(
    folder: Path, porescale: Callable[..., int], capsys: pytest.CaptureFixture[str]
) -> None:
    assert porescale("check", folder) == 0
    said = capsys.readouterr().out
    for word in ("laws.py:sticky", "contact.adhesion", "stiffest tangent", "contact time"):
        assert word in said


@pytest.mark.parametrize(
    ("force", "energy", "said"),
    [
        ("p.stiffness * overlap * mass / (mass + 1e-3)", True, True),
        ("p.stiffness * overlap * mass / (mass + 1e-3)", False, False),
        ("p.stiffness * overlap + 0.1 * mass * closing", True, False),  # of the mass, but not at rest
    ],
)
def test_check_warns_of_an_energy_that_is_not_of_the_overlap_alone(
    folder: Path,
    force: str,
    energy: bool,
    said: bool,
    porescale: Callable[..., int],
    capsys: pytest.CaptureFixture[str],
) -> None:
    write_laws(folder, LAW.format(force=force))
    assert porescale("check", folder, "--set", f"output.energy={str(energy).lower()}") == 0
    words = " ".join(" ".join(capsys.readouterr()).split())
    assert ("laws.py:sticky at rest depends on the mass" in words) == said


def test_a_run_that_was_interrupted_goes_on_to_the_bit(folder: Path, porescale: Callable[..., int]) -> None:
    # In the middle of the contact, from 6.4 to 9.2 ms.  The law of the case, whose kernels other tests have compiled;
    # the other run has one that pulls a millionth more.
    shutil.copy(CASES / "own_law" / "laws.py", folder)
    law = ("contact.release=overlap", "contact.damping=0.01", "contact.adhesion=0.002")
    few = (*law, "output.series_interval=1e-3", "output.snapshot_interval=2e-3")
    runs = {"whole": ("time.end=0.012",), "halved": ("time.end=0.008", "time.end=0.012")}
    for name, parts in {**runs, "other": ("contact.adhesion=0.002000002",)}.items():
        for k, setting in enumerate(parts):
            resumed = ["--resume"] * (k > 0) + (["--set", "time.end=0.012"] if name == "other" else [])
            words = [word for it in (*few, setting) for word in ("--set", it)]
            assert porescale("run", folder, "--out", folder / name, "--quiet", *words, *resumed) == 0
    whole, halved, other = (open_run(folder / name).series.to_pandas() for name in ("whole", "halved", "other"))
    assert whole["largest overlap over diameter ()"][0.007:0.009].min() > 0.0
    assert whole.equals(halved)
    assert not whole.equals(other)
    assert states(folder / "whole") == states(folder / "halved")
    assert states(folder / "whole") != states(folder / "other")
