"""Polygons within each other are seen, however far they are through, and those that only touch are not."""

import numpy as np
import pytest

from porescale.coupling.coverage.interpenetration import depth

SQUARE = np.array([(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)])
TURNED = (SQUARE - 0.5) @ np.array([(1.0, 1.0), (-1.0, 1.0)]) / np.sqrt(2.0)


def test_the_depth_is_the_way_out():
    assert depth(SQUARE, SQUARE + np.array((0.75, 0.0))) == pytest.approx(0.25, rel=1e-15)
    assert depth(SQUARE, SQUARE + np.array((0.75, 0.9))) == pytest.approx(0.1, rel=1e-14)  # of 1.9 - 1, rounded at 2
    assert depth(SQUARE, SQUARE) == pytest.approx(1.0)
    assert depth(SQUARE, 0.2 * SQUARE + 0.4) == pytest.approx(0.6)  # wholly within: no corner meets a side
    assert depth(SQUARE, np.array([(0.3, 0.5)])) == pytest.approx(0.3)


def test_what_lies_apart_has_none():
    assert depth(SQUARE, SQUARE + np.array((1.01, 0.0))) < 0.0
    # A corner beside a corner: shadows on the first one's sides overlap, on the other's they do not.
    assert depth(SQUARE, TURNED + np.array((1.4, 1.4))) < 0.0
    assert depth(SQUARE, np.array([(1.1, 0.5)])) < 0.0
