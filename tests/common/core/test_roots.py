"""Brent's method against SciPy's."""

import math

import pytest
from scipy.optimize import brentq

from porescale.common.core.roots import brent
from porescale.dem.contact.restitution import contact_phase, ratio_from_restitution

FUNCTIONS = [
    (lambda x: x * x - 2.0, 0.0, 2.0),
    (lambda x: math.cos(x) - x, 0.0, 1.5),
    (lambda x: math.exp(x) - 1e-3, -50.0, 3.0),
    (lambda x: x, 0.0, 1.0),
    (lambda x: x - 1.0, 0.0, 1.0),
]


@pytest.mark.parametrize("tolerance", [1e-15, 1e-6])
def test_the_root_is_that_of_scipy_in_every_bit(tolerance: float) -> None:
    for function, low, high in FUNCTIONS:
        wanted = brentq(function, low, high, xtol=tolerance, rtol=1e-14)
        assert brent(function, low, high, xtol=tolerance, rtol=1e-14) == wanted


def test_damping_ratios_are_those_that_scipy_finds() -> None:
    for k in range(1, 200):
        e = k / 200.0
        wanted = -math.log(e)

        def excess(h: float, wanted: float = wanted) -> float:
            return h * contact_phase(h, "force") - wanted

        highest = 1.0 + math.exp(0.5 * wanted)
        assert ratio_from_restitution(e, "force") == brentq(excess, 0.0, highest, xtol=1e-15, rtol=1e-14)


def test_a_looser_tolerance_finds_other_bits() -> None:  # the twin that must fail
    function, low, high = FUNCTIONS[1]
    assert brent(function, low, high, xtol=1e-4, rtol=1e-14) != brentq(function, low, high, xtol=1e-15, rtol=1e-14)


def test_signs_that_agree_are_refused() -> None:
    with pytest.raises(AssertionError):
        brent(lambda x: 1.0 + x * x, 0.0, 1.0, xtol=1e-9, rtol=1e-9)
