"""Rate of the fluid with grains in it: coverage anew, saturated cells and loads in each step; plain fluid beside it."""

import math
from collections.abc import Callable

import numpy as np

from porescale.benchmarks.lbm import RELAXATION_TIME, bytes_of, kind_on, memory_of, plain, side_of, steps_on
from porescale.common.evidence.benchmarks import CPU, PLAIN, Benchmarks, Dtype, Work
from porescale.coupling.step import cells_of

BENCHMARKS = Benchmarks()

SOLID = 0.22  # of the cells, about what the column of Saito et al. is of its box
DIAMETER = 12.0  # cells, about: between draft (5) and standard (15) of the column collapse
SPEED = 0.02  # cells per step


def stirred(side: int, dtype: Dtype, device: str = CPU) -> Callable[[int], None]:
    """Does so many steps of a box of ``side``² cells, ``SOLID`` of it in discs that move and spin.

    The discs swing about the points of a square lattice, so that their coverage is new in every step.
    """
    kind, wait = kind_on(device)
    fluid = kind(side, side, RELAXATION_TIME, dtype=dtype)
    across = max(1, round(side * math.sqrt(4 * SOLID / math.pi) / DIAMETER))
    pitch = side / across
    x, y = np.meshgrid((np.arange(across) + 0.5) * pitch, (np.arange(across) + 0.5) * pitch)
    home = np.stack((x, y), axis=-1).reshape(-1, 2)
    count = len(home)
    phase = np.random.default_rng(1).uniform(0, 2 * np.pi, count)
    velocity = SPEED * np.stack((np.cos(phase), np.sin(phase)), axis=-1)
    centre, spin = home.copy(), SPEED / DIAMETER * np.cos(3 * phase)
    wet = cells_of(fluid)(fluid, np.full(count, pitch * math.sqrt(SOLID / math.pi)))

    def run(steps: int) -> None:
        """So many steps; discs turn round every 64."""
        for _ in range(steps):
            if fluid.step % 64 == 32:
                np.negative(velocity, out=velocity)
            np.add(centre, velocity, out=centre)
            wet.advance(fluid, centre, velocity, spin)
        wait()

    return run


@BENCHMARKS.row("psm", gpu=True)
def bench_psm(size: int | None, threads: int, dtype: Dtype, device: str = CPU) -> list[Work]:
    """A box of ``size`` by ``size`` cells, 22 % of it solid and moving, and ``psm.plain``: the same box without discs.

    The ratio of their rates, measured in turns, is what the discs leave of the fluid's rate.
    """
    side = side_of(size)
    steps, gpu = steps_on(device, side**2), device != CPU
    wet, dry = stirred(side, dtype, device), plain(side, dtype, device)
    updates, moved, memory = float(steps * side**2), bytes_of(dtype), memory_of(side, dtype)
    return [
        Work(lambda: wet(steps), updates, "cells/s", side, moved, memory=memory, gpu=gpu),
        Work(lambda: dry(steps), updates, "cells/s", side, moved, PLAIN, yardstick=True, memory=memory, gpu=gpu),
    ]
