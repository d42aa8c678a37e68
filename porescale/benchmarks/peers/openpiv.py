"""Pairs of pictures beside OpenPIV: passes at 64, 32 and 16 px with deformation, half overlap, its defaults."""

import io
from contextlib import redirect_stdout

import numpy as np

from porescale.benchmarks.piv import SIZE, checked
from porescale.common.core.extras import extra
from porescale.common.evidence.benchmarks import Benchmarks, Dtype, Work
from porescale.piv.estimate.measure import measure
from porescale.piv.images.flows import lamb_oseen
from porescale.piv.images.synth import Camera, pair

PEERS = Benchmarks()
WINDOWS = (64, 32, 16)


@PEERS.row("openpiv")
def against_openpiv(size: int | None, threads: int, dtype: Dtype) -> list[Work]:
    """A pair of pictures ``size`` px a side, of a vortex: ours, and OpenPIV's, on one thread whatever ``threads``."""
    side = SIZE if size is None else checked(size)
    settings = extra("openpiv.settings").PIVSettings(
        windowsizes=WINDOWS, overlap=tuple(it // 2 for it in WINDOWS), num_iterations=len(WINDOWS)
    )
    multipass = extra("openpiv.windef").simple_multipass
    made = pair(lamb_oseen((side, side), 6.0, side / 8), Camera((side, side)))
    first, second = (np.ascontiguousarray(it) for it in (made.first, made.second))
    whole = [it.astype(np.int32) for it in (first, second)]

    def theirs() -> None:
        """The same pair by OpenPIV, which prints as it goes."""
        with redirect_stdout(io.StringIO()):
            multipass(*whole, settings)

    return [
        Work(lambda: measure(first, second), 1.0, "pairs/s", side, variant="ours"),
        Work(theirs, 1.0, "pairs/s", side, variant="peer", yardstick=True),
    ]
