"""The finite differences that columns are held to, beside exact solutions."""

import numpy as np
import pytest
from scipy.integrate import quad

from continuum_sph.validation.unsaturated.richards import Column, Gardner, VanGenuchtenMualem, relaxed

SOIL = VanGenuchtenMualem(alpha=5.0, n=3.0, residual=0.1)


@pytest.mark.parametrize("flux", [0.0, 0.1, -0.3])
def test_steady_flow_in_gardners_soil_is_exact_to_the_second_order(flux):
    errors = []
    for cells in (20, 40):
        column = Column(Gardner(2.0), 0.5, cells, 1e-3, 0.4, bottom=0.0, flux=flux * 1e-3)
        head = relaxed(column, -column.y, 3e4, 1e3)
        errors.append(np.abs(head - column.soil.steady(column.y, flux)).max())
    # cells of H/40: the second order, (a H/40)² of a head of H, a part of it; at rest the steady line is exact
    assert errors[1] < 0.5 * (2.0 * 0.5 / 40) ** 2
    assert flux == 0.0 or errors[0] / errors[1] == pytest.approx(4.0, rel=0.2)


def test_what_drains_is_what_van_genuchtens_profile_cannot_hold():
    column = Column(SOIL, 0.6, 60, 1e-2, 0.4, bottom=0.0)
    start = np.zeros(60)
    head = relaxed(column, start, 5e4, 500.0)
    np.testing.assert_allclose(head, -column.y, atol=2e-3)  # at rest: the last of it drains for ever
    held = 0.01 * SOIL.saturation(head).sum()
    exact, _ = quad(lambda y: float(SOIL.saturation(np.array([-y]))[0]), 0.0, 0.6)
    assert held == pytest.approx(exact, rel=2e-3)


def test_a_closed_column_keeps_its_water():
    column = Column(SOIL, 0.6, 40, 1e-3, 0.4)
    start = np.where(column.y > 0.4, -0.05, -0.4)
    before = SOIL.saturation(start).sum()
    head = relaxed(column, start, 60.0, 0.5)
    assert np.abs(head - start).max() > 0.1  # it has flowed
    # the mixed form keeps water to what the last iteration changes, 1e-9 m of heads in 200 steps, over 1/alpha
    assert SOIL.saturation(head).sum() == pytest.approx(before, abs=200 * 40 * 1e-9 * 5.0)


def test_horizontal_uptake_without_weight_goes_as_the_root_of_time():
    # Philip 1957: far from its end a dry column takes up S √t; weight is left out by a short time, n S/k of it
    column = Column(SOIL, 0.3, 600, 1e-3, 0.4, bottom=0.0)
    head, taken = np.full(600, -0.3), []
    start = SOIL.saturation(head).sum()
    for seconds in (1.0, 3.0):  # at 1 s and 4 s
        head = relaxed(column, head, seconds, 0.02)
        taken.append(SOIL.saturation(head).sum() - start)
    # weight takes k t of S √t off: at 4 s k t = 4 mm of 15, half of which shows by t/2 of the term; 15 %
    assert taken[1] / taken[0] == pytest.approx(2.0, rel=0.15)
