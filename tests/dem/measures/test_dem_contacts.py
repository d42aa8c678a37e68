"""The list of contacts says what the next step uses: every force, torque and spring of it."""

import math

import numpy as np
import pytest

from porescale.dem.contact.linear import Linear
from porescale.dem.discs import make_discs
from porescale.dem.forces.rectangle import Rectangle
from porescale.dem.forces.walls import Box, Plate
from porescale.dem.grains import Grains
from porescale.dem.measures.contacts import contacts

LAW = Linear(1e6, 20.0, 2.5e5, 5.0, 0.4)
DT = 2e-6


def dense_discs(seed: int = 3, periodic: bool = False) -> Grains:
    """Discs thrown together in a box with a plate and a rectangle, after some steps: all kinds of contacts."""
    rng = np.random.default_rng(seed)
    size = 0.1
    side = "periodic" if periodic else "solid"
    box = Box((0.0, 0.0), (size, size), left=side, right=side)
    at = np.array([(x, y) for x in np.arange(0.005, 0.1, 0.01) for y in np.arange(0.005, 0.1, 0.01)])
    at = at[np.abs(at - 0.05).max(axis=1) > 0.007]
    discs = make_discs(at, rng.uniform(0.004, 0.0056, len(at)), 2500.0, rng.normal(0.0, 1.0, at.shape),
                       rng.normal(0.0, 200.0, len(at)))  # fmt: skip
    grains = Grains(discs, LAW, box, wall_law=LAW.with_friction(0.2), plates=[Plate(0.031, 0.0, 0.045, 0.3)])
    grains.set_rectangles([Rectangle((0.0392, 0.0452), (0.0608, 0.0548), (0.2, 0.0))])
    grains.step(DT, count=40)
    return grains


@pytest.mark.parametrize("periodic", [False, True])
def test_forces_of_all_contacts_sum_to_what_the_step_uses(periodic):
    grains = dense_discs(periodic=periodic)
    found = contacts(grains)
    count = grains.discs.count
    before = grains.state()
    assert {name for name in found.names if (found.surface == found.names.index(name)).any()} >= {
        "bottom", "top", "plate", "rectangle 0",
    }  # fmt: skip
    assert found.sliding.any()
    assert not found.sliding.all()
    grains.step(DT)
    force, torque = found.resultants(count)
    # At most seven terms of the largest force in another order.
    worst = float(np.abs(found.force).max())
    np.testing.assert_allclose(force, grains.discs.force, rtol=0, atol=8 * np.finfo(float).eps * worst)
    np.testing.assert_allclose(torque, grains.discs.torque, rtol=0, atol=8 * np.finfo(float).eps * worst * 0.006)
    for w, name in enumerate(grains.wall_names):
        np.testing.assert_allclose(
            found.of(name).force.sum(axis=0), grains.wall_force[w], rtol=0, atol=1e-15 * count * worst
        )
    # The twin that must fail: the same contacts with springs left behind.
    grains.restore(before)
    grains.pairs.carried[:] = 0.0
    assert np.abs(contacts(grains).resultants(count)[0] - force).max() > 1e-3 * worst


def test_a_list_leaves_the_system_as_it_is():
    grains, other = dense_discs(), dense_discs()
    contacts(grains)
    grains.step(DT, count=50)
    other.step(DT, count=50)
    np.testing.assert_array_equal(grains.discs.position, other.discs.position)
    np.testing.assert_array_equal(grains.pairs.carried, other.pairs.carried)


def test_geometry_of_contacts():
    grains = dense_discs()
    d, found = grains.discs, contacts(grains)
    np.testing.assert_allclose(np.hypot(*found.normal.T), 1.0, rtol=1e-15 * 4)
    pair = found.chosen(found.pairs)
    assert (found.overlap > 0.0).all()
    # Both bodies feel the force on the chord of the overlap: as far from either rim, to first order.
    for k, centre in ((pair.first, d.position[pair.first]), (pair.second, d.position[pair.first] + pair.branch)):
        depth = d.radius[k] - np.hypot(*(pair.point - centre).T)
        assert (depth > 0.0).all()
        assert (depth < pair.overlap).all()
    wall = found.of("bottom")
    assert wall.count
    np.testing.assert_array_equal(wall.normal, np.tile([0.0, -1.0], (wall.count, 1)))
    np.testing.assert_allclose(wall.point[:, 1], 0.0, atol=1e-17 * 100)


def test_two_discs_pressed_together_by_hand():
    n = np.array([math.cos(0.7), math.sin(0.7)])
    grains = Grains(
        make_discs(np.array([(0.5, 0.5), 0.5 + 0.0299 * n]), [0.01, 0.02], 2500.0), LAW, Box((0, 0), (1, 1))
    )
    found = contacts(grains)
    assert found.count == 1
    assert found.overlap[0] == pytest.approx(1e-4, rel=1e-11)
    np.testing.assert_allclose(found.force[0], 1e6 * 1e-4 * n, rtol=1e-11)  # of the first on the second: away from it
    assert found.tangential_force[0] == 0.0
    assert not found.sliding[0]
    assert contacts(Grains(make_discs([(0.5, 0.5)], 0.01, 1.0), LAW, Box((0, 0), (1, 1)))).count == 0
