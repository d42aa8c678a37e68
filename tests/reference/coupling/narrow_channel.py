"""Steady plane flow between two exact walls at any place in their cells, linear and direct.

One column of cells.  Full cells turn populations back, as those do whose time-centred velocity is the wall's; the body
force acts in whole cells.
"""

import math

import numpy as np

from tests.reference.coupling import solid_operators as solid

C, W, BACK = solid.DIRECTIONS, solid.WEIGHTS, solid.BACK


def collision(e, tau, magic, wall="exact-wall"):
    """Matrix (9, 9) that populations of a cell are multiplied with, and what a force of 1 along x adds, (9,)."""
    third = 1 / (0.5 + magic / (tau - 0.5))
    if e >= 1:
        return np.eye(9)[BACK], np.zeros(9)
    b, rate_odd, rate_even = 0.0, third, 1 / tau
    if e > 0:
        weight, rates = solid.WALLS[wall]
        b = weight(e, tau)
        rate_odd, rate_even = (float(x) for x in rates(e, tau, third))
    even, carried, rest = solid.halves(np.eye(9))
    equilibrium = np.outer(W, np.ones(9))
    after = even + rate_even * (equilibrium - even) + (1 - b) * carried + (1 - rate_odd) * rest
    return after, 3 * W * C[:, 0] * (1 - b / 2)


def flux(width, low, tau, magic, wall="exact-wall"):
    """Sum of the momentum of all cells over the flux of the parabola;  low: height of the lower wall in its cell."""
    high = low + width
    rows = math.ceil(high) + 2
    e = [1.0, *(1 - max(0.0, min(high, y + 1) - max(low, y)) for y in range(rows - 2)), 1.0]
    matrix, source = np.eye(9 * rows), np.zeros(9 * rows)
    for y, (after, push) in enumerate(collision(min(1.0, max(0.0, each)), tau, magic, wall) for each in e):
        for i in range(9):
            to = (y + int(C[i, 1])) % rows * 9 + i
            matrix[to, 9 * y : 9 * y + 9] -= after[i]
            source[to] += push[i]
    f = np.linalg.lstsq(matrix, source, rcond=1e-13)[0].reshape(rows, 9)
    return float((f @ C[:, 0]).sum()) / (width**3 / (4 * (tau - 0.5)))


def mean_flux(width, tau, magic, count=10, wall="exact-wall"):
    """Mean of ``flux`` over heights of the lower wall, and the standard deviation."""
    found = [flux(width, (n + 0.5) / count, tau, magic, wall) for n in range(count)]
    return float(np.mean(found)), float(np.std(found))
