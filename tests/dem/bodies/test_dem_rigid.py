"""Stress, porosity, rattlers and the work of a cell are of rigid bodies where discs are bound to clumps."""

from dataclasses import replace

import numpy as np
import pytest

from porescale.dem.bodies.rigid import areas, arms, as_bodies, body_of
from porescale.dem.bodies.union import outline
from porescale.dem.contact.linear import Linear
from porescale.dem.discs import make_discs
from porescale.dem.forces.walls import Box
from porescale.dem.grains import Grains
from porescale.dem.measures.contacts import contacts
from porescale.dem.measures.fabric import LEAST_WITH_FRICTION, rattlers
from porescale.dem.measures.porosity import disc_areas
from porescale.dem.measures.region import Region
from porescale.dem.measures.stress import contact_stress, kinetic_stress
from porescale.dem.measures.survey import coordination
from porescale.dem.motion import affine_strain as strain
from porescale.validation.dem.bodies import clumped_cell
from porescale.validation.dem.setups import DENSITY, MASS, RADIUS, STIFFNESS
from tests.reference.dem.stored import stored

EPS = np.finfo(float).eps
LAW = Linear(1e7)


def pairs_in_a_column(count: int, bound: bool) -> Grains:
    """Pairs of discs that just touch, one above the other on a floor, weightless, with 100 N/m on the top one."""
    y = RADIUS * (2.0 * np.arange(2 * count) + 1.0)
    box = Box((0.0, 0.0), (2.0 * RADIUS, 5.0 * RADIUS * count), left="open", right="open", top="open")
    grains = Grains(make_discs(np.column_stack((np.full(2 * count, RADIUS), y)), RADIUS, DENSITY),
                    Linear(STIFFNESS), box)  # fmt: skip
    if bound:
        grains.steering.bind([[2 * k, 2 * k + 1] for k in range(count)], DENSITY)
    push = np.zeros((2 * count, 2))
    push[-1, 1] = -100.0
    slowest = np.sqrt(STIFFNESS / MASS) * np.pi / (4.0 * count + 1.0)
    dt = grains.stable_step()
    grains.step(dt, push, None, int(60.0 / (slowest * dt)), 2.0 * slowest)
    return grains


def test_a_column_of_clumps_carries_its_load_within_clumps_too():
    grains = pairs_in_a_column(4, bound=True)
    found, y = contacts(grains), grains.steering.clumps.position[:, 1]
    for low, high in ((y[0], y[1]), (y[1], y[3]), (y[0] + 0.3 * RADIUS, y[2] - 0.1 * RADIUS)):
        region = Region((0.0, low), (2.0 * RADIUS, high))
        # Rest is reached to exp(-60); forces from overlaps of 1e-5 m read off places known to 3e-17 m.
        assert contact_stress(region, found)[1, 1] == pytest.approx(100.0 / (2.0 * RADIUS), rel=1e-10)
        # The twin that must fail: ways between discs leave out what clumps carry, here one in two.
        bare = replace(found, start=found.start + arms(grains)[found.first], branch=found.normal * 2.0 * RADIUS)
        assert contact_stress(region, bare.chosen(bare.pairs))[1, 1] < 0.7 * 100.0 / (2.0 * RADIUS)


def test_love_weber_stress_of_a_strained_cell_of_clumps_is_the_one_that_it_works_with():
    grains = clumped_cell(Linear(1e7, 20.0, 5e6, 10.0, 0.5), 5)
    dt = grains.stable_step()
    grains.steering.strain_cell(xx=-0.15 / (900 * dt), yy=-0.12 / (900 * dt), xy=0.3 / (900 * dt))
    grains.step(dt, count=900)
    (width, height, _), found = grains.period, contacts(grains)
    assert found.count > 20
    stress = contact_stress(Region((0.01, -0.02), (0.01 + width, height - 0.02)), found, grains.period)
    grains.step(grains.last_dt)
    load = -grains.steering.load[:4].reshape(2, 2) / (width * height)
    # As for discs: k eps of a metre and some roundings of each contact's force times its branch; here members' shares
    # of the sums are as large.
    worst = 4 * found.count / (width * height) * 0.03 * EPS * (4 * 1e7 + 100 * np.abs(found.force).max())
    np.testing.assert_allclose(stress, load, rtol=0, atol=worst)
    bare = np.einsum("ca,cb->ab", found.force, found.branch - arms(grains)[found.first] + arms(grains)[found.second])
    assert np.abs(bare / (width * height) - load).max() > 0.01 * np.abs(load).max()  # the twin that must fail


def energy_of_bodies(grains):
    """Kinetic energy relative to a strained cell, J/m: clumps by their own motion, not by that of their members."""
    d, clumps = grains.discs, grains.steering.clumps
    free = clumps.group < 0
    parts = (
        (d.mass[free], d.velocity[free], d.inertia[free], d.spin[free]),
        (clumps.mass, clumps.velocity, clumps.inertia, clumps.spin),
    )
    return 0.5 * float(sum(m @ np.sum(v**2, axis=1) + i @ w**2 for m, v, i, w in parts))


@pytest.mark.parametrize("rates", [{"xx": -4.0}, {"xy": 8.0}])
def test_the_work_of_a_cell_of_clumps_is_the_energy_it_gains(rates):
    grains = clumped_cell(LAW, 5)
    grains.steering.strain_cell(**rates)
    grains.step(4e-6)
    start, before = energy_of_bodies(grains) + stored(grains), grains.steering.cell[strain.WORK]
    held = 0.0
    for _ in range(50):
        grains.step(4e-6, count=100)
        held = max(held, stored(grains))
    gained = energy_of_bodies(grains) + stored(grains) - start
    work = grains.steering.cell[strain.WORK] - before
    # Speeds lag positions by half a step: w dt = 0.014 of what contacts hold.  With ways between discs in place of
    # bodies the work of the first is 6 % off, 1.7 J/m, at any step.
    assert abs(work - gained) < 0.014 * held
    assert abs(gained) > 0.02 * start


def test_a_cell_of_clumps_without_contacts_has_the_pressure_of_its_bodies():
    grains = clumped_cell(LAW, 1)
    grains.discs.position *= 3.0
    grains.steering.strain_cell()
    d = grains.discs
    far = Grains(make_discs(3.0 * d.position, 0.2 * RADIUS, DENSITY, d.velocity), LAW,
                 Box((0.0, 0.0), tuple(9.0 * np.array(grains.box.upper)), *("periodic",) * 4))  # fmt: skip
    clumps = far.steering.bind([[k, 36 + k] for k in range(12)], DENSITY)
    clumps.spin[:] = 50.0
    far.steering.strain_cell()
    far.step(1e-6, count=2)
    width, height, _ = far.period
    bodies = as_bodies(far)
    exact = np.einsum("i,ia,ib->ab", bodies.mass, bodies.velocity, bodies.velocity) / (width * height)
    pxx, pxy, pyy = far.steering.cell_pressure()
    # Turning members were taken off as they were a step before: 50 rad/s by 1e-6 s of them.
    np.testing.assert_allclose([[pxx, pxy], [pxy, pyy]], exact, rtol=0, atol=1e-4 * np.abs(exact).max())
    free = np.einsum("i,ia,ib->ab", far.discs.mass, far.discs.velocity, far.discs.velocity) / (width * height)
    assert np.abs(free - exact).max() > 0.1 * np.abs(exact).max()  # the twin that must fail


def test_areas_of_clumps_are_those_of_their_unions():
    grains = clumped_cell(LAW, 2)
    d, clumps, share = grains.discs, grains.steering.clumps, areas(grains)
    for c in range(clumps.count):
        own = clumps.discs_of(c)
        assert share[own].sum() == pytest.approx(outline(d.position[own], d.radius[own]).area, rel=1e-13)
        assert share[own].sum() < 0.999 * d.area[own].sum()
    free = clumps.group < 0
    np.testing.assert_array_equal(share[free], d.area[free])
    period = grains.period
    whole = Region((0.0, 0.0), period[:2])
    covered = disc_areas(whole, d.position, d.radius, period) / d.area @ share
    assert covered == pytest.approx(clumps.area.sum() + d.area[free].sum(), rel=1e-13)


def test_a_clump_held_at_both_ends_is_no_rattler():
    # A bridge of two discs between two walls: each touches one wall, the body two.
    box = Box((0.0, 0.0), (3.9 * RADIUS, 1.0), bottom="open", top="open")
    at = [(0.99 * RADIUS, 0.5), (2.91 * RADIUS, 0.5)]
    grains = Grains(make_discs(at, RADIUS, DENSITY), LAW, box)
    grains.steering.bind([[0, 1]], DENSITY)
    number = body_of(grains)
    np.testing.assert_array_equal(number, [0, 0])
    found = contacts(grains)
    assert not rattlers(found.of_bodies(number), 2, LEAST_WITH_FRICTION)[number].any()
    assert rattlers(found, 2, LEAST_WITH_FRICTION).all()  # the twin that must fail


def test_coordination_counts_bodies():
    grains = pairs_in_a_column(3, bound=True)
    # Three bodies, two contacts between them, each counted from both sides; as discs, six.
    assert coordination(grains) == pytest.approx(4.0 / 3.0)
    assert coordination(pairs_in_a_column(3, bound=False)) == pytest.approx(10.0 / 6.0)


def test_bodies_of_free_discs_are_the_discs():
    grains = Grains(make_discs([[0.1, 0.1], [0.3, 0.3]], RADIUS, DENSITY), LAW, Box((0.0, 0.0), (1.0, 1.0)))
    assert as_bodies(grains) is grains.discs
    np.testing.assert_array_equal(body_of(grains), [0, 1])
    np.testing.assert_array_equal(areas(grains), grains.discs.area)
    assert not arms(grains).any()
    assert not kinetic_stress(Region((0.0, 0.0), (1.0, 1.0)), grains.discs).any()


def test_stress_control_brings_a_cell_of_clumps_to_the_stress():
    grains = clumped_cell(Linear(1e7, 200.0, 5e6, 100.0, 0.5), 3)
    grains.steering.strain_cell(pressure=(2e4, 3e4), limit=3.0)
    grains.step(grains.stable_step(), None, None, 6000, 20.0)
    pxx, _, pyy = grains.steering.cell_pressure()
    # Motion is damped at 20/s for 1 s: what is left of its pressure is e^-40 of it; grains that slip into place shake
    # the stress by that of one contact in thirty.
    assert [pxx, pyy] == pytest.approx([2e4, 3e4], rel=1 / 30)
