"""A user's own law through the commands: run, card, resume, and what is wrong with its file."""

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest

from tests.reference.folders import ROOT
from tests.reference.own_laws import write_laws
from tests.reference.waiting import done

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


def porescale(*words: object) -> subprocess.CompletedProcess[str]:
    """The command line, in the project's folder."""
    env = {**os.environ, "PYTHONPATH": str(ROOT)}
    return done([sys.executable, "-m", "porescale", *words], cwd=ROOT, env=env)


def test_a_run_names_its_law_and_goes_on_with_no_other(folder: Path) -> None:
    run = ["run", folder, "--out", folder / "run", "--quiet"]
    ended = porescale(*run)
    assert ended.returncode == 0, ended.stdout + ended.stderr
    card = json.loads((folder / "run" / "card.json").read_text(encoding="utf-8"))
    law = card["laws"]["contact.law"]
    assert card["scene"]["contact"]["law"] == law["law"] == "laws.py:sticky"
    assert law["sources"] == {"laws.py": LAW.format(force=FORCE)}
    rows = (folder / "run" / "series.csv").read_text(encoding="utf-8")
    longer = porescale(*run, "--resume", "--set", "time.end=0.03")
    assert longer.returncode == 0, longer.stdout + longer.stderr
    write_laws(folder, LAW.format(force=f"2.0 * {FORCE}"))
    other = porescale(*run, "--resume", "--set", "time.end=0.04")
    assert other.returncode == 2
    assert len(other.stderr.splitlines()) == 1
    assert f"contact.law = 'laws.py:sticky': has changed since the run began (hash {law['hash']}" in other.stderr
    anew = porescale("run", folder, "--out", folder / "anew", "--quiet")  # the edited file, another result
    assert anew.returncode == 0, anew.stdout + anew.stderr
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
def test_what_is_wrong_with_the_file_is_one_line_and_exit_code_2(folder: Path, force: str, said: str) -> None:
    write_laws(folder, LAW.format(force=force))
    found = porescale("check", folder)
    assert found.returncode == 2
    assert said in found.stderr
    assert len(found.stderr.splitlines()) == 1


def test_check_says_what_follows_from_it(folder: Path) -> None:
    found = porescale("check", folder)
    assert found.returncode == 0, found.stderr
    for word in ("laws.py:sticky", "contact.adhesion", "stiffest tangent", "contact time"):
        assert word in found.stdout
