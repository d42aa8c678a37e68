"""Grains in fluid converge: the drag on fixed arrays, and the leak between touching discs."""

from __future__ import annotations

import numpy as np
import pytest

from porescale.coupling import experiments as lab
from porescale.coupling.verify import ARRAY_DRAG


@pytest.mark.parametrize("tau", [0.6, 0.8])
def test_the_drag_converges_at_second_order(tau):
    # spec section 1 point 7: the deficit in radius is C h²/d.  1.7: the place in the cell moves the coarse error
    # by up to a fifth, log2(1.2) = 0.26 of the order.
    errors = [abs(lab.array_drag(cells, relaxation_time=tau) / ARRAY_DRAG - 1) for cells in (20, 40)]
    assert np.log2(errors[0] / errors[1]) > 1.7


@pytest.mark.parametrize("centre", [(0.3, 0.1), (0.5, 0.5), (0.0, 0.0)])
def test_the_leak_of_touching_discs_falls_at_second_order(centre):
    # spec section 5; the square array closes the plane, all that passes is error
    leaks = [4 / lab.array_drag(cells, np.pi / 4, 0.55, centre) for cells in (15, 30)]
    assert np.log2(leaks[0] / leaks[1]) > 2.0


def test_discs_with_a_gap_leak_for_good():
    # The twin: half a percent less than touching is a way through at any resolution (Gebart 1992).
    leaks = [4 / lab.array_drag(cells, 0.97 * np.pi / 4, 0.55) for cells in (15, 30)]
    assert np.log2(leaks[0] / leaks[1]) < 2.0
