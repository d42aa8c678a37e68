"""The grains' validations hold, and their tolerances are tight enough to catch the error next door."""

import math

import numpy as np
import pytest

from porescale.common.core.constants import GRAVITY
from porescale.common.evidence.validations import Measured
from porescale.dem.contact.linear import Linear
from porescale.dem.timestep import packing_limit
from porescale.validation.dem import critical_step, restitution, rolling, stacks
from porescale.validation.dem import setups as lab
from tests.reference.dem.dem import Body, World
from tests.validation.tolerances import tolerance


def test_the_other_end_of_contact_has_another_restitution():
    law = lab.law_at(0.2155, "force")
    bounced = restitution.bounce(law, law.contact_time(lab.MASS), 1000.0)
    other = lab.law_at(0.2155, "overlap").restitution(lab.MASS)
    assert np.abs(bounced - other).min() > 10 * tolerance("dem.restitution_release_at_zero_force")


def test_restitution_converges_at_first_order():
    # The start of the dashpot is missed by up to a step: error proportional to dt, tenfold for a tenth; the
    # second-order term is w0 dt = 3 % at T_c/100.
    law = lab.law_at(0.2155)
    coarse, fine = (
        np.abs(restitution.bounce(law, law.contact_time(lab.MASS), n) - law.restitution(lab.MASS)).max()
        for n in (100.0, 1000.0)
    )
    assert coarse / fine == pytest.approx(10.0, rel=0.05)
    assert coarse < 1e-2  # first order at contact switching: ten times the error at a tenth of the steps
    assert coarse > 1e-3  # so the resolution of the validation is needed


def test_a_pair_bounces_with_its_effective_mass():
    mass = lab.MASS * 4.0 / 5.0
    law = lab.law_at(0.2155, mass=mass)
    bounced = restitution.bounce_pair(law, law.contact_time(mass))
    assert abs(bounced - law.restitution(lab.MASS)) > 10 * tolerance("dem.restitution_of_pairs")


def test_a_sphere_would_roll_at_another_time():
    stops, speed = rolling.slide_to_roll(0.2)
    assert abs(stops * 7.0 * 0.2 * GRAVITY / 2.0 - 1.0) > 10 * tolerance("dem.sliding_turns_into_rolling")
    assert abs(speed / (5.0 / 7.0) - 1.0) > 10 * tolerance("dem.sliding_turns_into_rolling")


def test_too_steep_a_slope_does_not_roll():
    a, _ = rolling.incline(0.8, 0.1)
    assert abs(a / (2.0 / 3.0 * GRAVITY * math.sin(0.8)) - 1.0) > 0.1


def test_a_slow_tangential_approach_does_not_slide_through():
    # v_t/v_n = 0.5 < 3 mu (1 + e) = 1.6: it sticks on the way, and the formula of gross sliding is far off.
    damped = lab.law_at(0.1)
    law = lab.law_at(0.1, tangential_stiffness=0.25 * lab.STIFFNESS, friction=0.3, tangential_damping=damped.damping)
    unit = 0.3 * (1.0 + law.restitution(lab.MASS)) * 0.01
    _, along, _ = restitution.impact(law, law.contact_time(lab.MASS), 0.01, 0.005, 0.0)
    assert abs((0.005 - float(along[0])) / unit - 1.0) > 100 * tolerance("dem.oblique_impact_in_gross_sliding")


def test_drifting_with_the_old_velocity_gains_energy():
    # Explicit Euler on the same contact: a bounce at T_c/1000 gains about w0 dt pi = 1 %.
    body = Body(0.0, lab.RADIUS, lab.RADIUS, lab.MASS, v=-1.0)
    world = World([body], lab.STIFFNESS, 0.0, 0.0, 0.0, 0.0, walls=[(0.0, 0.0, 0.0, 1.0)])
    dt = lab.law_at(0.0).contact_time(lab.MASS) / 1000.0
    for _ in range(1300):
        ((_, push, _),) = world.forces(dt)
        body.y += dt * body.v
        body.v += dt * push / body.m
    assert body.v**2 - 1.0 > 100 * tolerance("dem.no_impact_gains_energy")


def test_a_stack_not_yet_at_rest_misses_its_overlaps():
    found = stacks.stack(10, decays=10.0)
    assert Measured.relative(range(1, 11), found).error > tolerance("dem.static_stack")


@pytest.mark.parametrize(("arms", "leaks"), [("lever", False), ("radius", True)])
def test_radii_as_lever_arms_leak_angular_momentum(arms, leaks):
    a = Body(0.0, 0.0, 0.01, 1.0, u=1.0, v=0.3)
    b = Body(0.0251, 0.003, 0.015, 2.0, w=40.0)
    world = World([a, b], 1e6, 20.0, 3e5, 5.0, 0.5, arms=arms)

    def turning():
        return sum(c.m * (c.x * c.v - c.y * c.u) + c.inertia * c.w for c in (a, b))

    start = turning()
    for _ in range(3000):
        world.step(1e-6, [(0.0, 0.0, 0.0)] * 2)
    assert a.u < 0.0  # they have met and parted
    drift = abs(turning() - start) / (a.m * 0.03)
    # 3000 steps of round-off against overlap/radius times friction, 1e-3 and more.
    assert (drift > 1e-5) if leaks else (drift < tolerance("dem.momentum_and_angular_momentum"))


def test_central_damping_would_allow_a_longer_step():
    assert abs(critical_step.critical_step(0.5) / 2.0 - 1.0) > 10 * tolerance("dem.critical_step_of_a_contact")


@pytest.mark.parametrize("shear", [0.25, 0.8])
def test_the_packing_limit_is_safe_in_a_lattice_and_the_pair_limit_is_not(shear):
    exact = 2.0 / math.sqrt(critical_step.lattice_frequency(shear))
    bound = packing_limit(Linear(lab.STIFFNESS, 0.0, shear * lab.STIFFNESS), lab.MASS) / math.sqrt(
        lab.MASS / lab.STIFFNESS
    )
    assert bound <= exact * (1 + 1e-12)  # rounding of an eigenvalue: the bound is reached at shear 0.8
    assert bound > 0.92 * exact  # sqrt(6.5/7.5) = 0.931 at shear 0.25
    assert math.sqrt(2.0) > 1.5 * exact  # two discs alone: 2 sqrt((m/2)/k)


def test_the_radius_as_a_lever_arm_is_off_by_the_overlap():
    found, rolls = rolling.incline(0.3, 0.5, wait=0.06), 2.0 / 3.0 * GRAVITY * math.sin(0.3)
    assert abs(found[0] / rolls - 1.0) > 1e4 * tolerance("dem.rolling_with_its_own_lever_arm")
    assert rolling.incline_exact(0.8, 0.5)[0] < GRAVITY * (
        math.sin(0.8) - 0.1 * math.cos(0.8)
    )  # it does not slip there


def test_springs_that_still_swing_are_noticed():
    off = Measured.relative(rolling.incline_exact(0.3, 0.5), rolling.incline(0.3, 0.5, wait=0.005)).error
    assert off > 10 * tolerance("dem.rolling_with_its_own_lever_arm")
