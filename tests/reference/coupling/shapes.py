"""Solid fractions of shapes by brute force: points in every cell that lie inside."""

import numpy as np

POINTS = 64
"""Points of a cell along x and y, in the middle of as many squares."""


def fractions(inside, nx, ny, periodic=(False, False)):
    """Share of the points of every cell for which ``inside(x, y)``, (ny, nx); periodic sides: of any image."""
    at = (np.arange(POINTS) + 0.5) / POINTS
    x = (np.arange(nx)[:, None] + at).ravel()[None, :]
    y = (np.arange(ny)[:, None] + at).ravel()[:, None]
    found = np.zeros((ny * POINTS, nx * POINTS), bool)
    for kx in (-2, -1, 0, 1, 2) if periodic[0] else (0,):
        for ky in (-2, -1, 0, 1, 2) if periodic[1] else (0,):
            found |= inside(x + kx * nx, y + ky * ny)
    return found.reshape(ny, POINTS, nx, POINTS).mean(axis=(1, 3))
