"""Contact steps of discs that are all held, at rest and without contact are left out, to the same bits; others not."""

import copy

import numpy as np
import pytest

from porescale.dem import grains as system
from porescale.dem.contact.linear import Linear
from porescale.dem.discs import make_discs
from porescale.dem.forces.walls import PY, Box, Plate
from porescale.dem.grains import Grains
from porescale.dem.motion.periodic_cell import Still
from porescale.dem.resting.static import bear, clear, resting, unchanged
from porescale.dem.state import StaticState
from porescale.validation.coupling import setups as lab
from tests.reference.dem.restarted import differing

LAW = Linear(1e4, 1.0, 2.5e3, 0.5, 0.5)
DT = 1e-4
PLACES = [(0.1, 0.1), (0.35, 0.1), (0.62, 0.3)]


def row(*, hold=True, energy=False, plates=(), places=PLACES):
    grains = Grains(make_discs(places, 0.1, 2000.0), LAW, Box((0.0, 0.0), (1.0, 1.0)), energy=energy, plates=plates)
    if hold:
        grains.hold(slice(None))
    return grains


def outside(step):
    """Force and torque that are others at every step, with thirds that sums must round."""
    rng = np.random.default_rng(step)
    return rng.normal(size=(3, 2)) / 3, rng.normal(size=3) / 7


def counted(monkeypatch):
    """How many contact steps have been done in full."""
    done, real = [0], system.contact_steps

    def steps(count, *others):
        result = real(count, *others)
        done[0] += result[0]
        return result

    monkeypatch.setattr(system, "contact_steps", steps)
    return done


def in_full(monkeypatch):
    monkeypatch.setattr(system, "leave_out", lambda *_: False)


def run(grains, calls=6, count=3, drag=0.0, given=outside):
    for step in range(calls):
        grains.step(DT, *given(step), count=count, drag=drag)
    return grains


@pytest.mark.parametrize("drag", [0.0, 5.0])
def test_what_stands_is_left_out_to_the_same_bits(monkeypatch, drag):
    done = counted(monkeypatch)
    short = run(row(), drag=drag)
    assert done == [3]  # the first call alone
    with monkeypatch.context() as patch:
        in_full(patch)
        whole = run(row(), drag=drag)
    assert done == [3 + 18]
    assert not differing(short, whole)
    assert np.all(short.withheld[:, :2] != 0.0)
    np.testing.assert_array_equal(short.discs.force, 0.0)
    assert short.steps == 18
    assert short.time == whole.time


def nothing(_):
    return None, None


def listed(step):
    force, torque = outside(step)
    return force.tolist(), torque.tolist()


def weight(step):
    return (0.0, -9.81 - step), None


def spun(step):
    return None, outside(step)[1]


@pytest.mark.parametrize("given", [nothing, listed, weight, spun])
def test_forces_may_be_none_lists_or_one_for_all(monkeypatch, given):
    done = counted(monkeypatch)
    short = run(row(), given=given)
    assert done == [3]
    in_full(monkeypatch)
    whole = run(row(), given=given)
    assert done == [3 + 18]
    assert not differing(short, whole)
    assert np.any(short.withheld != 0.0) or given is nothing


def loose(grains):
    grains.hold(1, x=False, y=True, rotation=True)


def spinning(grains):
    grains.discs.spin[2] = 0.1


def towed(grains):
    grains.discs.velocity[0, 1] = 1e-3


def put_elsewhere(grains):
    grains.discs.position[1, 1] += 1e-4
    grains.refresh()


def put_beside(grains):
    grains.discs.position[1] = (0.29, 0.1)  # overlaps the first
    grains.refresh()


def wall_across(grains):
    grains.add_wall("slope", (0.0, 0.03), (0.0, 1.0))


def bottom_raised(grains):
    grains.walls[grains.wall_names.index("bottom"), PY] += 0.02


def grown(grains):
    grains.discs.radius[1] += 0.02  # into the bottom, not to the first


def lowered(grains):
    grains.discs.position[1, 1] -= 0.01


def shifted(grains):
    grains.discs.position[2, 0] += 1e-3  # touches nothing there either


CHANGES = [loose, spinning, towed, put_elsewhere, put_beside, wall_across, bottom_raised, grown, lowered, shifted]


@pytest.mark.parametrize("change", CHANGES)
def test_what_may_move_or_touches_is_not_left_out(monkeypatch, change):
    done = counted(monkeypatch)
    grains, twin, alike = run(row()), run(row()), run(row())
    done[0] = 0
    change(grains)
    change(twin)
    run(grains, calls=1, count=2)
    assert done[0] == 2
    run(grains)
    with monkeypatch.context() as patch:
        in_full(patch)
        run(twin, calls=1, count=2)
        run(twin)
    assert not differing(grains, twin)
    run(alike, calls=1, count=2)
    run(alike)
    assert differing(grains, alike)


def test_without_a_change_all_is_the_same():  # the twin of what is compared last above
    grains, alike = run(row()), run(row())
    assert not differing(run(grains, calls=1, count=2), run(alike, calls=1, count=2))


@pytest.mark.parametrize(
    ("change", "disc", "push"),
    [
        (bottom_raised, 1, (0.0, 1e4 * 0.02)),
        (grown, 1, (0.0, 1e4 * 0.02)),
        (lowered, 1, (0.0, 1e4 * 0.01)),
        (shifted, 2, (0.0, 0.0)),
    ],
)
def test_what_owners_write_in_place_is_felt_at_once(change, disc, push):
    grains = run(row())
    change(grains)
    run(grains, calls=1)
    # 16 roundings of places up to 1 m, each 1e4 N/m times eps/2: 2e-11 N/m
    np.testing.assert_allclose(grains.withheld[disc, :2] - outside(0)[0][disc], push, rtol=0, atol=2e-11)


def test_what_stands_is_copied_to_one_place():
    grains = run(row())
    first = grains.static
    grains.walls[:, PY] -= 0.1
    shifted(grains)
    run(grains)
    assert grains.static.position is first.position
    assert grains.static.radius is first.radius
    assert grains.static.walls is first.walls
    np.testing.assert_array_equal(first.position, grains.discs.position)
    np.testing.assert_array_equal(first.walls, grains.walls)
    assert not np.shares_memory(first.walls, grains.walls)


@pytest.mark.parametrize("more", [{"energy": True}, {"plates": [Plate(0.8, 0.0, 1.0, name="gate")]}, {"hold": False}])
def test_with_a_budget_a_plate_or_nothing_held_each_step_is_done(monkeypatch, more):
    done = counted(monkeypatch)
    grains = run(row(**more))
    assert done == [18]
    assert grains.static is None


def test_held_discs_that_touch_bear_their_contacts_step_by_step(monkeypatch):
    done = counted(monkeypatch)
    grains = run(row(places=[(0.1, 0.1), (0.29, 0.1), (0.62, 0.3)]))
    assert done == [18]
    assert grains.withheld[0, 0] - np.mean([outside(5)[0][0, 0]]) == pytest.approx(-1e4 * 0.01, rel=1e-9)


def test_a_restored_system_stands_on_to_the_same_bits(monkeypatch):
    done = counted(monkeypatch)
    whole = run(row())
    again = row()
    again.restore(copy.deepcopy(whole.state()))
    done[0] = 0
    run(again, calls=2)
    assert done == [3]
    run(whole, calls=2)
    assert not differing(whole, again)


def test_fluid_around_discs_that_stand_goes_on_to_the_same_bits(monkeypatch):
    def flow():
        places = [(15.0, 15.0), (28.9, 15.3)]
        coupled = lab.immersed((40, 30), places, 4.0, 2.0, acceleration=(0.0, -1e-5), ratio=0.9)
        coupled.grains.hold(slice(None))
        coupled.fluid.set_flow(0.02, 0.01)
        return coupled

    done = counted(monkeypatch)
    short = flow()
    for _ in range(10):
        short.advance()
    assert done == [short.contact_steps]
    in_full(monkeypatch)
    whole = flow()
    for _ in range(10):
        whole.advance()
    assert not differing(short, whole)
    np.testing.assert_array_equal(short.contact_load(), whole.contact_load())
    assert np.abs(short.grains.withheld).min() > 0.0


def test_the_kernels_say_the_same_compiled_or_not():
    grains = row()
    d, pairs, walls = grains.discs, grains.current_pairs(), grains.walls
    given, torque = outside(1)
    position, radius, sides = last = d.position.copy(), d.radius.copy(), walls.copy()
    others = (
        (position + 1.0, radius, sides),
        (position, 2.0 * radius, sides),
        (position, radius, sides - 1.0),
        (position, radius, sides[:-1]),
    )
    results = []
    kernels = resting, unchanged, clear, bear
    for rest, alike, touch, do in (kernels, [kernel.py_func for kernel in kernels]):
        withheld = np.zeros((3, 3))
        assert rest(grains.held, d.velocity, d.spin)
        assert touch(d.position, d.radius, pairs.start, pairs.partner, walls, Still(0.0, 0.0))
        discs = grains.disc_arrays()
        discs = discs._replace(external_force=given, external_torque=torque, withheld=withheld)
        for other in others:
            assert not alike(d.position, d.radius, walls, *other)
            assert not do(7, discs, walls, StaticState(*other, 1e-5, 0.0))
            np.testing.assert_array_equal(withheld, 0.0)
        assert alike(d.position, d.radius, walls, *last)
        assert do(7, discs, walls, StaticState(*last, 1e-5, 0.0))
        results.append(withheld)
    np.testing.assert_array_equal(*results)
