"""Beside the rows on what passes under a sheet pile twins that must fail."""

import numpy as np
import pytest

from continuum_sph.seepage import halving, pores
from continuum_sph.validation.seepage import pile_balance
from tests.validation.tolerances import tolerance


@pytest.mark.slow
def test_water_that_keeps_its_excess_of_volume_stays_in_the_ground(monkeypatch):
    monkeypatch.setattr(pores, "PACE", 0.0)
    assert pile_balance.shares.__wrapped__(10)[0] > tolerance("continuum.in_and_out_under_a_pile")


@pytest.mark.slow
def test_water_that_stays_as_coarse_as_in_the_open_passes_less_under_a_pile(monkeypatch):
    monkeypatch.setattr(halving, "HEAVY", np.inf)
    assert 1.0 - pile_balance.shares.__wrapped__(10)[1] > tolerance("continuum.discharge_under_a_pile_lasts")
