"""Laws that hold for every state: mirror images, passivity of a contact, third law."""

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from porescale.dem.contact.law import coulomb
from porescale.dem.contact.linear import Linear
from porescale.dem.discs import make_discs
from porescale.dem.forces.walls import Box
from porescale.dem.grains import Grains
from porescale.validation.dem.momentum import cloud, momentum_drift


def thrown(seed, mirrored=False):
    """Discs in a box symmetric about x = 0, or their mirror image."""
    rng = np.random.default_rng(seed)
    grid = np.stack(np.meshgrid(np.arange(5) - 2.0, np.arange(5)), axis=-1).reshape(-1, 2)
    x = grid * 0.021 + (0.0, 0.012) + rng.uniform(-1e-3, 1e-3, grid.shape)
    velocity, spin = rng.normal(0.0, 1.0, grid.shape), rng.normal(0.0, 100.0, 25)
    sign = np.array([-1.0, 1.0]) if mirrored else np.ones(2)
    discs = make_discs(x * sign, 0.01 * rng.uniform(0.6, 1.0, 25), 2000.0, velocity * sign, spin * sign[0])
    return Grains(discs, Linear(1e6, 5.0, 3e5, 4.0, 0.4), Box((-0.0525, 0.0), (0.0525, 0.105)))


@settings(max_examples=15)
@given(st.integers(0, 10_000))
def test_a_mirror_image_stays_a_mirror_image_to_the_bit(seed):
    here, there = thrown(seed), thrown(seed, mirrored=True)
    for grains in (here, there):
        grains.step(1e-5, count=300)
    assert here.pairs.carried.any() or here.wall_spring.any()
    np.testing.assert_array_equal(here.discs.position * (-1.0, 1.0), there.discs.position)
    np.testing.assert_array_equal(-here.discs.spin, there.discs.spin)


def test_spin_kept_in_the_mirror_is_no_mirror_image():  # the twin that must fail
    here, there = thrown(1), thrown(1, mirrored=True)
    there.discs.spin[:] = here.discs.spin
    for grains in (here, there):
        grains.step(1e-5, count=300)
    assert not np.array_equal(here.discs.position * (-1.0, 1.0), there.discs.position)


slips = st.lists(st.tuples(st.floats(-10.0, 10.0), st.floats(0.0, 100.0)), min_size=1, max_size=60)


def taken_minus_stored(path, law, dt, friction=coulomb.py_func):
    """Smallest over the path of: work taken out of the slip, less the energy in the spring."""
    spring = work = 0.0
    least = 0.0
    for slip, limit in path:
        force, spring = friction(
            spring, slip, limit, dt, law.tangential_stiffness, 1.0 / law.tangential_stiffness, law.tangential_damping
        )
        work -= force * slip * dt
        least = min(least, work - 0.5 * law.tangential_stiffness * spring**2)
    return least


@settings(max_examples=200)
@given(slips, st.floats(0.0, 50.0))
def test_friction_never_returns_more_than_it_took(path, damping):
    # The force at the end of a step does the step's work: it exceeds the spring's mean by k_t ds/2 >= 0
    # while the spring grows, and falls short while it shrinks, by k_t ds^2/2 each, ds <= 10 dt; that much
    # is round-off of the scheme, at most 60 steps of 0.5 * 100 * (10 * 1e-6)^2.
    law = Linear(1.0, 0.0, 100.0, damping, 0.5)
    assert taken_minus_stored(path, law, 1e-6) >= -60 * 0.5 * 100.0 * 1e-10


def test_resetting_the_spring_to_the_limit_with_the_dashpot_creates_energy():  # the twin that must fail
    def common(spring, slip, limit, dt, stiff, soft, damping):
        trial = stiff * (spring + slip * dt) + damping * slip
        force = min(max(trial, -limit), limit)
        return -force, (spring + slip * dt if force == trial else force * soft)

    law = Linear(1.0, 0.0, 100.0, 50.0, 0.5)
    assert taken_minus_stored([(10.0, 100.0)], law, 1e-6, common) < -10.0


@settings(max_examples=10)
@given(st.integers(0, 10_000), st.integers(2, 80), st.floats(0.0, 1.0))
def test_momentum_and_angular_momentum_are_kept_to_round_off(seed, count, friction):
    # A sum over 80 discs rounds at 80 * 1e-16 of its scale, a thousand steps add up to 30 times that.
    assert max(momentum_drift(cloud(count, seed, friction), 1000)) < 30 * 80 * 1e-16


@settings(max_examples=50)
@given(st.lists(st.floats(0.0, 2 * np.pi), min_size=6, max_size=6), st.floats(0.0, 1.0))
def test_no_set_of_neighbours_is_stiffer_than_the_packing_factor(angles, shear):
    # Single disc on contacts of twice the stiffness, as in packing_factor; 60 degrees apart or more.
    from porescale.dem.timestep import packing_factor

    kept = []
    for angle in angles:
        if all(np.cos(angle - other) <= 0.5 + 1e-12 for other in kept):
            kept.append(angle)
    matrix = np.zeros((3, 3))
    for angle in kept:
        n, t = np.array([np.cos(angle), np.sin(angle), 0.0]), np.array([-np.sin(angle), np.cos(angle), 1.0])
        matrix += 2.0 * (np.outer(n, n) + shear * np.outer(t, t))
    scale = np.array([1.0, 1.0, np.sqrt(2.0)])
    highest = np.linalg.eigvalsh(scale[:, None] * matrix * scale)[-1]
    assert highest <= packing_factor(1.0, shear) * (1.0 + 1e-12)


def test_seven_neighbours_are_stiffer():  # the twin that must fail: the bound is not loose
    from porescale.dem.timestep import packing_factor

    spin = 2.0 * 7 * 2.0  # seven contacts on the rotation, r^2/I = 2/m
    assert spin > packing_factor(1.0, 1.0)
