"""Steady plane flow over a row of partially saturated cells, linear and direct: what a solid operator makes of a wall.

Cells stand on each other.  Below the row of solid fraction e lie full cells whose time-centred velocity is the wall's:
they turn populations back, a half-way wall at height 0.  The wall proper is at height e; above stands a half-way wall
that moves at speed 1 or stands.  One column, equilibria without squares of the velocity, density 1.
"""

import numpy as np

from tests.reference.coupling import solid_operators as solid

C, W, BACK = solid.DIRECTIONS, solid.WEIGHTS, solid.BACK


def printed_row(f, g, u, e, tau):
    """Odd half of SC1 with weight B2, at rest."""
    k = tau - 0.5
    b = e * k / (1 - e + k)
    return (1 - b) * g + b * (f[BACK] + 3 * np.tensordot(W[:, None] * C, u, 1))


def step(f, e, tau, force, speed, operator, magic=3 / 16):
    """One step of populations less the weights, f (9, rows, m)."""
    third = 1 / (0.5 + magic / (tau - 0.5))
    push = np.array([force, 0.0])[:, None, None]
    u = np.tensordot(C.T, f, 1) + push / 2
    even, odd = (f + f[BACK]) / 2, (f - f[BACK]) / 2
    carried = 3 * np.tensordot(W[:, None] * C, u, 1)
    pushed = 3 * np.tensordot(W[:, None] * C, push, 1)
    rest = even + (W[:, None, None] * f.sum(0) - even) / tau
    g = rest + odd + third * (carried - odd) + (1 - third / 2) * pushed
    row, force_there = f[:, 0], push[:, 0] * np.ones_like(u[:, 0])
    if operator == "exact-wall":
        g[:, 0] = solid.exact_wall(row, g[:, 0], 1.0, force_there, 0 * u[:, 0], e, tau, third)
    else:
        g[:, 0] = printed_row(row, g[:, 0], u[:, 0], e, tau)
    out = np.zeros_like(f)
    for i, (cx, cy) in enumerate(C.astype(int)):
        if cy == 0:
            out[i] = g[i]
        elif cy > 0:
            out[i, 1:] = g[i, :-1]
            out[BACK[i], -1] = g[i, -1] - 6 * W[i] * cx * speed
        else:
            out[i, :-1] = g[i, 1:]
            out[BACK[i], 0] = g[i, 0]
    return out


def steady_velocity(rows, e, tau, *, force=0.0, speed=0.0, operator="exact-wall", magic=3 / 16):
    """Time-centred velocity along the wall at the centres of all rows but the first, (rows - 1,)."""
    size = 9 * rows
    still = step(np.zeros((9, rows, 1)), e, tau, force, speed, operator, magic).reshape(size)
    moved = step(np.eye(size).reshape(9, rows, size), e, tau, 0.0, 0.0, operator, magic).reshape(size, size)
    f = np.linalg.lstsq(np.eye(size) - moved, still, rcond=1e-13)[0].reshape(9, rows)
    return C[:, 0] @ f[:, 1:] + force / 2
