"""Ground under water keeps its level and the pressure in its pores, once the stress of its start has found its rest."""

from dataclasses import replace

import pytest

from continuum_sph.benchmarks.endurance import ENDURANCES, PORES, STANDS
from porescale.common.evidence.endurance import endure

GROUND = ENDURANCES["ground under water"]
STEPS = 20_000  # a fifth of which it does: 0.7 s


@pytest.mark.slow
def test_ground_under_water_keeps_level_and_pressure():
    lines = {line.quantity: line for line in endure(GROUND, STEPS)}
    assert lines[STANDS].holds
    assert lines[PORES].holds


@pytest.mark.slow
def test_before_it_has_consolidated_its_pressure_moves():  # the twin that must fail
    lines = {line.quantity: line for line in endure(replace(GROUND, before=0), STEPS)}
    assert lines[PORES].off > 2.0 * lines[PORES].allowed
