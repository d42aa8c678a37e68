"""Gauss-Newton update of displacements, and their uncertainty, from pictures already deformed by the last estimate.

With r = a - k b, both less their mean in the window, and g the gradient of their mean, the update solves
(sum w g g') d = sum w g r.  w is a bell over the window times 1/(1 + r^2/(n^2 + t^2 g^2)), n the noise of the pictures, t
a displacement taken for possible: pixels where the pictures show different tracers (lost pairs) hardly count (Cauchy
weights; Black & Anandan 1996, Comput. Vis. Image Underst. 63, 75).
"""

from __future__ import annotations

import math

import numpy as np

from porescale.ground.jit import parallel_kernel, prange

BLOCK = 4
"""Pixels of a block, within which residuals are taken as one: about a spot."""

F = np.float32


@parallel_kernel
def refine(a, b, mask, gx, gy, bell, pad, start, step, noise, slack, lanes, sums):
    """Sums of each window for one Gauss-Newton update.

    a, b, gx, gy (rows + 2 pad, columns + 2 pad) float32 : deformed pictures and the gradient of their mean;  mask : 1
    where both show fluid, else 0;  bell (n,) : weights along a side, n a multiple of BLOCK;  start, step : centre of the
    first window and from one to the next;  noise, slack : n, t^2;  lanes (ny, 6, n) : scratch;
    sums (ny, nx, 9), added to: sum w gx gx, w gx gy, w gy gy, w gx r, w gy r; squares of the last two summed by blocks and
    their product; correlation times weight, weight.
    """
    ny, nx, _ = sums.shape
    n = bell.shape[0]
    for row in prange(ny):
        top = pad + start + row * step - n // 2
        for column in range(nx):
            left = pad + start + column * step - n // 2
            lanes[row] = F(0)
            for j in range(n):
                wy = bell[j]
                y = top + j
                for i in range(n):
                    w = wy * bell[i] * mask[y, left + i]
                    f, g = a[y, left + i], b[y, left + i]
                    lanes[row, 0, i] += w
                    lanes[row, 1, i] += w * f
                    lanes[row, 2, i] += w * g
                    lanes[row, 3, i] += w * f * f
                    lanes[row, 4, i] += w * g * g
                    lanes[row, 5, i] += w * f * g
            s0, s1, s2, s3, s4, s5 = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
            for i in range(n):
                s0 += lanes[row, 0, i]
                s1 += lanes[row, 1, i]
                s2 += lanes[row, 2, i]
                s3 += lanes[row, 3, i]
                s4 += lanes[row, 4, i]
                s5 += lanes[row, 5, i]
            if s0 <= 0:
                continue
            mean_a, mean_b = F(s1 / s0), F(s2 / s0)
            var_a, var_b = s3 / s0 - s1 / s0 * (s1 / s0), s4 / s0 - s2 / s0 * (s2 / s0)
            if var_a <= 1e-9 or var_b <= 1e-9:
                continue
            cov = s5 / s0 - s1 / s0 * (s2 / s0)
            gain = F(math.sqrt(var_a / var_b))
            match = cov / math.sqrt(var_a * var_b)
            least = F(max(noise * noise, 1e-6 * var_a))
            hxx, hxy, hyy, bx, by, qxx, qxy, qyy = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
            for part in range(0, n, BLOCK):
                lanes[row] = F(0)
                for j in range(part, part + BLOCK):
                    wy = bell[j]
                    y = top + j
                    for i in range(n):
                        r = (a[y, left + i] - mean_a) - gain * (b[y, left + i] - mean_b)
                        f, g = gx[y, left + i], gy[y, left + i]
                        known = least + slack * (f * f + g * g)
                        w = wy * bell[i] * mask[y, left + i] * known / (known + r * r)
                        lanes[row, 0, i] += w * f * f
                        lanes[row, 1, i] += w * f * g
                        lanes[row, 2, i] += w * g * g
                        lanes[row, 3, i] += w * f * r
                        lanes[row, 4, i] += w * g * r
                for k in range(0, n, BLOCK):
                    x, y = 0.0, 0.0
                    for i in range(k, k + BLOCK):
                        hxx += lanes[row, 0, i]
                        hxy += lanes[row, 1, i]
                        hyy += lanes[row, 2, i]
                        x += lanes[row, 3, i]
                        y += lanes[row, 4, i]
                    bx += x
                    by += y
                    qxx += x * x
                    qxy += x * y
                    qyy += y * y
            found = sums[row, column]
            found[0] += hxx
            found[1] += hxy
            found[2] += hyy
            found[3] += bx
            found[4] += by
            found[5] += qxx
            found[6] += qxy
            found[7] += qyy
            found[8] += match
