"""Plates count in what is measured of grains and in what is beyond sense; a rebuilt list costs no array."""

import numpy as np
import pytest

from porescale.common.core.errors import Unstable
from porescale.dem.contact.linear import Linear
from porescale.dem.discs import make_discs
from porescale.dem.finite import first_without_number
from porescale.dem.forces.walls import Box, Plate
from porescale.dem.grains import Grains
from porescale.dem.measures import survey as measure
from porescale.dem.measures.energy import elastic
from porescale.dem.prepare.merge import joined
from tests.reference.memory import peak

LAW = Linear(1e6, 0.0, 3e5, 0.0, 0.4)


def beside_a_plate(*places, velocity=0.0, rise=0.0):
    """Discs of 1 cm radius in a box of 1 m with a plate at x = 0.5 m from the floor to 0.5 m."""
    gate = Plate(0.5, 0.0, 0.5, velocity=rise, name="gate")
    discs = make_discs(np.array(places), 0.01, 2000.0, velocity=velocity)
    grains = Grains(discs, LAW, Box((0.0, 0.0), (1.0, 1.0)), plates=[gate])
    grains.refresh()
    return grains


def test_the_overlap_with_a_plate_is_measured():
    grains = beside_a_plate((0.3, 0.2), (0.492, 0.2))
    deepest = measure.max_overlap(grains)
    assert deepest.share == pytest.approx(0.2, rel=1e-12)  # 2 mm of 1 cm
    assert (deepest.disc, deepest.against) == (1, "the gate")
    grains.remove_plate("gate")
    assert measure.max_overlap(grains).share == 0.0


def test_the_energy_in_the_spring_of_a_plate_is_counted():
    grains = beside_a_plate((0.492, 0.2))
    grains.plate_spring[0, 0] = 1e-3
    assert sum(elastic(grains)) == pytest.approx(0.5 * 1e6 * 2e-3**2 + 0.5 * 3e5 * 1e-3**2, rel=1e-12)
    # The end of a plate: closest point (0.5, 0.5), 3-4-5.
    grains = beside_a_plate((0.4952, 0.5064))
    assert measure.max_overlap(grains).share == pytest.approx(0.2, rel=1e-9)


def test_energy_is_kept_in_a_bounce_from_a_plate():
    # Leap-frog at T_c/300, speed lagging by half a step: as between discs, a share of w dt = pi/300 at most.
    grains = beside_a_plate((0.48, 0.2), velocity=[[1.0, 0.0]])
    start = measure.kinetic_energy(grains.discs)
    dt = np.pi * np.sqrt(grains.discs.mass[0] / 1e6) / 300
    met = 0
    while grains.discs.velocity[0, 0] > -0.99:
        grains.step(dt, count=10)
        met += sum(elastic(grains)) > 0.0
        total = measure.kinetic_energy(grains.discs) + sum(elastic(grains))
        assert total == pytest.approx(start, rel=np.pi / 300)
    assert met > 10


def test_a_disc_pressed_deep_into_a_plate_is_unstable():
    grains = beside_a_plate((0.3, 0.2), (0.4935, 0.2))
    with pytest.raises(Unstable, match=r"overlap with the gate over radius = 0.35.* at grain 1"):
        grains.check()
    beside_a_plate((0.3, 0.2), (0.4925, 0.2)).check()


def leap(start, end, rise=0.0):
    """A disc that is at ``start`` at one check and at ``end`` at the next."""
    grains = beside_a_plate((0.3, 0.8), start, rise=rise)
    grains.step(1e-6)
    grains.check()
    grains.discs.position[1] = end
    grains.step(1e-6)
    grains.check()


def test_a_disc_that_went_through_a_plate_is_unstable():
    with pytest.raises(Unstable, match=r"distance to the gate = -0.02.* at grain 1.*went through"):
        leap((0.48, 0.2), (0.52, 0.2))
    with pytest.raises(Unstable, match="went through"):
        leap((0.52, 0.2), (0.48, 0.2))


@pytest.mark.parametrize(
    ("start", "end"), [((0.48, 0.2), (0.45, 0.3)), ((0.48, 0.8), (0.52, 0.8)), ((0.48, 0.8), (0.52, 0.2))]
)
def test_a_disc_that_stays_on_its_side_or_passes_over_a_plate_is_not(start, end):
    leap(start, end)


def test_a_disc_may_pass_below_a_rising_plate():
    leap((0.48, 0.02), (0.52, 0.02), rise=5e4)  # 5 cm a step
    grains = beside_a_plate((0.48, 0.2))
    grains.check()
    grains.discs.position[0, 0] = 0.52
    grains.refresh()  # moved by hand, and said so
    grains.check()


def test_the_first_disc_without_a_number_is_found_position_first():
    position, velocity, spin, angle = np.zeros((4, 2)), np.zeros((4, 2)), np.zeros(4), np.zeros(4)
    for find in (first_without_number, first_without_number.py_func):
        assert find(position, velocity, spin, angle) == (-1, -1)
    for at, column in (((angle, 1), 3), ((spin, 1), 2), ((velocity, (2, 1)), 1), ((position, (3, 0)), 0)):
        at[0][at[1]] = np.inf if column else np.nan
        for find in (first_without_number, first_without_number.py_func):
            assert find(position, velocity, spin, angle) == (np.ravel(at[1])[0], column)


def test_a_step_that_rebuilds_the_list_makes_no_array():
    side = 80
    places = (np.stack(np.meshgrid(np.arange(side), np.arange(side)), axis=-1).reshape(-1, 2) + 0.5) / side
    rng = np.random.default_rng(5)
    discs = make_discs(places, 0.4 / side, 2000.0, velocity=rng.normal(0.0, 0.05, places.shape))
    grains = Grains(discs, LAW, Box((0.0, 0.0), (1.0, 1.0)))
    weights = np.zeros((discs.count, 2))
    for _ in range(4):  # compiles, and lets the buffers of both lists grow
        discs.position += rng.normal(0.0, 0.05 / side, places.shape)
        grains.stale = True
        grains.step(1e-6, weights)
    builds = grains.pairs.builds
    discs.position += 0.5 / side  # all go together: the pairs stay
    grains.pairs.list_position[0] -= 1.0  # but one seems to have come from far, so the list is rebuilt
    grains.stale = True
    held = peak(lambda: grains.step(1e-6, weights))
    assert grains.pairs.builds == builds + 1
    assert held < discs.count  # not even a flag for each disc


def test_joining_keeps_what_rests_and_adds_the_rest():
    bed = beside_a_plate((0.3, 0.0099), (0.3198, 0.0099), rise=0.5)
    bed.pairs.carried[:] = 3e-6
    bed.wall_spring[:], bed.plate_spring[:] = 1e-6, 2e-6
    more = make_discs(np.array([[0.31, 0.4], [0.7, 0.4]]), 0.05, 2500.0, velocity=[[1.0, 2.0], [3.0, 4.0]], spin=5.0)
    both = joined(bed, more)
    assert both.discs.count == 4
    np.testing.assert_array_equal(both.discs.velocity, [[0, 0], [0, 0], [1, 2], [3, 4]])
    np.testing.assert_array_equal(both.plates, bed.plates)
    assert both.plate_names == ["gate"]
    np.testing.assert_array_equal(both.wall_spring[:, :2], bed.wall_spring)
    np.testing.assert_array_equal(both.plate_spring[:, :, 0], [[2e-6, 2e-6, 0, 0]])
    pairs = {
        (i, int(both.pairs.partner[k])): both.pairs.carried[k, 0]
        for i in range(4)
        for k in range(both.pairs.start[i], both.pairs.start[i + 1])
    }
    assert pairs.pop((0, 1)) == 3e-6
    assert set(pairs.values()) <= {0.0}
