"""Masked normalised correlation of windows of two pictures, over a search range, and its peak.

R(s) = sum A(x) B(x + s) / sqrt(sum A^2 m_B(x + s)  sum B(x + s)^2 m_A): pictures less their local mean over fluid pixels
and zero elsewhere, so that solids neither correlate nor count (Padfield 2012, IEEE Trans. Image Process. 21, 2706).
"""

from __future__ import annotations

import math

import numpy as np

from porescale.ground.jit import inline, parallel_kernel, prange

TINY = np.float32(1e-20)
SPARSE = 0.2
"""Share of a window that must be fluid in both pictures for a shift to count."""


@inline
def _products(a, ma, b, mb, top, left, down, right, size, lanes):
    """Sum A B, sum A^2 m_B, sum B^2 m_A and sum m_A m_B of one window and shift, by lanes (4, size), in lanes[:, 0]."""
    lanes[:] = np.float32(0)
    for j in range(size):
        p, mp = a[top + j], ma[top + j]
        q, mq = b[down + j], mb[down + j]
        for i in range(size):
            f, g, mf, mg = p[left + i], q[right + i], mp[left + i], mq[right + i]
            lanes[0, i] += f * g
            lanes[1, i] += f * f * mg
            lanes[2, i] += g * g * mf
            lanes[3, i] += mf * mg
    for k in range(4):
        for i in range(1, size):
            lanes[k, 0] += lanes[k, i]


@inline
def _product(a, b, top, left, down, right, size, lane):
    """Sum A B of one window and shift, by lanes (size,), in lane[0]."""
    lane[:] = np.float32(0)
    for j in range(size):
        p, q = a[top + j], b[down + j]
        for i in range(size):
            lane[i] += p[left + i] * q[right + i]
    half = size
    while half > 1 and half % 2 == 0:
        half //= 2
        for i in range(half):
            lane[i] += lane[half + i]
    for i in range(1, half):
        lane[0] += lane[i]


@parallel_kernel
def correlate(a, b, ma, mb, energy_a, energy_b, pad, start, step, size, search, lanes, total):
    """Add to ``total`` (ny, nx, 2 search + 1, 2 search + 1) the correlation of each window with each shift.

    a, b : pictures less their local means, (rows + 2 pad, columns + 2 pad) float32, zero in solids and beyond the edges;
    ma, mb : 1 where fluid, else 0;  energy_a, energy_b : sums of a^2, b^2 over the window that begins at a pixel, of the
    same shape;  start, step : first pixel of the first window, and from one to the next;  size : of windows;
    lanes (ny, 4, size) : scratch.  Not checked: that windows and shifts stay within the padded pictures.
    """
    ny, nx, width, _ = total.shape
    least = SPARSE * size * size
    for row in prange(ny):
        top = pad + start + row * step
        for column in range(nx):
            left = pad + start + column * step
            fluid = True
            for j in range(top - search, top + size + search):
                for i in range(left - search, left + size + search):
                    fluid = fluid and ma[j, i] > 0 and mb[j, i] > 0
            for sy in range(width):
                down = top + sy - search
                for sx in range(width):
                    right = left + sx - search
                    if fluid:
                        _product(a, b, top, left, down, right, size, lanes[row, 0])
                        below = energy_a[top, left] * energy_b[down, right]
                    else:
                        _products(a, ma, b, mb, top, left, down, right, size, lanes[row])
                        below = lanes[row, 1, 0] * lanes[row, 2, 0]
                        if lanes[row, 3, 0] < least:
                            below = TINY
                    if below > TINY:
                        total[row, column, sy, sx] += lanes[row, 0, 0] / math.sqrt(below)


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

    total (ny, nx, n, n) as of ``correlate``; u, v, value, ratio (ny, nx) are overwritten.  A peak at the edge of the range
    is kept whole.
    """
    ny, nx, width, _ = total.shape
    for row in prange(ny):
        for column in range(nx):
            plane = total[row, column]
            best, py, px = plane[0, 0], 0, 0
            for j in range(width):
                for i in range(width):
                    if plane[j, i] > best:
                        best, py, px = plane[j, i], j, i
            second = 0.0
            for j in range(width):
                for i in range(width):
                    if (abs(j - py) > 1 or abs(i - px) > 1) and plane[j, i] > second:
                        second = plane[j, i]
            du = dv = 0.0
            if 0 < px < width - 1:
                du = _vertex(plane[py, px - 1], best, plane[py, px + 1])
            if 0 < py < width - 1:
                dv = _vertex(plane[py - 1, px], best, plane[py + 1, px])
            u[row, column], v[row, column] = px - width // 2 + du, py - width // 2 + dv
            value[row, column] = best
            ratio[row, column] = best / max(second, 1e-3 * max(best, 1e-12))
