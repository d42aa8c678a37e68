"""What a body force on the fluid does to the bodies in it.

A body force F per area stands for a pressure gradient -F, which acts on solids as well: a body of area A is pushed by
F A.  The lattice has the force act on fluid alone, so that the loads of its cells lack what it would do to the fluid
that a body displaces.  That is what each cell's fluid does not get of F:

    force_everywhere (exact walls)   the solid gets back the part e of F                        F e
    (1 - B) of the fluid operator    with rho u = j + (1 - B) F/2 in it, momentum relaxes       F B (1 + (1 - B) s/2)
                                     towards rho u with the rate s of the odd moments, so
                                     that it changes by F (1 - s B/2)

Summed over the cells of a body, the momentum of a periodic box then grows by F times its area, whatever lies in it: the
drag on discs that stand is all that drives their cells, and water and discs of its density start alike.  In a closed
box at rest load and push of exact walls cancel; the other operators leave 0.3 to 4 % of F A at 10 cells a diameter,
since water beside their rims does not quite come to rest.  Derived here.
"""

import numpy as np

from porescale.common.compiled.jit import inline, parallel_kernel, prange
from porescale.coupling.weighting.law import weight


@inline
def cells_within(patches, n, j, periodic, shape):
    """Where row ``j`` of body ``n`` lies in ``fraction`` as far as it is in a box of shape (ny, nx): first, last."""
    at = patches.start[n] + j * patches.stride[n]
    x, y = patches.corner[n, 0], patches.corner[n, 1] + j
    first, last = 0, patches.stride[n]
    if not periodic[0]:
        first, last = max(0, -x), min(last, shape[1] - x)
    if not periodic[1] and not 0 <= y < shape[0]:
        last = first
    return at + first, at + last


@inline
def covered_area_of(n, patches, periodic, shape):
    """``covered_area`` of body ``n``."""
    taken = 0.0
    for j in range(patches.height[n]):
        first, last = cells_within(patches, n, j, periodic, shape)
        for i in range(first, last):
            taken += np.float64(patches.fraction[i])
    return taken


@inline
def held_area_of(n, patches, periodic, shape, half_rate, weighting):
    """``held_area`` of body ``n``."""
    taken = 0.0
    for j in range(patches.height[n]):
        first, last = cells_within(patches, n, j, periodic, shape)
        for i in range(first, last):
            e = np.float64(patches.fraction[i])
            zero = e * 0
            b = np.float64(weight(min(e, zero + 1), zero, zero, zero, weighting))
            taken += b * (1.0 + (1.0 - b) * half_rate)
    return taken


@parallel_kernel
def covered_area(patches, periodic, shape, area):
    """Sum of the solid fractions of every body in a box of shape (ny, nx), into area (n,); periodic: along x, y."""
    for n in prange(area.shape[0]):
        area[n] = covered_area_of(np.int64(n), patches, periodic, shape)


@parallel_kernel
def held_area(patches, periodic, shape, half_rate, weighting, area):
    """The same with B (1 + (1 - B) s/2) in place of the fraction;  half_rate: s/2;  weighting: law of B."""
    for n in prange(area.shape[0]):
        area[n] = held_area_of(np.int64(n), patches, periodic, shape, half_rate, weighting)
