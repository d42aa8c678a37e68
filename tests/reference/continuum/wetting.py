"""A levee on an impervious base wetted by a river that rises: Darcy's law on a grid, in a few slow lines.

Cells are full, or hold what has come so far; water leaves a cell as its filling lets it, k min(f, 1) ∇H, from the cell
of the higher head (upwind).  A full cell has the pressure ρ g M (f - 1), M a column that squeezes it by 1/M of a metre.
Neither suction, nor inertia, nor air; a river at rest.
"""

from collections.abc import Callable, Sequence

import numpy as np

POROSITY, MODULUS = 0.4, 2.0  # M, m: a river of 0.28 m squeezes water by 14 % at its bottom, in the mean of a levee 4 %


def lines(
    outline: Sequence[tuple[float, float]], level: Callable[[float], float], wet: float, times: Sequence[float],
    permeability: float, step: float,
):  # fmt: skip
    """(places x (k,) m, heights (len(times), k) m of the water in a levee of an ``outline`` from foot to foot, m, at
    ``times``, s): 0 where cells are less than half full.  level : of the river, m;  wet : what is full at the start
    lies left of it and below the level, m;  permeability m/s;  step : of the grid, m."""
    corners = np.array(outline)
    x = np.arange(0.5 * step, corners[-1, 0] + 2.0 * step, step)
    y = np.arange(0.5 * step, corners[:, 1].max() + 2.0 * step, step)
    ground = np.interp(x, corners[:, 0], corners[:, 1])
    inside = y[None, :] < ground[:, None]
    river = ~inside & (x[:, None] < corners[:, 0].mean())
    high = np.broadcast_to(y, inside.shape)
    full = inside & (x[:, None] < wet) & (high < level(0.0))
    filling = np.where(full, 1.0 + (level(0.0) - high) / MODULUS, 0.0)
    dt = 0.2 * step**2 * POROSITY / (permeability * MODULUS)
    rate, time, found = permeability * dt / (POROSITY * step**2), 0.0, []
    for due in times:
        while time < due:
            now = level(time)
            under = river & (high < now)
            head = np.where(under, now, high + MODULUS * np.maximum(filling - 1.0, 0.0))
            open_ = np.where(inside, np.minimum(filling, 1.0), under)
            for axis in range(2):
                a, b = (slice(None, -1), slice(1, None)) if axis == 0 else (np.s_[:, :-1], np.s_[:, 1:])
                fall = head[a] - head[b]
                flux = rate * fall * np.where(fall > 0.0, open_[a], open_[b]) * (inside[a] | inside[b])
                filling[a] -= flux
                filling[b] += flux
            filling[~inside] = 0.0
            time += dt
        half = inside & (filling > 0.5)
        found.append(np.where(half, high + 0.5 * step, 0.0).max(axis=1))
    return x, np.array(found)
