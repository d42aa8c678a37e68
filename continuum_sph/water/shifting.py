"""Shifting: particles drift down the gradient of their concentration, which keeps them evenly spread.

δu_i = -2 h s U Σ {1 + R (W/W(spacing))⁴} V_j ∇_i W, at most a quarter of U, the speed of the fastest particle; s is 1
to 2.  Density changes by δu · ∇ρ, so that it stays that of the place (Sun et al., Comput. Methods Appl. Mech. Eng. 348
(2019) 912); velocity does not, which keeps momentum.  Without shifting particles line up along streamlines and leave
gaps, the more so with corrected gradients, which push them apart less.  Source: Lind et al., J. Comput. Phys. 231
(2012) 1499; Sun et al., Comput. Methods Appl. Mech. Eng. 315 (2017) 25 (δ⁺-SPH).

Density does not see the drift's own divergence, so what shifting pushes together is lost volume: in water at rest it
and corrected gradients stir each other, and a column of 1 m sank by 2 cm in 10 s.  (To let density see it keeps the
volume, but takes 5 % of the speed of vortices, and water tears itself apart at an impact: measured.)  Water at rest has
no streamlines to line up on: U counts from QUIET of the speed of sound on.  Two fluids are shifted at any
speed: without it a drop that turns round loses its shape.

Gas is not shifted: its densities do not follow the drift, so a bubble would grow at the pressure it has.

A free surface is one-sided by nature and must not be filled: its particles (trace of M below OPEN) stay, and those that
see one move along the surface only, its normal being where the trace falls steepest.
"""

import numpy as np

from continuum_sph.water.bundles import inverse_period, nearest_image
from continuum_sph.water.fluids import LIQUID
from continuum_sph.water.kernel_correction import TRACE
from continuum_sph.water.smoothing import kernel_kind, slope_scale, slope_shape
from continuum_sph.water.state import X, Y
from porescale.common.compiled.jit import inline, parallel_kernel, prange
from porescale.common.compiled.simd import LANES, gather_four, gather_rows, maximum, reduce_add, sqrt, zeros

OPEN = 1.5  # trace of M: 1.97 on a lattice, 1.2 in the outermost row of a level surface, 0.9 in a corner
MOST = 0.25  # of U
QUIET = 1.0 / 500.0  # of the speed of sound: a settling lattice stays below it, and a flow of Mach 0.1 loses 2 % of U


@parallel_kernel
def shift(fluid, record, near, material, table, matrix, concentration, drift, strength, most):
    """Overwrites ``drift`` (fluid, 2) m/s, the shifting velocity.

    record: see `state.Layer`;  near: see `bundles`;  material, table: the particles' fluids;  matrix, concentration: of
    `neighbourhood_moments`;  strength 2 h s U, m²/s;  most: longest shifting velocity, m/s.
    """
    kind = kernel_kind(near.kind)
    steep = slope_scale(kind, near.h)
    inverse_h = 1.0 / near.h
    turns_x = inverse_period(near.period_x)
    turns_y = inverse_period(near.period_y)
    for i in prange(fluid):
        drift[i, 0] = 0.0
        drift[i, 1] = 0.0
        closed = matrix[i, TRACE]
        if closed < OPEN or table[material[i], LIQUID] == 0.0:
            continue
        ux = -strength * concentration[i, 0]
        uy = -strength * concentration[i, 1]
        if not lists_open(i, near, matrix):
            drift[i, 0], drift[i, 1] = at_most(ux, uy, most)
            continue
        falls_x = zeros()
        falls_y = zeros()
        open_by = zeros()
        k = near.start[i]
        while k < near.split[i]:  # a particle stands for the missing end of its row: it is not open
            xj, yj, _, _, _, _, volume, _ = gather_rows(record, near.partner, k, near.split[i], i)
            _, _, _, trace = gather_four(matrix, near.partner, k, near.split[i], i)
            k += LANES
            dx = nearest_image(record[i, X] - xj, near.period_x, turns_x)
            dy = nearest_image(record[i, Y] - yj, near.period_y, turns_y)
            part = volume * steep * slope_shape(kind, sqrt(dx * dx + dy * dy) * inverse_h)
            falls_x += part * (trace - closed) * dx
            falls_y += part * (trace - closed) * dy
            open_by -= part * maximum(OPEN - trace, 0.0)  # more than nothing where some neighbour is open
        nx = reduce_add(falls_x)
        ny = reduce_add(falls_y)
        sees_open = reduce_add(open_by) > 0.0
        length = nx * nx + ny * ny
        if sees_open and length > 0.0:
            along = (ux * nx + uy * ny) / length
            ux -= along * nx
            uy -= along * ny
        drift[i, 0], drift[i, 1] = at_most(ux, uy, most)


@inline
def lists_open(i, near, matrix):
    """Whether a partner of particle i in the fluids, within reach or in the skin of the list, is at a free surface."""
    for k in range(np.uint64(near.start[i]), np.uint64(near.split[i])):
        if matrix[np.uint64(near.partner[k]), TRACE] < OPEN:
            return True
    return False


@inline
def at_most(x, y, most):
    """The vector (x, y), shortened to the length ``most`` where it is longer."""
    size = np.sqrt(x * x + y * y)
    scale = most / size if size > most else 1.0
    return scale * x, scale * y
