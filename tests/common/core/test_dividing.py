"""The spacing that a refused one is to be replaced with divides all lengths, and is the nearest that does."""

import pytest

from porescale.common.core.dividing import FACTOR, MOST, dividing

SLACK = 1e-9


@pytest.mark.parametrize(
    ("lengths", "given", "exact"),
    [
        ([0.03, 0.02], 7e-4, 0.01 / 14),  # 0.03/43 and 0.02/29, nearer to it, divide one of them each
        ([1.0, 0.6, 0.4], 0.07, 0.2 / 3),
        ([0.012, 0.008, 0.0081], 2e-4, 1e-4),
        ([0.3], 0.07, 0.075),
        ([1.0, 2.0**0.5], 0.01, None),
    ],
)
def test_a_spacing_divides_all_lengths(lengths, given, exact):
    found = dividing(lengths, given, SLACK)
    assert found == (None if exact is None else pytest.approx(exact, rel=1e-12))
    if found:
        assert given / FACTOR <= found <= given * FACTOR
        for length in lengths:
            assert length / found == pytest.approx(round(length / found), rel=SLACK)
        assert any(abs(it / given - round(it / given)) > 0.01 for it in lengths)  # the twin: the one that was given


def test_nothing_is_looked_for_among_more_spacings_than_a_run_has():
    assert dividing([1.0, 0.6], 1.5 / MOST, SLACK) is not None
    assert dividing([1.0, 0.6], 0.5 / MOST, SLACK) is None
