"""Sums and extremes over all cells, beside a slow twin in numpy."""

import numpy as np
import pytest

from porescale.lbm.boundary.sides import Sides
from porescale.lbm.fluid import Fluid
from porescale.lbm.sanity import sane
from porescale.lbm.totals import ROWS, START, Totals, add_blocks, blocks_of, force_rows, totals_of

FORCE = (2e-4, -1e-4)
EPS = np.finfo(float).eps


def stirred(nx=5, ny=ROWS + 3, steps=0, dtype=np.float64, **more):
    """A box with a last block of three rows, in a random flow."""
    fluid = Fluid(nx, ny, 0.7, dtype=dtype, **{"force": FORCE, **more})
    random = np.random.default_rng(1)
    fluid.set_flow(*(0.05 * random.uniform(-1, 1, (2, ny, nx))), 1 + 0.01 * random.uniform(-1, 1, (ny, nx)))
    for _ in range(steps):
        fluid.advance()
    return fluid


def twin(fluid):
    """The same from the fields, in numpy and float64."""
    rho, ux, uy = (it.astype(float) for it in fluid.fields())
    fx, fy = FORCE if fluid.force_field is None else fluid.force_field
    square = ux**2 + uy**2
    return Totals(
        (rho - 1).sum(), (rho * ux - 0.5 * fx).sum(), (rho * uy - 0.5 * fy).sum(), (0.5 * rho * square).sum(),
        square.max(), (rho - 1).min(), (rho - 1).max(),
    )  # fmt: skip


def far(fluid):
    """How far totals are from the twin's, over what rounding may do."""
    cells, eps = fluid.nx * fluid.ny, np.finfo(fluid.populations.dtype).eps
    # A cell's density, momentum and energy carry at most 16 roundings of numbers up to 1; what is summed is below 1,
    # and the order of a sum of N float64 numbers moves it by N EPS of their sum at most.  Extremes are of one cell.
    bounds = [cells * (16 * eps + cells * EPS)] * 4 + [16 * eps] * 3
    return max(abs(a - b) / c for a, b, c in zip(fluid.totals(), twin(fluid), bounds, strict=True))


@pytest.mark.parametrize("dtype", [np.float32, np.float64])
@pytest.mark.parametrize("steps", [0, 1])
def test_totals_are_those_of_the_fields(steps, dtype):
    assert far(stirred(steps=steps, dtype=dtype)) < 1


def test_totals_without_the_last_rows_are_others():
    """The check that must fail: what the last, shorter block holds is not forgotten."""
    fluid = stirred()
    blocks = blocks_of(fluid.nx, fluid.ny)
    add_blocks(fluid.padded, fluid.nx, 0, force_rows(FORCE, None, fluid.nx, float), START, blocks)
    short, whole = totals_of(blocks[:1]), twin(fluid)
    assert totals_of(blocks) == fluid.totals()
    assert abs(short.energy - whole.energy) > 1e-3 * whole.energy


def test_a_force_of_every_cell_is_in_the_energy():
    fluid = stirred(force=(0.0, 0.0))
    still = fluid.totals()
    fluid.set_force_field(np.random.default_rng(2).uniform(-1e-3, 1e-3, (2, fluid.ny, fluid.nx)))
    assert far(fluid) < 1
    assert fluid.totals().energy != still.energy


@pytest.mark.parametrize("name", ["first", "last"])
def test_a_number_that_is_none_anywhere_is_seen(name):
    fluid = stirred()
    assert sane(fluid)
    row, column = {"first": (1, 1), "last": (fluid.ny, fluid.nx)}[name]
    fluid.populations[0, row, column] = np.nan
    found = fluid.totals()
    assert np.isnan([found.mass, found.energy, found.fastest, found.density_change]).all()
    assert not sane(fluid)


def test_the_change_of_density_is_the_larger_one():
    for density in (0.9, 1.1):
        fluid = Fluid(4, 4, 0.7)
        field = np.ones((4, 4))
        field[2, 1] = density
        fluid.set_flow(0, 0, field)
        assert fluid.totals().density_change == pytest.approx(0.1, abs=16 * EPS)
        fluid.set_flow(0, 0, 1 + 6 * (field - 1))
        assert not sane(fluid)


def test_plates_are_read_through_at_odd_steps():
    fluid = stirred(7, 6, sides=Sides("wall", "wall", "slip", "wall"))
    plate = fluid.add_plate(3)
    plate.lower_edge, plate.speed = 2.0, 0.01
    fluid.advance()
    assert far(fluid) < 1
    with_plate = fluid.totals()
    fluid.plates.clear()
    assert fluid.totals().jx != with_plate.jx
