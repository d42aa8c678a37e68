"""How fast a GPU reads and writes its memory in place: the ceiling of all that streams over arrays there."""

from typing import Any

import numpy as np

from porescale.common.compiled.cuda import device_kernel, grid, launch, synchronize, to_device
from porescale.common.evidence.bandwidth import STREAMS
from porescale.common.evidence.timing import seconds_of

THREADS = 256
"""Threads of a block."""


def flip_there(values: Any, one: Any) -> None:
    """values[i, k] <- one - values[i, k] for every stream i, in place: ``flip_nine`` of bandwidth.py.

    values : (streams, n), overwritten;  one : 1;  threads : an entry k each.
    """
    k = grid()
    if k < values.shape[1]:
        for i in range(values.shape[0]):
            values[i, k] = one - values[i, k]


class DeviceCopy:
    """In-place read-modify-write of memory of the GPU, in one stream and in nine; ``bytes`` counts the read and the
    write of one call.

    In float64 for work of either precision: words of eight bytes come faster than those of four.
    """

    def __init__(self, size: int = 2**28) -> None:
        """size : bytes of the memory, that of the work whose ceiling it is to be."""
        n = max(1, size // (STREAMS * 8))
        self.nine = to_device(np.full((STREAMS, n), 0.25))
        self.values = self.nine.reshape((1, STREAMS * n))
        self.bytes = 2 * STREAMS * n * 8
        self._kernel = device_kernel(flip_there, object, np.float64)

    def seconds(self) -> float:
        """Seconds in which the memory is gone over once: the faster of both forms."""
        return min(seconds_of(lambda: self._flip(self.values)), seconds_of(lambda: self._flip(self.nine)))

    def _flip(self, values: Any) -> None:
        """Go over the memory once, and wait for it."""
        launch(self._kernel, values.shape[1], THREADS, values, 1.0)
        synchronize()
