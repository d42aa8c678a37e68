"""Validations of rock hold, and their twins fail."""

import math

import pytest

from porescale.dem.contact.linear import Linear
from porescale.dem.measures.network import stiffness
from porescale.dem.prepare.rock import load
from porescale.validation.dem import rock as lab
from porescale.validation.dem.rock import FAST, SEEDS
from tests.validation.tolerances import ROWS


def test_without_bonds_nothing_bears_tension():  # the twin that must fail
    made = lab.sample("discs", 0, 60)
    made.grains.bonds.whole[:] = 0
    curve = load(made, 0.006, 0.3, moments=50)
    assert curve.strength() < 0.01 * made.naive_strength


@pytest.mark.slow
def test_cells_are_no_weak_rock_as_discs_are():  # the twin that must fail
    tensile, compressive, _ = lab.strengths("cells", 0, 60, 0.05)
    assert compressive / tensile > 3.0


def test_without_tangential_springs_a_packing_is_no_solid():  # the twin that must fail
    row = ROWS["dem.rock_stiffness_of_its_springs"]
    free = Linear(lab.STIFFNESS, lab.law().damping)
    made = lab.sample("discs", 0, 60)
    firm = stiffness(made)
    made.grains.set_law(free)
    assert stiffness(made) < 0.1 * firm
    assert abs(stiffness(made) / firm - 1.0) > 10.0 * row.tolerance


@pytest.mark.slow
def test_square_cells_do_not_break():  # the twin that must fail: every plane of shear ends on a plate
    row = ROWS["dem.rock_of_slender_cells_breaks"]
    assert lab.left_when_pressed(1.0, SEEDS, FAST) > row.tolerance + 0.3


def test_triangles_whose_corners_count_once_have_too_few_contacts():  # the twin that must fail
    row = ROWS["dem.rock_of_triangles_that_count_each"]
    contacts, stiff = lab.triangles_over_discs("outline", count=60)
    assert math.log2(10.0 / contacts) > 2.0 * row.tolerance
    assert math.log2(10.0**0.5 / 2.0 / stiff) > 2.0 * row.tolerance
