"""Discs touch rectangles as they touch walls, at faces and at corners, wherever those go."""

import numpy as np
import pytest

from porescale.common.core.errors import InputError
from porescale.dem.arrays import contact_arrays
from porescale.dem.contact.linear import Linear, LinearKernel
from porescale.dem.discs import make_discs
from porescale.dem.forces.rectangle import Rectangle, add_rectangle_forces
from porescale.dem.forces.walls import Box
from porescale.dem.grains import Grains

LAW = Linear(1e5, 0.0, 0.0, 0.0, 0.0)
RUBBING = Linear(1e5, 5.0, 2.5e4, 1.0, 0.5)
BOX = Box((0.0, 0.0), (1.0, 1.0))


def thrown(position, velocity, rectangles, law=LAW):
    """A disc of radius 0.05 and mass 1 thrown in a box with rectangles."""
    grains = Grains(make_discs([position], 0.05, 1 / (np.pi * 0.05**2), [velocity]), law, BOX)
    grains.set_rectangles(rectangles)
    return grains


def test_a_face_is_a_wall():
    # The same throw at the right side of the box and at a face where that side is: the same bits.
    face = thrown((0.9, 0.5), (1.0, 0.3), [Rectangle((1.0, -1.0), (2.0, 2.0))], RUBBING)
    wall = thrown((0.9, 0.5), (1.0, 0.3), [], RUBBING)
    face.walls[1, 0] = 10.0  # the box's own right side out of the way
    for grains in (face, wall):
        grains.step(1e-4, count=2000)
    assert wall.discs.velocity[0, 0] < -0.5
    # One subtraction of places and velocities is made in another order: a rounding in each of the steps that touch.
    np.testing.assert_allclose(face.discs.velocity, wall.discs.velocity, rtol=0, atol=2000 * 1e-14)
    np.testing.assert_allclose(face.discs.spin, wall.discs.spin, rtol=0, atol=2000 * 1e-12)


def test_a_corner_turns_a_disc_back_along_its_normal():
    # At 45 degrees onto a corner: back the way it came; the free bounce of a leap-frog errs by a step in its duration.
    grains = thrown((0.4, 0.4), (1.0, 1.0), [Rectangle((0.5, 0.5), (0.8, 0.8))])
    grains.step(1e-4, count=1000)
    np.testing.assert_allclose(grains.discs.velocity, [[-1.0, -1.0]], rtol=0, atol=0.03)
    assert grains.discs.velocity[0, 0] == grains.discs.velocity[0, 1]


def test_a_moving_face_gives_twice_its_speed():
    # Elastic, in the frame of the face: v -> 2 V - v; to a step in the contact's duration of pi sqrt(m/k) = 100 steps.
    grains = thrown((0.5, 0.5), (0.0, 0.0), [Rectangle((0.1, 0.2), (0.4, 0.8), (0.5, 0.0))])
    grains.step(1e-4, count=3000)
    assert grains.discs.velocity[0, 0] == pytest.approx(1.0, abs=0.01)
    assert grains.rectangles[0, 0] == pytest.approx(0.1 + 0.15, abs=3000 * 1e-16)


def test_a_rectangle_gets_what_the_disc_gets_less():
    discs = make_discs([(0.44, 0.5)], 0.05, 1.0, [(0.1, 0.2)])
    row, spring, on = RUBBING.row()[None, None], np.zeros((1, 1, 1)), np.zeros((1, 2))
    box = np.array([Rectangle((0.1, 0.2), (0.4, 0.8)).row()])
    for kernel in (add_rectangle_forces, add_rectangle_forces.py_func):
        found = contact_arrays(discs.position, discs.velocity, discs.spin, discs.radius, discs.mass)
        kernel(found, box, row, spring, on, 0, 0, 1, LinearKernel(row, 1.0, None), 1e-4)
        assert found.force[0, 0] > 0.0
        np.testing.assert_array_equal(on, -found.force)


@pytest.mark.parametrize("inside", [(0.11, 0.5), (0.39, 0.5), (0.25, 0.21), (0.25, 0.79)])
def test_a_centre_inside_is_pushed_out_through_the_nearest_face(inside):
    discs = make_discs([inside], 0.05, 1.0)
    row, spring, on = LAW.row()[None, None], np.zeros((1, 1, 1)), np.zeros((1, 2))
    box = np.array([Rectangle((0.1, 0.2), (0.4, 0.8)).row()])
    found = contact_arrays(discs.position, discs.velocity, discs.spin, discs.radius, discs.mass)
    add_rectangle_forces(found, box, row, spring, on, 0, 0, 1, LinearKernel(row, 1.0, None), 1e-4)
    out = np.sign(np.array(inside) - (0.25, 0.5)) * np.array([abs(inside[0] - 0.25) > 0.1, abs(inside[1] - 0.5) > 0.2])
    np.testing.assert_allclose(found.force[0], out * 1e5 * 0.06, rtol=1e-12)


def test_a_state_goes_on_bit_for_bit():
    def made():
        return thrown((0.5, 0.5), (-1.0, 0.2), [Rectangle((0.1, 0.2), (0.4, 0.8), (0.5, 0.0), 0.3)], RUBBING)

    one, two = made(), made()
    one.step(1e-4, count=700)
    two.restore(one.state())
    for grains in (one, two):
        grains.step(1e-4, count=300)
    np.testing.assert_array_equal(one.discs.velocity, two.discs.velocity)
    np.testing.assert_array_equal(one.rectangles, two.rectangles)


def test_rectangles_that_cannot_be_are_refused():
    with pytest.raises(InputError, match="upper"):
        Rectangle((0.1, 0.2), (0.1, 0.8))
    with pytest.raises(InputError, match="friction"):
        Rectangle((0.1, 0.2), (0.2, 0.8), friction=-1.0)
