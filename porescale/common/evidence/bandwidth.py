"""How fast this machine reads and writes memory in place: the ceiling of all that streams over arrays."""

import numpy as np

from porescale.common.compiled.jit import parallel_kernel, prange, set_threads, threads

BLOCKS = 64
"""Equal parts of the array, spread over the threads."""


@parallel_kernel
def flip(values, one):
    """values[b, i] <- one - values[b, i], in place.

    values : (blocks, n) any float, overwritten;  one : 1 in the type of values.  Calling it twice gives the
    same array back, up to rounding.  Source: the in-place "scale" of McCalpin's STREAM, with one array.
    """
    for block in prange(values.shape[0]):
        for i in range(values.shape[1]):
            values[block, i] = one - values[block, i]


class Copy:
    """In-place read-modify-write of one array; ``bytes`` counts the read and the write of one call."""

    def __init__(self, count: int | None = None, dtype: str = "float64", size: int = 2**28) -> None:
        """count : threads (None: all);  dtype : "float32" or "float64";  size : bytes of the array.

        The array must be several times larger than the caches: 256 MiB by default.
        """
        kind = np.dtype(dtype)
        self.count = count
        self.values = np.full((BLOCKS, max(1, size // (BLOCKS * kind.itemsize))), 0.25, kind)
        self.one = kind.type(1)
        self.bytes = 2 * self.values.nbytes

    def __call__(self) -> None:
        """Go over the array once, on this copy's number of threads."""
        before = threads()
        set_threads(self.count)
        flip(self.values, self.one)
        set_threads(before)
