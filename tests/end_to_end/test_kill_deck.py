"""A deck killed while its segment is thrown back by a disc resumes to the same bits in every file it leaves."""

import signal
import sys

import numpy as np
import pytest

from tests.reference import decks
from tests.reference.folders import ROOT
from tests.reference.same_run import differences
from tests.reference.waiting import done

CHILD = """
import os, signal, sys
from porescale.cli import demseg
from porescale.cli.main import main
from porescale.demseg.run import DeckRun

last, advance = int(sys.argv.pop(1)), DeckRun.advance
demseg.CHECKPOINT_SECONDS = 1e-3

def killed(self, steps):
    if last and self.step + steps > last:
        os.kill(os.getpid(), signal.SIGKILL)
    advance(self, steps)

DeckRun.advance = killed
sys.exit(main())
"""
"""`porescale` in a process that saves as often as it can, and is killed before more than ``last`` steps are done."""
STEPS, TOUCH = 1200, 830
"""The pushed segment meets the disc when ½ 8000 t² = 1, after 790 steps of 2e-5, for some 17 steps; and again later."""


def deck(last: int, *words: object) -> int:
    """Exit code of ``porescale demseg run`` with ``words``."""
    command = [sys.executable, "-c", CHILD, str(last), "demseg", "run", *map(str, words), "--quiet", "--threads", "1"]
    return done(command, cwd=ROOT).returncode


@pytest.fixture(scope="module")
def whole(tmp_path_factory):
    """The deck's folder, and that of its uninterrupted run."""
    place = tmp_path_factory.mktemp("deck")
    folder = decks.write(place / "deck", decks.PUSHED, decks.boundary(f"0 0 {STEPS} 400 10", *decks.PUSH))
    assert deck(0, folder, "--out", place / "whole") == 0
    return folder, place / "whole"


@pytest.mark.slow
@pytest.mark.parametrize("last", [400, 797, TOUCH])
def test_a_killed_deck_resumes_to_the_same_bits(whole, tmp_path, last):
    folder, done = whole
    parts = tmp_path / "parts"
    assert deck(last, folder, "--out", parts) == -signal.SIGKILL
    # What is there of a run that was killed is whole: the first rows, up to the last snapshot, each 400 steps.
    for name in ("energy.dat", "f-d_curve.dat"):
        early = (parts / name).read_bytes()
        assert (done / name).read_bytes().startswith(early)
        assert int(np.loadtxt(parts / name)[-1, 0]) == last // 400 * 400
    assert deck(0, folder, "--out", parts, "--resume") == 0
    for name in ("energy.dat", "f-d_curve.dat", *(f"new_in_{part}.dat" for part in ("gm", "bc", "cf", "cf0"))):
        assert (parts / name).read_bytes() == (done / name).read_bytes(), name
    assert differences(parts, done) == []


@pytest.mark.slow
def test_the_disc_is_met_between_the_kills(whole):  # so that the kills differ in what they cut
    rows = np.loadtxt(whole[1] / "f-d_curve.dat")
    met = rows[rows[:, 2] != 0.0, 0]
    assert 400 < met.min() < TOUCH
