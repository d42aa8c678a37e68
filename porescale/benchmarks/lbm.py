"""Rate of the fluid: cells updated per second, and the share of the memory bandwidth that is."""

from collections.abc import Callable

import numpy as np

from porescale.common.core.errors import Fault, InputError
from porescale.common.evidence.benchmarks import CPU, Benchmarks, Dtype, Work
from porescale.lbm.collision.choose import OPERATORS, choose
from porescale.lbm.collision.smagorinsky import CONSTANT
from porescale.lbm.fluid import Fluid
from porescale.lbm.lattice import CX

BENCHMARKS = Benchmarks()

SIZE = 1024  # cells along a side: nine populations of float64 are 75 MB, beyond the caches
RELAXATION_TIME = 0.8
SMALLEST = 16  # a side that holds a disc, and rows to share among threads
CELLS_A_CALL = 4e6  # long enough that two steps of a small box are not all that is timed
MOST_STEPS = 2000  # of a call: a step of a few cells takes what starting its kernels takes, some 0.1 ms


def steps_of(cells: int) -> int:
    """Steps of one call, an even number: even and odd steps cost differently."""
    return 2 * max(1, round(min(CELLS_A_CALL / cells, MOST_STEPS) / 2))


def steps_on(device: str, cells: int) -> int:
    """The same on a device: a GPU takes them some hundred times as fast; in its simulator two."""
    if device == CPU:
        return steps_of(cells)
    from porescale.common.compiled.cuda import simulated

    return 2 if simulated() else steps_of(max(1, cells // 100))


def side_of(size: int | None) -> int:
    """Cells along a side; InputError when the box is too small to time anything but the start of a kernel."""
    if size is not None and size < SMALLEST:
        raise InputError(Fault("--size", size, "is too small to be timed", allowed=f">= {SMALLEST}"))
    return SIZE if size is None else size


def bytes_of(dtype: Dtype) -> float:
    """Bytes a cell must move in a step: nine populations, read and written once."""
    return 2.0 * len(CX) * np.dtype(dtype).itemsize


def memory_of(side: int, dtype: Dtype) -> int:
    """Bytes of the populations of a box."""
    return round(bytes_of(dtype) / 2) * side**2


@BENCHMARKS.row("lbm", gpu=True)
def bench_lbm(size: int | None, threads: int, dtype: Dtype, device: str = CPU) -> Work:
    """A box of ``size`` by ``size`` cells of moving fluid between walls, TRT."""
    side = side_of(size)
    steps = steps_on(device, side**2)
    run = plain(side, dtype, device)
    return Work(
        lambda: run(steps), float(steps * side**2), "cells/s", side, bytes_of(dtype), memory=memory_of(side, dtype),
        gpu=device != CPU,
    )  # fmt: skip


def plain(side: int, dtype: Dtype, device: str = CPU) -> Callable[[int], None]:
    """Does so many steps of a box of ``side``² cells without solids, and waits for the device."""
    kind, wait = kind_on(device)
    fluid = kind(side, side, RELAXATION_TIME, dtype=dtype)
    fluid.set_flow(0.01, 0.005)

    def run(steps: int) -> None:
        """So many steps of the fluid alone."""
        for _ in range(steps):
            fluid.advance()
        wait()

    return run


def kind_on(device: str) -> tuple[type[Fluid], Callable[[], None]]:
    """The fluid of a device, and what waits until it has done its steps."""
    if device == CPU:
        return Fluid, lambda: None
    from porescale.common.compiled.cuda import synchronize
    from porescale.lbm.device.fluid import DeviceFluid

    return DeviceFluid, synchronize


@BENCHMARKS.row("operators")
def bench_operators(size: int | None, threads: int, dtype: Dtype) -> list[Work]:
    """The same box with each collision operator in turn, without and with an eddy viscosity."""
    side = side_of(size)
    fluid = Fluid(side, side, RELAXATION_TIME, dtype=dtype)
    fluid.set_flow(0.01, 0.005)
    steps = steps_of(side**2)

    def work(operator: str, smagorinsky: float) -> Work:
        """Steps of a box with this operator."""
        law = choose(operator, RELAXATION_TIME, (0.0, 0.0), dtype, smagorinsky=smagorinsky)

        def run() -> None:
            """The steps, with the operator."""
            fluid.law = law
            for _ in range(steps):
                fluid.advance()

        variant = f"{operator}_eddies" if smagorinsky else operator
        return Work(
            run, float(steps * side**2), "cells/s", side, bytes_of(dtype), variant, memory=memory_of(side, dtype)
        )

    return [work(operator, constant) for operator in OPERATORS for constant in (0.0, CONSTANT)]
