"""Seepage through a rectangular dam by a variational inequality, in a few slow lines.

w(x, y) = ∫_y^h(x) p/(ρ g) dy' solves Δw = 1 where w > 0 and w = 0 beyond: no free surface to move about (Baiocchi, Ann.
Mat. Pura Appl. 92 (1972) 107).  On the sides w = (H - y)²/2 up to the levels, at the base a straight line between.
"""

import numpy as np


def surface(upstream: float, downstream: float, length: float, cells: int = 100, sweeps: int = 4000):
    """(places x, heights h of the free surface) of a dam; lengths in one unit, ``cells`` over the upstream level."""
    step = upstream / cells
    columns = round(length / step)
    y = np.linspace(0.0, upstream, cells + 1)
    x = np.linspace(0.0, length, columns + 1)
    w = np.zeros((columns + 1, cells + 1))
    left, right = 0.5 * np.maximum(0.0, upstream - y) ** 2, 0.5 * np.maximum(0.0, downstream - y) ** 2
    part = (x / length)[:, None]
    w[:] = (1.0 - part) * left + part * right
    number = np.add.outer(np.arange(columns + 1), np.arange(cells + 1))[1:-1, 1:-1] % 2
    factor = 2.0 / (1.0 + np.sin(np.pi / cells))
    for _ in range(sweeps):
        for colour in (0, 1):
            around = 0.25 * (w[2:, 1:-1] + w[:-2, 1:-1] + w[1:-1, 2:] + w[1:-1, :-2] - step * step)
            better = np.maximum(0.0, w[1:-1, 1:-1] + factor * (around - w[1:-1, 1:-1]))
            w[1:-1, 1:-1] = np.where(number == colour, better, w[1:-1, 1:-1])
    # √w falls to nothing in a straight line: from the last two nodes well inside
    root, heights = np.sqrt(w), np.zeros(columns + 1)
    for i in range(columns + 1):
        inside = np.flatnonzero(w[i] > step * step)
        if inside.size < 2:
            continue
        k = inside[-1]
        heights[i] = y[k] + step * root[i, k] / (root[i, k - 1] - root[i, k])
    return x, heights
