"""The reference of a column of water that is let go: its sums, what it keeps, and the rows that validations read."""

import numpy as np
import pytest

from continuum_sph.validation.water import dam_break
from tests.reference.continuum.dam_break import front, normal_speed, splines, start


@pytest.mark.parametrize("near", [0.02, 0.01])
def test_a_flow_that_is_known_has_its_speed_across_the_surface(near):
    x = start(2.0, near)
    phi = x[:, 0] ** 2 - x[:, 1] ** 2  # harmonic, and even about wall and floor
    arc, of_x, of_y, _ = splines(x, phi)
    outwards = np.column_stack((-of_y(arc, 1), of_x(arc, 1)))
    exact = 2.0 * (x[:, 0] * outwards[:, 0] - x[:, 1] * outwards[:, 1])
    away = np.hypot(*(x - [1.0, 2.0]).T) > 0.3  # the corner, rounded by 0.1, is a few elements
    # straight elements: second order, of the 4 near apart far from the tip, times the largest speed
    assert np.abs(normal_speed(x, phi) - exact)[away].max() < (4.0 * near) ** 2 * 4.0


def test_a_released_column_keeps_its_water_and_falls_as_one_at_first():
    rows = front(2.0, 0.3, 0.02)
    # smoothing takes f''''/16 near⁴ of a tip as curved as near: a share near² of 2 a time, 1 in 10 steps
    assert np.ptp(rows[:, 1]) < len(rows) / 10.0 * 0.02**2
    assert rows[0, 2] == 1.0
    assert (np.diff(rows[:, 2]) > 0.0).all()
    # nothing is faster than what falls the whole height: √(2 g h) t, g = 1/2, h = 2
    assert (rows[1:, 2] - 1.0 < 2.0**0.5 * rows[1:, 0]).all()


@pytest.mark.slow
def test_the_rows_that_validations_read_are_the_references():
    kept = dam_break.released_front()
    rows = front(2.0, 2.9, 0.02, (0.0, *dam_break.DEPTHS))
    for column, depth in enumerate((0.0, *dam_break.DEPTHS), 2):
        found = np.interp(kept[depth][:, 0], rows[:, 0], rows[:, column])
        # points four times as far apart: the tip is told to one of them
        assert np.abs(found - kept[depth][:, 1]).max() < 0.02
