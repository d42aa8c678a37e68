"""How much of each cell every disc covers, exactly, and the velocity of the solid there.

The area of a disc of radius r inside the corner rectangle [0, a] x [0, b] (a, b >= 0, clamped to r) is

    K(a, b) = a b                                if a² + b² <= r²
            = G(a) + G(b) - pi r²/4              otherwise,     G(a) = (a sqrt(r² - a²) + r² asin(a/r)) / 2

odd in a and in b.  A cell is four such terms, and G belongs to a grid line, not to a cell: a disc d cells wide
needs 2 (d + 2) of them.  Derived from G being the area under the quarter circle up to a.

Three passes: each disc fills its own patch of fractions; bands of rows add the patches up, disc by disc in index order
(so sums do not depend on threads); each disc turns its fractions into its share of the cell's weight.
"""

import math

from porescale.coupling.weighting import saturation_weight
from porescale.ground.jit import inline, kernel, parallel_kernel, prange


@inline
def quarter_area(a, r):
    """G(a): area under the quarter circle of radius r from 0 to a, 0 <= a <= r.

    The angle comes from both legs: asin(a/r) loses half the digits of a disc that just touches a grid line.
    """
    h = math.sqrt((r - a) * (r + a))
    return 0.5 * (a * h + r * r * math.atan2(a, h))


@inline
def corner_area(a, b, ga, gb, r):
    """K(a, b) for signed a, b already clamped to [-r, r], with ga = G(|a|), gb = G(|b|)."""
    if a * a + b * b <= r * r:
        return a * b
    return math.copysign(ga + gb - 0.25 * math.pi * r * r, a * b)


@parallel_kernel
def cover(centre, radius, patch_start, patch_width, patch, corner, lines):
    """Exact solid fractions of the cells around every disc.

    centre (n, 2), radius (n,): cells;  patch_start (n,), patch_width (n,): where in ``patch`` a disc's width² fractions
    lie;  lines (n, 2, largest width + 1): scratch.  Overwrites patch and corner (n, 2), the cell (x, y) at the patch's
    lower left.
    """
    for n in prange(centre.shape[0]):
        r = radius[n]
        w = patch_width[n]
        x0 = math.floor(centre[n, 0] - r)
        y0 = math.floor(centre[n, 1] - r)
        corner[n, 0] = x0
        corner[n, 1] = y0
        ga = lines[n, 0]
        below = lines[n, 1]
        for i in range(w + 1):
            ga[i] = quarter_area(min(abs(x0 + i - centre[n, 0]), r), r)
        for j in range(w + 1):
            b = min(max(y0 + j - centre[n, 1], -r), r)
            gb = quarter_area(abs(b), r)
            left = 0.0
            left_below = 0.0
            for i in range(w + 1):
                a = min(max(x0 + i - centre[n, 0], -r), r)
                k = corner_area(a, b, ga[i], gb, r)
                if i > 0 and j > 0:
                    e = (k - left) - (below[i] - left_below)
                    if e < 1e-12:
                        e = 0.0
                    elif e > 1.0 - 1e-12:
                        e = 1.0
                    patch[patch_start[n] + (j - 1) * w + i - 1] = e
                left = k
                left_below = below[i]
                below[i] = k


@kernel
def list_bands(corner, patch_width, ny, height, periodic_y, band_start, band_disc, last):
    """Which discs touch which band of ``height`` rows, in index order, by counting sort.

    Overwrites band_start (bands + 1,), band_disc (entries) and last (bands,).  Returns the entries needed; where that
    is more than band_disc holds, the caller grows it and calls again.
    """
    bands = band_start.shape[0] - 1
    band_start[:] = 0
    for turn in range(2):
        last[:] = -1
        for n in range(corner.shape[0]):
            for j in range(patch_width[n]):
                y = corner[n, 1] + j
                if periodic_y:
                    y %= ny
                elif y < 0 or y >= ny:
                    continue
                band = y // height
                if last[band] != n:
                    last[band] = n
                    if turn == 0:
                        band_start[band + 1] += 1
                    else:
                        band_disc[band_start[band]] = n
                        band_start[band] += 1
        if turn == 0:
            for band in range(bands):
                band_start[band + 1] += band_start[band]
            if band_start[bands] > band_disc.shape[0]:
                return band_start[bands]
    for band in range(bands, 0, -1):
        band_start[band] = band_start[band - 1]
    band_start[0] = 0
    return band_start[bands]


@parallel_kernel
def accumulate(
    centre, velocity, spin, patch_start, patch_width, patch, corner, band_start, band_disc, height, periodic_x,
    periodic_y, solid, solid_x, solid_y, span,
):  # fmt: skip
    """Sum of the solid fractions of each cell, and of fraction times solid velocity at the cell's centre.

    velocity (n, 2), spin (n,): lattice units.  Overwrites solid, solid_x, solid_y (ny, nx), which are zero outside
    ``span`` (ny, 2), first covered cell of a row and one past the last, and span itself.
    """
    ny, nx = solid.shape
    for band in prange(band_start.shape[0] - 1):
        bottom = band * height
        top = min(bottom + height, ny)
        for y in range(bottom, top):
            for x in range(span[y, 0], span[y, 1]):
                solid[y, x] = 0
                solid_x[y, x] = 0
                solid_y[y, x] = 0
            span[y, 0] = nx
            span[y, 1] = 0
        for k in range(band_start[band], band_start[band + 1]):
            n = band_disc[k]
            w = patch_width[n]
            for j in range(w):
                y = corner[n, 1] + j
                ry = y + 0.5 - centre[n, 1]
                if periodic_y:
                    y %= ny
                if y < bottom or y >= top:
                    continue
                for i in range(w):
                    e = patch[patch_start[n] + j * w + i]
                    x = corner[n, 0] + i
                    rx = x + 0.5 - centre[n, 0]
                    if periodic_x:
                        x %= nx
                    elif x < 0 or x >= nx:
                        continue
                    if e > 0:
                        solid[y, x] += e
                        solid_x[y, x] += e * (velocity[n, 0] - spin[n] * ry)
                        solid_y[y, x] += e * (velocity[n, 1] + spin[n] * rx)
                        span[y, 0] = min(span[y, 0], x)
                        span[y, 1] = max(span[y, 1], x + 1)


@parallel_kernel
def share(patch_start, patch_width, patch, corner, periodic_x, periodic_y, solid, k):
    """Turn each disc's fractions e into its share of the cell's weight, B2(min(1, sum)) e / sum.  Overwrites patch."""
    ny, nx = solid.shape
    for n in prange(patch_start.shape[0]):
        w = patch_width[n]
        for j in range(w):
            y = corner[n, 1] + j
            if periodic_y:
                y %= ny
            for i in range(w):
                x = corner[n, 0] + i
                if periodic_x:
                    x %= nx
                at = patch_start[n] + j * w + i
                if y < 0 or y >= ny or x < 0 or x >= nx:
                    patch[at] = 0
                elif patch[at] > 0:
                    total = solid[y, x]
                    patch[at] = saturation_weight(total, k, 1.0) * patch[at] / total
