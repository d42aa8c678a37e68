"""Beside each row on soil, water and air a twin that must fail."""

from dataclasses import replace

import pytest

from continuum_sph.validation.seepage import air
from continuum_sph.validation.seepage.air import CLOSED, OPEN
from tests.validation.tolerances import tolerance


@pytest.mark.slow
def test_water_that_drives_air_out_does_not_sink_as_if_air_were_trapped():
    exact, found = air.late(OPEN, CLOSED)
    assert abs(found / exact - 1.0) > 3.0 * tolerance("continuum.infiltration_into_trapped_air")


@pytest.mark.slow
def test_water_on_trapped_air_does_not_sink_as_if_air_could_leave():
    exact, found = air.late(CLOSED, OPEN)
    assert abs(found / exact - 1.0) > 3.0 * tolerance("continuum.infiltration_that_drives_air_out")


@pytest.mark.slow
def test_trapped_air_does_not_keep_its_temperature():
    # γ = 1, of air that gives its heat to the grains, is another gas
    assert abs(air.squeezed(CLOSED, 1.0) - 1.0) > 3.0 * tolerance("continuum.trapped_air_is_compressed")


@pytest.mark.slow
def test_air_that_is_lost_is_noticed():
    given = replace(CLOSED, rows=10)
    both = given.build()
    before = both.water.layer.mass.sum()
    both.water.layer.mass[both.water.layer.fluid - 1] *= 1.0 - 1e-6
    assert before - both.water.layer.mass.sum() > tolerance("continuum.mass_of_three_phases")
