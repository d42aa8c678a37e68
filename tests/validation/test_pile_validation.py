"""Beside the row on sheet piles twins that must fail."""

from __future__ import annotations

from dataclasses import replace

import pytest

from continuum_sph.scene.trials_seepage_steady import SheetPile
from continuum_sph.scene.validations import VALIDATIONS
from continuum_sph.scene.verify_pile import BOUNDS, QUICK

ROW = VALIDATIONS["continuum.heave_behind_pile"]
MIDDLE = 0.5 * sum(BOUNDS[QUICK.share])


@pytest.mark.slow
def test_a_shorter_pile_heaves_under_less_head():
    # Half as deep, and its head over the i_c s of the pile that it is taken for.
    short = replace(QUICK, share=0.5 * QUICK.share, first=2.0, last=6.0)
    assert MIDDLE - short.onset() * 0.5 > ROW.tolerance


@pytest.mark.slow
def test_heavier_grains_hold_more_head():
    # Grains of 3200 kg/m³ under the i_c of quartz.
    heavy = replace(QUICK, grains=3200.0)
    assert not heavy.onset() * heavy.critical / QUICK.critical - MIDDLE <= ROW.tolerance


def test_bounds_are_those_of_the_exit_gradient_and_of_the_prism():
    # π/(4 K m) of the exit gradient, Harr 1962, to the digits given.

    for share, (_, high) in BOUNDS.items():
        assert 1.0 / (SheetPile(share).exit_gradient * share) == pytest.approx(high, abs=5e-3)
