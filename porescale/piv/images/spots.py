"""Pictures of tracers: Gaussian spots integrated over each pixel, and discs."""

import math

import numpy as np
from numpy.typing import NDArray

from porescale.common.compiled.jit import kernel
from porescale.piv.images.flows import Discs

REACH = 4.5
"""Standard deviations at which a spot ends: beyond lies 7e-6 of its light."""


@kernel
def add_spots(x, y, peak, sigma, image):
    """Add to ``image`` (rows, columns) the light of Gaussian spots, the mean over each pixel.

    peak (n,) grey levels: height of the Gaussian peak exp(-r^2/(2 sigma^2)) at x, y (n,) px;  sigma : px.  The mean
    over a pixel is a product of differences of error functions (Raffel et al. 2018, Particle Image Velocimetry,
    section 3.2).
    """
    rows, columns = image.shape
    scale = 1.0 / (sigma * math.sqrt(2.0))
    factor = 0.5 * math.pi * sigma * sigma
    reach = REACH * sigma + 0.5
    across = np.empty(int(2.0 * reach) + 3)
    for k in range(x.shape[0]):
        left, right = max(0, math.ceil(x[k] - reach)), min(columns - 1, math.floor(x[k] + reach))
        top, bottom = max(0, math.ceil(y[k] - reach)), min(rows - 1, math.floor(y[k] + reach))
        for i in range(left, right + 1):
            across[i - left] = math.erf((i + 0.5 - x[k]) * scale) - math.erf((i - 0.5 - x[k]) * scale)
        for j in range(top, bottom + 1):
            down = math.erf((j + 0.5 - y[k]) * scale) - math.erf((j - 0.5 - y[k]) * scale)
            light = factor * peak[k] * down
            for i in range(left, right + 1):
                image[j, i] += light * across[i - left]


def coverage(discs: Discs, share: NDArray[np.float64]) -> None:
    """Raise ``share`` (rows, columns), of each pixel, to what discs in px cover of it: exact to the rim's bending."""
    rows, columns = share.shape
    for x, y, r in zip(discs.x.tolist(), discs.y.tolist(), discs.radius.tolist(), strict=True):
        left, right = max(0, math.floor(x - r - 1)), min(columns, math.ceil(x + r + 2))
        top, bottom = max(0, math.floor(y - r - 1)), min(rows, math.ceil(y + r + 2))
        if left < right and top < bottom:
            part = share[top:bottom, left:right]
            far = np.hypot(np.arange(left, right) - x, np.arange(top, bottom)[:, None] - y)
            np.maximum(part, np.clip(0.5 + r - far, 0.0, 1.0), out=part)
