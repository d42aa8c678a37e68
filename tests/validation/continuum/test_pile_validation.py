"""Beside the row on sheet piles twins that must fail."""

from dataclasses import dataclass, replace

import numpy as np
import pytest

from continuum_sph.builders.parts import sheet_pile
from continuum_sph.seepage import reservoir, sheet_flow
from continuum_sph.validation.seepage import bare_exit
from continuum_sph.validation.seepage.heave import (
    BOUNDS,
    GROUNDS,
    HALF_HEAD,
    NARROW,
    QUICK,
    RISES,
    SEEN,
    WAIT,
    WEAKEST,
    Heave,
    rising,
    slowly,
)
from continuum_sph.validation.seepage.sheet_pile import SHARES, SheetPile, flow
from tests.reference.continuum.sheet_pile import bounds, heads, thick, weakest_prism
from tests.validation.tolerances import ROWS

ROW = ROWS["continuum.heave_behind_pile"]
MIDDLE = 0.5 * (WEAKEST[QUICK.share] + NARROW[QUICK.share][0])


@pytest.mark.slow
def test_a_shorter_pile_heaves_under_less_head():  # the twin that must fail
    # Half as deep, and its head over the i_c s of the pile that it is taken for.
    short = replace(slowly(QUICK), share=0.5 * QUICK.share)
    assert MIDDLE - short.onset() * 0.5 > ROW.tolerance


@pytest.mark.slow
def test_heavier_grains_hold_more_head():  # the twin that must fail
    # Grains of 3200 kg/m³ under the i_c of quartz.
    heavy = replace(QUICK, grains=3200.0)
    assert heavy.stands((MIDDLE + ROW.tolerance) * QUICK.critical / heavy.critical)
    assert not QUICK.stands(MIDDLE + ROW.tolerance)


def test_bounds_are_those_of_the_exit_gradient_and_of_the_prism():
    # π/(4 K m) of the exit gradient, Harr 1962, to the digits given.

    for share, (_, high) in BOUNDS.items():
        assert 1.0 / (sheet_flow.exit_gradient(share) * share) == pytest.approx(high, abs=5e-3)


@pytest.mark.parametrize("share", SHARES)
def test_flow_around_a_sheet_is_that_of_finite_volumes(share):
    # Linear in the size of cells, 40 and 80 over T; what is left goes as their square root cubed.
    exact, found = SheetPile(share), []
    for cells in (40, 80):
        h = heads(cells, cells, 0, round(share * cells))
        side = h[:, cells:]
        found.append((2.0 * side[-1].sum(), 2.0 * side[-1, 0] * cells, side[cells - cells // 10, 0]))
    discharge, gradient, _ = 2.0 * np.array(found[1]) - np.array(found[0])
    assert discharge == pytest.approx(exact.discharge, rel=40**-1.5)
    assert gradient == pytest.approx(exact.exit_gradient, rel=2.0 * 40**-1.5)
    # A middle of a cell beside the sheet, half a cell under a tenth of T deep.
    assert found[1][2] == pytest.approx(float(exact.head(np.array(0.1 - 0.5 / 80))), abs=1.0 / 80)


@pytest.mark.parametrize("share", SHARES)
def test_ground_far_wider_than_deep_has_no_end(share):
    # What is cut off is e^(-π 3) of the flow, 1e-4.
    wide = SheetPile(share, reach=3.0)
    assert wide.discharge == pytest.approx(sheet_flow.discharge(share), rel=3e-4)
    assert wide.exit_gradient == pytest.approx(sheet_flow.exit_gradient(share), rel=3e-4)
    assert wide.head(np.array([0.0, share])) == pytest.approx([0.0, 0.5])


@pytest.mark.parametrize("share", [0.35, 0.5, 0.75])
def test_a_slab_is_longer_than_itself_by_what_is_derived(share):
    # A slab T/20 thick that ends so far above the tip, between two that end a row apart: their discharge is that of a
    # sheet to within 0.02 spacings, of which 0.01 are of cells, three to a row (with six they are 0.006 less); ground
    # without ends in place of ground that ends at 1 T is worth ln(0.64/0.49)/2π = 0.04 at s/T = 0.5.
    rows, finer = 20, 3
    longer = sheet_flow.slab(share, rows)
    found = [thick(share, rows, 1.0, finer, short)[0] for short in (finer * 2 // 3, finer, finer * 4 // 3)]
    sheet = SheetPile(share).discharge
    at = float(np.interp(sheet, found, [2.0 / 3.0, 1.0, 4.0 / 3.0]))
    assert at == pytest.approx(longer, abs=0.02 + 0.042)
    # and without it, the twin that must fail
    assert abs(at - 0.5) > 0.1


@pytest.mark.slow
def test_a_tip_between_rows_lies_between_rows():
    # Half a row lower; without the foot it would be either row's, a quarter of a row off at least, 2.3 % of q.
    given = SheetPile(0.525)
    discharge, gradient, _ = flow(given)
    row = ROWS["continuum.sheet_pile_50"]
    assert max(abs(discharge - 1.0), abs(gradient - 1.0)) < row.tolerance
    assert abs(discharge * given.discharge / SheetPile(0.5).discharge - 1.0) > row.tolerance


@pytest.mark.slow
def test_the_flow_around_a_pile_a_row_deeper_is_refused():  # the twin that must fail
    found, deeper = flow(SheetPile(0.5))[0] * SheetPile(0.5).discharge, SheetPile(0.55).discharge
    assert abs(found / deeper - 1.0) > ROWS["continuum.sheet_pile_50"].tolerance


def test_bounds_in_narrow_ground_are_those_of_finite_volumes():
    # Two digits after the point; what is left of cells of T/80 after extrapolation goes as their square root cubed.
    for share, known in NARROW.items():
        assert bounds(share, 1.0, 40) == pytest.approx(known, abs=5e-3 + 40**-1.5)


@pytest.mark.slow
@pytest.mark.parametrize("share", [0.25, 0.75])
def test_heavier_grains_stand_all_that_others_might(share):  # the twin that must fail
    # Grains of 3200 kg/m³ under the i_c of quartz still stand at the upper of the two bounds.
    heavy = replace(GROUNDS[share], grains=3200.0)
    assert heavy.stands(NARROW[share][1] * QUICK.critical / heavy.critical, seconds=1.0)


HEAVED = 2.9  # i_c s


@dataclass(frozen=True)
class Moved(Heave):
    """Ground whose surface stands up to HEAVED and beyond it rises by ``pace`` times RISES, after it has swollen by a
    tenth of s within WAIT."""

    pace: float = 1.1

    def course(self, every=0.01):
        rise, speed = 0.1, RISES * self.permeability * self.critical / self.buried
        for time in np.arange(self.settle, self.end, every) + every:
            rise += every * speed * (self.pace if self.head(time) > HEAVED else 0.5)
            yield time, self.head(time), rise * min(1.0, (time - self.settle) / WAIT), None


def test_ground_heaves_where_it_rises_faster_than_it_creeps():
    # Seen when t of a second are beyond HEAVED: 0.5 + (1.1 - 0.5) t = 1, t = 0.83 s, a third of one after its middle;
    # and a step of 0.02 s.
    given = slowly(Moved(**vars(QUICK)))
    assert given.onset() == pytest.approx(HEAVED + given.rate * (0.5 / 0.6 - 0.5) * SEEN, abs=0.02 * given.rate)
    assert given.stands(HEAVED - 0.01)
    assert not given.stands(HEAVED + 0.01)
    # and the twins that must fail: slower than that it never heaves; without WAIT it would at once
    slow = replace(given, pace=0.9)
    assert np.isnan(slow.onset())
    assert slow.stands(HEAVED + 0.01)
    assert RISES * given.permeability * given.critical / given.buried < 0.1 / WAIT


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


@pytest.mark.slow
def test_the_exit_gradient_of_a_pile_two_rows_deeper_is_refused():  # the twin that must fail
    row = ROWS["continuum.exit_gradient_in_a_run"]
    deeper = replace(HALF_HEAD, share=HALF_HEAD.share + 2.0 / HALF_HEAD.rows)
    exact = (SheetPile(given.share, given.rows, given.reach).exit_gradient for given in (deeper, HALF_HEAD))
    assert abs(rising.__wrapped__(deeper) * next(exact) / next(exact) - 1.0) > row.tolerance


@pytest.mark.slow
def test_weighed_from_the_ground_on_water_stands_too_high_for_its_exit_gradient(monkeypatch):  # the twin that must fail
    monkeypatch.setattr(reservoir, "ABOVE", 0.0)
    assert 1.0 - rising.__wrapped__(HALF_HEAD) > ROWS["continuum.exit_gradient_in_a_run"].tolerance


@pytest.mark.slow
def test_the_second_row_of_bare_ground_has_no_head_to_fit(monkeypatch):  # the twin that must fail
    monkeypatch.setattr(sheet_pile, "BARE", sheet_pile.BLURRED)
    found = [bare_exit.exit_over_exact.__wrapped__(20, share) for share in (0.5, 0.75)]
    assert 1.0 - min(found) > ROWS["continuum.exit_through_bare_ground"].tolerance


@pytest.mark.parametrize("first", [0.1, 0.25, 0.5, 0.9])
def test_a_zig_zag_falls_out_of_the_head_of_open_water(first):
    # exact: a wave of two rows is orthogonal to the weight over four, wherever the rows lie
    above = first + np.arange(-3.0, 9.0)
    zig_zag = np.cos(np.pi * np.arange(12))
    assert sheet_pile.open_head(above, 2.0 + 0.2 * zig_zag) == pytest.approx(2.0, abs=1e-14)
    assert sheet_pile.open_head(above[:3], zig_zag[:3]) is None
    inside = (above > 0.0) & (above < 3.0)  # the twin that must fail: a mean of three rows
    assert abs(0.2 * zig_zag[inside].mean()) > 0.05
