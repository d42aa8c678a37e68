"""The pair list says what the definition says, keeps data by pair, and grows without waste."""

import numpy as np
import pytest

from porescale.common.compiled.jit import set_threads
from porescale.common.core.errors import InputError
from porescale.common.neighbors import PairList, search
from porescale.common.neighbors import pair_list as pairs
from porescale.common.neighbors import skin as skins
from porescale.common.neighbors.cells import Grid
from tests.reference.dem.pairs import neighbours, rows_of

LOWER, UPPER = (0.0, -1.0), (10.0, 7.0)
OLDER = ("start", "partner", "carried", "anchor", "anchor_reach", "builds")
"""What states of lists have said from the first."""


def cloud(n, seed=0, ratio=1.0, outside=0.0):
    """Random points (n, 2) in the box, ``outside`` m beyond it, and reaches up to ``ratio`` apart, 1 m at most."""
    rng = np.random.default_rng(seed)
    x = rng.uniform(np.array(LOWER) - outside, np.array(UPPER) + outside, (n, 2))
    return x, 0.1 * min(1.0, 10.0 / ratio) * ratio ** rng.uniform(0.0, 1.0, n)


def listing(n, skin, *options, seed=0, **named):
    """Points (n, 2), their reaches, and their list, just made."""
    x, reach = cloud(n, seed)
    listed = PairList(n, skin, LOWER, UPPER, *options, **named)
    assert listed.update(x, reach)
    return x, reach, listed


def assert_none_missing(listed, x, reach, periodic=(False, False)):
    """Every pair within reach is in a full list."""
    for row, must in zip(rows_of(listed), neighbours(x, reach, 0.0, LOWER, UPPER, periodic, True), strict=True):
        assert set(must) <= set(row)


@pytest.mark.parametrize("full", [False, True])
@pytest.mark.parametrize("periodic", [(False, False), (True, False), (True, True)])
@pytest.mark.parametrize(("ratio", "levels"), [(1.0, 1), (10.0, 2), (100.0, 4), (1e9, pairs.LEVELS)])
def test_lists_what_the_definition_lists(full, periodic, ratio, levels):
    x, reach = cloud(300, ratio=ratio, outside=3.0)
    listed = PairList(300, 0.05, LOWER, UPPER, periodic, full)
    assert listed.update(x, reach)
    assert rows_of(listed) == neighbours(x, reach, 0.05, LOWER, UPPER, periodic, full)
    assert len(listed.partner) == listed.start[-1] > 20
    assert len(listed._sort(x, reach)) == levels


def test_a_box_of_just_two_cutoffs_is_right_and_a_thinner_one_refused():
    x = np.random.default_rng(3).uniform(0.0, 1.0, (60, 2))
    reach = np.full(60, 0.1)
    listed = PairList(60, 0.05, (0.0, 0.0), (0.5, 0.5), (True, True), full=True)
    listed.build(x, reach)
    assert rows_of(listed) == neighbours(x, reach, 0.05, (0.0, 0.0), (0.5, 0.5), (True, True), True)
    with pytest.raises(InputError, match="periodic height"):
        PairList(60, 0.051, (0.0, 0.0), (9.0, 0.5), (True, True)).build(x, reach)


def test_points_far_outside_still_meet():
    x = np.array([[1e6, 1e6], [1e6 + 0.15, 1e6], [-1e6, 0.0], [5.0, 5.0]])
    listed = PairList(4, 0.0, LOWER, UPPER)
    listed.build(x, np.full(4, 0.1))
    assert rows_of(listed) == [[1], [], [], []]


def test_a_box_much_larger_than_its_points_need_costs_no_memory():
    listed = PairList(3, 0.0, (-1e9, -1e9), (1e9, 1e9))
    listed.build(np.array([[0.0, 0.0], [0.1, 0.0], [5.0, 0.0]]), np.full(3, 0.1))
    assert rows_of(listed) == [[1], [], []]
    assert listed._cell_start.shape[0] < 1000


@pytest.mark.parametrize("n", [0, 1, 2])
def test_few_points(n):
    x, reach = np.zeros((n, 2)), np.full(n, 0.1)
    listed = PairList(n, 0.0, LOWER, UPPER)
    listed.update(x, reach)
    assert rows_of(listed) == neighbours(x, reach, 0.0, LOWER, UPPER)


def test_rebuilds_when_two_points_may_have_come_nearer_by_the_skin_and_not_before():
    x, reach, listed = listing(50, 0.2)
    x[7], x[8] = [5.0, 3.0], [5.0, 3.3]
    listed.build(x, reach)
    x[7] += [0.0, 0.09]
    x[8] -= [0.0, 0.105]
    assert not listed.update(x, reach)
    x[7] += [0.0, 0.006]
    assert listed.update(x, reach)
    assert not listed.update(x, reach)


def test_growing_reach_uses_up_the_skin_too():
    x, reach, listed = listing(50, 0.2)
    x[3], x[4] = [5.2, 3.3], [5.2, 3.35]  # in one block: the growth of both counts
    listed.build(x, reach)
    reach[3] += 0.06
    x[3] += [0.0, 0.07]
    assert not listed.update(x, reach)
    x[3] += [0.0, 0.02]
    assert listed.update(x, reach)
    reach[3] += 0.11
    assert listed.update(x, reach)


def test_points_that_move_together_keep_their_list():
    x, reach, listed = listing(400, 0.2, (True, False), full=True, seed=7)
    x += [3.0, 0.2]
    assert not listed.update(x, reach)
    x += 1e-3 * (x - x.mean(axis=0))  # and apart, a little: by 5 mm in 5 m, across blocks of 0.8 m by less than 2 mm
    assert not listed.update(x, reach)


def test_two_crowds_that_meet_from_afar_do_not(monkeypatch):
    # Each moves as one, so no two neighbours come nearer: the twin that must fail is a list that asks no more.
    def meet():
        x = np.concatenate((np.tile([1.0, 0.0], (3, 1)), np.tile([8.0, 0.0], (3, 1))))
        x[:, 1] = np.tile([0.0, 0.3, 0.6], 2)
        listed = PairList(6, 0.2, LOWER, UPPER)
        listed.update(x, np.full(6, 0.1))
        x[3:, 0] -= 6.9
        built = listed.update(x, np.full(6, 0.1))
        return built, rows_of(listed) == neighbours(x, np.full(6, 0.1), 0.2, LOWER, UPPER)

    assert meet() == (True, True)
    ask = skins.remaining_skin
    monkeypatch.setattr(skins, "remaining_skin", lambda *a: ask(*a[:9], np.inf, *a[10:]))
    assert meet() == (False, False)


def test_the_skin_shrinks_where_a_list_lasts_and_grows_back_and_no_pair_is_missing():
    x, reach = cloud(150, seed=5)
    rng = np.random.default_rng(6)
    listed, twin = (PairList(150, 0.1, LOWER, UPPER, full=True) for _ in range(2))
    listed.adaptive = twin.adaptive = True
    least, skins = 0.1, []
    for k in range(200):
        listed.update(x, reach)
        if k == 80:
            twin.restore(listed.state())
        if k > 80:  # what comes next is known from the state
            twin.update(x, reach)
            assert twin.skin == listed.skin
            assert np.array_equal(twin.partner, listed.partner)
        assert_none_missing(listed, x, reach)
        least = min(least, listed.skin)
        skins.append(listed.skin)
        x += rng.normal(0.0, 1e-4 if k < 150 else 0.02, x.shape)
    assert least == pytest.approx(0.02)
    assert skins[-1] > 0.09


@pytest.mark.parametrize("periodic", [(False, False), (True, True)])
def test_no_pair_is_missing_in_a_stream_that_shears(periodic):
    x, reach = cloud(300, seed=8)
    rng = np.random.default_rng(9)
    listed = PairList(300, 0.15, LOWER, UPPER, periodic, full=True)
    quiet = strayed = 0
    for _ in range(40):
        quiet += not listed.update(x, reach)
        strayed += bool(skins.needs_rebuild(x, listed.list_position, reach, reach, 0.075, *listed.period))
        assert_none_missing(listed, x, reach, periodic)
        x[:, 0] += 0.04 * np.cos(0.25 * np.pi * x[:, 1]) + rng.normal(0.0, 0.002, len(x))
    assert 10 < quiet < 39
    assert strayed > 10  # where the ways of single points say nothing any more


def test_no_pair_within_reach_is_ever_missing_between_builds():
    x, reach = cloud(150, seed=5)
    rng = np.random.default_rng(6)
    listed = PairList(150, 0.1, LOWER, UPPER, (True, False), full=True)
    quiet = 0
    for _ in range(60):
        quiet += not listed.update(x, reach)
        assert_none_missing(listed, x, reach, (True, False))
        x += rng.normal(0.0, 0.006, x.shape)
    assert 10 < quiet < 59  # the list did rest, and did rebuild


def test_crossing_a_periodic_side_is_no_displacement():
    x, reach, listed = listing(50, 0.2, (True, True))
    x[4] += [10.0, -8.0]
    assert not listed.update(x, reach)


def test_carried_data_survives_by_pair():
    x, reach, listed = listing(120, 0.3, carried=2, seed=1)
    known: dict[tuple[int, int], tuple[float, float]] = {}
    rng = np.random.default_rng(2)
    kept = lost = 0
    for _ in range(8):
        owner = np.repeat(np.arange(120), np.diff(listed.start))
        pairs_now = list(zip(owner.tolist(), listed.partner.tolist(), strict=True))
        for k, pair in enumerate(pairs_now):
            if pair in known:
                assert tuple(listed.carried[k]) == known[pair]
                kept += 1
            else:
                assert tuple(listed.carried[k]) == (0.0, 0.0)
        lost += len(set(known) - set(pairs_now))
        listed.carried[:] = rng.normal(size=listed.carried.shape)
        known = {pair: tuple(listed.carried[k]) for k, pair in enumerate(pairs_now)}
        x += rng.normal(0.0, 0.2, x.shape)
        assert listed.update(x, reach)
    assert kept > 100
    assert lost > 100


def test_buffers_are_reused():
    x, reach, listed = listing(200, 0.1, carried=1)
    listed.build(x, reach)
    held = {id(a) for a in (*listed._partners, *listed._carrieds, *listed._starts, listed._cell_start)}
    for _ in range(4):
        listed.build(x, reach)
    assert held == {id(a) for a in (*listed._partners, *listed._carrieds, *listed._starts, listed._cell_start)}


@pytest.mark.parametrize("value", [np.nan, np.inf, -np.inf])
def test_a_position_that_is_no_number_is_named(value):
    x, reach, listed = listing(30, 0.1)
    x[17, 1] = value
    with pytest.raises(ValueError, match="point 17"):
        listed.update(x, reach)
    x[17, 1] = 0.0
    reach[5] = np.nan
    with pytest.raises(ValueError, match="point 5"):
        listed.update(x, reach)


def test_restored_list_goes_on_exactly():
    x, reach, first = listing(100, 0.2, full=True, carried=1, seed=4)
    rng = np.random.default_rng(0)
    first.carried[:] = rng.normal(size=first.carried.shape)
    x += 0.01  # between builds: the list is not the one a build here would give
    second = PairList(100, 0.2, LOWER, UPPER, full=True, carried=1)
    second.restore(first.state())
    for _ in range(6):
        assert first.update(x, reach) == second.update(x, reach)
        for name, value in first.state().items():
            assert np.array_equal(value, second.state()[name]), name
        x += rng.normal(0.0, 0.03, x.shape)
    assert first.builds > 1


def test_a_state_that_does_not_say_its_skin_is_listed_anew_and_keeps_its_data():
    x, reach, first = listing(400, 0.02, carried=1, seed=4)
    first.carried[:, 0] = np.arange(1.0, 1.0 + len(first.partner))
    older = {name: value for name, value in first.state().items() if name in OLDER}
    moved = x + np.array([0.05, 0.0]) * (np.arange(400) % 2)[:, None]  # less than half of 0.2
    for state, anew in ((older, True), (first.state() | {"skin": np.array(0.2)}, False)):  # the twin that must fail
        second = PairList(400, 0.2, LOWER, UPPER, carried=1)
        second.restore(state)
        assert second.update(moved, reach) == anew
        must = neighbours(moved, reach, 0.0, LOWER, UPPER, (False, False), False)
        lacking = [set(row) - set(now) for row, now in zip(must, rows_of(second), strict=True)]
        assert any(lacking) != anew
    again = PairList(400, 0.2, LOWER, UPPER, carried=1)
    again.restore(older)
    again.update(x, reach)
    assert set(first.carried[:, 0]) <= set(again.carried[:, 0])


@pytest.mark.parametrize("full", [False, True])
def test_one_thread_and_many_list_the_same(full, monkeypatch):
    x, reach = cloud(400, ratio=5.0)
    monkeypatch.setattr(pairs, "SERIAL_BELOW", 0)
    lists = []
    for count in (1, 2):
        set_threads(count)
        listed = PairList(400, 0.1, LOWER, UPPER, (True, False), full)
        listed.build(x, reach)
        lists.append(rows_of(listed))
    assert lists[0] == lists[1] == neighbours(x, reach, 0.1, LOWER, UPPER, (True, False), full)


def test_kernels_as_plain_python():
    # Compiled kernels do not check bounds; plain Python does.
    x, reach = cloud(25, outside=2.0)
    reach *= 4.0
    listed = PairList(25, 0.1, LOWER, UPPER, (True, False), full=True)
    listed.build(x, reach)
    where = (listed._sorted, listed._order, listed._cell_start, listed._sort(x, reach), search.Criterion(0.1, True))
    start, partner = np.zeros(26, np.int64), np.empty(len(listed.partner), np.int32)
    total, longest = search.fill_serial.py_func(start, partner, np.empty(100, np.int32), x, reach, *where)
    assert total == listed.start[-1]
    assert longest <= 100
    assert np.array_equal(start, listed.start)
    assert np.array_equal(partner, listed.partner)
    carried = np.empty((total, 1))
    search.carry.py_func(start, partner, np.ones((total, 1)), start, partner, carried)
    assert np.all(carried == 1.0)
    assert not skins.needs_rebuild.py_func(x, listed.list_position, reach, reach, 0.05, 10.0, 0.0)
    block, bounds = np.empty(25, np.int32), np.empty((5, skins.BOUNDS))
    skins.sort_into_blocks.py_func(x, Grid(*LOWER, 0.2, 0.25, 2, 2, 10.0, 0.0), block)
    for far, built in ((0.0, False), (0.2, True)):
        moved = x + far * (np.arange(25)[:, None] == 3)
        how = (listed.list_position, reach, reach, block, bounds, 2, 2, 0.1, 1.0, 10.0, 0.0)
        left = skins.remaining_skin(moved, *how)
        assert skins.remaining_skin.py_func(moved, *how) == left
        assert (left < 0.0) == built
    assert search.first_unusable.py_func(x, reach) == -1


def test_a_box_without_area_and_a_skin_below_zero_are_refused():
    with pytest.raises(InputError, match="skin"):
        PairList(3, -0.1, LOWER, UPPER)
    with pytest.raises(InputError, match="box"):
        PairList(3, 0.1, UPPER, LOWER)
