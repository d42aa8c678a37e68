"""Bodies move or are pushed as prescribed, and what that takes is on record; walls likewise."""

import math

import numpy as np
import pytest

from porescale.common.core.errors import InputError
from porescale.dem.arrays import contact_arrays
from porescale.dem.contact.linear import Linear
from porescale.dem.discs import make_discs
from porescale.dem.forces.walls import Box
from porescale.dem.grains import Grains
from porescale.dem.measures.survey import kinetic_energy
from porescale.dem.motion import control, servo
from porescale.dem.motion import time_function as schedule
from porescale.dem.motion.control import Moved, Placed, Pushed
from porescale.dem.motion.drivers import Clump
from porescale.dem.motion.time_function import Sine, Table, schedule_rows, value_at

LAW = Linear(1e6, 5.0, 3e5, 4.0, 0.4)
FREE = Box((-1.0, -1.0), (1.0, 1.0), "open", "open", "open", "open")
EPS = np.finfo(float).eps
DT = 1e-5


def apart(count=3):
    """Discs of 1 cm that do not touch, in free space."""
    return Grains(make_discs([[0.1 * k, 0.0] for k in range(count)], 0.01, 2000.0), LAW, FREE)


@pytest.mark.parametrize("compiled", [True, False])
def test_schedules_are_what_they_say(compiled):
    rows, points = schedule_rows([3.0, -1.0, Sine(2.0, 5.0, 0.3, 1.0), Table([0.0, 1.0, 3.0], [1.0, 2.0, 0.0])])
    at = value_at if compiled else value_at.py_func
    assert at(rows, points, 0, 7.0) == 3.0
    assert at(rows, points, 1, 7.0) == -1.0
    assert at(rows, points, 2, 0.02) == pytest.approx(1.0 + 2.0 * math.sin(2 * math.pi * 5.0 * 0.02 + 0.3), rel=1e-15)
    assert [at(rows, points, 3, t) for t in (-1.0, 0.0, 0.5, 1.0, 2.0, 3.0, 9.0)] == [1.0, 1.0, 1.5, 2.0, 1.0, 0.0, 0.0]


@pytest.mark.parametrize("wrong", [Table([0.0, 0.0], [1.0, 2.0]), Table([], []), Table([0.0], [1.0, 2.0]), math.nan])
def test_a_schedule_without_sense_is_refused(wrong):
    with pytest.raises(InputError, match="schedule"):
        schedule_rows([wrong])


def test_a_place_is_met_to_round_off_however_the_steps_are_cut():
    ends = []
    for cut in (1, 10):
        grains = apart()
        grains.steering.control(0, x=Placed(Sine(1e-3, 40.0)), rotation=Placed(Table([0.0, 0.01], [0.0, 0.5])))
        for _ in range(1000 // cut):
            grains.step(DT, count=cut)
        ends.append((grains.discs.position[0, 0], grains.discs.angle[0]))
        # 1000 sums of differences that round to eps of the largest displacement.
        assert ends[-1][0] == pytest.approx(1e-3 * math.sin(2 * math.pi * 40.0 * 0.01), abs=1000 * EPS * 1e-3)
        assert ends[-1][1] == pytest.approx(0.5, abs=1000 * EPS)
    assert ends[0] == ends[1]


def test_a_velocity_is_taken_at_the_middle_of_the_step():
    # The midpoint rule integrates a straight line exactly: x = 2 t^2 at rates of 4 t.
    grains = apart()
    grains.steering.control(1, y=Moved(Table([0.0, 1.0], [0.0, 4.0])))
    grains.step(DT, count=1000)
    assert grains.discs.position[1, 1] == pytest.approx(2.0 * 0.01**2, rel=1000 * EPS)


def test_a_push_accelerates_and_its_work_is_the_kinetic_energy():
    grains = apart()
    mass, inertia = grains.discs.mass[2], grains.discs.inertia[2]
    grains.steering.control(2, x=Pushed(Table([0.0, 0.01], [0.0, 5.0])), rotation=Pushed(1e-3))
    grains.step(DT, count=1000)
    # Rectangles under a straight line, from its lower end: short by half a step in 1000.
    assert grains.discs.velocity[2, 0] == pytest.approx(0.5 * 5.0 * 0.01 / mass * (1 - 1e-3), rel=1e-10)
    assert grains.discs.spin[2] == pytest.approx(1e-3 * 0.01 / inertia, rel=1e-12)
    assert grains.steering.work()[1] == pytest.approx(kinetic_energy(grains.discs), rel=1e-12)
    assert grains.steering.work()[0] == 0.0


def test_what_moves_a_disc_supplies_its_acceleration_and_the_force_of_its_contacts():
    grains = Grains(make_discs([[0.0, 0.0], [0.0199, 0.0]], 0.01, 2000.0), LAW, FREE)
    grains.steering.control(0)  # nothing held: free
    grains.steering.control(1, x=Moved(0.0), y=Moved(0.0), rotation=Moved(0.0))
    grains.steering.watch(1)
    weight = np.array([[0.0, 0.0], [3.0, -7.0]])
    grains.step(1e-7, weight)
    (row,) = grains.steering.record()
    push = LAW.stiffness * 1e-4
    np.testing.assert_allclose(row.contact, [push, 0.0, 0.0], rtol=1e-12, atol=1e-12)
    np.testing.assert_allclose(row.supply, [-push - 3.0, 7.0, 0.0], rtol=1e-12, atol=1e-12)
    np.testing.assert_allclose(grains.withheld[1], [push + 3.0, -7.0, 0.0], rtol=1e-12, atol=1e-12)
    assert row.displacement == (0.0, 0.0, 0.0)


def test_a_restored_system_has_the_same_record_of_loads():
    def pressed_pair():
        grains = Grains(make_discs([[0.0, 0.0], [0.0199, 0.0]], 0.01, 2000.0), LAW, FREE)
        grains.steering.control(1, x=Moved(0.0), y=Pushed(3.0))
        grains.steering.watch(1)
        return grains

    whole, again = pressed_pair(), pressed_pair()
    whole.step(DT, count=4)
    again.restore(whole.state())
    assert again.steering.record() == whole.steering.record()
    assert whole.steering.record()[0].supply[1] == pytest.approx(3.0)
    assert pressed_pair().steering.record() != whole.steering.record()  # the check that must fail


def test_the_work_of_a_piston_is_what_the_spring_stores():
    # A disc pushed onto a wall without damping: stored k d^2/2, the force lagging by a step in 1000.
    law = Linear(1e6)
    grains = Grains(make_discs([[0.01, 0.5]], 0.01, 2000.0), law, Box((0.0, 0.0), (1.0, 1.0)))
    grains.steering.control(0, x=Moved(-0.1), y=Moved(), rotation=Moved())
    grains.step(DT, count=1000)
    depth = 0.1 * 0.01
    before = 0.5 * grains.discs.mass[0] * 0.1**2  # it is set going from rest
    assert grains.steering.work()[0] == pytest.approx(0.5 * 1e6 * depth**2 + before, rel=2e-3)


def test_without_the_push_the_work_is_not_there():  # the twin that must fail
    grains = apart()
    grains.discs.velocity[2] = 1.0
    grains.steering.control(2, x=Pushed(0.0))
    grains.step(DT, count=10)
    assert grains.steering.work() == (0.0, 0.0)


def test_a_clump_moves_as_prescribed_and_is_on_record():
    grains = Grains(make_discs([[0.0, 0.0], [0.015, 0.0], [0.1, 0.0]], 0.01, 2000.0), LAW, FREE)
    grains.steering.bind([[0, 1]], 2000.0)
    grains.steering.control(Clump(0), y=Moved(0.2), rotation=Placed(Table([DT, DT + 0.01], [0.0, 1.0])))
    weights = np.array([[0.0, -1.0], [0.0, -3.0], [0.0, 0.0]])
    grains.step(DT, weights)  # sets it going
    grains.steering.watch(Clump(0), 2)
    grains.step(DT, weights, count=1000)
    row, other = grains.steering.record()
    np.testing.assert_allclose(row.displacement, [0.0, 0.002, 1.0], atol=1000 * EPS)
    # Only weights act: no contact; 4 N/m up, and about the centroid the unequal weights' moment.
    np.testing.assert_allclose(row.contact, 0.0, atol=1e-12)
    assert row.supply[1] == pytest.approx(4.0, rel=1e-12)
    assert other.displacement == (0.0, 0.0, 0.0)
    assert np.hypot(*(grains.discs.position[1] - grains.discs.position[0])) == pytest.approx(0.015, rel=1e-14)


def test_letting_go_frees_and_holding_holds():
    grains = apart()
    grains.steering.control(0, x=Moved(1.0))
    assert grains.held[0].tolist() == [1, 0, 0]
    grains.step(DT)
    grains.steering.control(0)
    assert grains.held[0].tolist() == [0, 0, 0]
    grains.step(DT, np.array([[2.0, 0.0], [0.0, 0.0], [0.0, 0.0]]), count=10)
    assert grains.discs.velocity[0, 0] > 1.0


def test_kernels_do_the_same_as_plain_python():
    made = []
    rows, points = schedule_rows([Sine(1.0, 3.0), 2.0, Table([0.0, 1.0], [0.0, 1.0])])
    table = np.array([[0, 0, 0, control.VELOCITY], [0, 1, 1, control.PUSH], [0, 1, 2, control.PLACE]], np.int64)
    for plain in (False, True):
        run = (lambda kernel: kernel.py_func) if plain else (lambda kernel: kernel)
        state = [np.full((2, 2), 0.5), np.full(2, 0.2), np.full(2, 3.0), np.full(2, 0.1), np.ones((2, 2)), np.ones(2)]
        given = np.zeros((3, 2))
        for k in range(3):
            bodies = contact_arrays(np.zeros((2, 2)), state[0], state[1], np.ones(2), np.ones(2))._replace(
                mass=state[2], inertia=state[3], force=state[4], torque=state[5]
            )
            run(control.apply_control)(table, given, k, rows, points, bodies, 0.1, 1e-3)
        walls = np.array([[0.0, 0.0, 0.0, 1.0, 0, 0, 0], [1.0, 0.0, -0.6, 0.8, 0, 0, 0]])
        drive = np.array([[0, servo.BY_STRESS, 0, 1], [1, servo.GIVEN_TURN, -1, -1]], np.int64)
        numbers = np.array([[1e5, 3.0, 0.5, 0.2, 0.0, 0.01], [0.0] * 6])
        load = np.array([[0.0, -3.0, 0.0], [0.0, 0.0, 0.0]])
        run(servo.drive_walls)(
            drive, numbers, rows, points, 0, walls, load, np.array([[0.1, 0.005]]), np.array([0.01]), 0.1, 1e-4
        )
        run(servo.move_walls)(walls, 0.1)
        made.append([*state, given, walls, numbers])
    for one, other in zip(*made, strict=True):
        np.testing.assert_array_equal(one, other)


def test_a_moving_wall_and_a_moving_disc_see_the_same_impact():
    # Galilei: a wall that comes at rest meets a disc as the disc comes to a wall.  Sums of other numbers round: 1e-16
    # of 1 m/s per step, stiffened by k dt/m = 16/s dt over the contact.
    still, coming = (Grains(make_discs([[0.5, 0.0101]], 0.01, 2000.0), LAW, Box((0.0, 0.0), (1.0, 1.0)))
                     for _ in range(2))  # fmt: skip
    still.discs.velocity[0] = [0.3, -1.0]
    coming.steering.move_wall("bottom", x=-0.3, y=1.0)
    coming.walls[coming.wall_names.index("bottom"), 4:6] = [-0.3, 1.0]  # as it was half a step back
    for grains in (still, coming):
        grains.step(DT, count=300)
    assert still.discs.velocity[0, 1] > 0.5
    np.testing.assert_allclose(coming.discs.velocity[0] - still.discs.velocity[0], [-0.3, 1.0], rtol=0, atol=1e-11)
    np.testing.assert_allclose(coming.discs.spin, still.discs.spin, rtol=0, atol=1e-9)
    assert coming.walls[2, 1] == pytest.approx(300 * DT, rel=1e-12)


def test_a_wall_turns_about_its_point_and_strikes_with_the_speed_it_has_there():
    grains = Grains(make_discs([[0.3, 0.0105], [-0.2, 0.05]], 0.01, 2000.0), Linear(1e6), FREE)
    grains.add_wall("lever", (0.0, 0.0), (0.0, 2.0))
    grains.steering.move_wall("lever", turn=1.0)
    grains.step(DT, count=800)
    # Elastic: twice the wall's speed, 0.3 m/s, along its normal; to a step in the contact, and the turn meanwhile.
    assert grains.discs.velocity[0, 1] == pytest.approx(0.6, rel=0.02)
    assert np.all(grains.discs.velocity[1] == 0.0)
    assert math.atan2(-grains.walls[0, 2], grains.walls[0, 3]) == pytest.approx(800 * DT, rel=1e-12)


def test_the_moment_on_a_wall_is_force_times_lever():
    grains = Grains(make_discs([[0.3, 0.0099]], 0.01, 2000.0), Linear(1e6), Box((0.0, 0.0), (1.0, 1.0)))
    grains.step(1e-9)
    assert grains.wall_force[2].tolist() == pytest.approx([0.0, -100.0], rel=1e-12)
    assert grains.wall_moment[2] == pytest.approx(-30.0, rel=1e-12)


def test_a_wall_of_its_own_is_like_a_side():
    made = []
    for own in (False, True):
        box = Box((0.0, 0.0), (1.0, 1.0), bottom="open" if own else "solid")
        grains = Grains(make_discs([[0.5, 0.0101]], 0.01, 2000.0, [[0.4, -1.0]]), LAW, box)
        if own:
            grains.add_wall("floor", (0.0, 0.0), (0.0, 3.0))
            with pytest.raises(InputError, match="is taken"):
                grains.add_wall("floor", (0.0, 0.0), (0.0, 1.0))
            with pytest.raises(InputError, match="no length"):
                grains.add_wall("other", (0.0, 0.0), (0.0, 0.0))
        grains.step(DT, count=300)
        made.append(grains.discs.velocity)
    np.testing.assert_array_equal(*made)


def pressed(dashpot=0.0):
    """Four discs that are held, half a millimetre above a floor that comes up as a servo, in contact from the start."""
    discs = make_discs([[0.1 * k, 0.0099] for k in range(1, 5)], 0.01, 2000.0)
    grains = Grains(discs, Linear(1e6, dashpot), Box((0.0, 0.0), (1.0, 1.0)))
    grains.hold(slice(None))
    return grains


@pytest.mark.parametrize("dashpot", [0.0, 3.0, 300.0])
@pytest.mark.parametrize(("share", "stable"), [(0.5, True), (1.9, True), (4.1, False)])
def test_a_servo_is_stable_below_its_bound_and_not_above(dashpot, share, stable):
    grains = pressed(dashpot)
    grains.steering.servo_wall("bottom", force=500.0, speed=1e3, share=min(share, 1.9))
    grains.steering._servo[:, servo.SHARE] = share
    # Slowest where a root of servo.py's polynomial comes nearest the circle: share 0.5 with the large dashpot leaves
    # 1 - gK dt/(2 (1 + gC)) = 0.9967 a step, 8000 steps exp(-26).  Large moves would part them: 1e-4 at most.
    first = None
    for _ in range(8000):
        grains.step(DT)
        error = abs(-grains.wall_force[2, 1] - 500.0)
        first = first or error
        if not error < 1e3:
            break
    if stable:
        assert error < 1e-6 * first
    else:
        assert not error < first


def test_a_servo_without_dashpots_closes_on_its_load_without_oscillation():
    grains = pressed()
    grains.steering.servo_wall("bottom", force=500.0, speed=1e3, share=0.25)
    errors = []
    for _ in range(40):
        grains.step(DT)
        errors.append(-grains.wall_force[2, 1] - 500.0)
    # (z - 1)^2 + share (z - 1 + share/4) = 0 has the double root r = 1 - share/2; from 1 and 1 - share: (1 - n/7) r^n.
    # Past the load once, by 0.875^14 = 0.154 at most.
    n, e = np.arange(40), np.array(errors)
    np.testing.assert_allclose(e / e[0], (1.0 - n / 7.0) * 0.875**n, rtol=0, atol=1e-9)


def test_a_servo_presses_as_wanted_on_discs_that_give_way():
    # The discs go up at 0.1 m/s; what PFC's servo alone is off by, V/g = V N k dt/share, takes 0.75^n of 1 to vanish.
    ahead, alone = pressed(), pressed()
    for grains in (ahead, alone):
        grains.discs.velocity[:, 1] = 0.1
        grains.steering.servo_wall("bottom", force=500.0, speed=1e3)
    for _ in range(200):
        ahead.step(DT)
        alone.step(DT)
        alone.steering._servo[:, servo.AHEAD] = 0.0
    assert -ahead.wall_force[2, 1] == pytest.approx(500.0, rel=1e-9)
    assert -alone.wall_force[2, 1] == pytest.approx(500.0 - 0.1 * 4 * 1e6 * DT / 0.5, rel=1e-9)


def test_a_stress_acts_over_the_distance_of_two_walls():
    grains = pressed()
    grains.steering.move_wall("right", x=-1.0)
    grains.steering.servo_wall("bottom", stress=600.0, speed=1e3, between=("left", "right"))
    grains.step(DT, count=2000)
    # Follows a length that shrinks by dt a step, a share of 1/2 of what is missing: one step of 6e-3 N/m behind.
    assert -grains.wall_force[2, 1] == pytest.approx(600.0 * (1.0 - 2000 * DT), abs=0.02)
    fixed = pressed()
    fixed.steering.servo_wall("bottom", stress=600.0, speed=1e3, length=0.5)
    fixed.step(DT, count=2000)
    assert -fixed.wall_force[2, 1] == pytest.approx(300.0, rel=1e-9)


def test_a_servo_that_touches_nothing_comes_at_its_speed():
    grains = apart()
    grains.add_wall("plate", (0.0, -0.5), (0.0, 1.0))
    grains.steering.servo_wall("plate", force=10.0, speed=0.2)
    grains.step(DT, count=100)
    assert grains.walls[0, 1] == pytest.approx(-0.5 + 0.2 * 100 * DT, rel=1e-12)


@pytest.mark.parametrize(
    ("given", "key"),
    [
        ({"speed": 1.0}, "either force or stress"),
        ({"force": 1.0, "stress": 1.0, "speed": 1.0}, "either force or stress"),
        ({"stress": 1.0, "speed": 1.0}, "either length or between"),
        ({"force": 1.0, "speed": 0.0}, "speed"),
        ({"force": 1.0, "speed": 1.0, "share": 2.0}, "share"),
        ({"stress": 1.0, "speed": 1.0, "between": ("left", "rigth")}, "no such wall"),
    ],
)
def test_a_servo_without_sense_is_refused(given, key):
    with pytest.raises(InputError, match=key):
        pressed().steering.servo_wall("bottom", **given)


def test_rows_of_a_table_follow_each_other():
    rows, points = schedule_rows([Table([0.0], [1.0]), Table([1.0, 2.0], [3.0, 4.0])])
    assert rows[:, [schedule.FIRST, schedule.LAST]].tolist() == [[0.0, 1.0], [1.0, 3.0]]
    assert len(points) == 3


def test_a_call_of_no_steps_changes_nothing_of_what_holders_and_controls_bore():
    grains, weight = apart(2), np.array([[0.0, -2.0], [0.0, 0.0]])
    grains.hold(0)
    grains.steering.control(1, x=Moved(0.01))
    grains.steering.watch(1)
    grains.step(DT, weight, count=4)
    held, (line,) = grains.withheld.copy(), grains.steering.record()
    grains.step(DT, weight, count=0)
    assert held[0].tolist() == [0.0, -2.0, 0.0]
    np.testing.assert_array_equal(grains.withheld, held)
    assert grains.steering.record() == [line]
    grains.step(DT, weight, count=1)  # the check that must fail: a step changes what the control gives
    assert grains.steering.record() != [line]
