"""Why no cell of water is left out where water rests: under a collapse there is none such."""

import numpy as np
import pytest

from porescale import build
from porescale.benchmarks.minimal_lbm import largest_of_rows
from tests.reference.scenes import column

SLOW = 1e-6
"""Cells a step, below which a cell may be said to rest: 1e-3 of a cell in a thousand steps."""
BLOCK = 8
"""Cells along a block: smaller ones would have more rims, which must be done whoever rests, than cells within."""


def resting(simulation) -> float:
    """Share of blocks of cells all of which go slower than that."""
    _, ux, uy = simulation.fluid.fields()
    slow = np.hypot(ux, uy) < SLOW
    high, wide = (size // BLOCK for size in slow.shape)
    blocks = slow[: high * BLOCK, : wide * BLOCK].reshape(high, BLOCK, wide, BLOCK)
    return float(blocks.all(axis=(1, 3)).mean())


@pytest.mark.slow
def test_sound_leaves_no_water_at_rest_in_a_collapse():
    # The gate opens at step 50.  Sound crosses 60 cells in 104 steps and meets walls that send it back.
    simulation = build(column(gate__lift_speed=None))
    assert resting(simulation) == 1.0  # before anything moves: the twin
    simulation.advance(250)
    for _ in range(8):
        simulation.advance(50)
        assert resting(simulation) == 0.0


def test_a_look_finds_the_row_that_moves():
    f = np.zeros((9, 6, 8))
    f[3, 4, 5] = -2e-9
    f[5, 0, 0] = 1.0  # beside the cells
    largest = np.zeros(4)
    largest_of_rows.py_func(f, np.zeros(6), largest)
    assert largest.tolist() == [0.0, 0.0, 0.0, 2e-9]
