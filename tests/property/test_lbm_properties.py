"""Whatever the flow: closed boxes keep their mass, periodic ones their momentum, and turned boxes turn."""

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from porescale.lbm.boundary.sides import Sides
from porescale.lbm.collision.choose import OPERATORS
from porescale.lbm.fluid import Fluid

EPS = np.finfo(float).eps
NX, NY = 9, 7
STEPS = 7
# 63 cells with nine populations of size 0.05, ten roundings a step, all one way
BOUND = NX * NY * 9 * 0.05 * 10 * STEPS * EPS

kinds = st.sampled_from(
    [("wall", "wall"), ("slip", "slip"), ("wall", "slip"), ("slip", "wall"), ("periodic", "periodic")]
)
taus = st.floats(0.5001, 3.0)
seeds = st.integers(0, 10_000)
operators = st.fixed_dictionaries(
    {"operator": st.sampled_from(sorted(OPERATORS)), "smagorinsky": st.sampled_from([0.0, 0.1])}
)
open_kinds = st.sampled_from(
    [("velocity", "pressure"), ("pressure", "wall"), ("slip", "velocity"), ("pressure", "pressure")]
)


def flow(seed):
    random = np.random.default_rng(seed)
    return *(0.03 * random.uniform(-1, 1, (2, NY, NX))), 1 + 0.03 * random.uniform(-1, 1, (NY, NX))


def run(fluid, steps=STEPS):
    for _ in range(steps):
        fluid.advance()
    return fluid


@settings(max_examples=60)
@given(seeds, taus, kinds, kinds, st.floats(-0.05, 0.05), operators)
def test_no_side_makes_or_loses_mass(seed, tau, columns, rows, speed, operator):
    sides = Sides(*columns, *rows, speed, -speed, 0.5 * speed, speed)
    fluid = Fluid(NX, NY, tau, force=(1e-4, -2e-4), sides=sides, **operator)
    fluid.set_flow(*flow(seed))
    before = fluid.mass_excess()
    assert abs(run(fluid).mass_excess() - before) < BOUND


@settings(max_examples=40)
@given(seeds, taus, st.floats(-1e-3, 1e-3), st.floats(-1e-3, 1e-3), operators)
def test_a_periodic_box_gains_the_body_force_and_nothing_else(seed, tau, fx, fy, operator):
    sides = Sides("periodic", "periodic", "periodic", "periodic")
    fluid = Fluid(NX, NY, tau, force=(fx, fy), sides=sides, **operator)
    fluid.set_flow(*flow(seed))
    before = np.array(fluid.momentum())
    gained = np.array(run(fluid).momentum()) - before
    assert np.abs(gained - STEPS * NX * NY * np.array([fx, fy])).max() < BOUND


def numbers(left, right, bottom, top):
    """Speeds, velocities and densities of four sides, each its own."""
    along = dict(
        zip(("left_speed", "right_speed", "bottom_speed", "top_speed"), (left, right, bottom, top), strict=True)
    )
    through = {
        "left_velocity": (0.5 * left, left), "right_velocity": (0.5 * right, right),
        "bottom_velocity": (bottom, 0.5 * bottom), "top_velocity": (top, 0.5 * top),
    }  # fmt: skip
    dense = {"left_density": 1 + abs(left), "right_density": 1 + abs(right)}
    return along | through | dense | {"bottom_density": 1 + abs(bottom), "top_density": 1 + abs(top)}


@settings(max_examples=60)
@given(seeds, taus, kinds | open_kinds, kinds | open_kinds, operators)
def test_a_mirrored_box_mirrors_to_the_bit(seed, tau, columns, rows, operator):
    # The collision sums opposite pairs in an order that mirroring maps onto itself.
    ux, uy, rho = flow(seed)
    given_one, given_two = numbers(0.01, 0.02, 0.03, -0.01), numbers(0.02, 0.01, 0.03, -0.01)
    for side in ("left", "right", "bottom", "top"):
        vx, vy = given_two[f"{side}_velocity"]
        given_two[f"{side}_velocity"] = (-vx, vy)
        if side in ("bottom", "top"):
            given_two[f"{side}_speed"] *= -1
    one = Fluid(NX, NY, tau, force=(1e-4, -2e-4), sides=Sides(*columns, *rows, **given_one), **operator)
    two = Fluid(NX, NY, tau, force=(-1e-4, -2e-4), sides=Sides(*columns[::-1], *rows, **given_two), **operator)
    one.set_flow(ux, uy, rho)
    two.set_flow(-ux[:, ::-1], uy[:, ::-1], rho[:, ::-1])
    for ours, theirs, sign in zip(run(one).fields(), run(two).fields(), (1, -1, 1), strict=True):
        np.testing.assert_array_equal(ours, sign * theirs[:, ::-1])


@settings(max_examples=60)
@given(seeds, taus, kinds | open_kinds, kinds | open_kinds, operators)
def test_a_turned_box_turns(seed, tau, columns, rows, operator):
    # Rows and columns change places; sums are then in another order: round-off.
    ux, uy, rho = flow(seed)
    given_one, given_two = numbers(0.01, 0.02, 0.03, -0.01), numbers(0.03, -0.01, 0.01, 0.02)
    one = Fluid(NX, NY, tau, force=(1e-4, -2e-4), sides=Sides(*columns, *rows, **given_one), **operator)
    two = Fluid(NY, NX, tau, force=(-2e-4, 1e-4), sides=Sides(*rows, *columns, **given_two), **operator)
    one.set_flow(ux, uy, rho)
    two.set_flow(uy.T, ux.T, rho.T)
    d, ux, uy = run(one).fields()
    d2, ux2, uy2 = run(two).fields()
    for ours, theirs in ((d, d2), (ux, uy2), (uy, ux2)):
        np.testing.assert_allclose(ours, theirs.T, rtol=0, atol=60 * STEPS * EPS)
