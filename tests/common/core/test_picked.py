"""Which of many things are taken."""

from itertools import pairwise

import pytest

from porescale.common.core.picked import every_so_many, spread


def test_every_so_many_and_the_last():
    assert every_so_many(10, 4) == [0, 4, 8, 9]
    assert every_so_many(9, 4) == [0, 4, 8]
    assert every_so_many(0, 4) == []


@pytest.mark.parametrize("count", range(1, 30))
def test_what_is_spread_has_both_ends_and_steps_that_differ_by_one(count):
    found = spread(count, 6)
    assert len(found) == min(count, 6)
    assert (found[0], found[-1]) == (0, count - 1)
    steps = {b - a for a, b in pairwise(found)}
    assert not steps or max(steps) - min(steps) <= 1
