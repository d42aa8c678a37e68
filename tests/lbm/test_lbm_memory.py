"""The fluid is one set of populations and little else, when it starts, when it steps and when it is read."""

import tracemalloc

import numpy as np
import pytest

from porescale.lbm.boundary.sides import Sides
from porescale.lbm.fluid import Fluid
from porescale.lbm.lattice import CX

SIDE = 1000
PAPER_SIDE = 12_000
GIGABYTE = 1e9
OPEN = Sides("velocity", "pressure", left_velocity=(0.01, 0.0))


def peaks(sides=None, operator="central"):
    """Most bytes held while a float32 box is made, started, stepped and read; numpy's arrays are counted."""
    warm = Fluid(8, 8, 0.6, operator=operator, sides=sides, dtype=np.float32)  # compiled before it counts
    warm.advance()
    warm.advance()
    found = []
    tracemalloc.start()
    try:
        fluid = Fluid(SIDE, SIDE, 0.6, operator=operator, sides=sides, dtype=np.float32)
        fluid.set_flow(0.01, 0.0)
        found.append(tracemalloc.get_traced_memory()[1])
        tracemalloc.reset_peak()
        before = tracemalloc.get_traced_memory()[0]
        for _ in range(4):
            fluid.advance()
        found.append(tracemalloc.get_traced_memory()[1] - before)
        fluid.fields()
        found.append(tracemalloc.get_traced_memory()[1])
    finally:
        tracemalloc.stop()
    return found


@pytest.mark.parametrize("sides", [None, OPEN], ids=["walls", "open"])
def test_a_box_of_the_papers_size_fits_into_eight_gigabytes(sides):
    start, step, read = peaks(sides)
    one_set = len(CX) * 4 * (SIDE + 2) ** 2
    # One set of populations; beside it 64 rows in double precision, some ten copies of nine: 0.4 of it at 1000 rows,
    # and lists of the rim, some kilobytes a cell of it; both grow with the side only.
    assert start < 2 * one_set
    # A step makes no array: views, numbers and kernels' arguments only.
    assert step < 20_000
    # Three fields, and while they are made one field's mask or product at most.
    assert read < one_set + 4 * 4 * SIDE**2 + (start - one_set)
    areal = one_set + 4 * 4 * SIDE**2
    lineal = start - one_set
    assert areal * (PAPER_SIDE / SIDE) ** 2 + lineal * PAPER_SIDE / SIDE < 8 * GIGABYTE


def test_two_sets_of_populations_would_not_fit():
    assert 2 * len(CX) * 4 * PAPER_SIDE**2 > 8 * GIGABYTE
