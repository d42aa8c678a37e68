"""Beside the row on what passes under a sheet pile a twin that must fail."""

import pytest

from continuum_sph.seepage import pores
from continuum_sph.validation.seepage import pile_balance
from tests.validation.tolerances import tolerance


@pytest.mark.slow
def test_water_that_keeps_its_excess_of_volume_stays_in_the_ground(monkeypatch):
    monkeypatch.setattr(pores, "PACE", 0.0)
    assert pile_balance.kept.__wrapped__(10) > 2.0 * tolerance("continuum.in_and_out_under_a_pile")
