"""Shifting: particles drift from where they crowd to where they are rare, which keeps them evenly spread.

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

from __future__ import annotations

import numpy as np

from continuum_sph.water.fluids import LIQUID
from continuum_sph.water.kernel_correction import TRACE
from continuum_sph.water.smoothing import slope_scale, slope_shape
from continuum_sph.water.state import X, Y
from porescale.common.compiled.jit import parallel_kernel, prange
from porescale.common.compiled.simd import LANES, greater, nearest, nothing, root, take_four, take_rows, total

OPEN = 1.5  # trace of M: 1.95 on a lattice, 1.2 in the outermost row of a level surface, 0.9 in a corner
MOST = 0.25  # of U
QUIET = 1.0 / 500.0  # of the speed of sound: a settling lattice stays below it, and a flow of Mach 0.1 loses 2 % of U


@parallel_kernel
def shift(
    fluid, start, split, partner, record, material, table, matrix, crowd, drift, kind, h, strength, most,
    period_x, period_y,
):  # fmt: skip
    """Overwrites ``drift`` (fluid, 2) m/s, the shifting velocity.

    start, split, partner: full list, walls from ``split[i]`` on;  material, table: the particles' fluids;  matrix,
    crowd: of `surroundings`;  strength 2 h s U, m²/s;  most: longest shifting velocity, m/s;  kind, h: smoothing;
    periods, m or 0, or both None.
    """
    steep = slope_scale(kind, h)
    inverse_h = 1.0 / h
    turns_x = 0.0
    turns_y = 0.0
    if period_x is not None:
        turns_x = 1.0 / period_x if period_x > 0.0 else 0.0
        turns_y = 1.0 / period_y if period_y > 0.0 else 0.0
    for i in prange(fluid):
        drift[i, 0] = 0.0
        drift[i, 1] = 0.0
        closed = matrix[i, TRACE]
        if closed < OPEN or table[material[i], LIQUID] == 0.0:
            continue
        ux = -strength * crowd[i, 0]
        uy = -strength * crowd[i, 1]
        falls_x = nothing()
        falls_y = nothing()
        open_by = nothing()
        k = start[i]
        while k < split[i]:  # a particle stands for the missing end of its row: it is not open
            xj, yj, _, _, _, _, volume, _ = take_rows(record, partner, k, split[i], i)
            _, _, _, trace = take_four(matrix, partner, k, split[i], i)
            k += LANES
            dx = record[i, X] - xj
            dy = record[i, Y] - yj
            if period_x is not None:
                dx -= period_x * nearest(dx * turns_x)
                dy -= period_y * nearest(dy * turns_y)
            part = volume * steep * slope_shape(kind, root(dx * dx + dy * dy) * inverse_h)
            falls_x += part * (trace - closed) * dx
            falls_y += part * (trace - closed) * dy
            open_by -= part * greater(OPEN - trace, 0.0)  # more than nothing where some neighbour is open
        nx = total(falls_x)
        ny = total(falls_y)
        near = total(open_by) > 0.0
        length = nx * nx + ny * ny
        if near and length > 0.0:
            along = (ux * nx + uy * ny) / length
            ux -= along * nx
            uy -= along * ny
        size = np.sqrt(ux * ux + uy * uy)
        scale = most / size if size > most else 1.0
        drift[i, 0] = scale * ux
        drift[i, 1] = scale * uy
