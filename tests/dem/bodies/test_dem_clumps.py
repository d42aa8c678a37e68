"""Clumps: mass of a union of discs, shares of members, rigid motion, contacts with everything but themselves."""

import numpy as np
import pytest

from porescale.common.core.errors import InputError
from porescale.dem.bodies import clumps
from porescale.dem.bodies.clumps import Body, Clumps
from porescale.dem.bodies.union import outline
from porescale.dem.contact.linear import Linear
from porescale.dem.discs import make_discs
from porescale.dem.forces.walls import Box, Plate
from porescale.dem.grains import Grains
from porescale.dem.measures import survey as measure
from porescale.dem.motion.drivers import Clump
from porescale.dem.prepare.merge import joined
from tests.reference.dem import dem_bodies
from tests.reference.dem.dem import Body as Disc
from tests.reference.dem.dem import World
from tests.reference.dem.restarted import OF_LAST_CALL, differing, saved_on_the_way
from tests.reference.memory import peak

LAW = Linear(1e6, 5.0, 3e5, 4.0, 0.4)
DENSITY = 2000.0


def cloud(seed=0, plates=()):
    """Three clumps, of two, three and one disc, and three free discs thrown about in a box."""
    rng = np.random.default_rng(seed)
    at = np.array(
        [[0.02, 0.02], [0.028, 0.024], [0.06, 0.02], [0.068, 0.02], [0.064, 0.028], [0.02, 0.06],
         [0.045, 0.05], [0.07, 0.06], [0.045, 0.075]]
    )  # fmt: skip
    size = np.array([8, 6, 6, 7, 5, 9, 8, 9, 7]) * 1e-3
    velocity = rng.normal(0.0, 1.0, at.shape)
    discs = make_discs(at, size, DENSITY, velocity, rng.normal(0.0, 50.0, len(at)))
    grains = Grains(discs, LAW, Box((0.0, 0.0), (0.09, 0.09)), plates=plates)
    grains.steering.bind([[0, 1], [2, 3, 4], [5]], DENSITY)
    return grains


@pytest.mark.parametrize(
    ("at", "size"),
    [
        ([[0, 0]], [1.0]),
        ([[0, 0], [0.7, 0.2]], [1.0, 0.6]),
        ([[0, 0], [1.2, 0], [0.6, 1.0]], [0.8, 0.8, 0.8]),
        ([[0, 0], [3, 0]], [1.0, 1.0]),  # apart
        ([[1, 0], [-0.5, 0.8660254], [-0.5, -0.8660254]], [0.95, 0.95, 0.95]),  # a hole in the middle
        ([[0, 0], [0.2, 0.1], [0, 0]], [1.0, 0.3, 1.0]),  # within, and the same twice
    ],
)
def test_the_union_of_discs_is_exact(at, size):
    at, size = np.add(at, (3.0, -1.0)), np.array(size)
    found = outline(at, size)
    area, centroid, second = dem_bodies.union_by_lines(at, size)
    # Lines miss half-circle ends by step^1.5, step = 3/20001: 2e-6 each; a moment about far away multiplies by 10.
    assert found.area == pytest.approx(area, rel=1e-5)
    np.testing.assert_allclose(found.centroid, centroid, atol=1e-5)
    assert found.second_moment == pytest.approx(second, rel=1e-4)


def test_the_union_of_one_disc_and_of_two_apart_is_known():
    # Round-off of moments about an origin three radii away: a few tens of eps.
    one = outline(np.array([[3.0, -1.0]]), np.array([2.0]))
    np.testing.assert_allclose([one.area, one.second_moment], [4 * np.pi, 8 * np.pi], rtol=1e-14)
    two = outline(np.array([[0.0, 0.0], [5.0, 0.0]]), np.array([1.0, 1.0]))
    np.testing.assert_allclose(two.second_moment, 2 * (np.pi / 2 + np.pi * 2.5**2), rtol=1e-14)
    np.testing.assert_allclose(two.exposed, 2 * np.pi, rtol=1e-14)


@pytest.mark.parametrize("deep", [3e-17, 1e-16, 1e-14, 1e-11, 1e-8, 1e-5, 0.02, 0.03])
def test_discs_that_hardly_touch_have_their_centre_on_the_line_between_them(deep):
    # Both circles must end at the same points of their chord: what they disagree by moves the centre off the line, and
    # no positive shares of a body are found beyond 1e-13.  50 eps: some ten rounded sums of lengths up to 3.
    for angle in np.linspace(0.1, 6.2, 50):
        along, across = np.array([np.cos(angle), np.sin(angle)]), np.array([-np.sin(angle), np.cos(angle)])
        at, size = np.array([-0.8 * along, (1.2 - deep) * along]), np.array([1.2, 0.8])
        found = outline(at, size)
        assert abs(found.centroid @ across) < 50 * np.finfo(float).eps
        # The lens has 2/3 of chord times depth, 1.31 deep^1.5 for these radii: 0.2 deep^1.5 of both discs.
        assert abs(found.area / (np.pi * np.sum(size**2)) - 1.0) < 0.22 * deep**1.5 + 50 * np.finfo(float).eps
        weight = size * found.exposed
        assert clumps.shares(weight, at - found.centroid, 1.2) is not None


def test_overlap_counted_twice_is_no_union():  # the twin that must fail
    at, size = np.array([[0.0, 0.0], [0.7, 0.2]]), np.array([1.0, 0.6])
    assert abs(np.pi * np.sum(size**2) / outline(at, size).area - 1.0) > 0.1


def test_members_hold_shares_of_the_body():
    grains = cloud()
    table, d = grains.steering.clumps, grains.discs
    for c in range(table.count):
        own = table.discs_of(c)
        away = d.position[own] - table.position[c]
        scale = table.mass[c] * d.radius[own].max()
        assert d.mass[own].sum() == pytest.approx(table.mass[c], rel=1e-14)
        np.testing.assert_allclose(d.mass[own] @ away, 0.0, atol=1e-13 * scale)
        inertia = d.mass[own] @ np.sum(away**2, axis=1) + d.inertia[own].sum()
        assert inertia == pytest.approx(table.inertia[c], rel=1e-13)
        assert d.mass[own].min() > 0.0
        assert d.inertia[own].min() > 0.0


def test_a_clump_starts_with_the_momentum_that_its_discs_were_given():
    at = np.array([[0.0, 0.0], [0.012, 0.0]])
    discs = make_discs(at, 0.01, DENSITY, [[1.0, 0.0], [1.0, 2.0]])
    given = discs.mass @ discs.velocity / discs.mass.sum()
    table = Clumps(discs, [[0, 1]], DENSITY)
    np.testing.assert_allclose(table.velocity[0], given, rtol=1e-15)
    # m r^2 (1 + (d/2r)^2 2) w = m d/2 (2 m/s), d = 1.2 r: both sides by hand.
    assert table.spin[0] == pytest.approx(0.006 * 2.0 / (0.01**2 + 2 * 0.006**2), rel=1e-13)


def test_numbers_by_hand_are_taken_as_they_are():
    discs = make_discs([[0.0, 0.0], [0.02, 0.0]], 0.01, DENSITY)
    table = Clumps(discs, [[0, 1]], 1.0, [Body(3.0, (0.012, 0.0), 1e-3)])
    assert (table.mass[0], table.inertia[0]) == (3.0, 1e-3)
    np.testing.assert_allclose(discs.mass, [3.0 * 0.4, 3.0 * 0.6], rtol=1e-13)


@pytest.mark.parametrize(
    ("members", "body", "key"),
    [
        ([[0, 1], [1, 2]], None, "member twice"),
        ([[0, 7]], None, "no such disc"),
        ([[]], None, "has no disc"),
        ([[0, 3]], None, "lies within disc 0"),
        ([[0, 1]], Body(1.0, (0.5, 0.0), 1.0), "centroid"),
        ([[0, 1]], Body(1.0, (0.006, 0.0), 1e-9), "inertia"),
        ([[0, 1]], Body(0.0, (0.006, 0.0), 1e-9), "centroid"),
    ],
)
def test_a_clump_without_sense_is_refused(members, body, key):
    discs = make_discs([[0.0, 0.0], [0.012, 0.0], [0.05, 0.0], [0.001, 0.0]], [0.01, 0.01, 0.01, 0.002], DENSITY)
    with pytest.raises(InputError, match=key):
        Clumps(discs, members, DENSITY, [body] * len(members) if body else ())


def twin_of(grains):
    d, table = grains.discs, grains.steering.clumps
    discs = [Disc(*d.position[i], d.radius[i], d.mass[i], *d.velocity[i], d.spin[i]) for i in range(d.count)]
    world = World(
        discs, LAW.stiffness, LAW.damping, LAW.tangential_stiffness, LAW.tangential_damping, LAW.friction,
        walls=[tuple(row) for row in grains.walls[:, :4].tolist()],
    )  # fmt: skip
    rigid = [
        dem_bodies.Rigid(
            table.discs_of(c).tolist(), table.mass[c], table.inertia[c], *table.position[c], *table.velocity[c],
            table.spin[c],
        )
        for c in range(table.count)
    ]  # fmt: skip
    return world, rigid


def test_fast_clumps_follow_the_slow_twin():
    grains = cloud()
    world, rigid = twin_of(grains)
    dt, steps = 1e-5, 800
    grains.step(dt, count=steps)
    for _ in range(steps):
        dem_bodies.step(world, rigid, dt)
    table = grains.steering.clumps
    assert np.abs(table.spin - [50.0, 50.0, 50.0]).min() > 0.0
    assert grains.wall_spring.any() or grains.pairs.carried.any()
    # The twin's internal forces, 1e6 * 1e-2 N/m, cancel to 1e-12 a step over masses of 0.3: 1e-16 m in dt^2, summed
    # over steps^2/2, and by collisions enlarged by 10 each.
    np.testing.assert_allclose(table.position, [(c.x, c.y) for c in rigid], rtol=0, atol=1e-9)
    np.testing.assert_allclose(grains.discs.position[:, 0], [b.x for b in world.bodies], rtol=0, atol=1e-9)


def test_members_of_a_clump_do_not_touch_and_stay_where_they_are():
    grains = cloud()
    table, d = grains.steering.clumps, grains.discs
    pairs = grains.current_pairs()
    for i in range(d.count):
        for j in pairs.partner[pairs.start[i] : pairs.start[i + 1]]:
            assert table.group[i] < 0 or table.group[i] != table.group[j]
    before = np.hypot(*(d.position[3] - d.position[2]))
    grains.step(1e-5, count=3000)
    assert np.hypot(*(d.position[3] - d.position[2])) == pytest.approx(before, rel=1e-14)  # places, not integrated
    np.testing.assert_allclose(d.angle[2] - d.angle[3], 0.0, atol=1e-14)


def test_a_clump_of_one_disc_is_that_disc():
    one, other = (Grains(make_discs([[0.02, 0.02], [0.045, 0.022]], 0.01, DENSITY, [[1.0, 0.0], [-1.0, 0.0]], 20.0),
                         LAW, Box((0.0, 0.0), (0.09, 0.09))) for _ in range(2))  # fmt: skip
    other.steering.bind([[0]], DENSITY)
    for grains in (one, other):
        grains.step(1e-5, count=1000)
    # Area and inertia of the union round, and so do a few operations in each of 1000 steps.
    np.testing.assert_allclose(one.discs.position, other.discs.position, rtol=0, atol=1000 * 1e-16)
    np.testing.assert_allclose(one.discs.spin, other.discs.spin, rtol=1e-11)


@pytest.mark.parametrize("before", [1, 313])
def test_a_restart_with_clumps_and_controls_equals_the_uninterrupted_run(before, tmp_path):
    def made():
        grains = cloud(plates=[Plate(0.045, 0.0, 0.04)])
        from porescale.dem.motion.control import Moved, Pushed
        from porescale.dem.motion.time_function import Sine

        grains.steering.control(Clump(1), x=Moved(Sine(0.3, 50.0)), rotation=Pushed(1e-2))
        grains.steering.control(8, y=Pushed(3.0))
        grains.steering.watch(Clump(1), 8)
        grains.steering.servo_wall("top", force=5.0, speed=0.1)
        return grains

    through, first, second = made(), made(), made()
    through.step(1e-5, count=600)
    assert differing(through, saved_on_the_way(first, second, 1e-5, 600, before, tmp_path)) <= OF_LAST_CALL
    work = [grains.state()["steering"]["given"][:, 1] for grains in (through, second)]
    np.testing.assert_array_equal(*work)


def test_kernels_do_the_same_as_plain_python():
    made = []
    for plain in (False, True):
        grains = cloud()
        grains.step(1e-5, count=5)
        t, d = grains.steering.clumps, grains.discs
        d.force[:] = np.arange(2 * d.count).reshape(-1, 2)
        run = clumps.gather.py_func if plain else clumps.gather
        run(t.arrays(), d.force, d.torque)
        t.angle += 0.3
        run = clumps.place_members.py_func if plain else clumps.place_members
        run(t.arrays(), grains.disc_arrays(), 0.1, 0.2, 0.3)
        made.append((t.force, t.torque, d.position, d.velocity, d.angle))
    for one, other in zip(*made, strict=True):
        np.testing.assert_array_equal(one, other)


def test_no_clump_costs_no_array_and_no_code():
    grains = Grains(make_discs([[0.02, 0.02]], 0.01, DENSITY), LAW, Box((0.0, 0.0), (0.09, 0.09)))
    grains.step(1e-5)
    assert not grains.steered  # the loop is compiled for None: nothing of clumps, controls and servos is in it
    assert grains.pairs.group is None
    with_clumps = cloud()
    with_clumps.step(1e-5, count=10)
    assert peak(lambda: with_clumps.step(1e-5, count=10)) < 20_000  # what a call wraps, none of it per step or disc


def test_clumps_shorten_the_stable_step_and_more_so_the_lighter_they_are():
    def step(members, body=()):
        at = np.array([[0.02, 0.02], [0.036, 0.02], [0.06, 0.06]])
        grains = Grains(make_discs(at, 0.01, DENSITY), LAW, Box((0.0, 0.0), (0.09, 0.09)))
        if members:
            grains.steering.bind(members, DENSITY, body)
        return grains.stable_step(steps_per_contact=0.0)

    # Two members bring twice the contacts for less than twice the mass.
    assert step([[0, 1]]) < step([])
    assert step([[0, 1]], [Body(0.02, (0.028, 0.02), 4e-6)]) < 0.3 * step([[0, 1]])


def test_a_member_is_moved_with_its_clump_only():
    grains = cloud()
    with pytest.raises(InputError, match="belongs to clump 0"):
        grains.steering.control(1)
    with pytest.raises(InputError, match="belongs to a clump"):
        grains.hold(1)
    with pytest.raises(InputError, match="no such clump"):
        grains.steering.watch(Clump(3))
    with pytest.raises(InputError, match="join them before"):
        joined(grains, make_discs([[0.08, 0.08]], 0.005, DENSITY))
    held = cloud()
    held.hold(7)
    with pytest.raises(InputError, match="that is held"):
        held.steering.bind([[7, 8]], DENSITY)


def test_sums_over_discs_are_those_of_the_bodies():
    grains = cloud()
    grains.step(1e-5, count=500)
    d, t = grains.discs, grains.steering.clumps
    free = t.group < 0
    kinetic = 0.5 * (t.mass @ np.sum(t.velocity**2, axis=1) + t.inertia @ t.spin**2)
    kinetic += 0.5 * (d.mass[free] @ np.sum(d.velocity[free] ** 2, axis=1) + d.inertia[free] @ d.spin[free] ** 2)
    assert measure.kinetic_energy(d) == pytest.approx(kinetic, rel=1e-13)
    np.testing.assert_allclose(measure.momentum(d), t.mass @ t.velocity + d.mass[free] @ d.velocity[free], rtol=1e-12)
