"""Gauss-Newton updates with a gradient, for windows that a solid cuts.

What such a window sees lies off its centre, by some pixels; a plane, sum w (r - g . (d + G (x - x0)))^2, gives the
update at the centre itself.  G, the change of the gradient against the last estimate, is wished small.
"""

from __future__ import annotations

import math

import numpy as np

from porescale.ground.jit import inline, parallel_kernel, prange

LENGTH = 4.0
"""px that coordinates are counted in: about how far off the centre a window's light lies."""
WISH = 0.02
"""Weight of the wish for small G times LENGTH, over that of the light for d."""


@inline
def _solved(h, right, count):
    """Solve h x = right in place, h (count, count) symmetric, positive (False if not); the answer is in ``right``."""
    for k in range(count):
        if h[k, k] <= 0:
            return False
        for i in range(k + 1, count):
            share = h[i, k] / h[k, k]
            for j in range(k, count):
                h[i, j] -= share * h[k, j]
            right[i] -= share * right[k]
    for k in range(count - 1, -1, -1):
        for j in range(k + 1, count):
            right[k] -= h[k, j] * right[j]
        right[k] /= h[k, k]
    return True


@parallel_kernel
def tilted(a, b, mask, gx, gy, bell, pad, start, step, noise, slack, which, found):
    """Updates (n, 2) px of the windows ``which`` (n, 2), row and column; others' arguments as of ``refine``.

    found : overwritten; nan where a window cannot be judged.
    """
    n = bell.shape[0]
    for number in prange(which.shape[0]):
        top = pad + start + which[number, 0] * step - n // 2
        left = pad + start + which[number, 1] * step - n // 2
        s0, s1, s2, s3, s4 = 0.0, 0.0, 0.0, 0.0, 0.0
        for j in range(n):
            for i in range(n):
                w = bell[j] * bell[i] * mask[top + j, left + i]
                f, g = a[top + j, left + i], b[top + j, left + i]
                s0, s1, s2, s3, s4 = s0 + w, s1 + w * f, s2 + w * g, s3 + w * f * f, s4 + w * g * g
        found[number, 0] = found[number, 1] = np.nan
        if s0 <= 0 or s3 * s0 <= s1 * s1 or s4 * s0 <= s2 * s2:
            continue
        mean_a, mean_b = s1 / s0, s2 / s0
        var_a = s3 / s0 - mean_a * mean_a
        gain = math.sqrt(var_a / (s4 / s0 - mean_b * mean_b))
        least = max(noise * noise, 1e-6 * var_a)
        h, right, slope = np.zeros((6, 6)), np.zeros(6), np.empty(6)
        for j in range(n):
            y = (j - n // 2) / LENGTH
            for i in range(n):
                w = bell[j] * bell[i] * mask[top + j, left + i]
                if w > 0:
                    x = (i - n // 2) / LENGTH
                    f, g = gx[top + j, left + i], gy[top + j, left + i]
                    r = (a[top + j, left + i] - mean_a) - gain * (b[top + j, left + i] - mean_b)
                    due = least + slack * (f * f + g * g)
                    w *= due / (due + r * r)
                    slope[0], slope[1], slope[2] = f, f * x, f * y
                    slope[3], slope[4], slope[5] = g, g * x, g * y
                    for k in range(6):
                        right[k] += w * slope[k] * r
                        for m in range(k, 6):
                            h[k, m] += w * slope[k] * slope[m]
        for k in range(6):
            for m in range(k):
                h[k, m] = h[m, k]
        wish = WISH * (h[0, 0] + h[3, 3])
        for k in (1, 2, 4, 5):
            h[k, k] += wish
        if _solved(h, right, 6):
            found[number, 0], found[number, 1] = right[0], right[3]
