"""Splines on a lattice of coefficients: from it to places, and back.

A field is sum c_k B(x/h - k), cubic B-splines h px apart along both axes.  A fit to data needs the field at the
data's places and the adjoint of that; both go along one axis after the other.
"""

import numpy as np

from porescale.common.compiled.jit import kernel, parallel_kernel, prange


@kernel
def collect(values, first_y, weights_y, first_x, weights_x, spare, found):
    """Adjoint of ``expand``: found[k, l] = sum over y, x of the weights that take nodes[k, l] to values[y, x].

    values (rows, columns), spare (rows, n), found (m, n) float32; the last two are overwritten.
    """
    rows, columns = values.shape
    found[:] = 0
    for y in range(rows):
        for i in range(spare.shape[1]):
            spare[y, i] = 0
        for x in range(columns):
            k, value = first_x[x], values[y, x]
            spare[y, k] += weights_x[0, x] * value
            spare[y, k + 1] += weights_x[1, x] * value
            spare[y, k + 2] += weights_x[2, x] * value
            spare[y, k + 3] += weights_x[3, x] * value
        for j in range(4):
            k, w = first_y[y] + j, weights_y[j, y]
            for i in range(spare.shape[1]):
                found[k, i] += w * spare[y, i]


@parallel_kernel
def moments(a, b, mask, block, lanes, found):
    """Sums over blocks of ``block`` px a side of m, m a, m b, m a a, m b b, m a b, m the mask.

    a, b, mask (rows, columns) float32;  lanes (blocks down, 6 or more, columns) : scratch;  found (6, blocks down,
    across) : overwritten; blocks at the far edges may be cut.
    """
    rows, columns = a.shape
    for row in prange(found.shape[1]):
        lane = lanes[row, :6]
        lane[:] = 0
        for y in range(row * block, min(rows, (row + 1) * block)):
            for x in range(columns):
                m, f, g = mask[y, x], a[y, x], b[y, x]
                lane[0, x] += m
                lane[1, x] += m * f
                lane[2, x] += m * g
                lane[3, x] += m * f * f
                lane[4, x] += m * g * g
                lane[5, x] += m * f * g
        for k in range(6):
            _narrowed(lane[k], block, found[k, row])


@parallel_kernel
def weighted(a, b, mask, known, slack, block, lanes, found):
    """Sums over blocks of w gx gx, w gx gy, w gy gy, w gx r, w gy r, where r = (a - mean a) - k (b - mean b).

    g : gradient of (a + k b)/2 by fourth-order differences; the outer two pixels are left out.  w = mask (n^2 + t^2
    g^2)/(n^2 + t^2 g^2 + r^2).  known (4, blocks down, across) : mean a, mean b, k, n^2 of each block;  slack : t^2;
    lanes (blocks down, 9, columns) : scratch;  found (5, blocks down, across) : overwritten.
    """
    rows, columns = a.shape
    near, far = np.float32(8 / 24), np.float32(1 / 24)
    for row in prange(found.shape[1]):
        lane, own = lanes[row, :5], lanes[row, 5:]
        lane[:] = 0
        for k in range(4):
            for x in range(columns):
                own[k, x] = known[k, row, x // block]
        for y in range(max(2, row * block), min(rows - 2, (row + 1) * block)):
            for x in range(columns - 4):  # two to the left of the pixel: an index that never falls needs no check
                gain = own[2, x + 2]
                f = near * ((a[y, x + 3] - a[y, x + 1]) + gain * (b[y, x + 3] - b[y, x + 1])) - far * (
                    (a[y, x + 4] - a[y, x]) + gain * (b[y, x + 4] - b[y, x])
                )
                g = near * ((a[y + 1, x + 2] - a[y - 1, x + 2]) + gain * (b[y + 1, x + 2] - b[y - 1, x + 2])) - far * (
                    (a[y + 2, x + 2] - a[y - 2, x + 2]) + gain * (b[y + 2, x + 2] - b[y - 2, x + 2])
                )
                r = (a[y, x + 2] - own[0, x + 2]) - gain * (b[y, x + 2] - own[1, x + 2])
                due = own[3, x + 2] + slack * (f * f + g * g)
                w = mask[y, x + 2] * due / (due + r * r)
                lane[0, x + 2] += w * f * f
                lane[1, x + 2] += w * f * g
                lane[2, x + 2] += w * g * g
                lane[3, x + 2] += w * f * r
                lane[4, x + 2] += w * g * r
        for k in range(5):
            _narrowed(lane[k], block, found[k, row])


@kernel
def _narrowed(lane, block, found):
    """Sums of ``block`` columns each."""
    columns = lane.shape[0]
    for k in range(found.shape[0]):
        total = lane[k * block]
        for x in range(k * block + 1, min(columns, (k + 1) * block)):
            total += lane[x]
        found[k] = total


@kernel
def bending(c, found):
    """Half the gradient of sum |second differences|^2 of coefficients c (m, n), mixed ones twice: planes have none.

    found (m, n) : overwritten.
    """
    m, n = c.shape
    found[:] = 0
    for j in range(m):
        for i in range(1, n - 1):
            d = c[j, i - 1] - 2 * c[j, i] + c[j, i + 1]
            found[j, i - 1] += d
            found[j, i] -= 2 * d
            found[j, i + 1] += d
    for j in range(1, m - 1):
        for i in range(n):
            d = c[j - 1, i] - 2 * c[j, i] + c[j + 1, i]
            found[j - 1, i] += d
            found[j, i] -= 2 * d
            found[j + 1, i] += d
    for j in range(m - 1):
        for i in range(n - 1):
            d = 2 * (c[j, i] - c[j, i + 1] - c[j + 1, i] + c[j + 1, i + 1])
            found[j, i] += d
            found[j, i + 1] -= d
            found[j + 1, i] -= d
            found[j + 1, i + 1] += d
