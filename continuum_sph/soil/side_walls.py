"""Friction of the side walls of a channel, which brake the soil between them.

Laboratories let soil slide between two plates, W apart, which a plane does not see.  Each bears the mean stress p of
the soil beside it and rubs by tan δ of that, against the soil's velocity, so between them the soil has

    dv/dt = ... - (2 tan δ/W) p/ρ v/|v|                                                                    (side-walls)

and soil at rest is held by no more than would move it (Taberlet et al. 2003; Jop, Forterre & Pouliquen 2005).  p is the
effective mean stress in the plane, as there.  A layer that slides on a slope β has p = ρ g cos β d at a depth d, so it
moves down to d0 = W (tan β - sin φ)/(2 tan δ), and faster by (2 tan δ/W) g cos β t for each metre above (row
`continuum.soil_between_side_walls`).  Water is not braked.
"""

from continuum_sph.soil.stress import XX, YY
from porescale.common.compiled.jit import parallel_kernel, prange


@parallel_kernel
def brake_beside_walls(soil, v, stress, density, friction, step):
    """Takes from ``v`` (soil…, 2) m/s what side walls take in a ``step`` (s), at most all of it.

    stress (soil…, 4) Pa;  density (soil,) kg/m³;  friction: 2 tan δ/W, 1/m.
    """
    for i in prange(soil):
        speed = (v[i, 0] * v[i, 0] + v[i, 1] * v[i, 1]) ** 0.5
        taken = step * friction * max(0.0, 0.5 * (stress[i, XX] + stress[i, YY])) / density[i]
        kept = 1.0 - taken / speed if speed > taken else 0.0
        v[i, 0] *= kept
        v[i, 1] *= kept
