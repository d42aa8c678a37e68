"""Masked normalised correlation of windows of two pictures, over a search range, and its peak.

R(s) = sum A(x) B(x + s) / sqrt(sum A^2 m_B(x + s)  sum B(x + s)^2 m_A): pictures less their local mean over fluid
pixels and zero elsewhere, so that solids neither correlate nor count (Padfield 2012, IEEE Trans. Image Process. 21,
2706). Windows that overlap share their products: sums over blocks of one grid step are formed once and added up.
"""

import math
from typing import NamedTuple

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view

from porescale.common.compiled.jit import inline, parallel_kernel, prange
from porescale.common.core.types import Singles

SPARSE = 0.2
"""Share of a window that must be fluid in both pictures for a shift to count."""


@parallel_kernel
def block_products(a, b, start, step, lane, found):
    """found[j, i, sy, sx] = sum over block (j, i) of a(x) b(x + s); s = (sy, sx) less half the range.

    a, b (rows, columns) float32;  start : first pixel of the first block, at least half the range;  step : side of a
    block;  lane (blocks down, columns) : scratch.  Not checked: that blocks and shifts stay within the pictures.
    """
    down, across, width, _ = found.shape
    search = width // 2
    count = across * step
    for row in prange(down):
        for sy in range(width):
            for sx in range(width):
                for x in range(count):
                    lane[row, x] = 0
                y, d, e = start + row * step, sy - search, start - search + sx
                own = lane[row, :count]
                for j in range(y, y + step - 3, 4):  # four rows at once: fewer trips to the lane
                    a0, a1, a2, a3 = a[j, start:], a[j + 1, start:], a[j + 2, start:], a[j + 3, start:]
                    b0, b1, b2, b3 = b[j + d, e:], b[j + d + 1, e:], b[j + d + 2, e:], b[j + d + 3, e:]
                    for x in range(count):
                        own[x] += a0[x] * b0[x] + a1[x] * b1[x] + a2[x] * b2[x] + a3[x] * b3[x]
                for j in range(y + step // 4 * 4, y + step):
                    a0, b0 = a[j, start:], b[j + d, e:]
                    for x in range(count):
                        own[x] += a0[x] * b0[x]
                for k in range(across):
                    total = lane[row, k * step]
                    for x in range(k * step + 1, (k + 1) * step):
                        total += lane[row, x]
                    found[row, k, sy, sx] = total


class Layout(NamedTuple):
    """Windows of ``blocks`` blocks a side, of ``step`` px; ``shape`` (ny, nx) windows, one block from one to the next.

    start : first pixel of the first window, in the padded pictures;  search : px.
    """

    shape: tuple[int, int]
    step: int
    blocks: int
    start: int
    search: int

    def sums(self, a: Singles, b: Singles) -> Singles:
        """Sum a(x) b(x + s) over every window, (ny, nx, 2 search + 1, 2 search + 1)."""
        (ny, nx), n, width = self.shape, self.blocks, 2 * self.search + 1
        found = np.empty((ny + n - 1, nx + n - 1, width, width), np.float32)
        lane = np.empty((ny + n - 1, (nx + n - 1) * self.step), np.float32)
        block_products(a, b, self.start, self.step, lane, found)
        rows = sum((found[k : k + ny] for k in range(1, n)), found[:ny].copy())
        return sum((rows[:, k : k + nx] for k in range(1, n)), rows[:, :nx].copy())

    def shifted(self, energy: Singles) -> Singles:
        """``energy`` (of the window that begins at a pixel) at every window and shift, a view."""
        (ny, nx), width, first = self.shape, 2 * self.search + 1, self.start - self.search
        every = sliding_window_view(energy, (width, width))
        return every[first :: self.step, first :: self.step][:ny, :nx]


def correlation(
    layout: Layout, a: Singles, b: Singles, masks: tuple[Singles, Singles] | None, energy: Singles
) -> Singles:
    """R of every window and shift, (ny, nx, 2 search + 1, 2 search + 1).

    a, b : padded pictures less their local means, zero in solids and beyond the edges;  masks : 1 where fluid, None if
    there is no solid;  energy : sums of b^2 over the window that begins at a pixel, used without masks.
    """
    top = layout.sums(a, b)
    if masks is None:
        middle = layout._replace(search=0)
        below = middle.sums(a, a) * layout.shifted(energy)
    else:
        ma, mb = masks
        below = layout.sums(a * a, mb) * layout.sums(ma, b * b)
        below[layout.sums(ma, mb) < SPARSE * (layout.step * layout.blocks) ** 2] = 0
    least = np.float32(1e-9) * max(float(below.max()), 1e-30)
    return np.where(below > least, top / np.sqrt(np.maximum(below, least)), np.float32(0))


@inline
def _vertex(low, middle, high):
    """Offset of the peak of a Gaussian through three values a pixel apart, of a parabola where one is not positive."""
    if low > 0 and middle > 0 and high > 0:
        low, middle, high = math.log(low), math.log(middle), math.log(high)
    bend = low - 2 * middle + high
    if bend >= 0:
        return 0.0
    return min(max(0.5 * (low - high) / bend, -0.5), 0.5)


@parallel_kernel
def peaks(total, u, v, value, ratio):
    """Place (px, to a fraction), height of each correlation peak, and its ratio to the highest one beyond 1 px from it.

    total (ny, nx, n, n) : correlations;  u, v, value, ratio (ny, nx) are overwritten.  A peak at the edge of the range
    is kept whole, and its ratio is 1: the true one may lie beyond.
    """
    ny, nx, width, _ = total.shape
    for row in prange(ny):
        for column in range(nx):
            best, py, px = total[row, column, 0, 0], 0, 0
            for j in range(width):
                for i in range(width):
                    if total[row, column, j, i] > best:
                        best, py, px = total[row, column, j, i], j, i
            second = 0.0
            for j in range(width):
                for i in range(width):
                    if (abs(j - py) > 1 or abs(i - px) > 1) and total[row, column, j, i] > second:
                        second = total[row, column, j, i]
            du = dv = 0.0
            if 0 < px < width - 1:
                du = _vertex(total[row, column, py, px - 1], best, total[row, column, py, px + 1])
            if 0 < py < width - 1:
                dv = _vertex(total[row, column, py - 1, px], best, total[row, column, py + 1, px])
            u[row, column], v[row, column] = px - width // 2 + du, py - width // 2 + dv
            value[row, column] = best
            ratio[row, column] = best / max(second, 1e-3 * max(best, 1e-12))
            if px in (0, width - 1) or py in (0, width - 1):
                ratio[row, column] = 1.0
