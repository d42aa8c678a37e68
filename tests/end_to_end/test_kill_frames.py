"""A scene of polygons, segments, a disc and a tray, with bonds made on the way that break, killed and resumed."""

import signal
import sys

import numpy as np
import pytest

from porescale.common.record.open_run import open_run
from porescale.common.record.series import read_series
from tests.reference.folders import ROOT
from tests.reference.same_run import differences
from tests.reference.scenes import write
from tests.reference.waiting import done

CHILD = """
import os, signal, sys
from porescale.cli.main import main
from porescale.builders.simulation import Simulation

last, advance = int(sys.argv.pop(1)), Simulation.advance

def killed(self, steps):
    if last and self.step + steps > last:
        os.kill(os.getpid(), signal.SIGKILL)
    advance(self, steps)

Simulation.advance = killed
sys.exit(main())
"""
"""`porescale` in a process that is killed before more than ``last`` steps are done."""
STEP = 1e-5
SQUARE = [[0, 0], [1e-3, 0], [1e-3, 1e-3], [0, 1e-3]]
SCENE = {
    "title": "Bonded squares on a tray that tips",
    "gravity": [0, -9.81],
    "domain": {"width": 0.012, "height": 0.01},
    "time": {"end": 600 * STEP},
    "output": {"snapshot_interval": 100 * STEP, "series_interval": 20 * STEP, "checkpoint_seconds": 1e-3,
               "energy": True},
    "grains": {"density": 2500, "overlap": 0.01, "grain": [{"x": 8e-3, "y": 2.599e-3, "diameter": 1e-3}]},
    "contact": {"stiffness": 2e4, "tangential_stiffness": 5e3, "restitution": 0.3, "friction": 0.5, "step": STEP},
    "polygon": [{"corners": SQUARE, "thickness": 5e-5,
                 "at": [[3e-3, 2.149e-3], [4.0995e-3, 2.149e-3], [5.199e-3, 2.149e-3], [6.2985e-3, 2.149e-3]]}],
    "segment": [{"chain": [[8e-3, 4e-3], [9e-3, 4e-3], [9e-3, 5e-3]], "thickness": 1e-4}],
    "container": [{"chain": [[2e-3, 4e-3], [2e-3, 2e-3], [1e-2, 2e-3]], "thickness": 1e-4, "pivot": [3e-3, 2.5e-3],
                   "rotation": {"displacement": [[0, 0], [2e-3, 0], [6e-3, -0.2]]}, "name": "tray", "record": True}],
    "bonds": [{"at": 1e-3, "bodies": ["polygon"]}],
}  # fmt: skip


def run(last: int, *words: object) -> int:
    """Exit code of ``porescale run`` with ``words``."""
    command = [sys.executable, "-c", CHILD, str(last), "run", *map(str, words), "--quiet", "--threads", "1"]
    return done(command, cwd=ROOT).returncode


@pytest.fixture(scope="module")
def whole(tmp_path_factory):
    """The scene's file, and the folder of its uninterrupted run."""
    place = tmp_path_factory.mktemp("frames")
    scene = write(place / "scene.toml", SCENE)
    assert run(0, scene, "--out", place / "whole") == 0
    return scene, place / "whole"


@pytest.mark.slow
@pytest.mark.parametrize("last", [60, 400])
def test_a_killed_scene_of_frames_and_bonds_resumes_to_the_same_bits(whole, tmp_path, last):
    scene, done = whole
    parts = tmp_path / "parts"
    assert run(last, scene, "--out", parts) == -signal.SIGKILL
    assert run(0, scene, "--out", parts, "--resume") == 0
    assert differences(parts, done) == []
    for name in ("control.csv", "breaks.csv"):
        assert (parts / name).read_bytes() == (done / name).read_bytes(), name


@pytest.mark.slow
def test_bonds_are_made_and_break_around_the_kills(whole):  # so that the kills differ in what they cut
    columns = read_series(whole[1] / "series.csv")
    first = columns["time (s)"][columns["bonds ()"] > 0].min()
    assert 60 * STEP < first < 400 * STEP
    assert columns["broken bonds ()"][-1] > 0
    last = open_run(whole[1]).snapshot(-1)
    assert set(last.clouds) == {"grains", "frames", "bonds"}
    lines = np.asarray(last.clouds["bonds"].lines)
    assert len(lines) == columns["bonds ()"].max()
