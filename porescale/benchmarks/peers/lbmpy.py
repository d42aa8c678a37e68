"""Plain fluid beside lbmpy (Bauer, Köstler & Rüde 2021), which writes C for the lattice and compiles it.

The same work: D2Q9, TRT with the same magic parameter, shifted populations, in place by the AA pattern, one array; with
vectors as wide as the machine has, and OpenMP on several threads.  Ours closes its four walls in each step; lbmpy's
kernel leaves the sides as they are.
"""

from typing import Any

import numpy as np

from porescale.benchmarks.lbm import RELAXATION_TIME, plain, side_of, steps_of
from porescale.common.core.errors import Fault, InputError
from porescale.common.core.extras import extra
from porescale.common.evidence.benchmarks import Benchmarks, Dtype, Work

PEERS = Benchmarks()


@PEERS.row("lbmpy")
def against_lbmpy(size: int | None, threads: int, dtype: Dtype) -> list[Work]:
    """A box of ``size``² cells of moving fluid: ours, and lbmpy's kernels for even and odd steps."""
    side = side_of(size)
    steps, ours = steps_of(side**2), plain(side, dtype)
    array, kernels = populations(side, dtype), [made_by_lbmpy(odd, dtype, threads) for odd in (False, True)]

    def theirs() -> None:
        """The same steps by lbmpy."""
        for _ in range(steps // 2):
            for kernel in kernels:
                kernel(src=array)

    updates = float(steps * side**2)
    return [
        Work(lambda: ours(steps), updates, "cells/s", side, variant="ours"),
        Work(theirs, updates, "cells/s", side, variant="peer", yardstick=True),
    ]


def populations(side: int, dtype: Dtype) -> Any:
    """Shifted populations of moving fluid as lbmpy indexes them, (x, y, 9); x is next to each other in memory."""
    array = np.zeros((9, side + 2, side + 2), dtype).transpose(2, 1, 0)
    array[...] = 1e-3 * np.random.default_rng(0).random(array.shape)
    return array


def made_by_lbmpy(odd: bool, dtype: Dtype, threads: int) -> Any:
    """lbmpy's compiled kernel for even or odd steps.  InputError where lbmpy or a compiler is missing."""
    lbm, ps = extra("lbmpy"), extra("pystencils")
    time = extra("lbmpy.advanced_streaming").Timestep
    config = lbm.LBMConfig(
        stencil=lbm.LBStencil(lbm.Stencil.D2Q9), method=lbm.Method.TRT, relaxation_rate=1 / RELAXATION_TIME,
        streaming_pattern="aa", timestep=time.ODD if odd else time.EVEN, compressible=True, zero_centered=True,
    )  # fmt: skip
    field = ps.fields(f"src(9): {dtype}[2D]", layout="fzyx")
    rule = lbm.create_lb_update_rule(lbm_config=config, lbm_optimisation=lbm.LBMOptimisation(symbolic_field=field))
    chosen = ps.CreateKernelConfig(target=ps.Target.CurrentCPU, default_dtype=dtype, ghost_layers=1)
    chosen.cpu.openmp.enable = threads > 1
    if threads > 1:
        chosen.cpu.openmp.num_threads = threads
    chosen.cpu.vectorize.enable = chosen.cpu.vectorize.assume_inner_stride_one = True
    try:
        return ps.create_kernel(rule, chosen).compile()
    except Exception as raised:  # pystencils raises its own of many kinds, for a missing compiler too
        repair = "install a C++ compiler, such as g++"
        text = str(raised).strip().split("\n")[0]
        raise InputError(Fault("lbmpy", None, f"cannot compile its kernel ({text})", repair=repair)) from None
