"""A sheet pile: who sees whom through it, and what it keeps out."""

import numpy as np
import pytest

from continuum_sph.builders.parts.sheet_pile import NAME, beside, sheet_pile, steepness
from continuum_sph.builders.reports.seepage_report import seepage_report
from continuum_sph.builders.simulation import Simulation
from continuum_sph.scene.pile import SheetPileSection
from continuum_sph.seepage.sheet_flow import longer, thickness_at_exit
from continuum_sph.seepage.sheet_pile import (
    FOOT_GAIN,
    FREE,
    LEFT,
    RIGHT,
    UNDER,
    CutPairList,
    cut_pairs,
    ease_foot,
    keep_out,
    side_of,
)
from continuum_sph.validation.tanks import level_ground, tank_scene
from continuum_sph.water.smoothing import CUBIC, kernel_value
from porescale.common.core.errors import InputError
from porescale.common.neighbors import PairList, square_lattice

SPACING = 0.1


def pile(tip):
    """The pile for a sheet in the middle of the tank."""
    return sheet_pile(SheetPileSection(x=0.75, tip=tip), SPACING)


PILE = pile(0.4)


def listed(x, partner_of):
    """Partners of particle ``partner_of`` in the list of free particles at ``x`` and of the pile's."""
    places, _, side = PILE.particles(3, 1.0)
    at = np.concatenate((x, places))
    reach = np.full(len(at), 1.3 * SPACING)
    pairs = CutPairList(
        PairList(len(at), 0.0, (0.0, 0.0), (1.5, 1.3), full=True), PILE, len(x), side, np.zeros_like(at)
    )
    pairs.update(at, reach)
    return at, pairs.partner[pairs.start[partner_of] : pairs.start[partner_of + 1]]


def test_it_stands_in_the_column_of_its_sheet_and_ends_a_row_above_its_tip():
    assert (PILE.x, PILE.bottom) == (pytest.approx(0.75), pytest.approx(0.5))
    lattice = square_lattice((0.0, 0.0), (1.5, 1.0), SPACING)
    assert PILE.holds(lattice).sum() == 5  # one column, from 0.5 to 1.0


def test_each_side_has_images_as_deep_as_a_kernel_and_their_normals_point_at_it():
    places, facing, side = PILE.particles(3, 1.0)
    for own, normal in ((LEFT, (-1.0, 0.0)), (RIGHT, (1.0, 0.0)), (UNDER, (0.0, -1.0))):
        behind = (facing[side == own, :2] - places[side == own]) @ np.array(normal)
        assert np.array_equal(facing[side == own, 2:], np.tile(normal, (len(behind), 1)))
        assert np.allclose(sorted(set(np.round(behind / SPACING, 6))), [0.5, 1.5, 2.5])


def test_a_particle_sees_every_place_beside_the_pile_once():
    # The cubic spline with h of 1.3 spacings sums to 1 within 0.0011 on a full square lattice: nothing is seen twice or
    # not at all, next to the pile and about its tip.
    lattice = square_lattice((0.0, 0.0), (1.5, 1.0), SPACING)
    x = lattice[~PILE.holds(lattice)]
    for place in ((0.65, 0.75), (0.85, 0.75), (0.65, 0.45), (0.75, 0.45), (0.65, 0.55)):
        i = int(np.argmin(np.hypot(*(x - place).T)))
        at, seen = listed(x, i)
        r = np.hypot(*(at[np.append(seen, i)] - at[i]).T)
        h = 1.3 * SPACING
        whole = SPACING**2 * sum(kernel_value.py_func(CUBIC, distance / h, h) for distance in r)
        assert whole == pytest.approx(1.0, abs=0.0011)


def test_without_the_pile_in_the_list_both_sides_are_seen_at_once():  # the twin that must fail
    lattice = square_lattice((0.0, 0.0), (1.5, 1.0), SPACING)
    x = lattice[~PILE.holds(lattice)]
    i = int(np.argmin(np.hypot(*(x - (0.65, 0.75)).T)))
    pairs = PairList(len(x), 0.0, (0.0, 0.0), (1.5, 1.3), full=True)
    pairs.update(x, np.full(len(x), 1.3 * SPACING))
    across = x[pairs.partner[pairs.start[i] : pairs.start[i + 1]], 0] > PILE.x
    assert across.any()
    _, seen = listed(x, i)
    assert not (x[seen[seen < len(x)], 0] > PILE.x).any()


def test_the_foot_makes_up_for_what_the_pile_is_longer_than_its_sheet():
    wanted = longer(1.0 / 3.0, 6.0)
    assert PILE.foot(0.6).strength == pytest.approx((wanted - 1.0) / FOOT_GAIN)
    # half a row lower the same column is half a row shorter than its sheet
    assert pile(0.4 + 0.04).foot(0.6).strength == pytest.approx((longer(0.16 / 0.6, 6.0) - 0.6) / FOOT_GAIN)
    assert pile(0.4).foot(0.3) is None  # no ground there
    assert pile(0.0).foot(0.6) is None  # no way round it


def test_the_ground_about_the_foot_resists_less_and_no_other():
    x = np.array([[0.75, 0.5], [0.85, 0.5], [0.75, 0.2], [1.2, 0.5]])
    plain, resisting = np.full(4, 2.0), np.zeros(4)
    ease_foot.py_func(x, plain, resisting, 0.75, 0.5, 0.25, 0.5)
    assert resisting[0] == pytest.approx(2.0 * np.exp(-0.5))
    assert resisting[0] < resisting[1] < 2.0
    assert resisting[2] == resisting[3] == 2.0


def test_pairs_pass_below_the_tip_only():
    x = np.array([[0.65, 0.45], [0.85, 0.45], [0.65, 0.55], [0.85, 0.55]])
    start, partner = np.array([0, 3, 6, 9, 12]), np.array([1, 2, 3, 0, 2, 3, 0, 1, 3, 0, 1, 2], np.int32)
    left = cut_pairs.py_func(x, np.full(4, FREE), start, partner, PILE.x, PILE.bottom)
    assert left == 10
    assert partner[start[2] : start[3]].tolist() == [0, 1]
    assert partner[start[3] : start[4]].tolist() == [0, 1]


def test_what_enters_it_is_put_back_where_it_came_from():
    half = 0.5 * SPACING
    last = np.array([[0.69, 0.8], [0.81, 0.8], [0.75, 0.49], [0.6, 0.8]])
    x = np.array([[0.72, 0.8], [0.79, 0.8], [0.75, 0.51], [0.61, 0.8]])
    v = np.array([[1.0, 2.0], [-1.0, 2.0], [1.0, 2.0], [1.0, 2.0]])
    assert keep_out.py_func(x, v, last, PILE.x, PILE.bottom, half) == 3
    assert np.allclose(x, [[0.7, 0.8], [0.8, 0.8], [0.75, 0.5], [0.61, 0.8]])
    assert v.tolist() == [[0.0, 2.0], [0.0, 2.0], [1.0, 0.0], [1.0, 2.0]]
    assert np.array_equal(last, x)


def test_what_is_put_elsewhere_has_not_crossed_it():
    x, last = np.array([[0.2, 0.8]]), np.array([[1.2, 0.8]])
    assert keep_out.py_func(x, np.ones((1, 2)), last, PILE.x, PILE.bottom, 0.5 * SPACING) == 0
    assert x.tolist() == last.tolist() == [[0.2, 0.8]]


def test_below_the_tip_sides_are_one():
    assert [side_of.py_func(*at, PILE.x, PILE.bottom) for at in ((0.6, 0.6), (0.9, 0.6), (0.9, 0.4))] == [
        LEFT,
        RIGHT,
        UNDER,
    ]


def test_a_list_goes_on_from_its_state():
    x = np.array([[0.65, 0.8], [0.85, 0.8]])
    v, reach = np.zeros((2, 2)), np.full(2, 0.13)
    first, second = (CutPairList(PairList(2, 0.01, (0.0, 0.0), (1.5, 1.0), full=True), PILE, 2, v=v) for _ in range(2))
    first.update(x, reach)
    second.restore(first.state())
    x[0, 0] = 0.72
    second.update(x, reach)
    assert x[0, 0] == pytest.approx(0.7)


def scene(**more):
    """A scene with a pile."""
    given = {
        "water": {"column": [{"width": 1.5, "height": 0.8}]},
        "soil": {"body": [level_ground(1.5, 0.6)]},
        "pile": {"x": 0.75, "tip": 0.4},
    }
    return tank_scene(1.5, 1.0, SPACING, **given | more)


def test_a_scene_has_room_for_its_pile():
    assert sheet_pile(scene().pile, SPACING) == PILE
    for wrong in ({"x": 0.2, "tip": 0.4}, {"x": 0.75, "tip": 0.9}):
        with pytest.raises(InputError, match="pile"):
            scene(pile=wrong)


@pytest.mark.slow
def test_a_run_beside_a_pile_goes_on_bit_for_bit():
    rising = [{"left": 0, "right": 0.7, "bottom": 0.6, "rise": [[0.0, 0.8], [0.02, 0.95]]}]
    settings = scene(tank={"width": 1.5, "height": 1.0, "lid": False}, reservoir=rising)
    first, second = Simulation(settings), Simulation(settings)
    first.advance(40)
    second.restore(first.state())
    for model in (first, second):
        model.advance(40)
    for one, other in (
        (first.flow.water.layer, second.flow.water.layer),
        (first.flow.ground.soil, second.flow.ground.soil),
    ):
        assert np.array_equal(one.x, other.x)
        assert np.array_equal(one.v, other.v)
    assert np.isnan(first.series()[NAME])  # two rows beside it


def test_check_says_why_a_pile_has_no_exit_gradient_and_where_too_little_ground_lies_below_it():
    def warnings(tip):
        return " ".join(seepage_report(scene(pile={"x": 0.75, "tip": tip})).warnings)

    assert "exit gradient () will be nan" in warnings(0.4)
    assert "numerics.spacing = 0.05 mends it" in warnings(0.4)
    assert "exit gradient" not in warnings(0.2)
    assert "below the pile" not in warnings(0.1)
    assert "below the pile" in warnings(0.06)
    assert "pile.tip = 0 does not close the ground" in warnings(0.0)
    beyond = scene(pile={"x": 0.75, "tip": 0.4}, soil={"body": [{"outline": [[0, 0], [0.5, 0], [0, 0.3]]}]})
    said = " ".join(seepage_report(beyond).warnings)
    assert "does not reach into the ground" in said
    assert "inf" not in said


def test_a_pile_stands_in_soil():
    with pytest.raises(InputError, match="pile"):
        scene(soil=None)


def field(level=0.8, slope=0.7, left=0.0):
    """Places and heads of water about a sheet down to 0.1 in ground up to 0.6, under open water: on its right the flow
    of ground without a base whose exit gradient is ``slope``, on its left that of ``left``."""
    water = square_lattice((0.0, 0.0), (1.5, 1.0), SPACING)
    away = np.abs(water[:, 0] - 0.75) - 0.5 * SPACING
    z = np.maximum(0.0, 0.6 - water[:, 1]) + 1j * away
    steep = np.where(water[:, 0] > 0.75, slope, left)
    return water, level + steep * 0.5 * np.arcsin(z / 0.5).real, square_lattice((0.0, 0.0), (1.5, 0.6), SPACING)


THICK = thickness_at_exit(0.5 / 0.6, 6.0)
"""What the thickness of this pile adds to its exit gradient."""


def test_the_exit_gradient_is_that_of_the_flow_around_a_sheet():
    deep = pile(0.1)  # 5 rows beside it, 2 of them fitted
    water, head, soil = field()
    assert beside(deep, water, head, soil) * THICK == pytest.approx(0.7, rel=1e-12)
    lifted = soil + np.array([0.0, SPACING])
    assert beside(deep, water, head, lifted) != pytest.approx(beside(deep, water, head, soil), rel=0.05)


def test_it_is_that_of_the_side_where_water_rises():
    water, head, soil = field(slope=-0.2, left=0.4)
    assert beside(pile(0.1), water, head, soil) * THICK == pytest.approx(0.4, rel=1e-12)


def test_a_sheet_to_the_base_has_an_exit_gradient():
    # beside both the sheet and its slab it vanishes there: 0 over 0, whose limit is 1 as cos² of the depth falls
    assert thickness_at_exit(1.0, 6.0) == 1.0
    assert thickness_at_exit(1.0 - 1e-6, 6.0) == pytest.approx(1.0, abs=1e-5)
    water, head, soil = field()
    assert np.isfinite(beside(pile(0.0), water, head, soil))


def test_fewer_than_four_rows_beside_a_pile_give_no_exit_gradient():
    water, head, soil = field()
    assert np.isfinite(beside(pile(0.2), water, head, soil))
    assert np.isnan(beside(pile(0.3), water, head, soil))
    assert np.isnan(steepness(np.zeros(3, np.complex128), np.zeros(3), 0.5))


def test_dry_ground_gives_the_head_at_its_surface_and_ground_that_is_gone_gives_none():
    deep = pile(0.1)
    water, head, soil = field(level=0.6)
    under = water[:, 1] < 0.6
    assert beside(deep, water[under], head[under], soil) * THICK == pytest.approx(0.7, rel=1e-12)
    assert np.isnan(beside(deep, water, head, soil[:0]))
