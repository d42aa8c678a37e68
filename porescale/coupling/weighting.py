"""Weight B of a partially saturated cell from its solid area fraction.

B2(e) = e k / ((1 - e) + k),  k = tau - 1/2  (Noble & Torczynski 1998).  tau is the molecular relaxation time: with an
eddy viscosity the geometry must not breathe with the flow.  Grains that share a cell: B = B2(min(1, sum of e)), split
in proportion to e, since summing B2(e) would make contacts porous.
"""

from porescale.ground.jit import inline


@inline
def saturation_weight(solid, k, one):
    """B2 of the summed solid fraction ``solid`` >= 0 of a cell;  k = tau - 1/2;  one: 1 in the dtype of the fields."""
    e = min(one, solid)
    return e * k / ((one - e) + k)
