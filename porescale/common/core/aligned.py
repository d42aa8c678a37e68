"""Arrays that begin where a line of the cache does: vectors that straddle two lines cost twice."""

import numpy as np
from numpy.typing import DTypeLike, NDArray

LINE = 64
"""Bytes of a line of the cache."""


def aligned_zeros(shape: int | tuple[int, ...], dtype: DTypeLike, first: int = 0) -> NDArray[np.floating]:
    """Zeros of ``shape``, contiguous, whose element ``first``, counted as if they were flat, begins a line."""
    size, count = np.dtype(dtype).itemsize, int(np.prod(shape))
    memory = np.zeros(count + LINE // size, dtype)
    skipped = -(memory.ctypes.data // size + first) % (LINE // size)
    return memory[skipped : skipped + count].reshape(shape)
