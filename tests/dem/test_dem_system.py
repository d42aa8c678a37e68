"""Grains stepped together: against the slow twin, as plain Python, restarted, watched."""

import numpy as np
import pytest

from porescale.common.core.errors import InputError, Unstable
from porescale.dem.contact.linear import Linear
from porescale.dem.discs import make_discs
from porescale.dem.forces import pairs as forces
from porescale.dem.forces import walls
from porescale.dem.forces.batch import pair_forces, scratch
from porescale.dem.forces.rectangle import add_rectangle_forces
from porescale.dem.forces.walls import LOW, Box, Plate
from porescale.dem.grains import Grains
from porescale.dem.measures import survey as measure
from porescale.dem.measures.energy import elastic
from porescale.dem.motion import leapfrog as kick
from porescale.dem.motion.control import Moved
from porescale.dem.motion.periodic_cell import Still
from porescale.dem.timestep import SAFETY, crowded, packing_factor, packing_limit
from tests.reference.dem.dem import Body, World
from tests.reference.dem.restarted import differing, saved_on_the_way

DENSITY = 2000.0
LAW = Linear(1e6, 5.0, 3e5, 4.0, 0.4)


def grains_in_a_box(seed=0, count=24, law=LAW, plates=None, skin=None):
    """Spinning discs of radii 1:2 flying about in a small closed box with a rising plate."""
    rng = np.random.default_rng(seed)
    side = int(np.ceil(np.sqrt(count)))
    grid = np.stack(np.meshgrid(np.arange(side), np.arange(side)), axis=-1).reshape(-1, 2)[:count]
    discs = make_discs(
        (grid + 0.5) * 0.021,
        0.01 * rng.uniform(0.5, 1.0, count),
        DENSITY,
        velocity=rng.normal(0.0, 1.0, (count, 2)),
        spin=rng.normal(0.0, 100.0, count),
    )
    if plates is None:
        plates = [Plate(2.0 * 0.021, -0.01, 0.05, velocity=0.7, friction=0.1)]
    box = Box((0.0, 0.0), (side * 0.021, side * 0.021))
    return Grains(discs, law, box, plates=plates, skin=skin)


def twin_of(grains):
    d, law = grains.discs, grains.law
    bodies = [
        Body(*d.position[i], d.radius[i], d.mass[i], *d.velocity[i], d.spin[i], d.angle[i]) for i in range(d.count)
    ]
    return World(
        bodies, law.stiffness, law.damping, law.tangential_stiffness, law.tangential_damping, law.friction,
        pulls=law.release == "overlap",
        walls=[tuple(row[:4]) for row in grains.walls.tolist()],
        plates=[[*p[:4], mu] for p, mu in zip(grains.plates.tolist(), grains.plate_laws[:, 0, 4], strict=True)],
    )  # fmt: skip


@pytest.mark.parametrize("release", ["force", "overlap"])
def test_fast_grains_follow_the_slow_twin(release):
    grains = grains_in_a_box(law=Linear(1e6, 5.0, 3e5, 4.0, 0.4, release))
    twin = twin_of(grains)
    weights = np.tile([1.0, -DENSITY * 9.81 * 1e-4], (24, 1))
    twist = np.full(24, 1e-3)
    dt, steps = grains.stable_step(), 400
    grains.step(dt, weights, twist, steps)
    for _ in range(steps):
        twin.step(dt, [(*weights[i], twist[i]) for i in range(24)])
    d = grains.discs
    assert grains.pairs.builds > 1
    assert measure.coordination(grains) > 0 or grains.wall_spring.any()
    # Same arithmetic in another order: 1e-16 a step, enlarged by collisions (a factor of about 10 each, 5
    # each).
    for name, fast, slow in (
        ("x", d.position[:, 0], [b.x for b in twin.bodies]),
        ("y", d.position[:, 1], [b.y for b in twin.bodies]),
        ("angle", d.angle * d.radius, [b.angle * b.r for b in twin.bodies]),
    ):
        np.testing.assert_allclose(fast, slow, atol=1e-10 * 0.1, rtol=0, err_msg=name)
    assert grains.plates[0, LOW] == pytest.approx(twin.plates[0][1], rel=1e-12)


def compress(grains):
    """A state with contacts everywhere: every disc 8 % larger than the room it has."""
    grains.discs.radius[:] = 0.0113
    grains.refresh()
    return grains


def test_kernels_do_the_same_as_plain_python():
    # Python checks the bounds that compiled code does not.
    a, b = compress(grains_in_a_box()), compress(grains_in_a_box())
    for grains, plain in ((a, False), (b, True)):
        d, pairs, law = grains.disc_arrays(), grains.pair_arrays(), grains.contact
        call = (lambda kernel: kernel.py_func) if plain else (lambda kernel: kernel)
        d.external_force[:], d.external_torque[:] = 1.0, 1.0
        call(forces.start_forces)(d)
        call(pair_forces)(d, pairs, law, 1e-5, Still(0.0, 0.0), *(it[0] for it in scratch(1)))
        near = np.ones((len(grains.walls), walls.runs_of(len(d.radius))), np.uint8)
        call(walls.add_near_walls)(d, *grains.surface("wall"), 0, near, 0, len(d.radius), law, 1e-5)
        call(add_rectangle_forces)(d, *grains.surface("plate"), 0, 0, len(d.radius), law, 1e-5)
        call(kick.kick_drift)(d, pairs.checked_position, 1.0, 3.0, 1e-5)
        grains.kept = call(measure.survey_pairs)(d.position, d.radius, pairs, grains.cell, grains.touching)
    assert (a.touching > 1).all()
    assert a.plate_force.any()
    assert a.kept == b.kept
    for name, one in a.state()["discs"].items():
        np.testing.assert_array_equal(one, b.state()["discs"][name], err_msg=name)
    for name in ("wall_spring", "plate_spring", "wall_force", "plate_force", "touching"):
        np.testing.assert_array_equal(getattr(a, name), getattr(b, name), err_msg=name)


def test_walls_and_plates_feel_the_force_they_exert():
    grains = compress(grains_in_a_box(plates=[Plate(0.042, 0.0, 0.05)]))
    d = grains.discs
    grains.step(1e-9)
    # Pair forces cancel in the sum; 200 terms of order 1e3 N/m round at 1e-16 each.
    total = d.force.sum(axis=0) + grains.wall_force.sum(axis=0) + grains.plate_force.sum(axis=0)
    assert np.abs(grains.wall_force).sum() > 1e2
    np.testing.assert_allclose(total, 0.0, atol=200 * 1e-16 * 1e5)


def test_a_call_of_many_steps_equals_many_calls():
    one, many = grains_in_a_box(), grains_in_a_box()
    one.step(1e-5, count=300)
    for _ in range(100):
        many.step(1e-5, count=3)
    assert not differing(one, many)
    assert one.pairs.builds == many.pairs.builds > 1


@pytest.mark.parametrize("before", [1, 137, 250])
def test_a_restart_equals_the_uninterrupted_run_bit_for_bit(before, tmp_path):
    through, first, second = (grains_in_a_box() for _ in range(3))
    through.step(1e-5, count=600)
    second.discs.position += 0.3  # nothing of the fresh one may survive
    assert not differing(through, saved_on_the_way(first, second, 1e-5, 600, before, tmp_path))


def test_without_its_springs_a_restart_takes_another_path():  # the twin that must fail
    through, forgetful = (compress(grains_in_a_box()) for _ in range(2))
    through.step(1e-6, count=40)
    forgetful.step(1e-6, count=20)
    forgetful.pairs.carried[:] = 0.0
    forgetful.step(1e-6, count=20)
    assert not np.array_equal(through.discs.velocity, forgetful.discs.velocity)


def test_the_skin_does_not_change_what_happens():
    thin, thick = grains_in_a_box(skin=2e-4), grains_in_a_box(skin=8e-3)
    for grains in (thin, thick):
        grains.step(1e-5, count=500)
    assert thin.pairs.builds > 5 * thick.pairs.builds
    np.testing.assert_array_equal(thin.discs.position, thick.discs.position)  # rows are sorted: same sums


def test_a_periodic_side_joins_left_and_right():
    # A row of discs around the seam does the same wherever the seam lies; positions of order 1 round to 1e-16,
    # amplified by stiffness times steps^2 dt^2 / m = 40.
    ends = []
    for shift in (0.0, 0.05):
        x = np.array([[0.002 + shift, 0.0], [0.091 + shift, 0.001], [0.0215 + shift, -0.001]])
        grains = Grains(
            make_discs(x, 0.01, DENSITY, velocity=[[0, 0], [1.0, 0.5], [-1.0, 0.0]], spin=[0.0, 30.0, 0.0]),
            LAW,
            Box((0.0, -1.0), (0.1, 1.0), left="periodic", right="periodic", bottom="open", top="open"),
        )
        grains.step(1e-5, count=400)
        ends.append((grains.discs.position - [shift, 0.0], grains.discs.spin))
    assert abs(ends[0][1]).min() > 1.0  # all three have met
    np.testing.assert_allclose(ends[0][0], ends[1][0], atol=1e-13)


def test_a_plate_holds_until_it_is_removed_and_then_is_nothing():
    def column():
        discs = make_discs([[0.0101, 0.0]], 0.01, DENSITY, velocity=[[-1.0, 0.0]])
        box = Box((-1.0, -1.0), (1.0, 1.0), "open", "open", "open", "open")
        return Grains(discs, LAW, box, plates=[Plate(0.0, -0.1, 0.1, name="gate")])

    held, freed = column(), column()
    held.step(1e-5, count=2000)
    assert held.discs.velocity[0, 0] > 0.0
    assert held.discs.velocity[0, 0] == pytest.approx(LAW.restitution(held.discs.mass[0]), abs=1e-2)  # T_c/1000
    freed.remove_plate("gate")
    freed.step(1e-5, count=2000)
    assert freed.discs.velocity[0, 0] == -1.0
    with pytest.raises(InputError, match=r"no such plate.*gate"):
        held.remove_plate("gat")


def test_a_plate_is_met_at_its_end_along_the_line_to_the_end():
    discs = make_discs([[0.0, 0.0]], 0.01, DENSITY)
    box = Box((-1.0, -1.0), (1.0, 1.0), "open", "open", "open", "open")
    grains = Grains(discs, LAW.with_friction(0.0), box, plates=[Plate(0.005, 0.005, 0.1)])
    grains.step(1e-9)
    push = LAW.stiffness * (0.01 - 0.005 * np.sqrt(2.0)) / np.sqrt(2.0)
    np.testing.assert_allclose(discs.force[0], [-push, -push], rtol=1e-14)


def test_a_rising_plate_drags_grains_up_only_by_its_friction():
    lifted = []
    for friction in (0.0, 0.5):
        discs = make_discs([[0.0099, 0.0]], 0.01, DENSITY)
        box = Box((-1.0, -1.0), (1.0, 1.0), "open", "open", "open", "open")
        grains = Grains(discs, LAW, box, plates=[Plate(0.0, -0.1, 0.1, friction=friction, name="gate")])
        grains.move_plate("gate", 1.0)
        grains.step(1e-5, np.array([[-20.0, 0.0]]), count=100)
        lifted.append(discs.velocity[0, 1])
    assert lifted[0] == 0.0
    assert lifted[1] > 0.0


def test_energy_is_kept_without_damping_and_friction():
    # Leap-frog at T_c/300: the energy of a bounce errs by (w dt)^2 = 1e-4 at most while in contact.
    law = Linear(1e6, 0.0, 0.0, 0.0, 0.0)
    grains = grains_in_a_box(law=law, plates=[])

    def energy():
        return measure.kinetic_energy(grains.discs) + sum(elastic(grains))

    start = energy()
    grains.step(law.contact_time(0.5 * grains.discs.mass.min()) / 300.0, count=3000)
    assert energy() == pytest.approx(start, rel=1e-2 * np.pi / 3)  # half-step speed lags by w dt


def test_unstable_grains_are_named():
    grains = grains_in_a_box()
    grains.step(1e-5)
    grains.check()
    grains.discs.velocity[7, 1] = np.nan
    with pytest.raises(Unstable, match="velocity = nan m/s at grain 7"):
        grains.check()


def test_a_number_that_is_none_stops_the_run_before_the_search():
    grains = grains_in_a_box()
    grains.step(1e-5)
    grains.discs.velocity[3] = np.nan
    with pytest.raises(Unstable, match="at grain 3"):
        grains.step(1e-5, count=10)


@pytest.mark.parametrize(
    ("spoil", "text"),
    [
        (lambda d: d.velocity.__setitem__(5, 1e4), "speed = 1.414e\\+04 m/s at grain 5"),
        (
            lambda d: d.position.__setitem__(6, (-1e-3, 0.05)),
            "distance to the left wall = -0.001 m at grain 6",
        ),
        (lambda d: d.position.__setitem__(2, d.position[1] + 1e-3), "overlap with grain 2 .* at grain 1"),
    ],
)
def test_a_state_beyond_sense_is_unstable(spoil, text):
    grains = grains_in_a_box()
    grains.step(1e-5)
    spoil(grains.discs)
    grains.refresh()
    with pytest.raises(Unstable, match=text):
        grains.check()


def test_what_no_force_moves_is_named_and_has_a_repair_of_its_own():
    grains = grains_in_a_box()
    grains.hold(1)
    grains.hold(2)
    grains.steering.control(3, x=Moved(0.0))
    grains.step(1e-5)
    grains.discs.position[2] = grains.discs.position[1] + 1e-3
    grains.refresh()
    with pytest.raises(Unstable, match=r"overlap with held disc 1 .* at held disc 0; its motion is prescribed"):
        grains.check()
    grains.discs.position[2] = grains.discs.position[3] + 1e-3
    grains.refresh()
    with pytest.raises(Unstable, match=r"overlap with grain 3 .* at held disc 1; its motion is prescribed"):
        grains.check()
    grains.discs.position[2] = grains.discs.position[4] + 1e-3  # which is free: stiffness keeps it out
    grains.refresh()
    with pytest.raises(Unstable, match=r"overlap with grain 4 .* at held disc 1; raise the stiffness"):
        grains.check()
    grains.hold(2, rotation=False)
    grains.discs.position[2] = 1e-4, 0.05
    grains.refresh()
    with pytest.raises(Unstable, match=r"overlap with the left wall .* at grain 2; its motion is prescribed"):
        grains.check()


def test_a_step_beyond_the_limit_is_caught():
    grains = compress(grains_in_a_box())

    def run():
        for _ in range(200):
            grains.step(3.0 * packing_limit(LAW, grains.discs.mass.min()), count=10)
            grains.check()

    with pytest.raises(Unstable):
        run()


@pytest.mark.parametrize(
    ("make", "key"),
    [
        (lambda: Box((0, 0), (1, 1), left="periodic"), "box.left"),
        (lambda: Box((0, 0), (1, 1), top="soft"), "box.top"),
        (lambda: Box((0, 0), (0, 1)), "box.upper"),
        (lambda: Plate(0.0, 1.0, 0.5), "plate.y_high"),
        (lambda: make_discs([[0, 0]], -1.0, 1.0), "grains.radius"),
        (lambda: make_discs([[0, np.inf]], 1.0, 1.0), "grains.position"),
        (lambda: make_discs([[1, 2, 0], [3, 4, 0]], 1.0, 1.0), r"grains.position: .*\(2, 3\).*shape \(n, 2\)"),
        (lambda: make_discs([1, 2, 0], 1.0, 1.0), "grains.position"),
        (lambda: make_discs([[0, 0], [1, 1]], [1.0, 1.0, 1.0], 1.0), "grains.radius"),
        (lambda: make_discs([[0, 0]], 1.0, 1.0, velocity=(np.nan, 0.0)), "grains.velocity = nan m/s: of grain 0"),
        (lambda: make_discs([[0, 0]], 1.0, 1.0, spin=np.inf), "grains.spin"),
        (lambda: make_discs([[0, 0]], 1.0, 1.0, angle=[np.nan]), "grains.angle"),
        (lambda: grains_in_a_box().restore(grains_in_a_box(count=5).state()), "state.position"),
    ],
)
def test_wrong_input_is_refused_by_name(make, key):
    with pytest.raises(InputError, match=key):
        make()


def test_one_pair_of_numbers_is_the_position_of_one_disc():
    discs = make_discs((1.0, 2.0), 0.1, 1.0, velocity=(3.0, 4.0))
    assert discs.position.tolist() == [[1.0, 2.0]]
    assert discs.velocity.tolist() == [[3.0, 4.0]]


def test_no_grains_is_a_system_too():
    grains = Grains(make_discs(np.zeros((0, 2)), 1.0, 1.0), LAW, Box((0, 0), (1, 1)))
    grains.step(1e-3, count=5)
    grains.check()
    assert measure.coordination(grains) == 0.0


def test_a_disc_among_many_small_ones_of_its_mass_is_as_heavy_as_the_step_asks():
    radius = np.array([1.0, 2.0, 20.0])
    heavier = crowded(radius)
    assert heavier[:2].tolist() == [1.0, 1.0]  # six, and nine round twice the radius: 0.8**-2 of six
    for r, factor in zip(radius, heavier, strict=True):
        count = int(np.pi / np.arcsin(1.0 / (1.0 + r)))  # discs of 1 that touch it and not each other
        angle = 2.0 * np.pi * np.arange(count) / count
        frequency = 2.0 * np.sum(np.cos(angle) ** 2) / factor  # along x, contacts twice as stiff: see packing_factor
        allowed = packing_factor(1.0, 0.0) / SAFETY**2
        assert frequency <= allowed * (1.0 + 1e-12)  # round-off of 65 terms
        assert r < 20.0 or frequency * factor > 5.0 * allowed  # the check that must fail: 65 of them, one mass
