"""Sweeps over the lattice: the slots of each row, passed to a row kernel.  See lattice.py for the in-place pattern."""

from porescale.common.compiled.jit import inline, parallel_kernel, prange
from porescale.lbm.collision.law import collide_row, row_law


@inline
def even_slots(f, y):
    """Nine views (nx,) of row ``y`` (1 to ny) of populations (9, ny + 2, nx + 2) for an even step."""
    n = f.shape[2] - 2
    return (
        f[0, y, 1 : n + 1],
        f[1, y, 1 : n + 1],
        f[2, y, 1 : n + 1],
        f[3, y, 1 : n + 1],
        f[4, y, 1 : n + 1],
        f[5, y, 1 : n + 1],
        f[6, y, 1 : n + 1],
        f[7, y, 1 : n + 1],
        f[8, y, 1 : n + 1],
    )


@inline
def odd_slots(f, y):
    """Nine views (nx,) of row ``y`` for an odd step: h_i is read at slot [opposite(i), x - c_i]."""
    n = f.shape[2] - 2
    return (
        f[0, y, 1 : n + 1],
        f[2, y, 0:n],
        f[1, y, 2 : n + 2],
        f[4, y - 1, 1 : n + 1],
        f[3, y + 1, 1 : n + 1],
        f[6, y - 1, 0:n],
        f[5, y + 1, 2 : n + 2],
        f[8, y - 1, 2 : n + 2],
        f[7, y + 1, 0:n],
    )


@inline
def slots(f, y, parity):
    """Nine views of row ``y`` for a step of ``parity``, 0 or 1."""
    return odd_slots(f, y) if parity else even_slots(f, y)


@parallel_kernel
def sweep(f, parity, law):
    """Step of ``parity`` of plain fluid on every cell; overwrites populations f (9, ny + 2, nx + 2).

    law: of the operator.  Before an odd step the halo must have been filled, and is overwritten too.  One kernel for
    both kinds of step: compiled in half the time.
    """
    n = f.shape[2] - 2
    for y in prange(1, f.shape[1] - 1):
        collide_row(slots(f, y, parity), 0, n, row_law(y - 1, law))
