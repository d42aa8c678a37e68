"""Rate of measuring image pairs: passes at 64, 32 and 16 px with deformation, half overlap."""

import numpy as np

from porescale.common.core.errors import Fault, InputError
from porescale.common.evidence.benchmarks import Benchmarks, Dtype, Work
from porescale.piv.estimate.measure import measure
from porescale.piv.images.flows import lamb_oseen
from porescale.piv.images.synth import Camera, pair

BENCHMARKS = Benchmarks()

SIZE = 512  # px a side
SMALLEST, LARGEST = 64, 4096


@BENCHMARKS.row("piv")
def bench_piv(size: int | None, threads: int, dtype: Dtype) -> list[Work]:
    """Pairs of pictures ``size`` px a side, of a vortex; the kernels compute in float32 whatever ``dtype``.

    Without ``size`` pairs of 512 and of 1024 px.  InputError for sizes out of range.
    """
    if size is not None:
        return [_work(checked(size), "")]
    return [_work(side, "" if side == SIZE else "large") for side in (SIZE, 1024)]


def checked(size: int) -> int:
    """A size of pictures; InputError if it is out of range."""
    if not SMALLEST <= size <= LARGEST:
        raise InputError(Fault("--size", size, "is out of range", "px", f"{SMALLEST} to {LARGEST}"))
    return size


def _work(side: int, variant: str) -> Work:
    made = pair(lamb_oseen((side, side), 6.0, side / 8), Camera((side, side)))
    first, second = (np.ascontiguousarray(it) for it in (made.first, made.second))
    return Work(lambda: measure(first, second), 1.0, "pairs/s", side, variant=variant)
