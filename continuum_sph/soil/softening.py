"""Plastic shear strain by which soil softens: that of a step, in the mean over neighbours.

A band of particles is two rows.  If each softened by its own strain, the row that is ahead would be the weaker and take
more yet: the band would end one row wide, the sooner the more slowly it slips, and soften by half of the slip.  So a
particle's strain grows by the mean of what its neighbours of the same material and it sheared in the step, with the
weights of volume times 1 - (r/2h)², in which one row counts little more than the next.  Averaged is what a step adds
(Bažant & Lin, Int. J. Numer. Meth. Eng. 26 (1988) 1805, of strains in a mesh), not the sum: soil that comes to lie
beside a band later does not soften by that, nor does the band recover.

Bands of a soil that are wider than those of particles have more averages, until both are as wide.  Strain that is not
in a band yet then softens soil as told, too.
"""

import functools
import math

import numpy as np

from continuum_sph.soil.state import VOLUME, X, Y
from continuum_sph.water.bundles import image, row
from continuum_sph.water.smoothing import SUPPORT, Smoothing
from porescale.common.compiled.jit import inline, parallel_kernel, prange

MOST = 30
"""Averages in a step at most: a band of 15.6 spacings."""


@inline
def share(distance2, h):
    """Weight of a neighbour at a squared distance (m²) in the mean, over its volume;  h, m."""
    return max(0.0, 1.0 - distance2 / (SUPPORT * SUPPORT * h * h))


@parallel_kernel
def average(soil, record, material, sheared, mean, near):
    """Overwrites ``mean`` (soil,) by that of ``sheared`` (soil,) over each particle and its neighbours of one material.

    record, material: see `state.Soil`, positions and volumes of the step;  near: see `water.bundles`; walls do not
    count.  Source: the module's.
    """
    for at in prange(soil):
        i = row(at)
        weight = record[i, VOLUME]
        total = weight * sheared[i]
        for k in range(np.uint64(near.start[i]), np.uint64(near.split[i])):
            j = np.uint64(near.partner[k])
            dx = image(record[i, X] - record[j, X], near.period_x)
            dy = image(record[i, Y] - record[j, Y], near.period_y)
            part = record[j, VOLUME] * share(dx * dx + dy * dy, near.h) if material[j] == material[i] else 0.0
            weight += part
            total += part * sheared[j]
        mean[i] = total / weight


@functools.cache
def band_width(smoothing: Smoothing, spacing: float, averages: int = 1) -> float:
    """Width (m) of a band of particles at ``spacing`` (m): the slip across it over the strain by which it softens.

    On a square lattice, for a slip that two rows share and so many ``averages``: the mean of half of it in each, 3.59,
    4.54, 5.35 spacings of one, two, three (h of 1.375).  Of a step of velocity gradients show 0.45 in both rows and
    0.05 in the next, which unload as the band softens.  Of such a step in any direction through the lattice the mean of
    both rows is that of a width of 3.5 to 3.7 spacings.
    """
    reach = range(-math.ceil(smoothing.support / spacing), math.ceil(smoothing.support / spacing) + 1)
    once = [math.fsum(share(spacing**2 * (i * i + j * j), smoothing.length) for i in reach) for j in reach]
    rows = np.array([1.0])
    for _ in range(averages):
        rows = np.convolve(rows, np.array(once) / math.fsum(once))
    own = len(rows) // 2
    return float(2.0 * spacing / (rows[own] + rows[own + 1]))


def averages_of(smoothing: Smoothing, spacing: float, width: float) -> int:
    """How often to average for a band of a ``width`` (m): until one more would make it too wide, from 1 to MOST."""
    averages = 1
    while averages < MOST and band_width(smoothing, spacing, averages + 1) <= width:
        averages += 1
    return averages
