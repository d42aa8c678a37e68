"""A deck whose segment is thrown back and a scene of bonded bodies, killed and resumed: the same bits in all files."""

import signal
import sys
from pathlib import Path

import numpy as np
import pytest

from porescale.common.record.open_run import open_run
from porescale.common.record.series import read_series
from tests.reference import decks
from tests.reference.folders import ROOT
from tests.reference.same_run import differences
from tests.reference.scenes import write
from tests.reference.waiting import done

pytestmark = pytest.mark.slow
CHILD = """
import os, signal, sys
from porescale.builders.simulation import Simulation
from porescale.cli import demseg
from porescale.cli.main import main
from porescale.demseg.run import DeckRun

last, model = int(sys.argv.pop(1)), DeckRun if sys.argv[1] == "demseg" else Simulation
advance = model.advance
demseg.CHECKPOINT_SECONDS = 1e-3

def killed(self, steps):
    if last and self.step + steps > last:
        os.kill(os.getpid(), signal.SIGKILL)
    advance(self, steps)

model.advance = killed
sys.exit(main())
"""
"""`porescale` in a process that saves as often as it can, and is killed before more than ``last`` steps are done."""
STEPS, TOUCH = 1200, 830
"""The pushed segment meets the disc when ½ 8000 t² = 1, after 790 steps of 2e-5, for some 17 steps; and again later."""
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
    """Exit code of ``porescale`` with ``words``."""
    command = [sys.executable, "-c", CHILD, last, *words, "--quiet", "--threads", "1"]
    return done(command, cwd=ROOT).returncode


@pytest.fixture(scope="module")
def deck(tmp_path_factory) -> tuple[tuple[object, ...], Path]:
    """The words that run a deck, and the folder of its uninterrupted run."""
    place = tmp_path_factory.mktemp("deck")
    folder = decks.write(place / "deck", decks.PUSHED, decks.boundary(f"0 0 {STEPS} 400 10", *decks.PUSH))
    words = ("demseg", "run", folder)
    assert run(0, *words, "--out", place / "whole") == 0
    return words, place / "whole"


@pytest.fixture(scope="module")
def bonded(tmp_path_factory) -> tuple[tuple[object, ...], Path]:
    """The words that run the scene, and the folder of its uninterrupted run."""
    place = tmp_path_factory.mktemp("frames")
    words = ("run", write(place / "scene.toml", SCENE))
    assert run(0, *words, "--out", place / "whole") == 0
    return words, place / "whole"


def assert_resumes(whole: Path, parts: Path, words: tuple[object, ...], *names: str) -> None:
    """A killed run in ``parts`` goes on to the bits of the ``whole`` one, in files of these ``names`` too."""
    assert run(0, *words, "--out", parts, "--resume") == 0
    for name in names:
        assert (parts / name).read_bytes() == (whole / name).read_bytes(), name
    assert differences(parts, whole) == []


@pytest.mark.parametrize("last", [400, 797, TOUCH])
def test_a_killed_deck_resumes_to_the_same_bits(deck, tmp_path, last):
    (words, whole), parts = deck, tmp_path / "parts"
    assert run(last, *words, "--out", parts) == -signal.SIGKILL
    # What is there of a run that was killed is whole: the first rows, up to the last snapshot, each 400 steps.
    curves = ("energy.dat", "f-d_curve.dat")
    for name in curves:
        assert (whole / name).read_bytes().startswith((parts / name).read_bytes())
        assert int(np.loadtxt(parts / name)[-1, 0]) == last // 400 * 400
    assert_resumes(whole, parts, words, *curves, *(f"new_in_{part}.dat" for part in ("gm", "bc", "cf", "cf0")))


def test_the_disc_is_met_between_the_kills(deck):  # so that the kills differ in what they cut
    rows = np.loadtxt(deck[1] / "f-d_curve.dat")
    met = rows[rows[:, 2] != 0.0, 0]
    assert 400 < met.min() < TOUCH


@pytest.mark.parametrize("last", [60, 400])
def test_a_killed_scene_of_frames_and_bonds_resumes_to_the_same_bits(bonded, tmp_path, last):
    (words, whole), parts = bonded, tmp_path / "parts"
    assert run(last, *words, "--out", parts) == -signal.SIGKILL
    assert_resumes(whole, parts, words, "control.csv", "breaks.csv")


def test_bonds_are_made_and_break_around_the_kills(bonded):  # so that the kills differ in what they cut
    columns = read_series(bonded[1] / "series.csv")
    first = columns["time (s)"][columns["bonds ()"] > 0].min()
    assert 60 * STEP < first < 400 * STEP
    assert columns["broken bonds ()"][-1] > 0
    last = open_run(bonded[1]).snapshot(-1)
    assert set(last.clouds) == {"grains", "frames", "bonds"}
    lines = np.asarray(last.clouds["bonds"].lines)
    assert len(lines) == columns["bonds ()"].max()
