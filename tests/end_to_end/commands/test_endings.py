"""How a command ends: 0 done, 2 wrong input, 3 unstable, 130 interrupted; one clear line, and nothing half-written."""

import json
import re
import signal
import sys
from pathlib import Path

import numpy as np
import pytest

from porescale import build, load, open_run
from porescale.builders.simulation import Simulation
from porescale.common.core.errors import Unstable
from porescale.common.record.checkpoint import read_checkpoint
from porescale.lbm.sanity import SOUND, WORST_MACH
from tests.reference.folders import ROOT, complaints_in
from tests.reference.same_run import differences
from tests.reference.scenes import COLUMN, grain, table, write
from tests.reference.waiting import done

TABLE1 = ROOT / "cases" / "column_collapse_table1"


@pytest.fixture
def ends(porescale, capsys):
    """Exit code of a command and the complaints on stderr; no traceback among them."""

    def run(*words):
        capsys.readouterr()
        code = porescale(*words)
        said = capsys.readouterr().err
        assert "Traceback" not in said
        return code, complaints_in(said)

    return run


def test_check_of_table_1_names_the_implied_viscosity(ends):
    code, said = ends("check", TABLE1)
    assert code == 2
    assert len(said) == 4
    (line,) = [it for it in said if "fluid.viscosity" in it]
    assert "fluid.viscosity = 0.0001 m^2/s: " in line
    assert "imply 1e-05 m^2/s; leave viscosity out, or give 1e-05" in line


def test_python_m_porescale_is_the_same_command():
    words = [sys.executable, "-m", "porescale", "check", str(TABLE1)]
    ended = done(words, cwd=ROOT)
    assert ended.returncode == 2
    assert "the others (spacing, step, relaxation_time) imply 1e-05 m^2/s" in ended.stderr
    assert "Traceback" not in ended.stderr
    assert ended.stdout == ""


def test_check_prints_what_a_scene_implies_and_builds_nothing(scene, porescale, capsys, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(Simulation, "__init__", None)  # nothing is built
    assert porescale("check", scene) == 0
    said = capsys.readouterr().out
    for name in ("relaxation time", "0.56", "60 x 40", "Archimedes", "Stokes", "Reynolds", "density ratio", "Mach"):
        assert name in said
    for name in ("contact steps per model step", "restitution of a pair", "memory", "snapshots", "built"):
        assert name in said
    assert list(tmp_path.iterdir()) == []


def broken(path: Path, name: str) -> Path:
    """A scene file that is wrong in one way."""
    wrong = {
        "unknown": table(fluid__viscsity=1e-5),
        "unit": table(domain__width="12 s"),
        "range": table(contact__stiffness=-1.0),
        "overlap": table(grains={"density": 2500, "hydraulic_radius_ratio": 1,
                                 "grain": [grain(0.003, 0.004), grain(0.0035, 0.004)]}),
        "cells": table(domain__width=0.0121),
    }  # fmt: skip
    return write(path / f"{name}.toml", wrong[name])


@pytest.mark.parametrize(
    ("name", "key", "also"),
    [
        ("unknown", "fluid.viscsity", "viscosity"),
        ("unit", "domain.width", "m"),
        ("range", "contact.stiffness = -1.0 N/m", ">= 1e-06"),
        ("overlap", "grains.grain[1]", "overlaps grain 0 by 0.0005 m"),
        ("cells", "domain.width = 0.0121 m", "not a whole number"),
    ],
)
@pytest.mark.parametrize("command", ["run", "check"])
def test_a_wrong_scene_is_one_line_and_leaves_nothing_behind(ends, tmp_path, command, name, key, also):
    out = tmp_path / "out"
    file = broken(tmp_path, name)
    options = ("--out", out, "--quiet") if command == "run" else ()
    code, said = ends(command, file, *options)
    assert code == 2
    (line,) = said
    assert key in line
    assert also in line.split(key, 1)[1]
    assert not out.exists()


@pytest.mark.parametrize("command", ["run", "check"])
def test_a_lattice_beyond_the_memory_is_refused_before_anything_is_built(ends, scene, tmp_path, monkeypatch, command):
    monkeypatch.setattr(Simulation, "__init__", None)
    fine = ("--set", "fluid.spacing=1e-9", "--set", "fluid.step=1e-12", "--set", "fluid.viscosity=1e-7")
    options = ("--out", tmp_path / "out", "--quiet") if command == "run" else ()
    code, (line,) = ends(command, scene, *fine, *options)
    assert code == 2
    assert line.startswith("--set: fluid.spacing = 1e-09 m: needs ")
    assert line.endswith("takes half of the memory")
    assert list(tmp_path.iterdir()) == []


def test_every_fault_of_a_file_is_said_at_once(ends, tmp_path):
    wrong = table(fluid__viscsity=1e-5, domain__width="12 s", contact__stiffness=-1.0, time__end=0)
    code, said = ends("run", write(tmp_path / "wrong.toml", wrong), "--out", tmp_path / "out")
    assert code == 2
    assert len(said) == 4
    assert all(line.startswith(str(tmp_path / "wrong.toml")) for line in said)


def test_a_run_is_not_overwritten_by_accident_nor_resumed_as_another(ends, folder, scene):
    before = (folder / "series.csv").read_bytes()
    code, (line,) = ends("run", scene, "--out", folder)
    assert (code, "already holds a run" in line) == (2, True)
    code, (line,) = ends("run", scene, "--out", folder, "--resume", "--set", "contact.friction=0.4")
    assert code == 2
    assert "contact.friction = 0.4: was 0.5" in line
    assert (folder / "series.csv").read_bytes() == before


def test_a_finished_run_is_left_alone(ends, folder, scene):
    card = (folder / "card.json").read_bytes()
    assert ends("run", scene, "--out", folder, "--resume", "--quiet") == (0, [])
    assert (folder / "card.json").read_bytes() == card


# A grain at Mach 0.3 in a fluid whose relaxation time is 1/2 + 3e-6: beyond what two relaxation times hold.
FAST = {
    "grains": {"density": 2500, "hydraulic_radius_ratio": 1.0, "grain": [
        grain(0.003, 0.004, velocity=[0.86, 0.0]), grain(0.009, 0.0045, velocity=[-0.86, 0.0])]},
    "gate": None, "output__snapshot_interval": 0.0004, "output__checkpoint_seconds": 1e-6,
}  # fmt: skip


def test_an_unstable_lattice_stops_the_run_and_names_its_cell(ends, tmp_path):
    out = tmp_path / "out"
    file = write(tmp_path / "edge.toml", table(**FAST, fluid__viscosity=1e-9))
    code, said = ends("run", file, "--out", out, "--quiet", "--threads", 1)
    assert code == 3
    line = said[-1]
    assert line.startswith("unstable at step ")
    assert "at cell (" in line
    assert "last good state: " in line
    stable = table(**FAST, time__end=0.002)  # the twin: a hundred times thicker than water it holds
    assert ends("run", write(tmp_path / "thick.toml", stable), "--out", tmp_path / "thick", "--quiet")[0] == 0
    card = json.loads((out / "card.json").read_text())
    assert card["outcome"] == "unstable"
    assert "at cell (" in card["problem"]
    run = open_run(out)
    assert len(run) > 1
    for snapshot in run.snapshots():
        assert np.isfinite(snapshot.grids["fields"].cells["velocity"]).all()
    saved = read_checkpoint(out / "checkpoint.h5")
    assert saved["step"] <= card["step"]
    simulation = build(load(file))
    simulation.restore(saved["state"])
    simulation.check()  # what was saved is good
    assert f"step {saved['step']}, " in line


LIGHT = {**FAST["grains"], "density": 50}


@pytest.mark.parametrize(
    ("changes", "cause"),
    [
        ({"fluid__viscosity": 1e-9}, "'trt' is known to hold up to"),
        ({"grains": LIGHT}, "free grains of density ratio 0.05 at 5 cells per diameter"),
        *(pytest.param(*case, marks=pytest.mark.slow) for case in (  # each compiles kernels of its own
            ({"fluid__viscosity": 1e-9, "fluid__operator": "bgk"}, "'bgk' is known to hold up to"),
            ({"fluid__viscosity": 1e-9, "fluid__operator": "mrt"}, "'mrt' is known to hold up to"),
            ({"fluid__viscosity": 1e-9, "fluid__precision": "float32"}, "'trt' is known to hold up to"),
        )),
    ],
)  # fmt: skip
def test_whatever_blows_up_stops_within_a_hundred_steps_with_its_cause(ends, tmp_path, changes, cause):
    out, file = tmp_path / "out", write(tmp_path / "edge.toml", table(**{**FAST, **changes}))
    code, said = ends("run", file, "--out", out, "--quiet", "--threads", 1)
    assert code == 3
    assert re.fullmatch(
        r"unstable at step \d+ \(t = \S+ s\): .+ = .+ at cell \(\d+, \d+\) at \(.+\) m; likely cause: .+; last good .+",
        said[-1],
    )
    assert cause in said[-1]
    for snapshot in open_run(out).snapshots():
        speed = snapshot.grids["fields"].cells["velocity"]
        assert float(np.abs(speed).max()) < WORST_MACH * SOUND * 5.0  # 5 m/s: one cell per step
    stopped = json.loads((out / "card.json").read_text())["step"]
    simulation, wrong = build(load(file)), []  # the twin: asked after every step
    while simulation.step < stopped:
        simulation.advance(1)
        try:
            simulation.check()
        except Unstable:
            wrong.append(simulation.step)
    assert stopped - wrong[0] <= 100
    # A speed that swings from step to step passes its limit at every other one at first: a state between is sound.
    state = read_checkpoint(out / "checkpoint.h5")
    assert state["step"] < stopped
    assert state["step"] not in wrong


def test_an_unstable_grain_is_named(ends, tmp_path):
    dry = table(
        fluid=None, gate=None, contact={"stiffness": 2e3, "restitution": 0.9},
        grains={"density": 2500, "grain": [grain(0.003, 0.004, velocity=[20.0, 0.0])]}, time__end=0.1,
    )  # fmt: skip
    code, said = ends("run", write(tmp_path / "fast.toml", dry), "--out", tmp_path / "out", "--quiet")
    assert code == 3
    assert "at grain 0; " in said[-1]
    assert "unstable at step " in said[-1]
    assert json.loads((tmp_path / "out" / "card.json").read_text())["outcome"] == "unstable"


def test_instability_counts_the_steps_of_the_model(scene):
    simulation = build(load(scene))
    simulation.advance(5)
    simulation.grains.discs.position[3] = np.nan
    with pytest.raises(Unstable) as caught:
        simulation.check()
    assert (caught.value.step, caught.value.where) == (5, "grain 3")
    assert caught.value.time == pytest.approx(5 * 4e-5)
    with pytest.raises(Unstable, match="position = nan m at grain"):
        simulation.advance(100)


def test_ctrl_c_saves_says_so_and_resumes_to_the_same_end(ends, folder, scene, tmp_path, monkeypatch):
    out = tmp_path / "out"
    advance = Simulation.advance

    def interrupted(self, steps):
        advance(self, steps)
        if self.step >= 300:
            signal.raise_signal(signal.SIGINT)

    with monkeypatch.context() as patch:
        patch.setattr(Simulation, "advance", interrupted)
        code, said = ends("run", scene, "--out", out, "--quiet", "--threads", 1)
    assert code == 130
    assert said[-1].startswith("interrupted at step 3")
    assert "resume to continue" in said[-1]
    assert json.loads((out / "card.json").read_text())["outcome"] == "interrupted"
    assert len(open_run(out)) == 4
    assert ends("run", scene, "--out", out, "--resume", "--quiet", "--threads", 1)[0] == 0
    assert differences(folder, out) == []


def test_the_scene_that_new_writes_is_sound(ends, porescale, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert ends("new", "mine") == (0, [])
    assert ends("check", "mine") == (0, [])
    for level in ("draft", "standard", "fine"):
        assert ends("check", "mine", "--quality", level)[0] == 0
    assert load("mine").gate is not None
    assert ends("new", "mine")[0] == 2
    code, (said,) = ends("new", "mine.toml")  # it would make a folder of that name
    assert (code, said) == (
        2,
        "NAME = 'mine.toml': names a file; name the folder to make: mine; scene.toml will be in it",
    )
    assert not Path("mine.toml").exists()
    assert COLUMN  # the twin of soundness is every refusal above
