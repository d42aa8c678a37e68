"""Sweeps over the lattice: the slots of each row, passed to a row kernel.  See lattice.py for the in-place pattern."""

import numpy as np

from porescale.common.compiled.jit import inline, parallel_kernel, prange, unchecked_view
from porescale.lbm.collision.law import collide_row, row_law


@inline
def even_slots(f, n, y):
    """Nine views (n,) of row ``y`` (1 to ny) of padded populations f of n cells a row, for an even step."""
    return (
        unchecked_view(f[0, y], 1, n),
        unchecked_view(f[1, y], 1, n),
        unchecked_view(f[2, y], 1, n),
        unchecked_view(f[3, y], 1, n),
        unchecked_view(f[4, y], 1, n),
        unchecked_view(f[5, y], 1, n),
        unchecked_view(f[6, y], 1, n),
        unchecked_view(f[7, y], 1, n),
        unchecked_view(f[8, y], 1, n),
    )


@inline
def odd_slots(f, n, y):
    """Nine views (n,) of row ``y`` for an odd step: h_i is read at slot [opposite(i), x - c_i]."""
    return (
        unchecked_view(f[0, y], 1, n),
        unchecked_view(f[2, y], 0, n),
        unchecked_view(f[1, y], 2, n),
        unchecked_view(f[4, y - 1], 1, n),
        unchecked_view(f[3, y + 1], 1, n),
        unchecked_view(f[6, y - 1], 0, n),
        unchecked_view(f[5, y + 1], 2, n),
        unchecked_view(f[8, y - 1], 2, n),
        unchecked_view(f[7, y + 1], 0, n),
    )


@inline
def slots(f, n, y, parity):
    """Nine views of row ``y`` for a step of ``parity``, 0 or 1."""
    return odd_slots(f, n, y) if parity else even_slots(f, n, y)


@parallel_kernel
def sweep(f, parity, n, law):
    """Step of ``parity`` of plain fluid on every cell; overwrites padded populations f (9, ny + 2, n + 2 or more).

    n: cells of a row;  law: of the operator.  Before an odd step the halo must have been filled, and is overwritten
    too.  One kernel for both kinds of step: compiled in half the time.
    """
    for y in prange(1, f.shape[1] - 1):
        collide_row(slots(f, n, y, parity), np.int64(0), n, row_law(y - 1, law))
