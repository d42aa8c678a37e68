"""Both packages through Slurm: sweeps, trade studies and homogenisation, with a machine that fails in the middle."""

import os
import sys
from pathlib import Path

import pytest

from continuum_sph.cli import PACKAGE as CONTINUUM
from porescale.cli.main import commands
from porescale.common.cli.application import application, main
from porescale.common.compiled import jit
from porescale.common.studies.schedulers import slurm as scheduler
from tests.reference.faults.killing import TANK
from tests.reference.faults.slurm import slurm
from tests.reference.same_run import differences
from tests.reference.scenes import COLUMN, table, write
from tests.reference.waiting import done

SOIL = table(COLUMN, homogenise={"pressure": 200.0, "grains": 100, "packings": 2, "strain": 0.06, "cells": 4})
PLAN = """
[reference]
settings = { numerics.spacing = 0.01 }
[[quantity]]
name = "energy"
column = "kinetic energy (J/m)"
scale = 1.0
[[knob]]
name = "spacing"
[[knob.point]]
label = "0.0125"
settings = { numerics.spacing = 0.0125 }
[[knob.point]]
label = "0.02"
settings = { numerics.spacing = 0.02 }
"""


@pytest.fixture
def cluster(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("PYTHONPATH", os.pathsep.join(sys.path))
    for name in ("FIRST_LOOK", "LAST_LOOK", "SECOND_LOOK", "ABSENT_SECONDS"):
        monkeypatch.setattr(scheduler, name, 0.1)
    with slurm(tmp_path / "cluster") as made:
        yield made


def asked(package: str, *words: str) -> int:
    """Exit code of a command line, on one thread."""
    before = jit.threads()
    try:
        return main(commands() if package == "porescale" else application(CONTINUUM), words)
    finally:
        jit.set_threads(before)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("package", "scene", "key", "longer"),
    [("porescale", COLUMN, "contact.friction", 0.04), ("continuum_sph", TANK, "water.viscosity", 0.5)],
)
def test_a_sweep_whose_machine_fails_ends_as_runs_of_their_own(cluster, package, scene, key, longer):
    write(Path("scene.toml"), table(scene, time__end=longer, output__report=False))
    points = [f"{key}={value}" for value in ("0.2", "0.4")]
    name = points[0].partition(".")[2]
    rows, saved = Path("out") / name / "series.csv", Path("out") / name / "checkpoint.h5"
    cluster.once(lambda: saved.exists() and rows.read_text().count("\n") > 3, lambda: cluster.kill("100_0"))
    words = ("scene.toml", "--vary", f"{key}=0.2,0.4", "--out", "out", "--scheduler", "slurm:time=10min")
    assert asked(package, "sweep", *words) == 0
    assert cluster.begun() == {"100_0": 2, "100_1": 1}
    for k, point in enumerate(points):
        alone = [sys.executable, "-m", package, "run", "scene.toml", "--set", point, "--threads", "1", "--quiet"]
        assert done([*alone, "--out", f"alone{k}"]).returncode == 0
    assert differences(Path("out") / name, Path("alone0")) == []
    assert differences(Path("out") / name, Path("alone1")) != []  # the check that must fail


@pytest.mark.slow
def test_a_trade_study_and_the_soil_of_a_packing_are_measured_through_slurm(cluster):
    write(Path("tank.toml"), table(TANK, output__report=False))
    Path("plan.toml").write_text(PLAN)
    words = ("tank.toml", "--plan", "plan.toml", "--out", "trade", "--scheduler", "slurm", "--jobs", "2")
    assert asked("continuum_sph", "study", "trade", *words) == 0
    assert Path("trade/front.json").exists()
    assert len(cluster.jobs) == 3
    assert cluster.most <= 2
    write(Path("soil.toml"), SOIL)
    assert asked("porescale", "homogenise", "soil.toml", "--out", "soil", "--scheduler", "slurm") == 0
    assert Path("soil/material.toml").exists()
    assert len(cluster.jobs) == 5
