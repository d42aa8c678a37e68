"""Every solid operator with every weight: mass in each cell, momentum between fluid and solid, neutrality, mirrors."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from porescale.coupling.saturated import Saturated
from porescale.coupling.solid.choose import SOLID_OPERATORS, choose_solid
from porescale.coupling.solid.law import mix, taken
from porescale.coupling.weighting import WEIGHTINGS, choose_weight
from porescale.lbm.collision.trt import MAGIC_MIDWAY_WALL, odd_rate
from porescale.lbm.fluid import Fluid
from porescale.lbm.lattice import CX, CY, WEIGHTS
from porescale.lbm.sides import Sides
from tests.reference import solid_operators as twin

EPS = np.finfo(float).eps
N = 20
PERIODIC = Sides("periodic", "periodic", "periodic", "periodic")
ORDER = [int(np.flatnonzero((np.array(CX) == x) & (np.array(CY) == y))[0]) for x, y in twin.DIRECTIONS.astype(int)]
"""Where the kernels keep the directions of the reference."""
ALL = [(solid, weight) for solid in SOLID_OPERATORS for weight in WEIGHTINGS]
every = pytest.mark.parametrize(("solid", "weight"), ALL)
seeds = st.integers(0, 10_000)


def cell(seed):
    """A cell far from equilibrium: populations (9,) in the reference's order, v, half force, B, tau."""
    random = np.random.default_rng(seed)
    f = twin.WEIGHTS * (1 + 0.2 * random.uniform(-1, 1, 9))
    return (
        f,
        random.uniform(-0.1, 0.1, 2),
        random.uniform(-0.01, 0.01, 2),
        random.uniform(0, 1),
        random.uniform(0.51, 2),
    )


@pytest.mark.parametrize("name", SOLID_OPERATORS)
@settings(deadline=None, max_examples=50)
@given(seeds)
def test_a_cell_is_that_of_the_paper_and_its_load_what_it_loses(name, seed):
    f, v, h, b, tau = cell(seed)
    rho, j = f.sum(), f @ twin.DIRECTIONS
    u = (j + h) / rho
    change = twin.OPERATORS[name](f, rho, u, v, tau)
    g = f + 0.01 * np.random.default_rng(seed + 1).uniform(-1, 1, 9)  # any collided fluid
    expected = (1 - b) * g + b * (f + change)
    shifted, collided = np.zeros(9), np.zeros(9)
    shifted[ORDER], collided[ORDER] = f - twin.WEIGHTS, g - twin.WEIGHTS
    law = choose_solid(name, float)
    found = np.array(mix.py_func(*shifted, *collided, b, rho, *u, *v, 1 / tau, law)) + WEIGHTS
    # 40 roundings of numbers up to 1
    np.testing.assert_allclose(found[ORDER], expected, rtol=0, atol=40 * EPS)
    ta, tx, ty = taken.py_func(b, rho, *j, *h, 1 / tau, law)
    np.testing.assert_allclose(np.array([tx, ty]) - ta * v, -b * change @ twin.DIRECTIONS, rtol=0, atol=40 * EPS)
    assert abs(change.sum()) < 40 * EPS


@pytest.mark.parametrize(("name", "other"), [(a, b) for a in SOLID_OPERATORS for b in SOLID_OPERATORS if a != b])
def test_no_operator_passes_for_another(name, other):
    f, v, h, _, tau = cell(3)
    rho = f.sum()
    u = (f @ twin.DIRECTIONS + h) / rho
    shifted = np.zeros(9)
    shifted[ORDER] = f - twin.WEIGHTS
    found = np.array(mix.py_func(*shifted, *shifted, 1.0, rho, *u, *v, 1 / tau, choose_solid(name, float)))
    there = f + twin.OPERATORS[other](f, rho, u, v, tau) - twin.WEIGHTS
    assert np.abs(found[ORDER] - there).max() > 1e-6


def moving(solid, weight, seed, *, mirrored=False):
    """A box of uneven flow with a force, and three discs that share cells; ``mirrored`` left for right."""
    random = np.random.default_rng(seed)
    tau = random.uniform(0.55, 1.5)
    force = np.array([2e-4, -1e-4]) * random.uniform(-1, 1, 2)
    ux, uy, rho = *(0.05 * random.uniform(-1, 1, (2, N, N))), 1 + 0.05 * random.uniform(-1, 1, (N, N))
    centre, velocity = random.uniform(0, N, (3, 2)), random.uniform(-0.05, 0.05, (3, 2))
    radius, spin = random.uniform(1.5, 4.5, 3), random.uniform(-0.01, 0.01, 3)
    centre[1] = centre[0] + (radius[0] + radius[1] - 0.3, 0.4)
    if mirrored:
        ux, uy, rho = -ux[:, ::-1], uy[:, ::-1], rho[:, ::-1]
        force, spin = force * (-1, 1), -spin
        centre, velocity = centre * (-1, 1) + (N, 0), velocity * (-1, 1)
    fluid = Fluid(N, N, tau, force=tuple(force), sides=PERIODIC)
    fluid.set_flow(ux, uy, rho)
    wet = Saturated(fluid, radius, solid_operator=solid, weighting=weight)
    return fluid, wet, (centre, velocity, spin)


@every
@settings(deadline=None, max_examples=10)
@given(seeds)
def test_what_discs_gain_the_fluid_loses(solid, weight, seed):
    fluid, wet, discs = moving(solid, weight, seed)
    before, mass = np.array(fluid.momentum()), fluid.mass_excess()
    wet.advance(fluid, *discs)
    wet.cover(*discs)
    # With u of half the force (1 - B) F/2, the odd half of a collision gives  F(1 - w-/2) + w-(1 - B) F/2.
    b = wet.weights()
    driven = np.sum((1 - b) * (1 - odd_rate(fluid.relaxation_time, MAGIC_MIDWAY_WALL) * b / 2)) * np.array(fluid.force)
    # 400 cells with nine populations of 0.05, ten roundings each, all one way
    bound = N * N * 9 * 0.05 * 10 * EPS
    assert np.abs(np.array(fluid.momentum()) - before - driven + wet.force.sum(axis=0)).max() < bound
    assert abs(fluid.mass_excess() - mass) < bound


@every
def test_a_neutral_disc_in_uniform_flow_feels_nothing(solid, weight):
    fluid = Fluid(N, N, 0.7, sides=PERIODIC)
    fluid.set_flow(0.03, 0.02)
    wet = Saturated(fluid, np.array([4.0, 4.1]), solid_operator=solid, weighting=weight)
    centre, velocity = np.array([(8.3, 9.2), (15.9, 9.9)]), np.full((2, 2), (0.03, 0.02))
    force = torque = 0.0
    for _ in range(20):
        wet.advance(fluid, centre, velocity, np.zeros(2))
        force, torque = max(force, np.abs(wet.force).max()), max(torque, np.abs(wet.torque).max())
        centre += velocity
    # four roundings of 2 rho u B in 80 cells, all one way, lever arms of four cells; steps do not add up but shake
    bound = 4 * 80 * 2 * 0.036 * EPS
    assert force < 20 * bound
    assert torque < 20 * 4 * bound


@every
@settings(deadline=None, max_examples=5)
@given(seeds)
def test_left_is_as_good_as_right(solid, weight, seed):
    one, two = moving(solid, weight, seed), moving(solid, weight, seed, mirrored=True)
    for _ in range(4):
        for fluid, wet, discs in (one, two):
            wet.advance(fluid, *discs)
    # four steps of 120 roundings of populations up to 0.5, and coverage by 16 r² roundings, in 60 cells
    bound = 4 * 120 * EPS * 60
    np.testing.assert_allclose(two[1].force * (-1, 1), one[1].force, rtol=0, atol=bound)
    np.testing.assert_allclose(-two[1].torque, one[1].torque, rtol=0, atol=4.5 * bound)
    for here, there, sign in zip(one[0].fields(), two[0].fields(), (1, -1, 1), strict=True):
        np.testing.assert_allclose(sign * there[:, ::-1], here, rtol=0, atol=bound)


@pytest.mark.parametrize("solid", SOLID_OPERATORS)
def test_an_operator_stays_in_single_precision(solid):
    law = choose_solid(solid, np.float32)
    b = np.float32(0.3)
    assert {type(v) for v in mix.py_func(*[b] * 25, law)} == {np.float32}
    assert {type(v) for v in taken.py_func(*[b] * 7, law)} == {np.float32}


def test_unknown_names_are_refused_with_the_known_ones():
    with pytest.raises(ValueError, match=r"SC4.*odd-SC1, SC1, SC2, SC3"):
        choose_solid("SC4", float)
    with pytest.raises(ValueError, match=r"B3.*B2, B1"):
        choose_weight("B3", 0.8, float)
