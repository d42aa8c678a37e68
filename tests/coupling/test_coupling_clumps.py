"""Clumps in fluid: they displace their union, weigh what is left, and sink as rigid bodies do."""

import numpy as np
import pytest

from porescale.coupling.coverage import overlap
from porescale.coupling.coverage.overlap import overlapping, subtract_overlap
from porescale.coupling.displaced import displaced, of_whole_bodies
from porescale.coupling.step import buoyant_weight
from porescale.dem.bodies.union import outline
from porescale.validation.coupling import clumps as lab
from porescale.validation.coupling import clumps as verify_clumps
from porescale.validation.coupling.clumps import VALIDATIONS, R, sunk
from porescale.validation.coupling.clumps import immersed_clumps as immersed

TWO = [[(12.0, 20.0, 5.0), (16.0, 23.0, 4.0)], [(30.0, 24.0, 5.0), (34.0, 22.0, 5.0)]]
TRIPLE = [(20.3, 30.1, 6.0), (26.2, 33.4, 4.5), (22.0, 37.7, 5.0)]


def test_fluid_within_a_clump_is_that_of_its_union():
    coupled = immersed([TRIPLE, [(38.0, 20.0, 4.0)]])
    at, radius = np.array(TRIPLE)[:, :2], np.array(TRIPLE)[:, 2]
    union, inside = outline(at, radius), displaced(coupled.grains, coupled.grains.discs.radius, 3.0)
    assert inside.mass[:3].sum() == pytest.approx(3.0 * union.area, rel=1e-13)
    np.testing.assert_allclose(inside.mass[:3] @ at / inside.mass[:3].sum(), union.centroid, rtol=1e-12)
    _, about = of_whole_bodies(coupled.grains, inside.mass, inside.inertia)
    np.testing.assert_allclose(about[:3], 3.0 * union.second_moment, rtol=1e-12)
    assert inside.mass[3] == pytest.approx(3.0 * np.pi * 16.0, rel=1e-13)
    assert (inside.mass > 0.0).all()
    assert (inside.inertia > 0.0).all()
    # The twin that must fail: discs that overlap displace more than their union.
    assert 3.0 * np.pi * float(np.sum(radius**2)) > 1.1 * inside.mass[:3].sum()


def test_a_clump_as_heavy_as_the_fluid_weighs_nothing():
    coupled = immersed([TRIPLE], ratio=1.0)
    weight = float(np.abs(buoyant_weight(coupled.grains, 0.0, (0.0, -1e-5))).sum())
    assert np.abs(coupled.weight).sum() < 1e-12 * weight
    sunk(coupled, 20)
    assert np.abs(coupled.grains.steering.clumps.velocity).max() < 1e-15


@pytest.mark.parametrize(
    "bodies", [[TRIPLE], [[(20.2, 30.0, 6.0), (20.3, 30.4, 6.0)]], [[(20.3, 30.4, 5.0), (24.1, 32.2, 5.0)]]]
)
def test_cells_hold_the_union_of_members(bodies):
    coupled = immersed(bodies)
    wet, d = coupled.saturated, coupled.grains.discs
    still = np.zeros_like(d.position), np.zeros(d.count)
    wet.cover(d.position, *still)
    covered = np.minimum(wet.solid, 1.0)
    union = outline(d.position, wet.covering_radius).area
    # Areas in common are means over 16 sub-rows: off by 1/(2 16) of a cell where an outline begins or ends between two
    # of them, at some four such ends, and by (1/16)^2/24 of their curvature elsewhere.
    assert covered.sum() == pytest.approx(union, abs=4 / 32)
    wet.pairs = np.zeros((0, 2), np.int64)
    wet.cover(d.position, *still)
    assert np.minimum(wet.solid, 1.0).sum() - union > 0.2  # the twin that must fail


def test_discs_of_a_clump_that_do_not_overlap_stay_as_they_are():
    coupled = immersed([[(20.0, 30.0, 5.0), (31.0, 30.0, 5.0)]])
    assert not len(coupled.saturated.pairs)
    assert not len(overlapping(immersed([TRIPLE], bound=False).grains, np.full(3, 9.0)))


def test_kernels_do_the_same_as_plain_python(monkeypatch):
    found = []
    for plain in (False, True):
        for name in ("subtract_in_row", "common") if plain else ():
            monkeypatch.setattr(overlap, name, getattr(overlap, name).py_func)
        wet, d = (coupled := immersed([TRIPLE])).saturated, coupled.grains.discs
        pairs, wet.pairs = wet.pairs, np.zeros((0, 2), np.int64)
        wet.cover(d.position, np.zeros_like(d.position), np.zeros(d.count))
        run = subtract_overlap.py_func if plain else subtract_overlap
        run(d.position, wet.covering_radius, pairs, wet._patches)
        found.append(wet._patches.fraction.copy())
    np.testing.assert_allclose(found[0], found[1], rtol=0, atol=1e-15)  # one root may be rounded otherwise


def test_a_clump_of_one_disc_sinks_as_the_disc():
    one, other = (sunk(immersed([[(20.3, 40.0, R)]], bound=bound), 60) for bound in (True, False))
    # Area and inertia by arcs differ in the last bit, 1e-16 a step of a speed that grows evenly.
    np.testing.assert_allclose(one.grains.discs.position, other.grains.discs.position, rtol=1e-14)
    np.testing.assert_allclose(one.grains.discs.velocity, other.grains.discs.velocity, rtol=1e-11, atol=1e-17)


def test_a_clump_of_unlike_discs_turns_as_it_sinks():  # the twin that must fail, of coupling.level_pair_sinks_straight
    _, turning = lab.level_pair(smaller=4.0)
    assert abs(turning) > 1e-3


def test_rims_counted_twice_slow_a_clump_down():  # the twin that must fail, of coupling.two_discs_in_one_place
    # A quarter of a cell more all around.
    found = lab.pair_beside_disc(verify_clumps.APART, shared=False)
    assert abs(found - 1.0) > 2 * VALIDATIONS["coupling.two_discs_in_one_place"].tolerance


def test_members_with_other_shares_than_the_bodys_break_the_momentum_book():  # the twin of coupling.momentum_of_clumps
    coupled = immersed(TWO, g=0.0, side="periodic", velocity=[[0.02, 0.01]] * 2 + [[-0.03, 0.0]] * 2)
    first, discs = coupled.momentum(), coupled.grains.discs
    discs.mass[:2] = discs.mass[1::-1]
    size = float(np.sum(discs.mass[:, None] * np.abs(discs.velocity)))
    assert np.abs(sunk(coupled, 200).momentum() - first).max() > 1e-5 * size


def test_a_restart_with_clumps_equals_the_uninterrupted_run():
    made = [immersed([TRIPLE], g=1e-4) for _ in range(3)]
    sunk(made[0], 40)
    made[2].restore(sunk(made[1], 17).state())
    sunk(made[2], 23)
    for name in ("position", "velocity", "spin", "force"):
        np.testing.assert_array_equal(getattr(made[2].grains.discs, name), getattr(made[0].grains.discs, name))
