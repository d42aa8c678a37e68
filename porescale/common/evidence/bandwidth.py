"""How fast this machine reads and writes memory in place: the ceiling of all that streams over arrays."""

import numpy as np

from porescale.common.compiled.jit import parallel_kernel, prange, set_threads, threads
from porescale.common.core.aligned import aligned_zeros
from porescale.common.evidence.timing import seconds_of

BLOCKS = 64
"""Equal parts of the array, spread over the threads."""
STREAMS = 9
"""Arrays that a lattice of nine populations goes over side by side."""
LINE_CELLS = 16
"""Parts of arrays are a multiple of this long: whole lines of the cache in single and in double precision."""


@parallel_kernel
def flip(values, one):
    """values[b, i] <- one - values[b, i], in place: one stream for each thread.

    values : (blocks, n) any float, overwritten;  one : 1 in the type of values.  Calling it twice gives the
    same array back, up to rounding.  Source: the in-place "scale" of McCalpin's STREAM, with one array.
    """
    for block in prange(values.shape[0]):
        for i in range(values.shape[1]):
            values[block, i] = one - values[block, i]


@parallel_kernel
def flip_nine(values, one):
    """The same in nine streams side by side for each thread.

    values : (9, blocks, n) any float, overwritten;  one : 1 in the type of values.
    """
    for block in prange(values.shape[1]):
        a0, a1, a2 = values[0, block], values[1, block], values[2, block]
        a3, a4, a5 = values[3, block], values[4, block], values[5, block]
        a6, a7, a8 = values[6, block], values[7, block], values[8, block]
        for i in range(values.shape[2]):
            a0[i], a1[i], a2[i] = one - a0[i], one - a1[i], one - a2[i]
            a3[i], a4[i], a5[i] = one - a3[i], one - a4[i], one - a5[i]
            a6[i], a7[i], a8[i] = one - a6[i], one - a7[i], one - a8[i]


class Copy:
    """In-place read-modify-write of aligned memory, in one stream a thread and in nine; ``bytes`` counts the read and
    the write of one call."""

    def __init__(self, count: int | None = None, dtype: str = "float64", size: int = 2**28) -> None:
        """count : threads (None: all);  dtype : "float32" or "float64";  size : bytes of the memory.

        What is to be the ceiling of a piece of work has its size: memory that fits a cache is faster.
        """
        kind = np.dtype(dtype)
        self.count = count
        cells = size // (STREAMS * BLOCKS * kind.itemsize) // LINE_CELLS * LINE_CELLS
        self.nine = aligned_zeros((STREAMS, BLOCKS, max(LINE_CELLS, cells)), kind)
        self.nine += 0.25
        self.values = self.nine.reshape(BLOCKS, -1)
        self.one = kind.type(1)
        self.bytes = 2 * self.values.nbytes

    def seconds(self) -> float:
        """Seconds in which the memory is gone over once on this copy's number of threads: the faster of both forms."""
        before = threads()
        set_threads(self.count)
        spent = min(seconds_of(lambda: flip(self.values, self.one)), seconds_of(lambda: flip_nine(self.nine, self.one)))
        set_threads(before)
        return spent
