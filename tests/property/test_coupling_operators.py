"""Every solid operator with its weights: mass and momentum of a cell and of moving discs, precision, names.

Mirrors, quarter turns and what is carried along: test_coupling_symmetries.py.
"""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from porescale.coupling.psm import SaturatedCells
from porescale.coupling.solid import exact_wall, odd_sc1, sc3
from porescale.coupling.solid.choose import SOLID_OPERATORS, choose_solid
from porescale.coupling.solid.law import SolidCell, blend, bounce, force_share, momentum_to_solid, rates
from porescale.coupling.weighting.choose import WEIGHTINGS, choose_weight, fitting_weight, fitting_weights
from porescale.coupling.weighting.law import weight
from porescale.lbm.boundary.sides import Sides
from porescale.lbm.collision.entry import MAGIC_MIDWAY_WALL
from porescale.lbm.collision.law import Macroscopic
from porescale.lbm.collision.trt import antisymmetric_rate
from porescale.lbm.fluid import Fluid
from porescale.lbm.lattice import CX, CY, WEIGHTS
from tests.reference.coupling import solid_operators as twin

EPS = np.finfo(float).eps
N = 20
PERIODIC = Sides("periodic", "periodic", "periodic", "periodic")
ORDER = [int(np.flatnonzero((np.array(CX) == x) & (np.array(CY) == y))[0]) for x, y in twin.DIRECTIONS.astype(int)]
"""Where the kernels keep the directions of the reference."""
ALL = [(s, w) for s in SOLID_OPERATORS for w in fitting_weights(s)]
every = pytest.mark.parametrize(("solid", "weight"), ALL)
seeds = st.integers(0, 10_000)


def cell(seed):
    """A cell far from equilibrium: populations (9,) in the reference's order, v, force, solid fraction, tau."""
    random = np.random.default_rng(seed)
    f = twin.WEIGHTS * (1 + 0.2 * random.uniform(-1, 1, 9))
    v, force = random.uniform(-0.1, 0.1, 2), random.uniform(-0.02, 0.02, 2)
    return f, v, force, random.choice([0.0, 1.0, *random.uniform(0, 1, 2)]), random.uniform(0.51, 2)


def collided(f, u, force, tau, seed):
    """The fluid operator of any lattice: mass and momentum of a step, the rest relaxed, the even half disturbed."""
    rho, third = f.sum(), antisymmetric_rate(tau, MAGIC_MIDWAY_WALL)
    noise = 0.01 * np.random.default_rng(seed).uniform(-1, 1, 9)
    noise = noise + noise[twin.BACK]
    noise[0] -= noise.sum()
    _, carried, rest = twin.halves(f)
    even = twin.equilibrium(rho, u)
    pushed = 3 * twin.WEIGHTS * (twin.DIRECTIONS @ force)
    return (even + even[twin.BACK]) / 2 + noise + carried + pushed + (1 - third) * rest


def expected_cell(name, f, g, force, v, e, b, tau):
    """Populations after a step, by the reference; the body force that acts in the cell has been put into g."""
    rho, acting = f.sum(), force if name in twin.WALLS else (1 - b) * force
    if name in twin.WALLS:
        return twin.exact_wall(f, g, rho, force, v, e, tau, antisymmetric_rate(tau, MAGIC_MIDWAY_WALL), name)
    u = (f @ twin.DIRECTIONS + acting / 2) / rho
    return (1 - b) * g + b * (f + twin.OPERATORS[name](f, rho, u, v, tau))


def mixed(name, f, g, force, v, e, b, tau, dtype=float):
    """The kernel's populations, and what it says the solid gains."""
    shifted, after = np.zeros(9), np.zeros(9)
    shifted[ORDER], after[ORDER] = f - twin.WEIGHTS, g - twin.WEIGHTS
    law = choose_solid(name, tau, antisymmetric_rate(tau, MAGIC_MIDWAY_WALL), dtype)
    rho, j, h = f.sum(), f @ twin.DIRECTIONS, force_share.py_func(b, law) * force / 2
    at, m = SolidCell(e, b, 0.0, *v, *h), Macroscopic(rho - 1, *(j + h), *((j + h) / rho))
    found = np.array(blend.py_func(shifted, after, at, m, 1 / tau, law)) + WEIGHTS
    ta, tx, ty = momentum_to_solid.py_func(at, rho, *j, 1 / tau, law)
    return found[ORDER], np.array([tx, ty]) - ta * v


@pytest.mark.parametrize("name", SOLID_OPERATORS)
@settings(max_examples=50)
@given(seeds)
def test_a_cell_is_that_of_its_formulas_and_its_load_what_it_loses(name, seed):
    f, v, force, e, tau = cell(seed)
    own = name in twin.WALLS
    b = twin.WALLS[name][0](e, tau) if own else e
    share = 1.0 if own else 1 - b
    g = collided(f, (f @ twin.DIRECTIONS + share * force / 2) / f.sum(), share * force, tau, seed + 1)
    expected = expected_cell(name, f, g, force, v, e, b, tau)
    found, gained = mixed(name, f, g, force, v, e, b, tau)
    # 40 roundings of numbers up to 1; quotients of the rates lose as many digits as 1/k has
    bound = 40 * EPS * max(1, 1 / (tau - 0.5))
    np.testing.assert_allclose(found, expected, rtol=0, atol=bound)
    assert abs(found.sum() - f.sum()) < bound
    # The force on the fluid part of the cell is that on the whole of it less what the solid holds back.
    lost = f @ twin.DIRECTIONS + force - found @ twin.DIRECTIONS
    if own:
        np.testing.assert_allclose(gained, lost - e * force, rtol=0, atol=bound)
    else:
        left = (1 - b) * (g @ twin.DIRECTIONS - f @ twin.DIRECTIONS)
        np.testing.assert_allclose(gained, lost - force + left, rtol=0, atol=bound)


@pytest.mark.parametrize(("name", "other"), [(a, b) for a in SOLID_OPERATORS for b in SOLID_OPERATORS if a != b])
def test_no_operator_passes_for_another(name, other):
    f, v, force, _, tau = cell(3)
    e = b = 0.6
    g = collided(f, f @ twin.DIRECTIONS / f.sum(), 0 * force, tau, 4)
    found, _ = mixed(name, f, g, 0 * force, v, e, b, tau)
    assert np.abs(found - expected_cell(other, f, g, 0 * force, v, e, b, tau)).max() > 1e-6


@settings(max_examples=50)
@given(st.floats(1e-6, 1 - 1e-6), st.floats(0.501, 3))
def test_the_rates_of_an_exact_wall_fulfil_its_condition(e, tau):
    # 1/beta + 2 lambda = 3/4 t/(k - k0 t) is what puts a plane wall of linear flow at its place
    t, k = 1 - e, tau - 0.5
    third, even = twin.wall_rates(e, tau, antisymmetric_rate(tau, MAGIC_MIDWAY_WALL))
    left = 1 / twin.wall_weight(e, tau) - 0.5 + 2 * (1 / third - 0.5)
    k0 = 1 / even - 0.5
    # t k0 is k less 3/4 t/R: the difference loses as many digits as R k/t has before the point
    assert left == pytest.approx(0.75 * t / (k - k0 * t), rel=1e3 * EPS * (1 + left * k / t) * (1 + k0))


@settings(max_examples=50)
@given(st.floats(1e-3, 1 - 1e-3), st.floats(0.501, 3))
def test_so_do_those_of_a_narrow_wall_and_a_channel_holds_what_it_should(e, tau):
    t, k = 1 - e, tau - 0.5
    third, even = twin.narrow_rates(e, tau, antisymmetric_rate(tau, MAGIC_MIDWAY_WALL))
    own, odd, k0 = 1 / twin.narrow_weight(e, tau) - 0.5, 1 / third - 0.5, 1 / even - 0.5
    # differences from a half lose as many digits as they are small: y X > 1e-9/k, lambda > 1e-4/k
    assert own + 2 * odd == pytest.approx(0.75 * t / (k - k0 * t), rel=1e-6 * max(1, k * k))
    # b <= 2, and the rates of the other two parts in their bounds: 0 <= s <= 2
    assert own >= 0
    assert 0 <= even <= 2
    assert odd >= 0


def test_the_share_of_a_narrow_wall_has_the_mean_that_cells_of_fluid_ask_for():
    # mean of t (t - y) over places: 1/24 would be right where gaps are wide, and is so at s = 0.16; chosen: 0.2
    t = (np.arange(2000) + 0.5) / 2000
    found = np.mean(t * (t - [twin.narrow_parts(1 - it, 0.3)[0] for it in t]))
    assert 1 / 24 < found < 1.25 / 24
    assert found != pytest.approx(1 / 24, rel=0.05)


@pytest.mark.parametrize("tau", [0.51, 0.8, 2.0])
def test_an_exact_wall_goes_over_into_fluid_and_into_a_rigid_cell(tau):
    fluid = antisymmetric_rate(tau, MAGIC_MIDWAY_WALL)
    tiny = 1e-9  # what remains is of first order in it, times 1/E = 20 and 1/k = 100
    assert twin.wall_rates(tiny, tau, fluid) == pytest.approx((fluid, 1 / tau), abs=1e4 * tiny)
    assert twin.wall_rates(1 - tiny, tau, fluid) == pytest.approx((2.0, 0.0), abs=1e4 * tiny)
    assert twin.wall_weight(0.0, tau) == 0
    assert twin.wall_weight(1.0, tau) == 1
    assert twin.narrow_rates(tiny, tau, fluid) == pytest.approx((fluid, 1 / tau), abs=1e4 * tiny)
    assert twin.narrow_rates(1 - tiny, tau, fluid) == pytest.approx((2.0, 0.0), abs=1e4 * tiny)
    assert twin.narrow_weight(tiny, tau) == pytest.approx(0, abs=1e4 * tiny)
    assert twin.narrow_weight(1 - tiny, tau) == pytest.approx(2, abs=1e4 * tiny)


def moving(solid, weight, seed):
    """A box of uneven flow with a force, before an even or an odd step; one to five discs, two of which share cells."""
    random = np.random.default_rng(seed)
    tau, discs = random.uniform(0.51, 2.0), random.integers(1, 6)
    force = np.array([2e-4, -1e-4]) * random.uniform(-1, 1, 2)
    ux, uy, rho = *(0.05 * random.uniform(-1, 1, (2, N, N))), 1 + 0.05 * random.uniform(-1, 1, (N, N))
    centre, velocity = random.uniform(0, N, (discs, 2)), random.uniform(-0.05, 0.05, (discs, 2))
    radius, spin = random.uniform(0.3, 5.0, discs), random.uniform(-0.01, 0.01, discs)
    centre[1:2] = centre[0] + (radius[:2].sum() - 0.3, 0.4)
    fluid = Fluid(N, N, tau, force=tuple(force), sides=PERIODIC)
    fluid.set_flow(ux, uy, rho)
    if random.integers(2):
        fluid.advance()
    wet = SaturatedCells(fluid, radius, solid_operator=solid, weighting=weight)
    return fluid, wet, (centre, velocity, spin)


@every
@settings(max_examples=10)
@given(seeds)
def test_what_discs_gain_the_fluid_loses(solid, weight, seed):
    fluid, wet, discs = moving(solid, weight, seed)
    for _ in range(3):  # a half-step correction has then built up
        before, mass = np.array(fluid.momentum()), fluid.mass_excess()
        wet.advance(fluid, *discs)
        wet.cover(*discs)
        if SOLID_OPERATORS[
            solid
        ].force_everywhere:  # the force acts in whole cells, and the solid gets back that on its part
            driven = np.sum(1 - np.minimum(wet.solid, 1)) * np.array(fluid.force)
        else:  # with u of half the force (1 - B) F/2, the odd half of a collision gives  F(1 - w-/2) + w-(1 - B) F/2
            b = wet.weights()
            odd = antisymmetric_rate(fluid.relaxation_time, MAGIC_MIDWAY_WALL)
            driven = np.sum((1 - b) * (1 - odd * b / 2)) * np.array(fluid.force)
        # 400 cells with nine populations of 0.05, ten roundings each, all one way
        bound = N * N * 9 * 0.05 * 10 * EPS
        assert np.abs(np.array(fluid.momentum()) - before - driven + wet.force.sum(axis=0)).max() < bound
        assert abs(fluid.mass_excess() - mass) < bound


@pytest.mark.parametrize("solid", SOLID_OPERATORS)
def test_an_operator_stays_in_single_precision(solid, monkeypatch):
    # Compiled ones hand numbers to Python in double precision.
    for name in ("rates", "_rates", "_missing_momentum", "add_partial"):
        monkeypatch.setattr(exact_wall, name, getattr(exact_wall, name).py_func)
    for module in (odd_sc1, sc3):
        monkeypatch.setattr(module, "bounce", bounce.py_func)
    law = choose_solid(solid, 0.8, 1.0, np.float32)
    b = np.float32(0.3)
    found = [
        *blend.py_func((b,) * 9, (b,) * 9, SolidCell(*[b] * 7), Macroscopic(*[b] * 5), b, law),
        *rates.py_func(*[b] * 5, law), *momentum_to_solid.py_func(SolidCell(*[b] * 7), b, b, b, b, law),
        force_share.py_func(b, law),
    ]  # fmt: skip
    assert {type(value) for value in found} == {np.float32}


@pytest.mark.parametrize("weighting", WEIGHTINGS)
def test_a_weight_stays_in_single_precision(weighting):
    b = np.float32(0.3)
    assert type(weight.py_func(b, b, b, b, choose_weight(weighting, 0.8, np.float32))) is np.float32


def test_unknown_names_are_refused_with_the_known_ones():
    with pytest.raises(ValueError, match=r"SC4.*exact-wall, odd-SC1, SC1, SC2, SC3"):
        choose_solid("SC4", 0.8, 1.0, float)
    with pytest.raises(ValueError, match=r"B3.*wall, B2, B1"):
        choose_weight("B3", 0.8, float)


@pytest.mark.parametrize("solid", SOLID_OPERATORS)
def test_every_operator_has_its_weights_and_refuses_others(solid):
    own = [w for s, w in ALL if s == solid]
    assert fitting_weight(solid, None) == own[0]
    assert [fitting_weight(solid, w) for w in own] == own
    for other in set(WEIGHTINGS) - set(own):
        with pytest.raises(ValueError, match=rf"{other}.*{solid}.*take '{own[0]}'"):
            SaturatedCells(Fluid(N, N, 0.7), np.array([4.0]), solid_operator=solid, weighting=other)
