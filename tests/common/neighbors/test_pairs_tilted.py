"""Pairs of a cell whose upper image lies aside; pairs within a group are none."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from porescale.common.compiled.jit import set_threads
from porescale.common.neighbors import PairList, search
from porescale.common.neighbors import pair_list as pairs
from porescale.common.neighbors.cells import minimum_image, tilted_image, untilted
from tests.reference.dem.dem_bodies import tilted_neighbours
from tests.reference.dem.pairs import rows_of


def listed_in(x, reach, skin, width, height, tilt):
    listed = PairList(len(x), skin, (0.0, 0.0), (1.0, 1.0), (True, True))
    listed.set_cell(width, height, tilt)
    listed.build(x, reach)
    return listed


@settings(max_examples=60)
@given(
    st.integers(0, 10_000), st.integers(2, 25), st.sampled_from([1.0, 1.05, 1.7, 4.0]),
    st.sampled_from([1.0, 1.3, 3.0]), st.floats(-2.5, 2.5),
)  # fmt: skip
def test_lists_what_the_definition_lists(seed, count, wide, high, lean):
    rng = np.random.default_rng(seed)
    reach, skin = rng.uniform(0.02, 0.1, count), 0.03
    least = 2.0 * (2.0 * reach.max() + skin)
    width, height = wide * least * (1 + 1e-12), high * least * (1 + 1e-12)
    x = rng.uniform(-1.5, 1.5, (count, 2)) * (width, height)
    tilt = lean * width
    expected = tilted_neighbours(x, reach, skin, width, height, tilt, turns=4)
    assert rows_of(listed_in(x, reach, skin, width, height, tilt)) == expected


def test_a_tilt_of_a_whole_width_is_none():
    x, reach = np.random.default_rng(0).uniform(0.0, 3.0, (300, 2)), np.full(300, 0.1)
    straight = rows_of(listed_in(x, reach, 0.02, 3.0, 3.0, 0.0))
    assert rows_of(listed_in(x, reach, 0.02, 3.0, 3.0, 3.0)) == straight
    assert rows_of(listed_in(x, reach, 0.02, 3.0, 3.0, 1.5)) != straight  # the twin that must fail


@pytest.mark.parametrize("count", [200, 25_000])
def test_serial_and_parallel_searches_agree_in_a_tilted_cell(count):
    side = np.sqrt(count) * 0.1
    x = np.random.default_rng(1).uniform(0.0, side, (count, 2))
    reach = np.full(count, 0.06)
    listed = listed_in(x, reach, 0.01, side, side, 0.37 * side)
    full = PairList(count, 0.01, (0.0, 0.0), (1.0, 1.0), (True, True), full=True)
    full.set_cell(side, side, 0.37 * side)
    full.build(x, reach)
    assert listed.start[-1] * 2 == full.start[-1]
    # Those near the seam, by hand: the first hundred points against all.
    for i in range(100):
        dy = x[:, 1] - x[i, 1]
        n = np.rint(dy / side)
        dx = x[:, 0] - x[i, 0] - n * 0.37 * side
        dx -= side * np.rint(dx / side)
        near = dx**2 + (dy - n * side) ** 2 < 0.13**2
        near[i] = False
        assert full.partner[full.start[i] : full.start[i + 1]].tolist() == np.flatnonzero(near).tolist()


@pytest.mark.parametrize("compiled", [True, False])
def test_images_without_a_tilt_are_the_nearest_ones(compiled):
    image = tilted_image if compiled else tilted_image.py_func
    assert image(1.9, -2.7, 2.0, 3.0, 0.0) == (minimum_image(1.9, 2.0), minimum_image(-2.7, 3.0))
    dx, dy = image(0.3, 2.9, 2.0, 3.0, 0.5)
    assert (dx, dy) == pytest.approx((-0.2, -0.1), rel=1e-14)
    place = untilted if compiled else untilted.py_func
    assert place(0.3, 3.1, 0.0, 3.0, 0.5) == pytest.approx(-0.2, rel=1e-14)
    assert place(0.3, 3.1, 0.0, 3.0, 0.0) == 0.3


@pytest.mark.parametrize("compiled", [True, False])
def test_pairs_of_one_group_are_left_out(compiled):
    group = np.array([0, -1, 0, 1, 1], np.int32)
    start, partner = np.array([0, 3, 5, 6, 7, 7]), np.array([1, 2, 3, 2, 4, 3, 4], np.int32)
    run = search.leave_out if compiled else search.leave_out.py_func
    assert run(group, start, partner) == 5
    assert start.tolist() == [0, 2, 4, 5, 5, 5]
    assert partner[:5].tolist() == [1, 3, 2, 4, 3]


@pytest.mark.parametrize("serial_below", [0, 1000])
@pytest.mark.parametrize(("first", "periodic"), [(0, False), (40, True), (79, False), (80, False)])
def test_pairs_between_two_kinds_are_those_that_groups_leave(first, periodic, serial_below, monkeypatch):
    monkeypatch.setattr(pairs, "SERIAL_BELOW", serial_below)
    set_threads(2)
    rng = np.random.default_rng(2)
    x, reach = rng.uniform(0.0, 1.0, (80, 2)), rng.uniform(0.03, 0.06, 80)
    box = (0.0, 0.0), (1.0, 1.0), (periodic, periodic)
    listed, twin = PairList(80, 0.02, *box, full=True, between=first), PairList(80, 0.02, *box, full=True)
    twin.group = np.repeat(np.array([0, 1], np.int32), [first, 80 - first])
    for _ in range(2):
        listed.build(x, reach)
        twin.build(x, reach)
        assert rows_of(listed) == rows_of(twin)
        x += rng.uniform(-0.05, 0.05, x.shape)
    twin.group = None
    twin.build(x, reach)
    assert rows_of(listed) != rows_of(twin)  # the twin that must fail


def test_rows_are_mirrored_in_plain_python_too():
    start, partner = np.array([0, 2, 3, -1, -1, -1]), np.array([2, 4, 4, -1, -1, -1], np.int32)
    assert search.mirror.py_func(2, start, partner) == 6
    assert start.tolist() == [0, 2, 3, 4, 4, 6]
    assert partner.tolist() == [2, 4, 4, 0, 0, 1]


def test_points_of_a_group_below_minus_one_are_in_no_pair():
    listed = PairList(3, 0.1, (0.0, 0.0), (1.0, 1.0))
    listed.group = np.array([-1, -2, -1], np.int32)
    listed.build(np.array([[0.5, 0.5], [0.52, 0.5], [0.5, 0.52]]), np.full(3, 0.1))
    assert rows_of(listed) == [[2], [], []]


@pytest.mark.parametrize("full", [False, True])
def test_a_list_with_groups_is_the_list_less_those_pairs_and_keeps_its_data(full):
    rng = np.random.default_rng(2)
    x, reach = rng.uniform(0.0, 1.0, (80, 2)), np.full(80, 0.06)
    made = [PairList(80, 0.02, (0.0, 0.0), (1.0, 1.0), full=full, carried=1) for _ in range(2)]
    group = np.where(rng.random(80) < 0.5, rng.integers(0, 8, 80), -1).astype(np.int32)
    made[1].group = group
    for listed in made:
        listed.build(x, reach)
    kept = [[j for j in row if group[i] < 0 or group[i] != group[j]] for i, row in enumerate(rows_of(made[0]))]
    assert rows_of(made[1]) == kept
    assert kept != rows_of(made[0])
    made[1].carried[:, 0] = np.arange(len(made[1].partner))
    made[1].build(x, reach)
    assert made[1].carried[:, 0].tolist() == list(range(len(made[1].partner)))
