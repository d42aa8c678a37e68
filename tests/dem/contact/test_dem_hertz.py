"""Hertz, rolling resistance and several materials: against slow twins and by what they must obey."""

import math
from dataclasses import replace

import numpy as np
import pytest

from porescale.common.core.errors import InputError
from porescale.dem.contact.hertz import Hertz
from porescale.dem.contact.law import Relative, contact
from porescale.dem.contact.linear import Linear
from porescale.dem.contact.materials import Materials
from porescale.dem.discs import make_discs
from porescale.dem.forces.walls import Box
from porescale.dem.grains import Grains
from porescale.dem.timestep import packing_limit
from tests.reference.dem.dem_contact import HertzContact
from tests.reference.dem.restarted import differing

STEEL = Linear(2e6, 10.0, 5e5, 3.0, 0.5, rolling_friction=0.1, rolling_stiffness=1e5)
RUBBER = Linear(2e5, 40.0, 5e4, 1.0, 0.8, rolling_friction=0.3, rolling_stiffness=2e4)


@pytest.mark.parametrize("resistance", [0.0, 0.2])
def test_hertz_and_rolling_follow_the_slow_twin(resistance):
    young, poisson, e, mu, dt = 1e8, 0.3, 0.6, 0.4, 1e-5
    law = Hertz.of(young, poisson, e, mu, rolling_friction=resistance)
    slow = HertzContact(young, poisson, 0.01, 0.02, 0.8, 3.0, law.damping_ratio, mu, resistance)
    kernel = law.kernel(law.row()[None, None], 1.0, 1.0 if law.rolls else None)
    radius, mass = 0.01 * 0.02 / 0.03, 0.8 * 3.0 / 3.8
    spring = roll = 0.0
    rng = np.random.default_rng(0)
    time = dt * np.arange(1, 400)
    overlap = 1e-4 * (1.2 + np.sin(2e3 * time)) * np.minimum(time / 1e-3, 1.0)
    closing = np.diff(overlap, prepend=0.0) / dt
    slips, turns = 0.05 * np.sin(900.0 * time) + rng.normal(0, 0.01, 399), 3.0 * np.cos(700.0 * time)
    limits = set()
    for d, c, s, w in zip(overlap, closing, slips, turns, strict=True):
        normal, tangential, resisting, spring, roll = contact.py_func(
            Relative(d, c, s, radius * w, radius), spring, roll, mass, dt, law.row(), kernel
        )
        exact = slow.step(d, c, s, w, dt)
        # Some twenty operations each and a spring that is a sum of up to 399 terms.
        np.testing.assert_allclose((normal, tangential, resisting), exact, rtol=1e-12, atol=1e-11 * abs(normal))
        limits.add(abs(tangential) > 0.999 * mu * normal)
    assert limits == {True, False}  # it stuck and it slid
    assert (roll != 0.0) == (resistance > 0.0)


def test_keeping_the_spring_on_loading_is_another_law():  # the twin that must fail
    law = Hertz.of(1e8, 0.3, friction=10.0)
    kernel = law.kernel(law.row()[None, None], 1.0, None)
    loads = contact.py_func(Relative(4e-5, 3.0, 0.0, 0.0, 0.01), 1e-6, 0.0, 1.0, 1e-5, law.row(), kernel)
    kept = 8.0 * law.shear_modulus * math.sqrt(0.01 * 4e-5) * 1e-6
    assert -loads[1] == pytest.approx(0.5 * kept)  # d from 1e-5 to 4e-5: the force stays, the spring halves


def test_elastic_constants_give_the_moduli_of_the_contact():
    law = Hertz.of(7e10, 0.25)
    assert law.modulus == pytest.approx(7e10 / (2 * (1 - 0.25**2)))
    shear = 7e10 / (2 * 1.25)
    assert law.shear_modulus == pytest.approx(shear / (2 * (2 - 0.25)))
    # Mindlin: k_t/k_n = 2(1 - nu)/(2 - nu), k_n = dF/dd = 2 E sqrt(R d).
    row = law.row()
    assert row[2] / (1.5 * row[0]) == pytest.approx(2 * (1 - 0.25) / (2 - 0.25))


@pytest.mark.parametrize("release", ["force", "overlap"])
@pytest.mark.parametrize("e", [1.0, 0.9, 0.5, 0.1])
def test_restitution_as_input_comes_out_at_any_mass(release, e):
    law = Hertz.of(1e9, 0.2, e, release=release)
    assert law.restitution() == pytest.approx(e, rel=1e-12)
    assert law.restitution(17.0) == law.restitution()


def test_the_stable_step_of_hertz_falls_with_the_overlap_it_allows_for():
    law = Hertz(1e9, 0.8e9)
    near, deep = (packing_limit(replace(law, deepest=d), 1.0, 0.01) for d in (0.01, 0.16))
    assert near / deep == pytest.approx(16.0**0.25, rel=1e-12)
    with pytest.raises(ValueError, match="radius"):
        packing_limit(law, 1.0)


def test_the_stable_step_of_hertz_is_safe_for_a_light_disc_that_is_not_the_smallest():
    # Stiffness goes with the radius, so the limit with the root of mass over radius: here that of the large disc.
    law = Hertz(1e8, 0.4e8, 0.2, 0.2)
    discs = make_discs([[0.01, 0.01], [0.05, 0.03]], [0.01, 0.03], [8000.0, 1000.0])
    grains = Grains(discs, law, Box((0.0, 0.0), (0.1, 0.1)))
    each = [packing_limit(law, float(m), float(r)) for m, r in zip(discs.mass, discs.radius, strict=True)]
    assert each[1] < 0.7 * each[0]  # the check that must fail: the smallest, which is the lightest too
    assert discs.mass[0] < discs.mass[1]
    assert grains.stable_step(safety=1.0, steps_per_contact=0.0) == pytest.approx(min(each), rel=1e-12)


@pytest.mark.parametrize("small", [0.01, 0.001])
def test_a_servo_holds_its_load_on_a_large_disc_beside_a_small_one(small):
    # With the stiffness of the small disc the gain would be too large by 0.01/small, and the wall would bounce.
    law = Hertz(1e8, 0.4e8, 0.3, 0.3)
    grains = Grains(make_discs([[0.05, 0.01], [0.02, small]], [0.01, small], 2000.0), law, Box((0.0, 0.0), (0.1, 0.1)))
    grains.add_wall("lid", (0.05, 0.02), (0.0, -1.0))
    grains.steering.servo_wall("lid", force=2000.0, speed=1.0)
    grains.step(grains.stable_step(), count=8000)
    # After 8000 steps 6e-11 of the start is left; with the gain of a stiffness ten times too small a third was missing.
    assert abs(grains.wall_force[grains.wall_names.index("lid"), 1]) == pytest.approx(2000.0, rel=1e-6)


def test_like_materials_keep_their_own_law_and_unlike_ones_mix():
    laws = Materials({"steel": STEEL, "rubber": RUBBER})
    assert laws.law("steel", "steel") is STEEL
    mixed = laws.law("steel", "rubber")
    assert mixed == laws.law("rubber", "steel")
    assert mixed.stiffness == pytest.approx(2.0 * 2e6 * 2e5 / 2.2e6)
    assert (mixed.friction, mixed.rolling_friction) == (0.5, 0.1)
    mean = 0.5 * (STEEL.damping_ratio(1.0) + RUBBER.damping_ratio(1.0))
    assert mixed.damping_ratio(1.0) == pytest.approx(mean)
    assert STEEL.mixed(STEEL).row() == pytest.approx(STEEL.row(), rel=1e-15)
    own = Materials({"a": STEEL, "b": RUBBER}, {("b", "a"): STEEL}, walls="b")
    assert own.law("a", "b") is STEEL
    assert own.against("b") == [STEEL, RUBBER]


@pytest.mark.parametrize(
    ("make", "named"),
    [
        (lambda: Materials({"a": STEEL}, walls="b"), "material"),
        (lambda: Materials({"a": STEEL, "b": Hertz(1e9)}), "one kind"),
        (lambda: Materials({"a": STEEL, "b": replace(RUBBER, release="overlap")}), "release"),
        (lambda: Hertz.of(1e9, 0.7), "poisson"),
        (lambda: Hertz(-1.0), "contact.modulus"),
        (lambda: dense_discs(Materials({"a": STEEL, "b": RUBBER}), material=2), "material"),
        (lambda: dense_discs(STEEL, wall_law=Hertz(1e9)), "one kind"),
    ],
)
def test_what_makes_no_sense_is_refused_by_name(make, named):
    with pytest.raises(InputError, match=named):
        make()


def dense_discs(law, **options):
    """Discs thrown together in a box."""
    rng = np.random.default_rng(4)
    grid = np.stack(np.meshgrid(np.arange(5), np.arange(5)), axis=-1).reshape(-1, 2)
    discs = make_discs(
        (grid + 0.5) * 0.0198,
        0.01 * rng.uniform(0.8, 1.0, 25),
        2000.0,
        rng.normal(0, 1, (25, 2)),
        rng.normal(0, 50, 25),
    )
    return Grains(discs, law, Box((0.0, 0.0), (0.099, 0.099)), **options)


def test_two_names_for_one_material_change_no_bit():
    one = dense_discs(STEEL)
    two = dense_discs(Materials({"a": STEEL, "b": STEEL}, {("a", "b"): STEEL}), material=np.arange(25) % 2)
    for grains in (one, two):
        grains.step(1e-6, count=400)
    assert one.pairs.carried[:, 1].any()
    assert not differing(one, two)


def test_rolling_springs_are_added_where_a_law_brings_them():
    grains = dense_discs(replace(STEEL, rolling_friction=0.0))
    grains.step(1e-6, count=50)
    before = grains.pairs.carried[:, 0].copy()
    grains.set_law(STEEL)
    np.testing.assert_array_equal(grains.pairs.carried, np.column_stack((before, np.zeros(len(before)))))
    assert grains.wall_spring.shape[2] == 2
    grains.step(1e-6, count=5)
    assert grains.pairs.carried[:, 1].any()


def test_a_state_with_rolling_and_a_budget_goes_on_bit_for_bit():
    through, first, second = (dense_discs(STEEL, energy=True) for _ in range(3))
    through.step(1e-6, count=300)
    first.step(1e-6, count=120)
    second.restore(first.state())
    second.step(1e-6, count=180)
    assert not differing(through, second)
