"""Validations of clumps, servo walls and strained cells hold, and their twins fail."""

import numpy as np

from porescale.common.core.constants import GRAVITY
from porescale.dem.motion.control import Moved
from porescale.dem.motion.drivers import Clump
from porescale.validation.dem import bodies, setups
from porescale.validation.dem import energy as boxed
from porescale.validation.dem.momentum import momentum_drift
from tests.validation.tolerances import tolerance


def test_a_dumbbell_does_not_bounce_like_a_disc():  # the twin that must fail
    up, spin = bodies.dumbbell_bounce(0.5)
    assert abs(up - 1.0) > 0.1
    assert abs(spin * setups.RADIUS) > 0.1


def test_a_fast_dumbbell_turns_while_it_touches():  # the twin that must fail
    up, spin = bodies.dumbbell_bounce(0.5, speed=1.0)
    exact = bodies.dumbbell_exact(0.5)
    assert max(abs(up - exact[0]), abs(spin - exact[1]) * setups.RADIUS) > 1e-3


def test_a_pendulum_that_swings_wide_is_no_harmonic_one():  # the twin that must fail
    assert abs(bodies.pendulum_period(1.0, steps=2000) / bodies.pendulum_exact(1e-6) - 1.0) > 0.05


def test_with_free_rotation_the_shear_modulus_is_another():  # the twin that must fail
    with_held, without = bodies.lattice_exact(0.5)[2], np.sqrt(3.0) / 4.0 * 1.5
    assert abs(bodies.lattice_moduli(0.5)[2] - with_held) < 4e-4 < abs(with_held - without)


def test_the_budget_of_a_servo_without_its_work_does_not_close():  # the twin that must fail
    budget = boxed.budget_of(("servo",), 200.0, 0)
    without = abs(budget["residual (J/m)"] + budget["work of moving surfaces (J/m)"]) / budget["turned over (J/m)"]
    assert without > 10 * tolerance("dem.energy_book_of_driven_bodies")


def test_a_servo_that_does_not_know_its_load_is_noticed():  # the twins that must fail
    floor, lid = bodies.column_under_servo(50.0, gravity=0.0)
    exact = 50.0 + 10 * setups.MASS * GRAVITY
    assert abs(floor / exact - 1.0) > 100 * tolerance("dem.servo_wall")
    assert abs(lid / 49.9 - 1.0) > 100 * tolerance("dem.servo_wall")


def test_a_clump_that_is_held_takes_angular_momentum():  # the twin that must fail
    grains = bodies.clumped_cloud()
    grains.steering.control(Clump(0), rotation=Moved(0.0))
    assert max(momentum_drift(grains, 5000)) > 1e6 * tolerance("dem.momentum_of_clumps")
