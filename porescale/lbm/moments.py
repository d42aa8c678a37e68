"""Density and momentum of every cell, from the slots at even and odd steps."""

import numpy as np
from numpy.typing import NDArray

from porescale.common.compiled.jit import inline, parallel_kernel, prange
from porescale.lbm.collision.law import moments
from porescale.lbm.stream import even_slots, odd_slots


@inline
def _moment_row(planes, d, jx, jy):
    """Moments of one row, the nine slots (nx,) of which are ``planes``, into d, jx, jy (nx,)."""
    a0, a1, a2, a3, a4, a5, a6, a7, a8 = planes
    for x in range(d.shape[0]):
        d[x], jx[x], jy[x] = moments((a0[x], a1[x], a2[x], a3[x], a4[x], a5[x], a6[x], a7[x], a8[x]))


@parallel_kernel
def _moments_even(f, d, jx, jy):
    """Density excess and first moments, each (ny, nx), of populations f before an even step."""
    for y in prange(d.shape[0]):
        _moment_row(even_slots(f, d.shape[1], y + 1), d[y], jx[y], jy[y])


@parallel_kernel
def _moments_odd(f, d, jx, jy):
    """The same before an odd step; the halo must have been filled."""
    for y in prange(d.shape[0]):
        _moment_row(odd_slots(f, d.shape[1], y + 1), d[y], jx[y], jy[y])


def moment_fields(
    padded: NDArray[np.floating], nx: int, parity: int, *, shifted: bool = False
) -> tuple[NDArray[np.floating], NDArray[np.floating], NDArray[np.floating]]:
    """Density (its excess over 1 if ``shifted``) and first moments before a step of that parity, each (ny, nx).

    padded: populations (9, ny + 2, nx + 2 or more), contiguous.
    """
    d, jx, jy = (np.empty((padded.shape[1] - 2, nx), padded.dtype) for _ in range(3))
    (_moments_odd if parity else _moments_even)(padded, d, jx, jy)
    if not shifted:
        d += 1
    return d, jx, jy
