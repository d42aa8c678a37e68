"""Only discs that may touch a wall within a call are checked at every step: the same bits as checking all of them."""

import numpy as np
import pytest

from porescale.dem.contact.linear import Linear
from porescale.dem.discs import make_discs
from porescale.dem.forces.walls import NX, PX, RUN, Box, mark_near, runs_of
from porescale.dem.grains import Grains
from porescale.dem.step import MARK_AGAIN, WAY

SMOOTH, ROUGH = Linear(1e5, 2.0), Linear(1e5, 2.0, 2.5e4, 1.0, 0.5)
DT = 1e-5


def flying(law, *, side=10, speed=2.0, energy=False):
    """Discs of 1 cm radius, row by row from the floor, flying about in a closed box."""
    rng = np.random.default_rng(4)
    grid = np.stack(np.meshgrid(np.arange(side), np.arange(side)), axis=-1).reshape(-1, 2)
    discs = make_discs((grid + 0.5) * 0.021, 0.01, 2500.0, velocity=rng.normal(0.0, speed, (side * side, 2)))
    return Grains(discs, law, Box((0.0, 0.0), (side * 0.021, side * 0.021)), energy=energy)


@pytest.mark.parametrize("count", [0, 1, RUN, 5 * RUN - 1])
def test_a_run_is_near_a_wall_when_one_of_its_discs_is(count):
    rng = np.random.default_rng(count)
    position, radius = rng.uniform(0.0, 1.0, (count, 2)), rng.uniform(0.005, 0.01, count)
    walls = Box((0.0, 0.0), (1.0, 1.0)).walls()[1]
    near, way = np.full((len(walls), runs_of(count)), 2, np.uint8), 0.01
    gap = np.einsum("nwk,wk->wn", position[:, None] - walls[:, PX : PX + 2], walls[:, NX : NX + 2]) - radius
    slow = [[(gap[w, k : k + RUN] <= way).any() for k in range(0, count, RUN)] for w in range(len(walls))]
    mark_near.py_func(position, radius, walls, way, near)
    np.testing.assert_array_equal(near, np.array(slow).reshape(near.shape))
    if count > RUN:
        assert 0 < near.sum() < near.size


def test_a_disc_that_is_nowhere_is_near_every_wall():
    near = np.zeros((4, 2), np.uint8)
    position = np.full((RUN + 1, 2), 0.5)
    position[RUN] = np.nan
    mark_near.py_func(position, np.full(RUN + 1, 0.01), Box((0.0, 0.0), (1.0, 1.0)).walls()[1], 0.01, near)
    np.testing.assert_array_equal(near, [[0, 1]] * 4)


@pytest.mark.parametrize(("law", "energy"), [(SMOOTH, False), (ROUGH, False), (ROUGH, True)])
def test_one_call_of_many_steps_has_the_bits_of_calls_that_ask_all_discs(law, energy):
    one, many = flying(law, energy=energy), flying(law, energy=energy)
    pressed, left_out = 0, 0
    for _ in range(15):
        one.step(DT, count=40)
        left_out += np.count_nonzero(one.sweeps.one.near == 0)  # none where the last list came in the last steps
        for _ in range(40):
            many.step(DT, count=1)
            assert many.sweeps.one.near.all()
        pressed += np.count_nonzero(one.wall_load)
        for name in ("wall_load", "wall_spring"):
            np.testing.assert_array_equal(getattr(one, name), getattr(many, name))
        for name in ("position", "velocity", "spin", "force", "torque"):
            np.testing.assert_array_equal(getattr(one.discs, name), getattr(many.discs, name))
        if energy:
            np.testing.assert_array_equal(one.budget, many.budget)
    assert one.pairs.builds > 1
    assert pressed > 0
    assert left_out > 0


def test_marked_without_the_way_discs_go_a_touching_one_is_left_out():  # the twin that must fail
    grains = flying(SMOOTH, side=1, speed=0.0)
    grains.refresh()
    d, room = grains.discs, grains.pairs.skin_margin
    start, steps = d.position.copy(), 50
    d.velocity[0] = (-room / (steps * DT), 0.0)  # to the left by no more than the list allows; the gap is a fifth
    with_way, without = np.zeros((4, 1), np.uint8), np.zeros((4, 1), np.uint8)
    mark_near.py_func(start, d.radius, grains.walls, WAY * room, with_way)
    mark_near.py_func(start, d.radius, grains.walls, 0.0, without)
    builds = grains.pairs.builds
    assert steps >= MARK_AGAIN
    grains.step(DT, count=steps // 2)
    assert grains.pairs.builds == builds
    assert grains.wall_load[0, 0] < 0.0
    assert with_way[0, 0] == 1
    assert without[0, 0] == 0
