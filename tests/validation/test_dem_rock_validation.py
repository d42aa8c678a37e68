"""Validations of rock hold, and their twins fail."""

from __future__ import annotations

import pytest

from porescale.dem import experiments_rock as lab
from porescale.dem.rock import load
from porescale.dem.verify_rock import VALIDATIONS

ROWS = {row.name: row for row in VALIDATIONS}


@pytest.mark.parametrize("name", [pytest.param(row.name, marks=[pytest.mark.slow] * row.slow) for row in VALIDATIONS])
def test_row_holds(name):
    row = ROWS[name]
    assert row.measure().error <= row.tolerance


def test_without_bonds_nothing_bears_tension():  # the twin that must fail
    made = lab.sample("discs", 0, 60)
    made.grains.bonds.whole[:] = 0
    curve = load(made, 0.006, 0.3, moments=50)
    assert curve.strength() < 0.01 * made.naive_strength


@pytest.mark.slow
def test_cells_are_no_weak_rock_as_discs_are():  # the twin that must fail
    tensile, compressive, _ = lab.strengths("cells", 0, 60, 0.05)
    assert compressive / tensile > 3.0
