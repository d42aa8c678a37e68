"""How a wetting line sags, and what Boussinesq's equation says of its foot."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from continuum_sph.validation.seepage.wetting import BOUSSINESQ, Levee, sag

X = np.linspace(0.0, 2.0, 401)
# the foot lies half a spacing beyond the last wet place: 1/400 of the way, and so the mean height
STEP = 1.0 / 200


@pytest.mark.parametrize(
    ("shape", "expected"),
    [(lambda s: 1.0 - s, 0.0), (lambda s: (1.0 - s) ** 2, 1.0 / 6.0), (lambda s: np.sqrt(1.0 - s), -1.0 / 6.0)],
)
def test_sag_tells_straight_hanging_and_standing_lines_apart(shape, expected):
    heights = 0.3 * np.where(X < 1.0, shape(np.minimum(X, 1.0)), 0.0)
    way, hang = sag(X, heights, 0.3)
    assert way == pytest.approx(1.0, abs=STEP)
    assert hang == pytest.approx(expected, abs=STEP)


def test_a_line_that_has_hardly_begun_has_no_sag():
    assert sag(X, np.where(2.5 * X[1] > X, 0.1, 0.0)[1:], 0.3) == (0.0, 0.0)


def test_the_foot_in_dry_ground_goes_as_boussinesq_says():
    # (H H')' + ξ/2 H' = 0 from the foot, where H = ξ_f/2 (ξ_f - ξ), back to the face, where H is 1; four digits given
    def slope(back, y):
        return [y[1], (0.5 * (BOUSSINESQ - back) * y[1] - y[1] ** 2) / y[0]]

    start = 1e-5
    foot = [0.5 * BOUSSINESQ * start, 0.5 * BOUSSINESQ]
    found = solve_ivp(slope, (start, BOUSSINESQ), foot, rtol=1e-9, atol=1e-11, dense_output=True)
    assert found.y[0, -1] == pytest.approx(1.0, abs=5e-4)
    mean = np.trapezoid(found.sol(np.linspace(start, BOUSSINESQ, 1001))[0], dx=1e-3)
    assert 0.5 - mean == pytest.approx(-0.049, abs=5e-4)


def test_a_levee_is_as_wide_as_its_slopes_need():
    given = Levee()
    assert given.base == pytest.approx(0.2 + 4.0 * 0.34)
    x = np.array([0.0, given.basin + 0.2, given.basin + 0.5 * given.base, given.size[0]])
    np.testing.assert_allclose(given.top(x), [0.0, 0.1, 0.34, 0.0])
    assert (given.ground[:, 1] < given.top(given.ground[:, 0])).all()
