"""Pair list against the definition over boxes, sizes, periods and points that hypothesis thinks of."""

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from porescale.common.neighbors import PairList
from tests.reference.dem.pairs import neighbours, rows_of

lengths = st.floats(0.01, 1.0)
coordinates = st.floats(-3.0, 3.0)


@st.composite
def situations(draw):
    """Points, reaches, skin and a box that is at least two cutoffs wide."""
    n = draw(st.integers(1, 25))
    # Coordinates on a coarse grid in half the cases: many exact ties, points on cell and box edges.
    step = draw(st.sampled_from([None, 0.25]))
    x = np.array(draw(st.lists(st.tuples(coordinates, coordinates), min_size=n, max_size=n)))
    if step:
        x = np.round(x / step) * step
    reach = np.array(draw(st.lists(lengths, min_size=n, max_size=n)))
    skin = draw(st.sampled_from([0.0, 0.125, 0.5]))
    least = 2.0 * (2.0 * reach.max() + skin)
    sides = [least * draw(st.sampled_from([1.0, 1.01, 1.6, 4.0])) for _ in range(2)]
    lower = (draw(coordinates), draw(coordinates))
    upper = (lower[0] + sides[0] * (1 + 1e-12), lower[1] + sides[1] * (1 + 1e-12))
    return x, reach, skin, lower, upper, draw(st.tuples(st.booleans(), st.booleans())), draw(st.booleans())


@settings(max_examples=300)
@given(situations())
def test_lists_what_the_definition_lists(situation):
    x, reach, skin, lower, upper, periodic, full = situation
    lower, upper = tuple(map(float, lower)), tuple(map(float, upper))
    side = np.subtract(upper, lower).min()
    if side < 2.0 * (2.0 * reach.max() + skin):  # rounding of lower + side far from the origin
        return
    listed = PairList(len(x), skin, lower, upper, periodic, full)
    listed.build(x, reach)
    assert rows_of(listed) == neighbours(x, reach, skin, lower, upper, periodic, full)


@given(situations(), st.integers(0, 2**32 - 1))
def test_a_half_list_is_the_upper_half_of_a_full_one_at_any_order_of_points(situation, seed):
    x, reach, skin, lower, upper, periodic, _ = situation
    order = np.random.default_rng(seed).permutation(len(x))
    listed = PairList(len(x), skin, lower, upper, periodic, full=False)
    shuffled = PairList(len(x), skin, lower, upper, periodic, full=True)
    if np.subtract(upper, lower).min() < 2.0 * (2.0 * reach.max() + skin):
        return
    listed.build(x, reach)
    shuffled.build(x[order], reach[order])
    half = {(i, j) for i, row in enumerate(rows_of(listed)) for j in row}
    both = {(int(order[i]), int(order[j])) for i, row in enumerate(rows_of(shuffled)) for j in row}
    assert both == half | {(j, i) for i, j in half}
