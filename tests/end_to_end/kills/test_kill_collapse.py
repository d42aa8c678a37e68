"""A collapse killed while contacts slide and the gate lifts resumes to the same bits; and one thread is two threads."""

import random
import signal
import sys
from pathlib import Path

import numpy as np
import pytest

from porescale import build, load, open_run
from porescale.common.record.checkpoint import read_checkpoint
from tests.reference.folders import ROOT
from tests.reference.same_run import contents, differences, state_of
from tests.reference.scenes import STEPS
from tests.reference.waiting import done

KILLED = """
import os, signal, sys
from porescale.cli.main import main
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
SAVE = ("--set", "output.checkpoint_seconds=0.001")
"""Saves with every row, at any speed of the machine, so that kills at different steps resume from different ones."""
GATE = (55, 500)
"""Steps between which the gate rises through the box, the grains behind it falling."""


def killed(last: int, *words: object) -> int:
    """Exit code of the command line ``words`` in a process that kills itself after ``last`` steps."""
    command = [sys.executable, "-c", KILLED, str(last), *map(str, words)]
    return done(command, cwd=ROOT).returncode


def sliding(scene: Path, state: dict) -> int:
    """Number of contacts between grains that slide in the contact step after a checkpoint, from its state.

    A spring that slides is left at the Coulomb limit mu max(0, k d + c d'), with overlap d and closing speed d' of
    where the step begins.
    """
    simulation = build(load(scene))
    simulation.restore(state)
    grains = simulation.grains
    law, pairs, r = grains.law, grains.pairs, grains.discs.radius
    grains.refresh()  # now, so that the step keeps the list
    x, v = grains.discs.position.copy(), grains.discs.velocity.copy()
    grains.step(grains.last_dt, grains.external_force.copy(), grains.external_torque.copy())
    count = 0
    for i in range(len(r)):
        for slot in range(pairs.start[i], pairs.start[i + 1]):
            j = pairs.partner[slot]
            distance = np.hypot(*(x[j] - x[i]))
            closing = (v[i] - v[j]) @ (x[j] - x[i]) / distance
            overlap = r[i] + r[j] - distance
            limit = law.friction * max(0.0, law.stiffness * overlap + law.damping * closing) if overlap > 0 else 0.0
            spring = law.tangential_stiffness * abs(pairs.carried[slot, 0])
            # Never above the limit, but for the rounding of a distance of 1 mm in an overlap of 0.1 um: 1e-12.
            assert spring <= (1 + 1e-9) * limit
            count += bool(limit > 0 and spring >= 0.999 * limit)
    return count


def test_killed_five_times_it_ends_bit_for_bit_as_untouched(folder, scene, tmp_path):
    out = tmp_path / "killed"
    steps = sorted(random.Random(2).sample(range(*GATE), 5))
    slid, edges, reached = 0, [], []
    for number, last in enumerate(steps):
        resume = ("--resume",) if number else ()
        assert killed(last, "run", scene, "--out", out, "--quiet", "--threads", 1, *SAVE, *resume) == -signal.SIGKILL
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
    assert done([*resumed, "--threads", "1"], cwd=ROOT).returncode == 0
    assert differences(folder, out) == []
    assert len(open_run(out).card["resumed"]) == 5
    names = {path.name for path in folder.iterdir()}
    assert {path.name for path in out.iterdir()} == names


@pytest.mark.usefixtures("without_pictures")
def test_two_threads_give_the_bits_of_one(folder, scene, porescale, tmp_path):
    out = tmp_path / "two"
    assert porescale("run", scene, "--out", out, "--quiet", "--threads", 2) == 0
    assert open_run(out).card["threads"] == min(2, open_run(out).card["machine"]["cores"])
    assert differences(folder, out) == []


@pytest.mark.usefixtures("without_pictures")
def test_a_state_that_differs_in_one_bit_ends_differently(folder, scene, porescale, tmp_path, monkeypatch):
    # The twin that must fail: the comparison sees a run whose first grain starts one rounding error to the right.
    import porescale.builders.initial.grains as module

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
    for name in ("populations", "position", "velocity", "spin", "carried", "partner", "inner_velocity", "inner_spin"):
        assert any(place.endswith(f"/{name}") for place in places), name
    assert any("plates" in place for place in places)
    assert any("Values" in place for place in contents(folder / "grains.vtkhdf"))
    assert b"600" in places["/step"]
    assert open_run(folder).steps[-1] == STEPS
