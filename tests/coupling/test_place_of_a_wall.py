"""Where a row of partially saturated cells puts a plane wall: the equation of docs/theory/saturated_cells.md."""

import math

import numpy as np
import pytest

from porescale.coupling.coverage.rectangle import Rectangle
from porescale.coupling.psm import SaturatedCells
from porescale.lbm.boundary.sides import Sides
from porescale.lbm.collision.entry import MAGIC_MIDWAY_WALL
from porescale.lbm.collision.trt import antisymmetric_rate
from porescale.lbm.fluid import Fluid
from porescale.lbm.lattice import viscosity
from porescale.validation.coupling.setups import NO_DISCS
from porescale.validation.lbm.channels import run

HEIGHT, SOLID = 8, 2
"""Rows of the box, and full rows of solid at its bottom."""
NOTHING = 1e-30
"""Of a force: less than any rounding, in the sweeps of driven fluid, which other tests compile, too."""


def seen(operator: str, weighting: str, fraction: float, tau: float) -> float:
    """T: share of the row that is fluid as the flow sees it, by the equation."""
    k, wall = tau - 0.5, fraction
    b = wall if weighting == "B1" else wall * k / ((1 - wall) + k)
    third = (1 - b) * antisymmetric_rate(tau, MAGIC_MIDWAY_WALL) + 2 * b
    own, k0 = (2 * b if operator == "SC3" else b), tau / (1 - b) - 0.5
    x = 1 / own - 0.5 + 2 * (1 / third - 0.5)
    return 4 * k * x / (3 + 4 * k0 * x)


def measured(operator: str, weighting: str | None, fraction: float, tau: float) -> float:
    """The same from a plane Couette flow above a rectangle that covers ``fraction`` of a row."""
    sides = Sides("periodic", "periodic", "wall", "wall", top_speed=1e-3)
    fluid = Fluid(3, HEIGHT, tau, force=(NOTHING, 0.0), sides=sides)
    solid = Rectangle((0.0, -2.0), (3.0, SOLID + fraction))
    wet = SaturatedCells(fluid, np.zeros(0), solid_operator=operator, weighting=weighting, rectangles=[solid])
    steps = math.ceil(30 * HEIGHT**2 / (math.pi**2 * viscosity(tau)))  # the rest of a start is exp(-30) = 1e-13
    run(lambda: wet.advance(fluid, *NO_DISCS), steps)
    u = fluid.fields()[1][SOLID + 2 :, 1]
    slope = u[-1] - u[-2]
    return 1 - (SOLID + 2.5 - u[0] / slope - SOLID)


CASES = [("odd-SC1", "B2", 0.8), ("SC1", "B2", 1.5), ("SC3", "B1", 1.5)]


@pytest.mark.parametrize(("operator", "weighting", "tau"), CASES)
@pytest.mark.parametrize("fraction", [0.25, 0.75])
def test_a_wall_lies_where_its_rates_put_it(operator, weighting, tau, fraction):
    # What is left: the start, 1e-13, and terms quadratic in velocity, 1e-3² of it, which vanish in flow along a wall.
    assert measured(operator, weighting, fraction, tau) == pytest.approx(
        seen(operator, weighting, fraction, tau), abs=1e-8
    )


@pytest.mark.parametrize("tau", [0.8, 1.5])
def test_an_exact_wall_lies_where_it_is(tau):
    assert measured("exact-wall", None, 0.3, tau) == pytest.approx(0.7, abs=1e-8)


def test_another_weight_puts_the_wall_elsewhere():  # the check that must fail
    assert abs(measured("odd-SC1", "B1", 0.25, 0.8) - seen("odd-SC1", "B2", 0.25, 0.8)) > 0.3
