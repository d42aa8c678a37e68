"""How far an order may fall short follows from the number of places and the span of the levels."""

import numpy as np
import pytest

from porescale.common.evidence.convergence import order_of
from porescale.validation.coupling.ladders import ALONE, MOST, scatter

LEVELS = 10.0, 20.0, 40.0, 80.0


def test_the_scatter_of_an_order_is_that_of_fits_to_errors_that_scatter():
    random = np.random.default_rng(1)
    noise = random.normal(0.0, ALONE / np.sqrt(64), (2000, len(LEVELS)))
    orders = [order_of(LEVELS, np.array(LEVELS) ** -2.0 * np.exp(row)) for row in noise]
    # A standard deviation of 2000 is known to 1/sqrt(4000) = 1.6 %, three times that; two digits of 0.08 are 6 %.
    assert scatter(LEVELS, 64) == pytest.approx(2 * np.std(orders), rel=0.11)
    assert scatter(LEVELS, 16) != pytest.approx(2 * np.std(orders), rel=0.11)  # the check that must fail


def test_fewer_places_and_levels_closer_together_scatter_more_up_to_the_most():
    assert scatter(LEVELS, 64) < scatter(LEVELS[:3], 64) < scatter(LEVELS[:3], 16) <= MOST
    assert scatter(LEVELS[:3], 1) == MOST
