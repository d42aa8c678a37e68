"""Density normalised within one material: eq. 27 of Maeda & Sakai 2004, as a filter.

ρ_i = Σ m_j W/Σ (m_j/ρ_j) W over particles of the same fluid, i itself included.  A Shepard average: it keeps any
uniform density, so it makes no pressure and cannot stand for continuity; every 20 to 40 steps it takes out the noise
that continuity collects.
"""

import numpy as np

from continuum_sph.water.smoothing import kernel_value
from continuum_sph.water.state import X, Y
from porescale.common.compiled.jit import parallel_kernel, prange
from porescale.common.neighbors.cells import minimum_image


@parallel_kernel
def filtered(start, split, partner, record, material, mass, density, out, kind, h, period_x, period_y):
    """Overwrites ``out`` (fluid,) with the normalised ``density`` (fluid,), kg/m³.

    start, split, partner: full list, wall partners from ``split[i]`` on (they take no part);  record: see Layer, its
    positions are read;  volumes are mass/density;  kind, h: smoothing;  periods, m or 0.
    """
    for i in prange(density.shape[0]):
        value = kernel_value(kind, 0.0, h)
        above = mass[i] * value
        below = mass[i] / density[i] * value
        for k in range(np.uint64(start[i]), np.uint64(split[i])):
            j = np.uint64(partner[k])
            if material[j] != material[i]:
                continue
            dx = minimum_image(record[i, X] - record[j, X], period_x)
            dy = minimum_image(record[i, Y] - record[j, Y], period_y)
            value = kernel_value(kind, np.sqrt(dx * dx + dy * dy) / h, h)
            above += mass[j] * value
            below += mass[j] / density[j] * value
        out[i] = above / below
