"""Frames of segments: mass, contacts that count once, springs that are handed over, lists, restart."""

from dataclasses import replace

import numpy as np
import pytest

from porescale.benchmarks import dem_polygons as bench_segments
from porescale.common.core.errors import InputError, Unstable
from porescale.dem.bodies.bonding import bond, segments_now
from porescale.dem.bodies.frames import Frame, chain, framed, from_ends, polygon, polygon_moments
from porescale.dem.contact.hertz import Hertz
from porescale.dem.contact.linear import Linear
from porescale.dem.contact.materials import Materials
from porescale.dem.discs import make_discs
from porescale.dem.forces import segments
from porescale.dem.forces.rectangle import Rectangle
from porescale.dem.forces.walls import Box, Plate
from porescale.dem.grains import Grains
from porescale.dem.measures import survey as measure
from porescale.dem.measures.energy import elastic, energy_budget
from porescale.dem.motion.control import Moved
from porescale.dem.motion.drivers import Clump
from porescale.dem.motion.periodic_cell import Still
from porescale.validation.dem.segments import mixed_cloud, regular
from tests.reference.dem import dem_segments as slow
from tests.reference.dem.restarted import OF_LAST_CALL, differing, saved_on_the_way
from tests.reference.memory import peak

K = 1e6
LAW = Linear(K)
BOX = Box((-5.0, -5.0), (5.0, 5.0), "open", "open", "open", "open")
BLUNT = [(0, 0), (2, 0), (2, 1), (1.1, 0.9), (1, 2), (0, 2)]  # a corner of it points inwards
REST = Moved()


def forces_of(grains):
    """Forces (b, 2) and torques (b,) on clumps and the forces on free discs after one step without motion."""
    grains.steering.watch(*(Clump(k) for k in range(grains.steering.clumps.count)))
    grains.step(1e-9)
    return np.array([row.contact for row in grains.steering.record()])


def probe(at, radius=0.2, rule="outline", frames=(), law=LAW):
    """A disc at ``at`` beside frames that are held; returns the force on it."""
    grains = framed(make_discs([at], radius, 1000.0), frames, law, BOX, rule=rule)
    grains.step(1e-9)
    return grains.discs.force[0].copy()


@pytest.mark.parametrize("corners", [[(0, 0), (1, 0), (0, 1)], BLUNT, BLUNT[::-1], np.add(BLUNT, (50.0, -70.0))])
def test_moments_of_a_polygon_are_those_of_its_triangles(corners):
    found, exact = polygon_moments(np.array(corners, float)), slow.polygon_by_triangles(np.array(corners, float))
    # Round-off of numbers as large as the distance from the origin squared, 7e3, times 1e-16 and some.
    for one, other in zip(found, exact, strict=True):
        np.testing.assert_allclose(one, other, rtol=1e-10)


def test_ends_that_coincide_are_one_corner():
    frame = from_ends([[(0, 0), (1, 0)], [(1, 1), (0, 0)], [(1, 0), (1, 1)]], 0.1, 1000.0)
    assert len(frame.corners) == 3
    assert frame.closed
    assert frame.mass_properties().mass == pytest.approx(500.0, rel=1e-14)
    assert not from_ends([[(0, 0), (1, 0)], [(1, 1), (1, 0)]], 0.1, 1000.0).closed


def test_a_tee_is_a_frame_of_rods():
    tee = Frame(((0, 0), (1, 0), (2, 0), (1, -1)), ((0, 1), (1, 2), (1, 3)), 0.05, 10.0).mass_properties()
    assert (tee.mass, tee.centroid) == (pytest.approx(3.0), pytest.approx((1.0, -1.0 / 6.0)))


@pytest.mark.parametrize(
    ("make", "key"),
    [
        (lambda: polygon([(0, 0), (1, 1), (1, 0), (0, 1)], 0.1, 1.0), "crosses itself"),
        (lambda: polygon([(0, 0), (2, 0), (1, 0), (1, 1)], 0.1, 1.0), "a spike"),
        (lambda: polygon([(0, 0), (1, 0), (1, 1), (1, -1)], 0.1, 1.0), "a spike"),
        (lambda: polygon([(1, 1), (0, 0), (1, 0), (1, 3)], 0.1, 1.0), "a spike"),
        (lambda: polygon([(0, 0), (1, 1), (2, 2)], 0.1, 1.0), "has no area"),
        (lambda: polygon([(0, 0), (2, 2), (1, 1), (3, 3)], 0.1, 1.0), "has no area"),
        (lambda: chain([(0, 0), (0, 0)], 0.1, 1.0), "no length"),
        (lambda: chain([(0, 0)], 0.1, 1.0), "every corner"),
        (lambda: chain([(0, 0), (1, 0)], 0.0, 1.0), "no mass"),
        (lambda: chain([(0, 0), (1, 0)], -1.0, 1.0), "thickness"),
        (lambda: chain([(0, 0), (1, 0)], 0.1, 0.0), "density"),
        (lambda: chain([(0, 0), (np.nan, 0)], 0.1, 1.0), "corners"),
        (lambda: framed(None, [regular(3, (0, 0))], LAW, BOX, rule="sharp"), "no such rule"),
        (lambda: framed(None, [regular(3, (0, 0))], LAW, BOX, plates=[Plate(0.0, 0.0, 1.0)]), "frames"),
        (lambda: framed(None, [polygon(BLUNT, 0.0, 1.0)], Hertz(1e7, 4e6), BOX), "thickness"),
    ],
)
def test_frames_without_sense_are_refused(make, key):
    with pytest.raises(InputError, match=key):
        make()


def test_what_does_not_go_with_segments_says_so():
    grains = framed(None, [regular(3, (0, 0))], LAW, Box((-1, -1), (1, 1), *("periodic",) * 4))
    with pytest.raises(InputError, match="strained"):
        grains.steering.strain_cell()
    with pytest.raises(InputError, match="bind all at once"):
        grains.steering.bind([], 1.0)
    with pytest.raises(InputError, match="segments"):
        grains.set_rectangles([Rectangle((0.0, 0.0), (0.1, 0.1))])


def two_bodies(seed):
    """Two frames, one with an inward corner, and a disc, thrown on one heap so that corners and sides overlap."""
    rng = np.random.default_rng(seed)
    turn, way = rng.uniform(0.0, 6.3), rng.uniform(-1.0, 1.0, 2)
    c, s = np.cos(turn), np.sin(turn)
    other = np.array([(-0.5, -0.4), (0.6, -0.5), (0.2, 0.5)]) @ np.array([(c, s), (-s, c)]) + (1.5, 1.5) + way
    frames = [polygon(BLUNT, 0.3, 10.0), polygon(other, 0.25, 10.0), chain([(-1.0, 0.0), (-0.4, 1.0)], 0.2, 10.0)]
    return framed(make_discs([rng.uniform(-0.4, 2.4, 2)], 0.3, 10.0), frames, LAW, BOX)


@pytest.mark.parametrize("compiled", [True, False])
def test_forces_are_those_of_the_potential_and_count_corners_once(compiled):
    run = segments.add_segment_forces if compiled else segments.add_segment_forces.py_func
    met = 0
    for seed in range(200 if compiled else 5):
        grains = two_bodies(seed)
        d, table = grains.discs, grains.steering.clumps
        d.force[:], d.torque[:] = 0.0, 0.0
        listed = segments_now(grains)
        run(grains.disc_arrays(), listed, grains.contact, 1e-9, Still(0.0, 0.0))
        bodies = [(np.array([0]), tuple(d.position[0]))]
        bodies += [(table.discs_of(c), tuple(table.position[c])) for c in range(table.count)]
        ends = [tuple(row) for row in grains.segments.ends.tolist()]
        exact = slow.forces(d.position, d.radius, grains.segments.group, ends, K, bodies)
        met += np.count_nonzero(np.abs(exact[:, 2]))
        for (own, centre), wanted in zip(bodies, exact, strict=True):
            arm = d.position[own] - centre
            moment = d.torque[own].sum() + float((arm[:, 0] * d.force[own, 1] - arm[:, 1] * d.force[own, 0]).sum())
            # Forces up to K d = 6e5; terms that cancel in the twin leave round-off of a dozen such.
            np.testing.assert_allclose([*d.force[own].sum(axis=0), moment], wanted, atol=6e5 * 1e-14)
        if compiled:
            normal = segments.survey_segments(d.position, d.radius, None, listed, grains.contact, grains.cell)[3]
            exact_energy = slow.potential(d.position, d.radius, grains.segments.group, ends, K)
            assert normal == pytest.approx(exact_energy, abs=6e5 * 1e-14)
    assert met > 3


@pytest.mark.parametrize("angle", [0.3, 0.8, 1.2])
def test_a_disc_at_a_corner_has_one_contact(angle):
    way = np.array([np.cos(angle), np.sin(angle)])  # beyond the corner (2, 1) of a rectangle, in its cone
    at = np.array([2.0, 1.0]) + 0.29 * way
    box = polygon([(0, 0), (2, 0), (2, 1), (0, 1)], 0.1, 10.0)
    once, twice = probe(at, frames=[box]), probe(at, rule="each", frames=[box])
    np.testing.assert_allclose(once, K * 0.01 * way, rtol=1e-12)
    np.testing.assert_allclose(twice, 2.0 * once, rtol=1e-12)


def test_a_side_cut_in_two_is_as_stiff_as_one():
    for x in (0.9, 1.0, 1.0 + 1e-9, 1.03):
        whole = probe((x, 0.29), frames=[chain([(0, 0), (2, 0)], 0.1, 10.0)])
        cut = probe((x, 0.29), frames=[chain([(0, 0), (1, 0), (2, 0)], 0.1, 10.0)])
        np.testing.assert_allclose(cut, whole, rtol=1e-12)
    doubled = probe((1.0, 0.29), rule="each", frames=[chain([(0, 0), (1, 0), (2, 0)], 0.1, 10.0)])
    assert doubled[1] == pytest.approx(2.0 * whole[1], rel=1e-12)  # the twin that must fail


@pytest.mark.parametrize("rule", ["outline", "each"])
def test_forces_are_continuous_along_a_disc_s_way_round_a_frame(rule):
    turns = np.array([(-0.6, -0.6), (2.6, -0.6), (2.6, 1.5), (1.6, 1.5), (1.55, 2.6), (-0.6, 2.6), (-0.6, -0.6)])
    places = np.linspace(0.0, 6.0, 601)
    ring = np.column_stack([np.interp(places, np.arange(7), turns[:, axis]) for axis in range(2)])
    found = np.array([probe(at, 0.6, rule, [polygon(BLUNT, 0.1, 10.0)]) for at in ring])
    steps = np.hypot(*np.diff(found, axis=0).T)
    # A way of 0.032 changes the force of each contact by the stiffness times as much; there are three at most.
    assert steps.max() < 3.0 * K * 0.032
    assert np.hypot(*found.T).max() > K * 0.1


def test_the_printed_rule_jumps_at_the_end_of_a_segment():
    rod = [chain([(0, 0), (1, 0)], 0.0, 10.0, width=1.0)]
    inside, outside = (probe((1.0 + off, 0.19), rule="printed", frames=rod) for off in (-1e-9, 1e-9))
    assert abs(inside[1]) < 1e-3 < 0.9 * K * 0.01 < outside[1]
    middle = probe((0.5, 0.19), rule="printed", frames=rod)
    np.testing.assert_allclose(middle, (0.0, K * 0.01), rtol=1e-12, atol=1e-9)
    # (8): the overlap falls in proportion to the way to the end within the half chord sqrt(r^2 - a^2).
    chord = np.sqrt(0.2**2 - 0.19**2)
    assert probe((1.0 - 0.5 * chord, 0.19), rule="printed", frames=rod)[1] == pytest.approx(0.5 * K * 0.01, rel=1e-9)


def test_springs_are_handed_over_at_a_corner():
    law = Linear(K, 0.0, K, 0.0, 1e3)
    grains = framed(make_discs([(0.995, 0.29)], 0.2, 10.0), [chain([(0, 0), (1, 0), (2, -0.2)], 0.1, 10.0)], law, BOX)
    grains.hold(0)
    grains.discs.velocity[0] = (1.0, 0.0)
    grains.steering.control(Clump(0), REST, REST, REST)
    seen = []
    for _ in range(75):
        grains.step(1e-3)
        own = grains.segments
        seen.append(
            [own.near_memory[own.near[:, 0] == 0, 0].tolist(), own.corner_memory[own.corner[:, 0] == 0, 0].max()]
        )
    total = np.array([sum(near) + corner for near, corner in seen])
    owner = [int(np.argmax([*near, corner])) for near, corner in seen]
    assert len(set(owner)) == 3  # first side, corner, second side
    # The disc slides by 1e-3 a step on a flat side and by no less than the cosine of 0.2 as much elsewhere.
    assert np.abs(np.diff(total)).max() < 1.001e-3
    assert np.diff(total).min() > 0.97e-3


def test_long_segments_press_as_short_ones_do():
    found = []
    for long in (False, True):
        grains = mixed_cloud(0.5)
        frames = [polygon([(-0.2, -0.2), (0.2, -0.2), (0.2, 0.2), (-0.2, 0.2)], 1e-3, 10.0, long=long)]
        grains = framed(grains.discs.__class__(*vars(make_discs([(0.19, 0.19), (0.0, -0.195)], 0.01, 10.0)).values()),
                        frames, LAW, BOX)  # fmt: skip
        assert len(grains.segments._short) == (0 if long else 4)
        grains.step(1e-9)
        found.append(grains.discs.force[:2].copy())
    np.testing.assert_array_equal(*found)
    assert np.abs(found[0]).max() > 0.0


def test_a_list_kept_long_gives_what_a_fresh_one_gives():
    made = [mixed_cloud(0.5, skin=skin) for skin in (2e-4, 1e-2)]
    for grains in made:
        grains.step(5e-6, count=2000)
    assert made[0].pairs.builds > 3 * made[1].pairs.builds
    # The order of sums may differ: round-off 1e-16, grown tenfold by each of a few collisions.
    np.testing.assert_allclose(made[0].discs.position, made[1].discs.position, atol=1e-11)


def bound_cloud():
    grains = mixed_cloud(0.5, pace=1.0, energy=True)
    grains.steering.control(Clump(3), rotation=REST)
    grains.steering.watch(Clump(3), 4)
    return grains


@pytest.mark.parametrize("before", [1, 517])
def test_a_restart_with_segments_equals_the_uninterrupted_run(before, tmp_path):
    through, first, second = bound_cloud(), bound_cloud(), bound_cloud()
    for grains in (through, first):
        grains.step(7e-6, count=1500)
        bond(grains)
    through.step(7e-6, count=900)
    assert differing(through, saved_on_the_way(first, second, 7e-6, 900, before, tmp_path)) <= OF_LAST_CALL
    assert through.state()["segments"]["near_memory"].any()


def test_a_scene_without_segments_has_nothing_of_them():
    grains = Grains(make_discs([[0.0, 0.0]], 0.1, 10.0), LAW, BOX)
    grains.step(1e-5)
    assert grains.segments is None  # the loop is compiled for None: nothing of segments and bonds is in it
    assert grains.bonds is None
    assert not grains.steered
    assert not {"segments", "bonds", "steering"} & grains.state().keys()


def test_a_step_allocates_nothing():
    grains = mixed_cloud(0.5)
    grains.step(5e-6, count=1500)
    bond(grains)
    grains.refresh()
    grains.step(1e-7)
    assert peak(lambda: grains.step(1e-7, count=20)) < 20_000  # what a call wraps, none of it per step


def test_corners_go_behind_walls_a_little_and_no_further():
    grains = framed(None, [polygon([(0, 0), (1, 0), (1, 1), (0, 1)], 0.0, 10.0)], LAW, Box((-5.0, 0.1), (5.0, 9.0)))
    grains.step(1e-9)
    grains.check()
    grains.steering.clumps.position[0, 1] -= 0.3
    grains.step(1e-9)
    with pytest.raises(Unstable, match="bottom wall"):
        grains.check()


def test_the_deepest_overlap_names_the_segment():
    grains = framed(make_discs([(0.5, -0.25)], 0.2, 10.0), [polygon(BLUNT, 0.1, 10.0)], LAW, BOX)
    found = measure.max_overlap(grains)
    assert found.disc == 0
    assert found.against.startswith("segment")
    assert sum(elastic(grains)) > 0.0


def test_sharper_frames_need_shorter_steps():
    square, needle = [(0, 0), (1, 0), (1, 1), (0, 1)], [(0, 0), (1, 0), (1, 0.1), (0, 0.1)]
    steps = [framed(None, [polygon(each, 0.01, 10.0)], LAW, BOX).stable_step() for each in (square, needle)]
    assert steps[1] < 0.5 * steps[0]


def test_hexagons_of_the_benchmark_touch_six_neighbours_with_their_sides():
    grains = bench_segments.hexagons(9)
    law = bench_segments.LAW
    pressed = bench_segments.PRESSED * (2.0 * bench_segments.RADIUS * np.sqrt(0.75) + 2.0 * bench_segments.THICKNESS)
    loads = forces_of(grains)
    # The one in the middle is pressed from all sides alike, by as much as makes round-off of its forces.
    np.testing.assert_allclose(loads[4, :2], 0.0, atol=1e-9 * law.stiffness * pressed)
    # Corners that face each other count once: two for each of 16 pairs of neighbours.
    each = 0.5 * law.stiffness * pressed**2
    assert sum(elastic(grains)) == pytest.approx(16 * 2 * each, rel=1e-9)


def test_segments_touch_across_a_periodic_side():
    box = Box((0.0, -5.0), (4.0, 5.0), "periodic", "periodic", "open", "open")
    whole = polygon([(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)], 0.1, 10.0)
    found = []
    for shift in (0.0, 2.0):
        at = np.add(whole.corners, (shift, 0.0))
        # At the side the other frame is at the far end of the box, in one piece, and meets the image of this one.
        beside = np.add([(-0.15, 0.3), (-0.8, 0.0), (-0.9, 0.8)], (shift if shift else 4.0, 0.0))
        frames = [polygon(at, 0.1, 10.0), polygon(beside, 0.1, 10.0)]
        grains = framed(make_discs([((shift - 0.25) % 4.0, 0.9)], 0.2, 10.0), frames, LAW, box)
        found.append(forces_of(grains))
    np.testing.assert_allclose(*found, atol=1e-9 * K)
    assert np.abs(found[0]).max() > 0.01 * K


@pytest.mark.slow  # compiles the loop for three more laws
@pytest.mark.parametrize(
    "law",
    [
        Hertz(1e7, 4e6, 0.1, 0.1, friction=0.5),
        Linear(K, 5.0, 0.25 * K, 2.0, 0.5, rolling_friction=0.1, rolling_stiffness=0.1 * K),
        Materials({"one": Linear(K, 5.0, 0.25 * K, 2.0, 0.5), "other": Linear(2.0 * K, 5.0, K, 2.0, 0.1)}),
    ],
)
def test_every_law_keeps_momentum_and_accounts_for_energy(law):
    frames = [
        regular(3 + k, (0.03 * k, 0.002 * k), 0.3 * k, velocity=(0.5 - 0.5 * k, 0.0), spin=10.0, material=k % 2)
        for k in range(3)
    ]
    materials = isinstance(law, Materials)
    frames = frames if materials else [replace(frame, material=0) for frame in frames]
    grains = framed(make_discs([(0.015, 0.02)], 0.008, 2000.0, [(0.0, -0.5)]), frames, law, BOX, energy=True)
    before = measure.momentum(grains.discs)
    dt = grains.stable_step(steps_per_contact=200.0)
    grains.step(dt, count=int(0.05 / dt))
    budget = energy_budget(grains)
    # Three or four contacts of some hundred steps each, first order: 1/200 of what they turn over, and the third law.
    assert abs(budget["residual (J/m)"]) < 5e-3 * budget["turned over (J/m)"]
    assert budget["lost in friction (J/m)"] > 0.0
    np.testing.assert_allclose(measure.momentum(grains.discs), before, atol=1e-12)


def test_rolling_resistance_that_comes_later_finds_room_for_its_springs():
    grains = mixed_cloud(0.5)
    grains.step(5e-6, count=10)
    known = grains.segments.near_memory.shape[1]
    grains.set_law(replace(grains.law, rolling_friction=0.1, rolling_stiffness=0.1 * K))
    assert (known, segments_now(grains).near_memory.shape[1]) == (1, 2)


@pytest.mark.slow  # compiles the loop for a law of its own
@pytest.mark.parametrize(
    ("length", "beside", "at"),
    [
        (2.0, 0.0, 0.2),  # amid a side: as on a wall, at its own radius
        (2.0, 1.1, 0.2 * 0.05 / 0.25),  # past the end of the side: two round bodies
        (0.3, 0.0, 0.2),  # however long the side is,
        (0.02, 0.0, 0.1),  # but with no more torque than N at its end: half of it over mu_r
    ],
)
def test_a_disc_rolls_on_a_side_as_on_a_wall(length, beside, at):
    # Without springs along the contact nothing but the resistance to rolling turns the disc, and its dashpot is at the
    # limit, so that the torque is mu_r N times the radius at which it rolls.
    law = Linear(K, friction=0.5, rolling_friction=0.1, rolling_damping=1e9)
    side = chain([(-0.5 * length, 0.0), (0.5 * length, 0.0)], 0.05, 1000.0)
    grains = framed(make_discs([(beside, 0.22)], 0.2, 1000.0, spin=5.0), [side], law, BOX)
    grains.steering.control(Clump(0), REST, REST, REST)
    grains.step(1e-12)
    normal = float(np.hypot(*grains.discs.force[0]))
    assert normal > 0.0
    # Round-off of the overlap, which is a tenth of distances at 2e-16.
    assert -grains.discs.torque[0] / (0.1 * normal) == pytest.approx(at, rel=1e-12)


def test_the_step_knows_what_resists_rolling_on_sides():
    # A light rod under a heavy disc: its rotation is held by k_r r^2, r of the disc, which the step must resolve.
    rod = chain([(-0.1, 0.0), (0.1, 0.0)], 1e-3, 10.0)
    soft = Linear(K, friction=0.5, tangential_stiffness=0.25 * K, rolling_friction=0.1, rolling_stiffness=1e-3 * K)
    steps = []
    for law in (soft, replace(soft, rolling_stiffness=100.0 * K)):
        steps.append(framed(make_discs([(0.0, 1.0)], 0.9, 1e4), [rod], law, BOX).stable_step(steps_per_contact=0.0))
    # Where rolling springs are all, the step goes with one over their root: w^2 >= 2 k_r r^2/I of one contact.
    inertia = 10.0 * 0.2 * 2e-3 * (0.2**2 + 2e-3**2) / 12.0
    assert steps[0] > steps[1]
    assert steps[1] < 2.0 / np.sqrt(2.0 * 100.0 * K * 0.9**2 / inertia)


def test_what_is_held_does_not_shorten_the_step():
    frames = [regular(4, (0.0, 0.0)), chain([(0.5, -1.0), (0.5, 1.0)], 1e-5, 1.0, long=True)]
    grains = framed(None, frames, LAW, BOX)
    free = grains.stable_step()
    grains.steering.control(Clump(1), REST, REST, REST)
    assert grains.stable_step() > 2.0 * free
    assert grains.stable_step() == framed(None, frames[:1], LAW, BOX).stable_step()
    with_disc = framed(make_discs([(0.0, 0.0)], 0.1, 10.0), frames[1:], LAW, BOX)
    with_disc.steering.control(Clump(0), REST, REST, REST)
    alone = Grains(make_discs([(0.0, 0.0)], 0.1, 10.0), LAW, BOX)
    assert with_disc.stable_step() == alone.stable_step()
