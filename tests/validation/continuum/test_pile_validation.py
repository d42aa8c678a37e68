"""Beside the row on sheet piles twins that must fail."""

from dataclasses import replace

import numpy as np
import pytest

from continuum_sph.validation.seepage.heave import (
    APART,
    BOUNDS,
    HALF_HEAD,
    HEADS,
    HELD,
    NARROW,
    QUICK,
    RISING,
    rests,
    rising,
)
from continuum_sph.validation.seepage.sheet_pile import AROUND, Around, SheetPile, one_side
from tests.reference.continuum.sheet_pile import around, bounds, seen, weakest_prism
from tests.validation.tolerances import ROWS, tolerance

ROW = ROWS["continuum.heave_behind_pile"]
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


@pytest.mark.slow
def test_what_is_known_around_piles_is_what_finite_volumes_give():
    # Four digits, the last of which is rounded in the table and once more here.
    for given, known in AROUND.items():
        assert around(given.share, given.rows, given.reach) == pytest.approx(known, abs=2e-4)


def test_finite_volumes_go_over_to_the_map_of_a_sheet():
    # Sides 2.5 T away miss e^(-2.5 π) of the flow, 0.04 %, a pile of T/12 ending a row above its sheet is it but for a
    # tenth of a row, and cells of T/24 lose half of theirs of the tip: (1/120 + 1/96) dq/ds / q, dq/ds = 0.94.
    pile = SheetPile(0.5)
    discharge, _ = seen(0.5, 12, 2.5, 2)
    assert discharge == pytest.approx(pile.discharge, rel=(1 / 120 + 1 / 96) * 0.94 / pile.discharge)


@pytest.mark.slow
def test_the_flow_around_another_pile_is_refused():  # the twin that must fail
    row = ROWS["continuum.pile_both_sides_50"]
    given = Around(0.5, 12)
    discharge, _ = replace(given, share=0.5 + 2.0 / given.rows).run(100 * given.rows)
    assert abs(discharge / AROUND[Around(0.5, 24)][0] - 1.0) > row.tolerance


def test_bounds_in_narrow_ground_are_those_of_finite_volumes():
    # Two digits after the point; what is left of cells of T/80 after extrapolation goes as their square root cubed.
    for share, known in NARROW.items():
        assert bounds(share, 1.0, 40) == pytest.approx(known, abs=5e-3 + 40**-1.5)


def test_ground_that_slows_down_near_where_it_was_rests():
    most = APART[QUICK.share]
    assert rests(np.array([0.01, 0.02, 0.029]), most)
    # the twins that must fail: steadily, if by less than elasticity explains; faster and faster; slower, but far away
    assert QUICK.elastic > 1 / 256
    assert not rests(np.array([1.0, 2.0, 3.0]) / 256, most)
    assert not rests(np.array([0.01, 0.02, 0.031]), most)
    assert not rests(np.array([0.5, 0.9, 1.0]) * 1.01 * most, most)


@pytest.mark.slow
def test_heavier_grains_stand_a_head_that_others_do_not():  # the twin that must fail
    heavy = replace(QUICK, grains=3200.0)
    assert heavy.stands(HEADS[1] * QUICK.critical / heavy.critical, APART[QUICK.share])
    assert not QUICK.stands(HEADS[1], APART[QUICK.share])


@pytest.mark.slow
@pytest.mark.parametrize("share", [0.25, 0.75])
def test_heavier_grains_stand_all_that_others_might(share):  # the twin that must fail
    # Grains of 3200 kg/m³ under the i_c of quartz still stand at the upper of the two bounds.
    heavy = replace(HELD[share], grains=3200.0)
    assert heavy.stands(NARROW[share][1] * QUICK.critical / heavy.critical, APART[share], seconds=1.0)


WEAKEST = {0.25: 2.54, 0.5: 2.56, 0.75: 2.65}
"""h/(i_c s) of the least of all prisms with friction in ground that ends 1 T beside the pile; about s/10 wide."""


def test_the_weakest_prism_is_narrow_and_that_of_terzaghi_no_lower_bound_of_it():
    # Linear in the size of cells, of which there are 80 and 160 over T; what is left goes as their square.
    for share, known in WEAKEST.items():
        (coarse, wide), (fine, _) = (weakest_prism(share, 1.0, cells) for cells in (80, 160))
        assert 2.0 * fine - coarse == pytest.approx(known, abs=5e-3 + (coarse - fine) ** 2)
        assert wide < 0.2
        assert known < NARROW[share][0]


def test_without_friction_the_narrowest_prism_is_the_weakest():  # the twin that must fail
    assert weakest_prism(0.5, 1.0, 40, friction=0.0)[1] < weakest_prism(0.5, 1.0, 40)[1]
    assert weakest_prism(0.5, 1.0, 40, friction=0.0)[0] < WEAKEST[0.5] - 0.1


def test_exit_gradients_known_of_runs_are_those_of_finite_volumes():
    for given, known in RISING.items():
        assert around(given.share, given.rows, given.reach)[1] == pytest.approx(known, abs=2e-4)


@pytest.mark.slow
def test_the_exit_gradient_of_a_pile_two_rows_deeper_is_refused():  # the twin that must fail
    row = ROWS["continuum.exit_gradient_in_a_run"]
    deeper = replace(HALF_HEAD, share=HALF_HEAD.share + 2.0 / HALF_HEAD.rows)
    read = rising.__wrapped__(deeper, RISING[HALF_HEAD])
    assert abs(read - 1.0) > row.tolerance


@pytest.mark.slow
def test_water_does_not_pass_a_pile_of_half_the_depth_as_easily():  # the twin that must fail
    found = one_side(0.25, 16)[0] * SheetPile(0.25).discharge
    assert abs(found / SheetPile(0.5).discharge - 1.0) > tolerance("continuum.sheet_pile_50")
