"""Laws that hold for every clump and every strain: third law, shares, unions, images."""

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from porescale.dem.bodies.clumps import Clumps, shares
from porescale.dem.bodies.union import outline
from porescale.dem.discs import make_discs
from porescale.dem.motion.affine_strain import STATE, room_square
from porescale.validation.dem.bodies import clumped_cloud
from porescale.validation.dem.momentum import momentum_drift

EPS = np.finfo(float).eps
numbers = st.integers(0, 100_000)


def heap(seed, count):
    """Discs of one clump, none of them within another."""
    rng = np.random.default_rng(seed)
    at, size = rng.uniform(-1.0, 1.0, (count, 2)), rng.uniform(0.2, 1.0, count)
    away = np.hypot(*(at[:, None] - at[None]).transpose(2, 0, 1)) + size[:, None] <= size[None]
    np.fill_diagonal(away, False)
    return at[~away.any(axis=1)], size[~away.any(axis=1)]


@settings(max_examples=150)
@given(numbers, st.integers(1, 7))
def test_every_union_has_positive_shares_with_its_mass_centre_and_inertia(seed, count):
    at, size = heap(seed, count)
    union = outline(at, size)
    discs = make_discs(at, size, 1.0)
    table = Clumps(discs, [np.arange(len(at))], 1.0)
    away = at - union.centroid
    assert discs.mass.min() > 0.0
    assert discs.inertia.min() > 0.0
    assert abs(discs.mass.sum() - union.area) < 100 * EPS * union.area
    assert np.abs(discs.mass @ away).max() < 1e-12 * union.area
    second = discs.mass @ np.sum(away**2, axis=1) + discs.inertia.sum()
    assert abs(second - union.second_moment) < 1000 * EPS * union.area
    assert table.mass[0] == union.area


@given(numbers, st.integers(2, 6), st.floats(0.0, 6.28))
def test_a_union_is_the_same_wherever_it_lies_and_however_it_is_turned(seed, count, angle):
    at, size = heap(seed, count)
    turn = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
    here, there = outline(at, size), outline(at @ turn.T + [5.0, -3.0], size)
    # Arcs that barely show come and go with rounding: their share of the area is eps^(1/2) cubed at most.
    assert abs(there.area - here.area) < 1e-12 * here.area
    assert np.abs(there.centroid - (turn @ here.centroid + [5.0, -3.0])).max() < 1e-12 * 10
    assert abs(there.second_moment - here.second_moment) < 1e-11 * here.second_moment


@settings(max_examples=50)
@given(numbers, st.integers(1, 6))
def test_no_disc_adds_more_than_itself(seed, count):
    at, size = heap(seed, count)
    whole, less = outline(at, size).area, outline(at[:-1], size[:-1]).area if len(at) > 1 else 0.0
    assert less - 1e-12 <= whole <= less + np.pi * size[-1] ** 2 + 1e-12


def test_no_shares_lie_outside_of_the_hull():  # the twin that must fail
    assert shares(np.ones(3), np.array([[1.0, 0.0], [2.0, 1.0], [2.0, -1.0]]), 1.0) is None


@settings(max_examples=8)
@given(numbers, st.floats(0.0, 1.0))
def test_momentum_and_angular_momentum_of_colliding_clumps_are_kept_to_round_off(seed, friction):
    # As for discs: sums over 60 members round at 60 eps of their scale, a thousand steps add up to 30 times that.
    assert max(momentum_drift(clumped_cloud(seed, friction), 1000)) < 30 * 60 * EPS


@settings(max_examples=200)
@given(st.floats(0.7, 1.4), st.floats(0.7, 1.4), st.floats(-0.6, 0.6), numbers)
def test_no_unlisted_pair_comes_within_reach_while_there_is_room(across, up, slope, seed):
    state = np.zeros(STATE)
    width, height, reach, skin = 3.0, 2.0, 0.1, 0.12
    state[:3] = across * width, up * height, slope * height
    state[6:11] = width, height, 0.0, reach, skin
    room = room_square(state)
    if room < 0.0:
        return
    rng = np.random.default_rng(seed)
    angle = rng.uniform(0.0, 2 * np.pi, 100)
    apart = (2 * reach + skin) * np.array([np.cos(angle), np.sin(angle)])
    carried = np.array([[across, slope], [0.0, up]]) @ apart
    assert np.hypot(*carried).min() - 2 * np.sqrt(room) >= 2 * reach - 1e-12
