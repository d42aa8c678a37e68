"""Twins of the validations of contact laws: each fails (that the validations hold, test_dem_validation.py says)."""

import math
from dataclasses import replace

import numpy as np
import pytest
from scipy.special import jv

from porescale.common.compiled.jit import set_threads
from porescale.common.core.constants import GRAVITY
from porescale.dem.contact import hertz
from porescale.dem.contact.hertz import Hertz
from porescale.dem.discs import FIELDS
from porescale.dem.measures.energy import energy_budget
from porescale.validation.dem import hertz as impacts
from porescale.validation.dem import rolling, setups, stacks, threads, waves
from porescale.validation.dem.momentum import cloud, momentum_drift
from porescale.validation.dem.restitution import bounce
from porescale.validation.dem.setups import MASS, RADIUS, STIFFNESS, TANGENTIAL, law_at
from tests.validation.tolerances import tolerance


def test_a_dashpot_that_does_not_know_the_overlap_depends_on_speed():
    # Restitution of F = K d^(3/2) + c d' with the linear formula at one speed is wrong at another.
    law = Hertz(impacts.MODULUS, damping_ratio=0.2155)
    slow, fast = (law.contact_time(MASS, RADIUS, v) for v in (0.1, 1.0))
    assert slow / fast == pytest.approx(10.0**0.2, rel=1e-9)  # T ~ v^(-1/5): a constant dashpot acts that much longer
    assert math.exp(math.log(law.restitution()) * slow / fast) < law.restitution() - 100 * tolerance(
        "dem.hertz_restitution_release_at_zero_force"
    )


def test_the_other_release_gives_another_restitution():
    law = Hertz(impacts.MODULUS, damping_ratio=0.2155)
    other = replace(law, release="overlap")
    for name, one, wrong in (("force", law, other), ("overlap", other, law)):
        bounced = bounce(one, one.contact_time(MASS, RADIUS, 1.0), 1000.0, phases=2)
        assert np.abs(bounced - wrong.restitution()).min() > 10 * tolerance(
            f"dem.hertz_restitution_release_at_zero_{name}"
        )


def test_a_linear_contact_lasts_otherwise():
    deepest, lasted = impacts.hertz_impact()
    assert abs(lasted / (math.pi * deepest) - 1.0) > 10 * tolerance("dem.hertz_impact")  # T = pi d/v


def test_the_secant_of_hertz_is_no_bound_of_the_step():
    share = 1e-2
    secant = 2.0 * math.sqrt(MASS / (impacts.HERTZ.constant(RADIUS) * math.sqrt(share * RADIUS)))
    assert abs(impacts.hertz_critical_step(share) / secant - 1.0) > 10 * tolerance(
        "dem.critical_step_of_a_hertz_contact"
    )


def test_a_spring_kept_while_the_contact_stiffens_gains_energy():
    # Pressed with its spring at s, k_t s^2/2 grows with k_t ~ sqrt(d) and nobody pays; rescaled it only falls.
    row, s, radius = impacts.HERTZ.row(), 1e-6, RADIUS
    energy = [0.5 * row[hertz.KT] * math.sqrt(radius * d) * s**2 for d in (1e-5, 4e-5)]
    left = hertz.history_scaling.py_func(4e-5, 1.0, 3e-5, kernel_law())
    assert energy[1] == pytest.approx(2.0 * energy[0])
    assert energy[1] * left**2 == pytest.approx(0.5 * energy[0])
    assert hertz.history_scaling.py_func(1e-5, -1.0, 3e-5, kernel_law()) == 1.0


def kernel_law():
    return impacts.HERTZ.kernel(impacts.HERTZ.row()[None, None], 1.0, None)


def test_without_resistance_a_disc_rolls_off():
    assert rolling.resisted_incline(0.09, 0.0) / GRAVITY > 100 * tolerance("dem.rolling_resistance_on_an_incline")
    wrong = 2.0 / 3.0 * GRAVITY * (math.sin(0.3) - 0.1 * math.cos(0.3))  # lever arm r: short by the static overlap
    assert abs(rolling.resisted_incline(0.3, 0.1) - wrong) / GRAVITY > 1e-6


def test_a_spin_that_is_held_takes_the_torque_of_rolling():
    grains = cloud()
    grains.set_law(replace(impacts.HERTZ, damping_ratio=0.1, friction=0.0, rolling_friction=0.2, deepest=0.1))
    grains.hold(0, x=False, y=False)
    assert max(momentum_drift(grains, 5000)) > 1e6 * tolerance("dem.angular_momentum_with_rolling_resistance")


def test_a_continuum_has_no_dispersion_and_other_waves():
    name = "dem.dispersion_of_a_chain"
    assert abs(waves.chain_frequency(8) / (2.0 * math.pi * 8 / 32) - 1.0) > 100 * tolerance(name)
    at, found = waves.kicked_chain(20.0)
    wrong = jv(np.minimum(np.arange(len(found)), len(found) - np.arange(len(found))), 2.0 * at)
    assert np.abs(found - wrong).max() > 100 * tolerance("dem.kick_travels_along_a_chain")


def test_the_softer_material_alone_is_not_the_pair():
    assert abs(stacks.unlike_stack()[1] * 0.1 * STIFFNESS - 1.0) > 1e6 * tolerance("dem.unlike_materials_in_contact")


def test_a_budget_without_friction_does_not_close():
    law = law_at(0.0, **TANGENTIAL)
    grains = setups.on_floor(law, 1e-6, energy=True)
    grains.discs.velocity[0] = 0.6, -1.0
    grains.step(law.contact_time(MASS) / 200.0, count=300)
    budget = energy_budget(grains)
    share = budget["residual (J/m)"] / budget["turned over (J/m)"]
    forgotten = (budget["residual (J/m)"] - budget["lost in friction (J/m)"]) / budget["turned over (J/m)"]
    assert abs(share) < 1e-3
    assert abs(forgotten) > 0.1


@pytest.mark.slow
def test_the_same_discs_numbered_otherwise_have_other_bits():
    # Sums in another order differ: the sweep over blocks does not give the same bits by chance.
    law = law_at(0.1, **TANGENTIAL, tangential_damping=300.0)
    set_threads(2)
    one = threads.dense_block(law, energy=False)
    back = np.arange(one.discs.count)[::-1]
    other = threads.dense_block(law, energy=False)
    for name in FIELDS:
        getattr(other.discs, name)[:] = getattr(one.discs, name)[back]
    other.refresh()
    for grains in (one, other):
        grains.step(one.stable_step(), count=20)
    assert np.count_nonzero(one.discs.force != other.discs.force[back]) > one.discs.count / 10
    np.testing.assert_allclose(one.discs.position, other.discs.position[back], atol=1e-9 * RADIUS)
