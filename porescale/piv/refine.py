"""Gauss-Newton update of displacements, and their uncertainty, from pictures already deformed by the last estimate.

With r = a - k b, both less their mean in the window, and g the gradient of their mean, the update solves
(sum w g g') d = sum w g r.  w is a bell over the window times 1/(1 + r^2/(n^2 + t^2 g^2)), n the noise of the
pictures, t a displacement taken for possible: pixels where the pictures show different tracers (lost pairs) hardly
count (Cauchy weights; Black & Anandan 1996, Comput. Vis. Image Underst. 63, 75).
"""

from __future__ import annotations

import math

from porescale.ground.jit import inline, parallel_kernel, prange

BLOCK = 4
"""Pixels of a block, within which residuals are taken as one: about a spot."""

FLAT = 1e-9
"""Variance of grey levels below which there is nothing to see."""


@inline
def _moments(a, b, mask, bell, top, left, columns, lane):
    """Bell-weighted sums down the rows: m, m a, m b, m a a, m b b, m a b of each column, in lane[:6]."""
    for k in range(6):
        for x in range(columns):
            lane[k, x] = 0
    for j in range(bell.shape[0]):
        y, w = top + j, bell[j]
        for x in range(columns):
            m, f, g = w * mask[y, left + x], a[y, left + x], b[y, left + x]
            lane[0, x] += m
            lane[1, x] += m * f
            lane[2, x] += m * g
            lane[3, x] += m * f * f
            lane[4, x] += m * g * g
            lane[5, x] += m * f * g


@inline
def _window(lane, bell, first, noise, out, known):
    """Means, gain and n^2 of the window that begins at column ``first``, into known[:5, window]; gives its correlation.

    known[4] : the bell along the row, zero where the window cannot be judged.
    """
    n = bell.shape[0]
    s0, s1, s2, s3, s4, s5 = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
    for i in range(n):
        w = bell[i]
        s0 += w * lane[0, first + i]
        s1 += w * lane[1, first + i]
        s2 += w * lane[2, first + i]
        s3 += w * lane[3, first + i]
        s4 += w * lane[4, first + i]
        s5 += w * lane[5, first + i]
    if s0 <= 0:
        return 0.0
    a, b = s1 / s0, s2 / s0
    var_a, var_b = s3 / s0 - a * a, s4 / s0 - b * b
    if var_a <= FLAT or var_b <= FLAT:
        return 0.0
    gain = math.sqrt(var_a / var_b)
    least = max(noise * noise, 1e-6 * var_a)
    for i in range(n):
        known[0, out + i] = a
        known[1, out + i] = b
        known[2, out + i] = gain
        known[3, out + i] = least
        known[4, out + i] = bell[i]
    return (s5 / s0 - a * b) / math.sqrt(var_a * var_b)


@inline
def _weighted(a, b, mask, gx, gy, slack, wy, y, left, columns, known, lane):
    """Add one row to the sums of w gx gx, w gx gy, w gy gy, w gx r, w gy r of each column, in lane[:5]."""
    for x in range(columns):
        r = (a[y, left + x] - known[0, x]) - known[2, x] * (b[y, left + x] - known[1, x])
        f, g = gx[y, left + x], gy[y, left + x]
        due = known[3, x] + slack * (f * f + g * g)
        w = wy * known[4, x] * mask[y, left + x] * due / (due + r * r)
        lane[0, x] += w * f * f
        lane[1, x] += w * f * g
        lane[2, x] += w * g * g
        lane[3, x] += w * f * r
        lane[4, x] += w * g * r


@parallel_kernel
def refine(a, b, mask, gx, gy, bell, pad, start, step, noise, slack, lanes, known, sums):
    """Sums of each window for one Gauss-Newton update.

    a, b, gx, gy (rows + 2 pad, columns + 2 pad) float32 : deformed pictures and the gradient of their mean;  mask : 1
    where both show fluid, else 0;  bell (n,) : weights along a side, n a multiple of BLOCK;  start, step : centre of
    the first window and from one to the next;  noise, slack : n, t^2;  lanes (ny, 11, columns + 2 pad), known (ny, 5,
    as many) : scratch;  sums (ny, nx, 9), added to: w gx gx, w gx gy, w gy gy, w gx r, w gy r; squares of the last two
    summed by blocks and their product; correlation.
    """
    ny, nx, _ = sums.shape
    n = bell.shape[0]
    every = -(-n // step)  # windows this far apart do not overlap: they are swept together, in long loops
    for row in prange(ny):
        top, left = pad + start + row * step - n // 2, pad + start - n // 2
        moment, lane, own = lanes[row, :6], lanes[row, 6:], known[row]
        _moments(a, b, mask, bell, top, left, (nx - 1) * step + n, moment)
        for turn in range(min(every, nx)):
            count = -(-(nx - turn) // every)
            begin, wide = turn * step, ((count - 1) * every) * step + n
            for x in range(wide):
                own[4, x] = 0
            for k in range(count):
                match = _window(moment, bell, begin + k * every * step, noise, k * every * step, own)
                sums[row, turn + k * every, 8] += match
            for part in range(0, n, BLOCK):
                for k in range(5):
                    for x in range(wide):
                        lane[k, x] = 0
                for j in range(part, part + BLOCK):
                    _weighted(a, b, mask, gx, gy, slack, bell[j], top + j, left + begin, wide, own, lane)
                for k in range(count):
                    found = sums[row, turn + k * every]
                    for first in range(k * every * step, k * every * step + n, BLOCK):
                        p, q = 0.0, 0.0
                        for i in range(first, first + BLOCK):
                            found[0] += lane[0, i]
                            found[1] += lane[1, i]
                            found[2] += lane[2, i]
                            p += lane[3, i]
                            q += lane[4, i]
                        found[3] += p
                        found[4] += q
                        found[5] += p * p
                        found[6] += p * q
                        found[7] += q * q
