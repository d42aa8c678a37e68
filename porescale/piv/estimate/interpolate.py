"""Grey values between pixels: quintic B-splines through the pixels.

The interpolator sets the sub-pixel bias of a measurement, not the peak fit (Astarita & Cardone 2005, Exp. Fluids 38,
233). Coefficients: Unser, Aldroubi & Eden 1993, IEEE Trans. Signal Process. 41, 821, the inverse filter cut where it
has fallen below float32.
"""

import cv2
import numpy as np
from numpy.typing import NDArray

from porescale.common.compiled.jit import kernel, parallel_kernel, prange
from porescale.common.core.types import Singles

PAD = 8
"""Pixels of mirrored coefficients around a picture: a sample may lie 5 px outside."""

POLES = (-0.43057534709997430, -0.043096288203264653)
"""Roots of z^4 + 26 z^3 + 66 z^2 + 26 z + 1 within the unit circle."""

F = np.float32
_1, _5, _10, _20, _26, _30, _50, _60, _66 = (F(k) for k in (1, 5, 10, 20, 26, 30, 50, 60, 66))
_SCALE = F(1 / 120**2)


def _inverse(taps: int = 21) -> NDArray[np.float64]:
    """Response (2 taps - 1,) of the inverse of [1, 26, 66, 26, 1]/120: 0.43^21 is 2e-8, below float32's 6e-8."""
    distance = np.abs(np.arange(-3 * taps, 3 * taps + 1))
    response = np.ones(1)
    for pole in POLES:
        one = pole**distance * (1 - pole) / (1 + pole)  # of (z - p)(1/z - p)/(1 - p)^2, gain 1
        response = np.convolve(response, one, "same") if response.size > 1 else one
    middle = len(response) // 2
    return response[middle - taps + 1 : middle + taps]


INVERSE = _inverse().astype(F)


def coefficients(picture: Singles) -> Singles:
    """Spline coefficients (rows + 2 PAD, columns + 2 PAD) of a picture (rows, columns), mirrored at its edges."""
    found = cv2.sepFilter2D(picture, cv2.CV_32F, INVERSE, INVERSE, borderType=cv2.BORDER_REFLECT_101)
    return np.asarray(cv2.copyMakeBorder(found, PAD, PAD, PAD, PAD, cv2.BORDER_REFLECT_101), F)


@kernel
def sample_row(c, y, dx, dy, out):
    """One row of ``sample``."""
    columns = out.shape[0]
    low_x, high_x = F(-4), F(columns + 3)
    low_y, high_y = F(-4), F(c.shape[0] - 2 * PAD + 3)
    start = 0
    while start < columns:
        # Pixels beside one another that take the same whole step: their loop reads along rows, without gathering.
        step_x, step_y = np.floor(dx[start]), np.floor(dy[start])
        stop = start + 1
        while stop < columns and np.floor(dx[stop]) == step_x and np.floor(dy[stop]) == step_y:
            stop += 1
        left, top = start + int(step_x), y + int(step_y)
        # A run ends where it enters or leaves the picture: where all pixels move alike it is a whole row.
        inside = F(left) >= low_x and F(left) < high_x and F(top) >= low_y and F(top) <= high_y
        if inside:
            stop = min(stop, start + int(high_x) - left)
        elif F(left) < low_x:
            stop = min(stop, start + int(low_x) - left)
        if not inside:
            for x in range(start, stop):  # outside: the nearest sample there is
                at_x = min(max(F(x) + dx[x], low_x), high_x)
                at_y = min(max(F(y) + dy[x], low_y), high_y)
                out[x] = c[int(at_y) + PAD, int(at_x) + PAD]
            start = stop
            continue
        base = PAD - 2 + int(step_x)
        r0, r1, r2 = c[top + PAD - 2], c[top + PAD - 1], c[top + PAD]
        r3, r4, r5 = c[top + PAD + 1], c[top + PAD + 2], c[top + PAD + 3]
        for x in range(start, stop):
            t = dy[x] - step_y
            s = t * t
            b = s * s
            a = b * t
            v5 = a
            v4 = _1 + _5 * t + _10 * s + _10 * s * t + _5 * b - _5 * a
            v3 = _26 + _50 * t + _20 * s - _20 * s * t - _20 * b + _10 * a
            v2 = _66 - _60 * s + _30 * b - _10 * a
            v1 = _26 - _50 * t + _20 * s + _20 * s * t - _20 * b + _5 * a
            v0 = (_1 - t) * (_1 - t) * (_1 - t) * (_1 - t) * (_1 - t)
            t = dx[x] - step_x
            s = t * t
            b = s * s
            a = b * t
            w5 = a
            w4 = _1 + _5 * t + _10 * s + _10 * s * t + _5 * b - _5 * a
            w3 = _26 + _50 * t + _20 * s - _20 * s * t - _20 * b + _10 * a
            w2 = _66 - _60 * s + _30 * b - _10 * a
            w1 = _26 - _50 * t + _20 * s + _20 * s * t - _20 * b + _5 * a
            w0 = (_1 - t) * (_1 - t) * (_1 - t) * (_1 - t) * (_1 - t)
            k = x + base
            total = v0 * (
                w0 * r0[k] + w1 * r0[k + 1] + w2 * r0[k + 2] + w3 * r0[k + 3] + w4 * r0[k + 4] + w5 * r0[k + 5]
            )
            total += v1 * (
                w0 * r1[k] + w1 * r1[k + 1] + w2 * r1[k + 2] + w3 * r1[k + 3] + w4 * r1[k + 4] + w5 * r1[k + 5]
            )
            total += v2 * (
                w0 * r2[k] + w1 * r2[k + 1] + w2 * r2[k + 2] + w3 * r2[k + 3] + w4 * r2[k + 4] + w5 * r2[k + 5]
            )
            total += v3 * (
                w0 * r3[k] + w1 * r3[k + 1] + w2 * r3[k + 2] + w3 * r3[k + 3] + w4 * r3[k + 4] + w5 * r3[k + 5]
            )
            total += v4 * (
                w0 * r4[k] + w1 * r4[k + 1] + w2 * r4[k + 2] + w3 * r4[k + 3] + w4 * r4[k + 4] + w5 * r4[k + 5]
            )
            total += v5 * (
                w0 * r5[k] + w1 * r5[k + 1] + w2 * r5[k + 2] + w3 * r5[k + 3] + w4 * r5[k + 4] + w5 * r5[k + 5]
            )
            out[x] = total * _SCALE
        start = stop


@parallel_kernel
def sample(c, dx, dy, pad, out):
    """Values of the spline with coefficients c at (x + dx, y + dy) for every pixel x, y of a picture (rows, columns).

    dx, dy (rows, columns) float32, px;  c : of ``coefficients`` for a picture of that size;  out (rows + 2 pad,
    columns + 2 pad) float32 : overwritten but for the border.  Beyond 4 px outside the picture values mean nothing.
    Not checked: that dx, dy are finite.
    """
    for y in prange(dx.shape[0]):
        sample_row(c, np.int64(y), dx[y], dy[y], out[y + pad, pad : pad + dx.shape[1]])
