"""Rate of the plain fluid: cells updated per second, and the share of the memory bandwidth that is."""

from __future__ import annotations

import numpy as np

from porescale.lbm.fluid import Fluid
from porescale.lbm.lattice import CX
from porescale.workbench.benchmarks import Benchmarks, Dtype, Work

BENCHMARKS = Benchmarks()

SIZE = 1024  # cells along a side: nine populations of float64 are 75 MB, beyond the caches
RELAXATION_TIME = 0.8
CELLS_A_CALL = 4e6  # long enough that two steps of a small box are not all that is timed


def steps_of(cells: int) -> int:
    """Steps of one call, an even number: even and odd steps cost differently."""
    return 2 * max(1, round(CELLS_A_CALL / (2 * cells)))


def bytes_of(dtype: Dtype) -> float:
    """Bytes a cell must move in a step: nine populations, read and written once."""
    return 2.0 * len(CX) * np.dtype(dtype).itemsize


@BENCHMARKS.row("lbm")
def bench_lbm(size: int | None, threads: int, dtype: Dtype) -> Work:
    """A box of ``size`` by ``size`` cells of moving fluid between walls, TRT."""
    side = SIZE if size is None else size
    fluid = Fluid(side, side, RELAXATION_TIME, dtype=dtype)
    fluid.set_flow(0.01, 0.005)
    steps = steps_of(side**2)

    def run() -> None:
        for _ in range(steps):
            fluid.advance()

    return Work(run, float(steps * side**2), "cells/s", side, bytes_of(dtype))
