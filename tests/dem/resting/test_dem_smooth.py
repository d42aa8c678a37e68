"""Grains without friction take a law of their own that leaves springs and rotation alone, and go the same way."""

import numpy as np
import pytest

from porescale.dem.contact.linear import Linear
from porescale.dem.discs import make_discs
from porescale.dem.forces.rectangle import Rectangle
from porescale.dem.forces.walls import Box, Plate
from porescale.dem.grains import Grains
from porescale.dem.resting.frictionless import law_of_steps, may_turn

SMOOTH, ROUGH = Linear(1e5, 2.0), Linear(1e5, 2.0, 2.5e4, 1.0, 0.5)


def row_of_discs(law, **more):
    """Five discs that press on each other and on both ends of their box, and move."""
    at = np.column_stack((0.0099 + 0.0199 * np.arange(5), np.full(5, 0.05)))
    velocity = 0.1 * np.random.default_rng(2).normal(size=(5, 2))
    discs = make_discs(at, 0.01, 2500.0, velocity=velocity)
    return Grains(discs, law, Box((0.0, 0.0), (0.0994, 0.1)), **more)


def kind(grains):
    """ "smooth" where the law that its steps take leaves friction out, else "rough"; None where it is not known yet."""
    law = law_of_steps(grains)
    return None if law is None else "smooth" if law.friction is None else "rough"


def test_friction_anywhere_books_and_springs_that_are_left_keep_the_law_as_it_is():
    assert kind(row_of_discs(SMOOTH)) == "smooth"
    assert kind(row_of_discs(ROUGH)) == "rough"
    assert kind(row_of_discs(SMOOTH, energy=True)) == "rough"
    assert kind(row_of_discs(SMOOTH, wall_law=ROUGH)) == "rough"
    assert kind(row_of_discs(SMOOTH, plates=[Plate(0.5, 0.0, 1.0, friction=0.3)])) == "rough"
    grains = row_of_discs(SMOOTH)
    grains.add_wall("ramp", (0.5, 0.0), (-1.0, 0.0), friction=0.2)
    assert kind(grains) == "rough"
    grains = row_of_discs(SMOOTH)
    grains.set_rectangles([Rectangle((0.5, 0.0), (0.6, 0.1), friction=0.2)])
    assert kind(grains) == "rough"
    grains = row_of_discs(ROUGH)
    grains.current_pairs().carried[0] = 1e-6
    grains.set_law(SMOOTH)
    assert kind(grains) is None


@pytest.mark.slow
def test_discs_without_friction_go_the_same_way_under_either_law_and_turn_only_where_they_did():
    runs = []
    for spin in (0.0, 3.0):
        grains, twin = row_of_discs(SMOOTH), row_of_discs(SMOOTH)
        for each in (grains, twin):
            each.discs.spin[:] = spin
        twin.free_law = twin.contact  # the law that knows friction, of which there is none
        assert may_turn(grains, law_of_steps(grains)) == (spin > 0.0)
        for each in (grains, twin):
            each.step(1e-5, count=200)
        assert grains.free_law.friction is None
        assert np.array_equal(grains.discs.position, twin.discs.position)
        assert np.array_equal(grains.discs.velocity, twin.discs.velocity)
        assert np.array_equal(grains.discs.angle, twin.discs.angle)
        assert np.all(grains.discs.spin == spin)
        assert np.array_equal(grains.wall_force, twin.wall_force)
        runs.append(grains)
    assert np.all(runs[1].discs.angle > runs[0].discs.angle)
    rough = row_of_discs(ROUGH)  # the twin that must fail: with friction they turn
    rough.step(1e-5, count=200)
    assert np.abs(rough.discs.spin).max() > 0.0
    assert not np.array_equal(rough.discs.position, runs[0].discs.position)
