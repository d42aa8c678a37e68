"""Soft rims are those of their formulas, cell by cell and disc by disc, also across the sides of a periodic box."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from porescale.coupling.psm import SaturatedCells
from porescale.coupling.solid.choose import choose_solid
from porescale.coupling.solid.law import SolidCell, blend, momentum_to_solid
from porescale.coupling.weighting.choose import choose_weight
from porescale.coupling.weighting.law import weight
from porescale.lbm.boundary.sides import Sides
from porescale.lbm.collision.law import Macroscopic
from porescale.lbm.fluid import Fluid
from porescale.lbm.lattice import CX, CY
from tests.reference.coupling import psm, soft_rim
from tests.reference.coupling import solid_operators as solid
from tests.reference.lbm import lbm

EPS = np.finfo(float).eps
PERIODIC = Sides("periodic", "periodic", "periodic", "periodic")
NX, NY, TAU = 22, 18, 0.52
SLIP = (0.01, 0.03, 0.0)
ORDER = [int(np.flatnonzero((np.array(CX) == x) & (np.array(CY) == y))[0]) for x, y in solid.DIRECTIONS.astype(int)]


def discs():
    """Three that share cells once they are smeared; the last sits astride two sides."""
    return [
        psm.Disc(6.3, 7.1, 3.4, 0.05, 0.02, 0.01), psm.Disc(12.4, 8.6, 2.8, -0.04, 0.03, -0.02),
        psm.Disc(20.9, 16.2, 2.2, 0.03, 0.05, 0.03),
    ]  # fmt: skip


def differences(wrong=None, steps=4):
    """Largest differences of loads, torques, flow and slips between kernels and twin."""
    there = discs()
    box = soft_rim.SoftBox(NX, NY, TAU, there, SLIP, wrong)
    random = np.random.default_rng(5)
    rho, ux, uy = 1 + 0.01 * random.uniform(-1, 1, (NY, NX)), *(0.05 * random.uniform(-1, 1, (2, NY, NX)))
    box.lattice.f = lbm.equilibrium(rho, ux, uy)
    fluid = Fluid(NX, NY, TAU, operator="central", sides=PERIODIC)
    fluid.set_flow(ux, uy, rho)
    wet = SaturatedCells(fluid, np.array([d.r for d in there]), soft_rim=True)
    wet.soft_rim.slip[:] = SLIP
    worst = np.zeros(4)
    for _ in range(steps):
        place, motion = np.array([(d.x, d.y) for d in there]), np.array([(d.u, d.v) for d in there])
        wet.advance(fluid, place, motion, np.array([d.w for d in there]))
        force, torque = box.step(there)
        for d in there:
            d.x, d.y = d.x + d.u, d.y + d.v
        density, jx, _ = box.lattice.moments()
        now, vx, _ = fluid.fields(np.ones_like(density))
        pairs = (wet.force, force), (wet.torque, torque), (now * vx, jx), (wet.soft_rim.slip, box.slip)
        worst = np.maximum(worst, [np.abs(np.subtract(*pair)).max() for pair in pairs])
    return worst


def test_soft_rims_are_those_of_the_formulas():
    force, torque, flow, slip = differences()
    # as for sharp ones (test_coupling_step.py), 120 eps a cell and step; rates with 1/k = 50 lose two digits of k
    bound = 4 * 120 * EPS * 50
    assert flow < bound
    assert force < 40 * bound
    assert torque < 3.4 * 40 * bound
    assert slip < bound


@pytest.mark.parametrize("wrong", ["filter", "radius", "stiffness", "odd"])
def test_what_is_left_out_of_a_soft_rim_is_missed(wrong):
    assert differences(wrong, steps=2).max() > 1e-5


@settings(deadline=None, max_examples=50)
@given(st.integers(0, 10_000))
def test_a_soft_cell_is_that_of_its_formulas_and_its_load_what_it_loses(seed):
    random = np.random.default_rng(seed)
    f = solid.WEIGHTS * (1 + 0.2 * random.uniform(-1, 1, 9))
    v, tau, theta = random.uniform(-0.1, 0.1, 2), random.uniform(0.501, 0.8), random.uniform(0, 1)
    e = random.choice([0.0, 1.0, random.uniform(0, 1)])
    rho, j = f.sum(), f @ solid.DIRECTIONS
    g = lbm.equilibrium(rho, *(j / rho))  # central moments at rate 1
    expected, b, _ = soft_rim.cell(f, g, v, e, tau, 1.0, theta)
    law = choose_solid("exact-wall", tau, 1.0, float, soft=True)
    zero = np.float64(0.0)
    own = weight.py_func(e, theta, *(j / rho - v), choose_weight("wall", tau, float, soft=True))
    assert own == pytest.approx(b, rel=20 * EPS)
    shifted, after = np.zeros(9), np.zeros(9)
    shifted[ORDER], after[ORDER] = f - solid.WEIGHTS, g - solid.WEIGHTS
    cell, m = SolidCell(e, own, theta, *v, zero, zero), Macroscopic(rho - 1, *j, *(j / rho))
    found = np.array(blend.py_func(shifted, after, cell, m, 1 / tau, law))
    found = found[ORDER] + solid.WEIGHTS
    bound = 40 * EPS * max(1, 1 / (tau - 0.5))  # as for sharp cells
    np.testing.assert_allclose(found, expected, rtol=0, atol=bound)
    assert abs(found.sum() - rho) < bound
    ta, tx, ty = momentum_to_solid.py_func(cell, rho, *j, 1 / tau, law)
    np.testing.assert_allclose(np.array([tx, ty]) - ta * v, j - found @ solid.DIRECTIONS, rtol=0, atol=bound)


def test_slips_at_a_rim_do_not_depend_on_the_place_of_the_sides():
    # the box moved by whole cells, so that the disc sits astride its sides: round-off of means of 30 cells
    slips = []
    for x in (10.3, 21.3, 0.3):
        fluid = Fluid(NX, NY, TAU, operator="central", sides=PERIODIC)
        wet = SaturatedCells(fluid, np.array([4.2]), soft_rim=True)
        for _ in range(5):
            wet.advance(fluid, np.array([[x, 9.1]]), np.array([[0.05, 0.02]]), np.zeros(1))
        slips.append(float(wet.soft_rim.slip[0]))
    assert slips == pytest.approx([slips[0]] * 3, rel=1e3 * EPS)
