"""Discs that the mirrors beside a window cut let through what they do whole."""

import numpy as np
import pytest

from porescale.analysis import permeability
from porescale.analysis.permeability import STEADY, Measured, measure
from porescale.coupling.psm import SaturatedCells

D, PITCH = 10, 14  # cells: an even pitch has discs lie alike in their cells, wherever a row of them is cut


def array(first: float, periodic: bool) -> Measured:
    """A square array, the first row of discs ``first`` cells above the lower flank of a window of 2 by 2 pitches."""
    at = [(PITCH * (i + 0.5), first + PITCH * k) for i in range(2) for k in range(2 if periodic else 3)]
    return measure(
        np.array(at), np.full(len(at), 0.5 * D), (0.0, 0.0), (2.0 * PITCH, 2.0 * PITCH), 1.0, direction="x",
        periodic=(True, periodic), solid_laws={"solid_operator": "exact-wall"},
    )  # fmt: skip


NOTHING = property(lambda _: np.zeros(0, int), lambda *_: None)


@pytest.fixture
def uncut(monkeypatch):
    """Discs that are cut are corrected as if they were whole."""
    monkeypatch.setattr(SaturatedCells, "cut", NOTHING, raising=False)


def test_an_array_cut_through_its_centres_lets_through_what_the_periodic_one_does():
    # The mirror image goes on as the period does, so all that differs is how far each is from steady.
    whole, halved = array(0.5 * PITCH, periodic=True), array(0.0, periodic=False)
    assert halved.solid_fraction == pytest.approx(whole.solid_fraction, rel=1e-12)
    assert halved.permeability == pytest.approx(whole.permeability, rel=2 * STEADY)


def test_corrected_as_whole_discs_it_does_not(uncut):  # the twin that must fail
    whole, halved = array(0.5 * PITCH, periodic=True), array(0.0, periodic=False)
    assert halved.permeability != pytest.approx(whole.permeability, rel=2e-3)


DEPTH = 0.1 * D


def test_a_sliver_of_a_disc_does_not_run_away(monkeypatch):
    monkeypatch.setattr(permeability, "MOST", 6000)  # four times what it takes
    assert array(DEPTH - 0.5 * D, periodic=False).steady


def test_corrected_as_a_whole_disc_a_sliver_runs_away(monkeypatch, uncut):  # the twin that must fail
    monkeypatch.setattr(permeability, "MOST", 6000)
    assert not array(DEPTH - 0.5 * D, periodic=False).steady
