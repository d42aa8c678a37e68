"""Slow twin of the pair list: every pair looked at, straight from the definition."""

import numpy as np


def nearest_image(dx, period):
    """Distance component between nearest images; period 0: not periodic."""
    return dx - period * np.rint(dx / period) if period > 0.0 else dx


def neighbours(x, reach, skin, lower, upper, periodic=(False, False), full=False):
    """Rows of partners, a list of lists: |x_i - x_j| < reach_i + reach_j + skin, nearest image."""
    period = [upper[a] - lower[a] if periodic[a] else 0.0 for a in (0, 1)]
    rows = []
    for i in range(len(x)):
        dx = nearest_image(x[i, 0] - x[:, 0], period[0])
        dy = nearest_image(x[i, 1] - x[:, 1], period[1])
        near = dx * dx + dy * dy < (reach[i] + reach + skin) ** 2
        near[i] = False
        if not full:
            near[:i] = False
        rows.append(np.flatnonzero(near).tolist())
    return rows


def rows_of(pairs):
    """The rows of a PairList as a list of lists."""
    return [pairs.partner[pairs.start[i] : pairs.start[i + 1]].tolist() for i in range(pairs.count)]
