"""A collapse killed while contacts slide and the gate lifts resumes to the same bits; and one thread is two threads."""

from __future__ import annotations

import random
import signal
import subprocess
import sys
from pathlib import Path

import numpy as np

from porescale import build, load, open_run
from porescale.runs.checkpoint import read_checkpoint
from tests.reference.same_run import contents, differences, state_of
from tests.reference.scenes import COLUMN, STEPS

ROOT = Path(__file__).resolve().parents[2]
KILLED = """
import os, signal, sys
from porescale.app.main import main
from porescale.coupling.step import Coupled

last, step = int(sys.argv.pop(1)), Coupled.advance

def advance(self):
    if self.fluid.step == last:
        os.kill(os.getpid(), signal.SIGKILL)
    step(self)

Coupled.advance = advance
sys.exit(main())
"""
"""`porescale` in a process that is killed when ``last`` steps are done, wherever its files stand then."""
GATE = (55, 500)
"""Steps between which the gate rises through the box, the grains behind it falling."""


def killed(last: int, *words: object) -> int:
    """Exit code of the command line ``words`` in a process that kills itself after ``last`` steps."""
    command = [sys.executable, "-c", KILLED, str(last), *map(str, words)]
    return subprocess.run(command, cwd=ROOT, capture_output=True, check=False).returncode


def sliding(scene: Path, state: dict) -> int:
    """Number of contacts between grains whose spring is at the Coulomb limit, from a checkpoint's state."""
    simulation = build(load(scene))
    simulation.restore(state)
    grains = simulation.grains
    count, x, r = 0, grains.discs.position, grains.discs.radius
    for i in range(len(r)):
        for slot in range(grains.pairs.start[i], grains.pairs.start[i + 1]):
            j = grains.pairs.partner[slot]
            overlap = r[i] + r[j] - np.hypot(*(x[i] - x[j]))
            tangential = COLUMN["contact"]["tangential_stiffness"] * abs(grains.pairs.carried[slot, 0])
            # The normal force also holds a damping share, so "at the limit" is to within it: half suffices to slide.
            if overlap > 0 and tangential > 0.5 * COLUMN["contact"]["friction"] * 2e5 * overlap:
                count += 1
    return count


def test_killed_five_times_it_ends_bit_for_bit_as_untouched(folder, scene, tmp_path):
    out = tmp_path / "killed"
    steps = sorted(random.Random(2).sample(range(*GATE), 5))
    slid, edges, reached = 0, [], []
    for number, last in enumerate(steps):
        resume = ("--resume",) if number else ()
        assert killed(last, "run", scene, "--out", out, "--quiet", "--threads", 1, *resume) == -signal.SIGKILL
        saved = read_checkpoint(out / "checkpoint.h5")
        reached.append(saved["step"])
        edges.append(float(saved["state"]["coupled"]["fluid"]["plates"]["0"]["edge"]))
        slid += sliding(scene, saved["state"])
        run = open_run(out)  # what was recorded so far opens
        assert len(run) >= last // 100
        assert all(np.isfinite(it.clouds["grains"].position).all() for it in run.snapshots())
    assert all(saved <= last for saved, last in zip(reached, steps, strict=True))
    assert len(set(reached)) > 2  # the kills came at different places
    assert sum(0 < edge < 40 for edge in edges) >= 3  # while the gate was rising, measured in cells
    assert slid > 0
    assert differences(folder, out) != []
    resumed = [sys.executable, "-m", "porescale", "run", str(scene), "--out", str(out), "--resume", "--quiet"]
    subprocess.run([*resumed, "--threads", "1"], cwd=ROOT, check=True, capture_output=True)
    assert differences(folder, out) == []
    assert len(open_run(out).card["resumed"]) == 5
    names = {path.name for path in folder.iterdir()}
    assert {path.name for path in out.iterdir()} == names


def test_two_threads_give_the_bits_of_one(folder, scene, porescale, tmp_path):
    out = tmp_path / "two"
    assert porescale("run", scene, "--out", out, "--quiet", "--threads", 2) == 0
    assert open_run(out).card["threads"] == min(2, open_run(out).card["machine"]["cores"])
    assert differences(folder, out) == []


def test_a_state_that_differs_in_one_bit_ends_differently(folder, scene, porescale, tmp_path, monkeypatch):
    # The twin that must fail: the comparison sees a run whose first grain starts one rounding error to the right.
    import porescale.scene.build as module

    out, prepared = tmp_path / "nudged", module.prepared

    def nudged(*parts):
        grains = prepared(*parts)
        grains.discs.position[0, 0] = np.nextafter(grains.discs.position[0, 0], 1.0)
        return grains

    monkeypatch.setattr(module, "prepared", nudged)
    assert porescale("run", scene, "--out", out, "--quiet", "--threads", 1) == 0
    found = differences(folder, out)
    assert "series.csv" in found
    assert any(it.startswith("fields.vtkhdf") for it in found)
    assert any("velocity" in it for it in found if it.startswith("checkpoint"))


def test_the_comparison_covers_the_whole_state(folder):
    places = state_of(folder)
    for name in ("populations", "position", "velocity", "spin", "carried", "partner", "old_velocity", "old_spin"):
        assert any(place.endswith(f"/{name}") for place in places), name
    assert any("plates" in place for place in places)
    assert any("Values" in place for place in contents(folder / "grains.vtkhdf"))
    assert b"600" in places["/step"]
    assert open_run(folder).steps[-1] == STEPS
