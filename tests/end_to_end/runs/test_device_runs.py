"""Runs on a GPU by commands, in numba's simulator: killed and resumed across devices, unstable, out of memory, in a
sweep.  The simulator rounds as the CPU does, so that every bit is that of a run on the CPU."""

import csv
import json
import os
import re
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from porescale.cli.main import commands
from porescale.common.cli.application import main
from porescale.common.compiled import cuda
from porescale.common.record.checkpoint import read_checkpoint
from porescale.common.record.open_run import open_run
from tests.reference.folders import ROOT

SCENE = """
[domain]
width = 0.007
height = 0.006
left = { kind = "velocity", velocity = [0.001, 0.0] }
right = { kind = "pressure", pressure = 0.0 }
[time]
end = 0.06
[output]
series_interval = 0.006
snapshot_interval = 0.02
checkpoint_seconds = 0.000001
report = false
[fluid]
spacing = 1e-3
relaxation_time = 0.7
viscosity = 1e-5
body_force = [0.01, 0]
"""
"""Nine steps of 42 cells; a row at each, a snapshot at every third, a checkpoint whenever one can be."""
KILLED = """
import os, signal, sys
from porescale.common.record.record import Record
save = Record.save
def saved(self, model, schedules):
    save(self, model, schedules)
    if model.step >= 3:
        os.kill(os.getpid(), signal.SIGKILL)
Record.save = saved
from porescale.cli.main import main
sys.exit(main())
"""
"""`porescale`, killed once the third step is in the checkpoint: at an odd one."""
BOUND = 0.0136
"""Relative density change that this flow reaches between its fourth and its fifth step."""
Command = Callable[..., tuple[int, list[str]]]


@pytest.fixture
def porescale(tmp_path, monkeypatch, capsys) -> Command:
    """Runs a command line, without pictures, in a folder with the scene; exit code and lines of stderr but warnings."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("PYTHONPATH", str(ROOT))  # processes of their own run the sources of this one
    monkeypatch.setattr("porescale.program.show", lambda _: [])
    Path("scene.toml").write_text(SCENE, encoding="utf-8")

    def _porescale(*words: str) -> tuple[int, list[str]]:
        code = main(commands(), words)
        return code, [line for line in capsys.readouterr().err.splitlines() if not line.startswith("warning")]

    return _porescale


def killed(*words: str) -> None:
    """The command in a process of its own, which kills itself."""
    environment = {**os.environ, "NUMBA_ENABLE_CUDASIM": "1", "NUMBA_NUM_THREADS": "2"}
    done = subprocess.run([sys.executable, "-c", KILLED, *words], env=environment, timeout=300, check=False)
    assert done.returncode == -9


def same(one: str, other: str) -> bool:
    """Whether two runs left the same populations, rows and snapshots, in every bit."""
    states = [read_checkpoint(Path(it) / "checkpoint.h5")["state"] for it in (one, other)]
    first, second = (it.get("stepper", it) for it in states)
    rows = [(Path(it) / "series.csv").read_bytes() for it in (one, other)]
    cells = [[it.grids["fields"].cells for it in open_run(run).snapshots()] for run in (one, other)]
    return (
        equal(first, second) and rows[0] == rows[1] and len(cells[0]) == len(cells[1]) == 4
        and all(equal(a, b) for a, b in zip(*cells, strict=True))
    )  # fmt: skip


def equal(a, b) -> bool:
    """Whether nested dicts of arrays and numbers are the same."""
    if isinstance(a, dict):
        return a.keys() == b.keys() and all(equal(a[key], b[key]) for key in a)
    return bool(np.array_equal(a, b))


@pytest.mark.slow
@pytest.mark.parametrize(("first", "then"), [("gpu", "cpu"), ("cpu", "gpu")])
def test_a_run_killed_on_one_device_goes_on_on_the_other(first, then, porescale):
    assert porescale("run", "scene.toml", "--out", "whole", "--quiet")[0] == 0
    killed("run", "scene.toml", "--out", "run", "--device", first)
    card = json.loads(Path("run/card.json").read_text())
    assert (card["outcome"], card["scene"]["run"]["device"]) == ("running", first)
    assert porescale("run", "scene.toml", "--out", "run", "--device", then, "--resume", "--quiet") == (0, [])
    assert same("run", "whole")
    card = json.loads(Path("run/card.json").read_text())
    names = {"gpu": {"name": cuda.SIMULATOR, "driver": ""}, "cpu": {"name": "cpu"}}
    assert (card["device"], [it["device"] for it in card["resumed"]]) == (names[then], [names[then]])
    assert card["resumed"][0]["step"] == 3


def test_a_whole_run_is_that_of_the_cpu_and_with_another_operator_it_is_not(porescale):
    for name, words in (("cpu", ()), ("gpu", ("--device", "gpu")), ("other", ("--set", "fluid.operator=mrt"))):
        assert porescale("run", "scene.toml", "--out", name, "--quiet", *words)[0] == 0
    assert same("gpu", "cpu")
    assert not same("other", "cpu")
    assert json.loads(Path("gpu/card.json").read_text())["device"]["name"] == cuda.describe()[0]


def test_an_unstable_run_stops_with_the_line_of_the_cpu_and_keeps_its_last_good_state(porescale, monkeypatch):
    """With a bound that this flow passes on its way: what `run` does there is what it does at any other."""
    monkeypatch.setattr("porescale.coupling.divergence_check.WORST_DENSITY", BOUND)
    code, said = porescale("run", "scene.toml", "--out", "cpu", "--quiet")
    assert (code, len(said)) == (3, 1)
    code, ours = porescale("run", "scene.toml", "--out", "gpu", "--device", "gpu", "--quiet")
    assert (code, [line.replace("gpu/", "cpu/") for line in ours]) == (3, said)
    assert re.search(r"unstable at step 5 .*density change = .* at cell \(", ours[0])
    assert "last good state: gpu/checkpoint.h5" in ours[0]
    reached = [read_checkpoint(Path(it) / "checkpoint.h5") for it in ("cpu", "gpu")]
    assert equal(reached[0]["state"], reached[1]["state"])
    assert reached[1]["step"] == 4
    assert json.loads(Path("gpu/card.json").read_text())["outcome"] == "unstable"


def test_memory_that_does_not_suffice_leaves_no_folder(porescale, monkeypatch):
    def full(_):
        raise RuntimeError("Call to cuMemAlloc results in CUDA_ERROR_OUT_OF_MEMORY")

    monkeypatch.setattr(cuda.cuda(), "to_device", full)
    code, said = porescale("run", "scene.toml", "--out", "run", "--device", "gpu", "--quiet")
    assert (code, len(said)) == (2, 1)
    assert "does not hold" in said[0]
    assert not Path("run").exists()


@pytest.mark.slow
def test_runs_of_a_sweep_share_a_gpu(porescale):
    vary = ("--vary", "fluid.relaxation_time=0.7,0.8", "--jobs", "2", "--out", "sweep")
    assert porescale("sweep", "scene.toml", *vary, "--set", "run.device=gpu")[0] == 0
    with Path("sweep/sweep.csv").open(encoding="utf-8") as file:
        assert [row["outcome"] for row in csv.DictReader(file)] == ["finished", "finished"]
    cards = [json.loads(it.read_text()) for it in sorted(Path("sweep").rglob("card.json"))]
    assert [it["device"]["name"] for it in cards] == [cuda.SIMULATOR] * 2
    assert len({it["scene"]["fluid"]["relaxation_time"] for it in cards}) == 2
