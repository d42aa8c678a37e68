"""Clumps under Hertz and of several materials, discs of very different sizes, rolling at walls that move."""

import math
from dataclasses import replace

import numpy as np
import pytest

from porescale.common.core.constants import GRAVITY
from porescale.dem.contact.hertz import Hertz
from porescale.dem.contact.linear import Linear
from porescale.dem.contact.materials import Materials
from porescale.dem.discs import make_discs
from porescale.dem.forces.walls import TURN, Box
from porescale.dem.grains import Grains
from porescale.dem.measures.contacts import contacts
from porescale.dem.measures.energy import energy_budget
from porescale.dem.measures.loads import on_surface
from porescale.dem.prepare.settle import come_to_rest, weights_of
from porescale.validation.dem.bodies import clumped_cloud
from porescale.validation.dem.setups import DENSITY, MASS, RADIUS, STIFFNESS
from tests.reference.dem.pairs import neighbours, rows_of

SOFT = Hertz(1e8, 0.8e8, damping_ratio=0.2155)


def upright(law: Hertz | Linear | Materials, gap: float, **options: object) -> Grains:
    """Two touching discs bound one above the other, ``gap`` (m) above a floor, weightless."""
    at = [(0.0, RADIUS + gap), (0.0, 3.0 * RADIUS + gap)]
    grains = Grains(make_discs(at, RADIUS, DENSITY), law, Box((-1.0, 0.0), (1.0, 1.0), "open", "open", top="open"),
                    **options)  # fmt: skip
    grains.steering.bind([[0, 1]], DENSITY)
    return grains


@pytest.mark.slow  # compiles the contact loop for laws of its own
@pytest.mark.parametrize("speed", [0.1, 1.0])
def test_a_clump_bounces_off_as_its_own_mass_under_hertz(speed):
    # Restitution of Hertz's law depends on the damping ratio alone, of the mass that hits: 1e-3 at T_c/1000, as verify.
    dt = SOFT.contact_time(2.0 * MASS, RADIUS, speed) / 1000.0
    grains = upright(SOFT, 0.5 * speed * dt)
    clumps = grains.steering.clumps
    clumps.velocity[0, 1] = -speed
    clumps.place(grains.discs)
    grains.step(dt, count=1300)
    assert clumps.velocity[0, 1] / speed == pytest.approx(SOFT.restitution(), abs=1e-3)
    assert abs(clumps.spin[0]) * RADIUS < 1e-14  # round-off
    # The twin that must fail: damped as the member alone, half as heavy, it keeps more.
    grains = upright(SOFT, 0.5 * speed * dt)
    grains.body_mass = grains.discs.mass
    grains.steering.clumps.velocity[0, 1] = -speed
    grains.steering.clumps.place(grains.discs)
    grains.step(dt, count=1300)
    assert grains.steering.clumps.velocity[0, 1] / speed > SOFT.restitution() + 0.05


def test_a_law_that_is_set_after_clumps_were_bound_knows_their_mass():
    grains = upright(Linear(STIFFNESS), 0.0)
    assert grains.body_mass.tolist() == pytest.approx([2.0 * MASS] * 2)
    other = upright(SOFT, 0.0)
    before = other.body_mass.copy()
    other.set_law(replace(SOFT, friction=0.3))
    np.testing.assert_array_equal(other.body_mass, before)


@pytest.mark.slow  # compiles the contact loop for laws of its own
def test_a_clump_on_the_floor_of_another_material_presses_in_as_the_pair_says():
    steel, rubber = Linear(STIFFNESS, 300.0), Linear(0.1 * STIFFNESS, 300.0)
    laws = Materials({"steel": steel, "rubber": rubber}, walls="steel")
    mixed = 2.0 * 0.1 / 1.1 * STIFFNESS
    weight = 2.0 * MASS * GRAVITY
    for lower, hard in ((0, STIFFNESS), (1, mixed)):
        grains = upright(laws, 0.0, material=[lower, 0])
        weights = np.tile([0.0, -MASS * GRAVITY], (2, 1))
        slowest = math.sqrt(mixed / (2.0 * MASS))
        dt = grains.stable_step()
        grains.step(dt, weights, None, int(60.0 / (slowest * dt)), 2.0 * slowest)
        # At rest to exp(-60); overlaps of 1e-6 m read off places of 1e-2 m.
        assert RADIUS - grains.discs.position[0, 1] == pytest.approx(weight / hard, rel=1e-8)


@pytest.mark.slow  # compiles the contact loop for laws of its own
@pytest.mark.parametrize("law", [
    Hertz.of(1e9, 0.25, 0.6, 0.4, rolling_friction=0.1),
    Materials({"a": Linear(STIFFNESS, 100.0, 0.25 * STIFFNESS, 50.0, 0.5),
               "b": Linear(0.2 * STIFFNESS, 300.0, 0.1 * STIFFNESS, 50.0, 0.2)}),
], ids=["hertz", "materials"])  # fmt: skip
def test_clumps_of_any_law_keep_momentum_and_lose_energy(law):
    plain = clumped_cloud(seed=3)
    d = plain.discs
    start = [d.mass @ d.velocity, energy(plain)]
    grains = Grains(d, law, plain.box, material=np.arange(60) % 2 if isinstance(law, Materials) else None)
    grains.steering.bind([[k, 40 + k] for k in range(20)], DENSITY)
    start = [d.mass @ d.velocity, energy(grains)]
    grains.step(grains.stable_step(), count=3000)
    scale = float(d.mass @ np.hypot(*d.velocity.T))
    # Round-off of 3000 sums, all one way: 3000 eps.
    assert np.abs(d.mass @ d.velocity - start[0]).max() < 3000 * 2.3e-16 * scale
    assert energy(grains) < 0.9 * start[1]


def energy(grains: Grains) -> float:
    """Kinetic energy of clumps and free discs, J/m."""
    d, clumps = grains.discs, grains.steering.clumps
    free = clumps.group < 0
    parts = float(d.mass[free] @ np.sum(d.velocity[free] ** 2, axis=1) + d.inertia[free] @ d.spin[free] ** 2)
    return 0.5 * (parts + float(clumps.mass @ np.sum(clumps.velocity**2, axis=1) + clumps.inertia @ clumps.spin**2))


@pytest.mark.slow  # compiles the contact loop for laws of its own
@pytest.mark.parametrize("law", [Linear(STIFFNESS, 0.0, 0.25 * STIFFNESS, 0.0, 0.5), Hertz(1e8, 0.4e8, friction=0.5)])
def test_the_stable_step_of_clumps_is_stable_and_not_timid(law):
    # Pressed between floor and lid, a ring of contacts around it: nothing grows at the step, and not all of it is lost
    # to bounds: a twentieth of the step of a free clump on one contact, 2 sqrt(M/k), at least (six neighbours all
    # around each member count, and both ends of each contact, and members' turning).
    at = [(0.0, 0.99 * RADIUS), (1.2 * RADIUS, 0.99 * RADIUS)]
    box = Box((-0.99 * RADIUS, 0.0), (2.19 * RADIUS, 1.98 * RADIUS))
    grains = Grains(make_discs(at, RADIUS, DENSITY), law, box)
    clumps = grains.steering.bind([[0, 1]], DENSITY)
    dt = grains.stable_step(steps_per_contact=0.0)
    clumps.velocity[0] = 1e-6, 0.0
    clumps.place(grains.discs)
    grains.step(dt, count=5000)
    assert np.hypot(*clumps.velocity[0]) < 1e-5
    stiff = law.stiffness if isinstance(law, Linear) else 1.5 * law.constant(RADIUS) * math.sqrt(0.02 * RADIUS)
    assert dt > 0.05 * 2.0 * math.sqrt(float(clumps.mass[0]) / stiff)


# -- sizes


def mixture() -> Grains:
    """Ten large discs in a bed of some five hundred ten times smaller."""
    rng = np.random.default_rng(3)
    big = np.array([(0.1 * (k % 5) + 0.05, 0.1 * (k // 5) + 0.05) for k in range(10)])
    at = np.array([(x, y) for x in np.arange(0.006, 0.5, 0.012) for y in np.arange(0.006, 0.2, 0.012)])
    at = at[np.hypot(*(at[:, None] - big[None]).transpose(2, 0, 1)).min(axis=1) > 0.046]
    at += rng.uniform(-5e-4, 5e-4, at.shape)
    radius = np.concatenate((np.full(10, 0.04), rng.uniform(0.0038, 0.0042, len(at))))
    law = Linear(1e6, 100.0, 2.5e5, 30.0, 0.5)
    return Grains(make_discs(np.concatenate((big, at)), radius, DENSITY), law,
                  Box((0.0, 0.0), (0.5, 0.4), top="open"))  # fmt: skip


def test_no_pair_of_sizes_one_to_ten_is_missed():
    grains = mixture()
    d = grains.discs
    pairs = grains.current_pairs()
    assert rows_of(pairs) == neighbours(d.position, d.radius, pairs.skin, grains.box.lower, grains.box.upper)
    apart = np.hypot(*(d.position[:, None] - d.position[None]).transpose(2, 0, 1))
    # The list is no longer than it must be: a small disc far from large ones lists its few neighbours.
    alone = np.flatnonzero((apart[:, :10].min(axis=1) > 0.06) & (d.radius < 0.01))
    assert np.diff(pairs.start)[alone].mean() < 8


def test_a_bed_of_sizes_one_to_ten_comes_to_rest_with_its_weight_on_the_floor():
    grains = mixture()
    weights = weights_of(grains.discs, DENSITY)
    come_to_rest(grains, weights, GRAVITY)
    walls = dict(zip(grains.wall_names, grains.wall_force, strict=True))
    # Rest to a thousandth of a disc's weight on average (come_to_rest), friction at the sides bears the rest.
    borne = walls["bottom"][1] + walls["left"][1] + walls["right"][1]
    assert -borne == pytest.approx(GRAVITY * grains.discs.mass.sum(), rel=5e-3)
    assert walls["left"][0] < 0.0 < walls["right"][0]
    assert grains.discs.position[:, 1].max() < 0.3
    grains.check()


# -- rolling at walls that move


def rolling(**more: float) -> Linear:
    """A law with resistance to rolling."""
    return Linear(STIFFNESS, 100.0, 0.25 * STIFFNESS, 100.0, 0.9, rolling_friction=0.1,
                  rolling_stiffness=0.25 * STIFFNESS, rolling_damping=100.0, **more)  # fmt: skip


def on_a_belt(law: Linear, belt: float, speed: float, spin: float) -> Grains:
    """A disc on a floor that slides at ``belt`` (m/s), with a speed and a spin."""
    load = MASS * GRAVITY / STIFFNESS
    grains = Grains(make_discs([[0.0, RADIUS - load]], RADIUS, DENSITY, [[speed, 0.0]], spin), law,
                    Box((-10.0, 0.0), (10.0, 1.0), "open", "open", top="open"))  # fmt: skip
    grains.steering.move_wall("bottom", x=belt)
    return grains


@pytest.mark.slow  # compiles the contact loop for laws of its own
def test_a_disc_on_a_moving_belt_is_one_on_a_floor_seen_from_another_train():
    weight = np.array([[0.0, -MASS * GRAVITY]])
    still, moved = on_a_belt(rolling(), 0.0, 0.5, -20.0), on_a_belt(rolling(), 1.0, 1.5, -20.0)
    for grains in (still, moved):
        grains.step(grains.stable_step(), weight, count=4000)
    # Round-off: speeds of 1 m/s, 4000 steps of eps each.
    assert moved.discs.velocity[0, 0] - 1.0 == pytest.approx(still.discs.velocity[0, 0], abs=4000 * 2.3e-16 * 2)
    assert moved.discs.spin[0] == pytest.approx(still.discs.spin[0], rel=1e-10)
    assert abs(still.discs.spin[0]) > 0.5  # it still rolls


@pytest.mark.slow  # compiles the contact loop for laws of its own
def test_a_disc_that_turns_with_its_wall_does_not_roll():
    # A wall that turns about the point under a disc, and the disc with it: seen from the wall nothing moves.
    law, turn = rolling(), 3.0
    grains = on_a_belt(law, 0.0, 0.0, turn)
    load = MASS * GRAVITY / STIFFNESS
    grains.steering.move_wall("bottom", turn=turn)
    wall = grains.walls[grains.wall_names.index("bottom")]
    wall[:2], wall[TURN] = 0.0, turn
    grains.discs.velocity[0] = -turn * (RADIUS - load), 0.0
    dt = grains.stable_step()
    grains.step(dt, np.array([[0.0, -MASS * GRAVITY]]))
    before = grains.wall_spring[0, 0].copy()
    grains.step(dt, np.array([[0.0, -MASS * GRAVITY]]))
    # In one step the weight, which does not turn, and the path's curvature, (turn dt)^2 of the radius, move it.
    slipped = grains.wall_spring[0, 0] - before
    assert np.abs(slipped).max() < (turn * dt) ** 2 * RADIUS
    # The twin that must fail: as if the wall did not turn it would have rolled by turn R dt.
    assert turn * RADIUS * dt > 100 * np.abs(slipped).max()


@pytest.mark.slow  # compiles the contact loop for laws of its own
def test_what_resists_rolling_turns_the_wall_back():
    grains = on_a_belt(rolling(), 0.0, 0.0, 50.0)
    weight = np.array([[0.0, -MASS * GRAVITY]])
    grains.step(grains.stable_step(), weight, count=400)
    found = contacts(grains)
    x, y, moment = on_surface(found, "bottom", (0.3, 0.0))
    grains.step(grains.last_dt, weight)
    load = grains.wall_load[0]
    assert [x, y] == pytest.approx(load[:2].tolist(), rel=1e-12)
    about = grains.walls[0, :2]
    # The wall's own point is at x = -10; the limit mu_r R N against a roll that goes on, and the force on its arm.
    assert moment == pytest.approx(load[2] - (0.3 - about[0]) * load[1], rel=1e-9)
    place = float(found.point[0, 0])
    assert moment - (place - 0.3) * y == pytest.approx(0.1 * RADIUS * -y, rel=1e-9)


@pytest.mark.slow  # compiles the contact loop for laws of its own
def test_rolling_and_turning_walls_are_in_the_energy_budget():
    shares = []
    for steps in (50.0, 200.0):
        law = replace(rolling(), damping=0.0, tangential_damping=0.0, rolling_damping=0.0)
        grains = Grains(make_discs([[0.0, RADIUS]], RADIUS, DENSITY, [[0.3, 0.0]], 60.0), law,
                        Box((-10.0, 0.0), (10.0, 1.0), "open", "open", top="open"), energy=True)  # fmt: skip
        grains.steering.move_wall("bottom", turn=30.0)
        grains.walls[0, :2] = 0.0
        dt = math.pi * math.sqrt(MASS / STIFFNESS) / steps
        grains.step(dt, np.array([[0.0, -MASS * GRAVITY]]), count=int(20 * steps))
        budget = energy_budget(grains, (0.0, -GRAVITY))
        assert abs(budget["work of moving surfaces (J/m)"]) > 0.01 * budget["turned over (J/m)"]
        shares.append(abs(budget["residual (J/m)"]) / budget["turned over (J/m)"])
    # First order: moving surfaces and switching of sliders, see energy.py.
    assert shares[1] < 0.5 * shares[0]
    assert shares[1] < 1 / 200
