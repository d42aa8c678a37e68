"""A packing on a slope: it settles level, and is let go under all of gravity."""

import numpy as np

from porescale.builders.build import build
from tests.reference.scenes import dry


def test_a_packing_settles_under_what_of_gravity_points_down_and_is_let_go_under_all_of_it():
    endless = {"domain__left": "periodic", "domain__right": "periodic", "grains__packing__settle": True}
    endless |= {"grains__packing__left": 0.0, "grains__packing__width": 0.012}
    level, tilted = (build(dry(**endless, gravity=given)) for given in ([0.0, -9.0], [6.0, -9.0]))
    np.testing.assert_array_equal(tilted.motion()[0], level.motion()[0])
    along = []
    for it in (level, tilted):
        it.advance(round(0.01 / it.step_seconds))
        along.append(abs(it.masses @ it.motion()[1][:, 0] / it.masses.sum()))
    # contact friction of 0.5 takes 4.5 of 6 m/s² on the flat floor at most; the twin, level, stays
    assert along[1] > (6.0 - 4.5) * 0.01 > 10.0 * along[0]
