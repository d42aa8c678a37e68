"""Discs held or towed beside free ones: they move as prescribed, and their holders bear what they do not follow."""

import copy

import numpy as np
import pytest

from porescale.dem.arrays import contact_arrays
from porescale.dem.motion.leapfrog import withhold
from porescale.validation.coupling import setups as lab

EPS = np.finfo(float).eps
FALL = (1e-5, -5e-5)


def party(*, hold=True, sides=("periodic", "periodic")):
    """A handful of which the first is towed, the third held still along x only, the last held altogether."""
    coupled = lab.handful(sides=sides, acceleration=FALL)
    if hold:
        grains = coupled.grains
        grains.hold(0)
        grains.hold(2, x=True, y=False, rotation=False)
        grains.hold(np.arange(6) == 5)
    return coupled


def picture(coupled):
    d, grains = coupled.grains.discs, coupled.grains
    parts = (
        coupled.fluid.populations[:, 1:-1, 1:-1],
        d.position,
        d.velocity,
        d.spin,
        coupled.fluid_force,
        grains.withheld,
    )
    return [part.copy() for part in parts]


def test_held_components_keep_their_velocity_and_free_ones_do_not():
    coupled = party()
    d = coupled.grains.discs
    velocity, spin, start = d.velocity.copy(), d.spin.copy(), d.position.copy()
    for _ in range(60):
        coupled.advance()
    held = coupled.grains.held != 0
    np.testing.assert_array_equal(d.velocity[held[:, :2]], velocity[held[:, :2]])
    np.testing.assert_array_equal(d.spin[held[:, 2]], spin[held[:, 2]])
    assert np.all(d.velocity[~held[:, :2]] != velocity[~held[:, :2]])
    assert np.all(d.spin[~held[:, 2]] != spin[~held[:, 2]])
    # 240 contact steps, each rounds a position up to 64
    np.testing.assert_allclose(d.position[0], start[0] + 60 * velocity[0], rtol=0, atol=240 * 32 * EPS)


def book_error(steps, *, reaction=True, push=0.0):
    """Error of the momentum book of a party, the holders' reaction and what the owner adds counted in."""
    coupled = party()
    d, grains = coupled.grains.discs, coupled.grains
    size = float(np.sum(d.mass[:, None] * np.abs(d.velocity)))
    expected, worst, met = coupled.momentum(), 0.0, 0
    for step in range(steps):
        if step == steps // 2:  # the owner tows faster
            d.velocity[0] += push
            expected += d.mass[0] * push
        coupled.advance()
        expected += coupled.weight.sum(axis=0) - reaction * grains.withheld[:, :2].sum(axis=0)
        worst = max(worst, float(np.abs(coupled.momentum() - expected).max()))
        met += np.count_nonzero(coupled.contact_load()[grains.held != 0])
    assert met > 10  # held ones and free ones do meet
    return worst / size


@pytest.mark.parametrize("push", [0.0, 0.01])
def test_the_momentum_book_closes_with_what_the_holders_bear(push):
    # As for free discs: each of 300 fluid and 1200 contact steps rounds every velocity, all one way.
    assert book_error(300, push=push) < 1500 * EPS


def test_without_the_holders_the_book_does_not_close():
    assert book_error(300, reaction=False) > 1e-2


def test_contacts_between_held_discs_are_equal_and_opposite():
    coupled = lab.immersed((40, 30), [(15.0, 15.0), (22.9, 15.3)], 4.0, 2.0, acceleration=(0.0, -1e-5))
    coupled.grains.hold(slice(None))
    for _ in range(3):
        coupled.advance()
    met = coupled.contact_load()
    overlap = 8.0 - np.hypot(7.9, 0.3)
    assert met[0, 0] == pytest.approx(-lab.LAW.stiffness * overlap * 7.9 / np.hypot(7.9, 0.3), rel=1e-12)
    # cancelled from forces of some 0.2
    np.testing.assert_allclose(met[0, :2], -met[1, :2], rtol=0, atol=10 * EPS)
    d, grains = coupled.grains.discs, coupled.grains
    np.testing.assert_array_equal(d.force, 0.0)
    np.testing.assert_allclose(grains.withheld[:, :2] - coupled.force, met[:, :2], rtol=0, atol=1e-15)


@pytest.mark.parametrize("restart", [20, 41])
def test_a_restored_run_with_held_discs_goes_on_bit_for_bit(restart):
    whole, again = party(), party()
    for step in range(60):
        if step == restart:
            kept = copy.deepcopy(again.state())
            again = party(hold=False)
            again.restore(kept)
        for coupled in (whole, again):
            if step == 30:
                coupled.grains.discs.velocity[0] *= -1
            if step == 35:
                coupled.grains.hold(5, x=False, y=True, rotation=False)
            coupled.advance()
    for one, two in zip(picture(whole), picture(again), strict=True):
        np.testing.assert_array_equal(one, two)


def test_to_hold_nothing_changes_no_bit():
    one, two = party(hold=False), party(hold=False)
    two.grains.hold(slice(None), x=False, y=False, rotation=False)
    for _ in range(40):
        one.advance()
        two.advance()
    for a, b in zip(picture(one)[:-1], picture(two)[:-1], strict=True):
        np.testing.assert_array_equal(a, b)


def test_what_is_withheld_is_summed_over_the_steps_of_a_call_compiled_or_not():
    held = np.array([[1, 0, 1], [0, 1, 0]], np.uint8)
    for run in (withhold, withhold.py_func):
        withheld, force, torque = np.full((2, 3), 7.0), np.array([[1.0, 2.0], [3.0, 4.0]]), np.array([5.0, 6.0])
        other = force.copy(), torque.copy()
        velocity, spin = np.array([[0.5, 0.25], [0.1, 0.2]]), np.array([0.3, 0.4])
        discs = contact_arrays(np.zeros((2, 2)), velocity, spin, np.ones(2), np.ones(2))._replace(
            mass=np.array([2.0, 3.0]), inertia=np.array([4.0, 5.0]), held=held, withheld=withheld
        )
        run(discs._replace(force=force, torque=torque), 0.0, True, None, 1.0)
        run(discs._replace(force=other[0], torque=other[1]), 0.1, False, None, 1.0)
        np.testing.assert_array_equal(withheld, [[2.0, 0.0, 10.0], [0.0, 8.0, 0.0]])
        np.testing.assert_array_equal(force, [[0.0, 2.0], [3.0, 0.0]])
        np.testing.assert_array_equal(torque, [0.0, 6.0])
        np.testing.assert_allclose(other[0], [[0.1 * 2.0 * 0.5, 2.0], [3.0, 0.1 * 3.0 * 0.2]], rtol=EPS)
        np.testing.assert_allclose(other[1], [0.1 * 4.0 * 0.3, 6.0], rtol=2 * EPS)


def test_background_damping_leaves_a_held_disc_its_speed():
    coupled = party()
    grains = coupled.grains
    velocity = grains.discs.velocity[0].copy()
    grains.step(0.25, None, None, 100, 0.01)
    np.testing.assert_allclose(grains.discs.velocity[0], velocity, rtol=100 * 4 * EPS)  # four roundings a step
