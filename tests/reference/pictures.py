"""Pictures of discs as a camera would take them: every pixel by its part of a disc, blurred, unevenly lit, noisy."""

import numpy as np
from scipy.ndimage import gaussian_filter


def photograph(position, radius, shape, *, noise=6.0, blur=0.8, light=True, seed=1):
    """Grey values (rows, columns) uint8 of discs at ``position`` (n, 2) px, x right and y down; the middle of the first
    pixel is at (0.5, 0.5).

    Discs are 130 grey levels above what is between them, lit half as much again on the right as on the left.
    """
    rows, columns = np.mgrid[0 : shape[0], 0 : shape[1]] + 0.5
    part = np.zeros(shape)
    for (x, y), r in zip(position, radius, strict=True):
        window = (slice(max(int(y - r) - 3, 0), int(y + r) + 4), slice(max(int(x - r) - 3, 0), int(x + r) + 4))
        part[window] = np.maximum(
            part[window], np.clip(r - np.hypot(columns[window] - x, rows[window] - y) + 0.5, 0, 1)
        )
    grey = (60.0 + 130.0 * gaussian_filter(part, blur)) * (0.75 + 0.5 * columns / shape[1])
    grey += np.random.default_rng(seed).normal(0.0, noise, shape)
    return np.clip(np.rint(grey if light else 255.0 - grey), 0, 255).astype(np.uint8)
