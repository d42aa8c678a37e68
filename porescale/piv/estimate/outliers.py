"""Vectors that do not fit their neighbours, and what to put in their place.  Only vectors of the fluid count."""

import numpy as np

from porescale.common.compiled.jit import inline, kernel
from porescale.common.core.types import Flags, Floats

THRESHOLD, LEAST = 2.0, 0.1
"""Of the normalised median test: bound, and fluctuation in px taken as normal (Westerweel & Scarano 2005)."""
ENOUGH = 5
"""Neighbours needed; where fewer of the eight are fluid the next ring counts too."""


@inline
def _median(values, count):
    """Median of the first ``count`` values, which are sorted in place."""
    for i in range(1, count):
        kept, k = values[i], i
        while k > 0 and values[k - 1] > kept:
            values[k] = values[k - 1]
            k -= 1
        values[k] = kept
    half = count // 2
    return values[half] if count % 2 else 0.5 * (values[half - 1] + values[half])


@kernel
def median_residual(u, v, use, least, found):
    """Normalised median residual of every vector (ny, nx), over its neighbours where ``use``; 0 with fewer than three.

    |u - m| / (median |u_i - m| + least), m the median of the neighbours u_i, both components as one length (Westerweel
    & Scarano 2005, Exp. Fluids 39, 1096).  ``found`` is overwritten.
    """
    ny, nx = u.shape
    list_u, list_v, spare = np.empty(25), np.empty(25), np.empty(25)
    for row in range(ny):
        for column in range(nx):
            count = 0
            for ring in range(1, 3):
                if count >= ENOUGH:
                    break
                for j in range(max(0, row - ring), min(ny, row + ring + 1)):
                    for i in range(max(0, column - ring), min(nx, column + ring + 1)):
                        if use[j, i] and max(abs(j - row), abs(i - column)) == ring:
                            list_u[count], list_v[count] = u[j, i], v[j, i]
                            count += 1
            found[row, column] = 0.0
            if count < 3:
                continue
            total = 0.0
            for values, own in ((list_u, u[row, column]), (list_v, v[row, column])):
                middle = _median(values, count)
                for k in range(count):
                    spare[k] = abs(values[k] - middle)
                total += ((own - middle) / (_median(spare, count) + least)) ** 2
            found[row, column] = np.sqrt(total)


REACH = 3
RIDGE = 0.05
"""Weight of the wish for a flat plane, over the total weight and the square of a grid step."""


@kernel
def fill_once(u, v, good, new_u, new_v, done):
    """Planes through the good vectors around, at each that is not good; ``done`` marks where there were enough.

    Least squares over a neighbourhood of REACH steps, weighted by exp(-d^2/4.5), with a small wish for flatness.  All
    (ny, nx); new_u, new_v, done are overwritten where ``good`` is false.
    """
    ny, nx = u.shape
    for row in range(ny):
        for column in range(nx):
            if good[row, column]:
                continue
            s, sx, sy, sxx, sxy, syy = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
            a, ax, ay, b, bx, by = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
            count = 0
            for j in range(max(0, row - REACH), min(ny, row + REACH + 1)):
                for i in range(max(0, column - REACH), min(nx, column + REACH + 1)):
                    if good[j, i]:
                        x, y = float(i - column), float(j - row)
                        w = np.exp(-(x * x + y * y) / 4.5)
                        s, sx, sy = s + w, sx + w * x, sy + w * y
                        sxx, sxy, syy = sxx + w * x * x, sxy + w * x * y, syy + w * y * y
                        a, ax, ay = a + w * u[j, i], ax + w * x * u[j, i], ay + w * y * u[j, i]
                        b, bx, by = b + w * v[j, i], bx + w * x * v[j, i], by + w * y * v[j, i]
                        count += 1
            done[row, column] = count >= 3
            if count < 3:
                continue
            # Slopes from moments about the centroid, then the plane's value at the vector itself.
            cxx, cxy, cyy = sxx - sx * sx / s + RIDGE * s, sxy - sx * sy / s, syy - sy * sy / s + RIDGE * s
            det = cxx * cyy - cxy * cxy
            px, py = ax - sx * a / s, ay - sy * a / s
            new_u[row, column] = (a - (cyy * px - cxy * py) / det * sx - (cxx * py - cxy * px) / det * sy) / s
            px, py = bx - sx * b / s, by - sy * b / s
            new_v[row, column] = (b - (cyy * px - cxy * py) / det * sx - (cxx * py - cxy * px) / det * sy) / s


def residual(u: Floats, v: Floats, use: Flags, least: float = LEAST) -> Floats:
    """Normalised median residual (ny, nx) of ``median_residual``."""
    found = np.empty(u.shape)
    median_residual(u, v, use, least, found)
    return found


def filled(u: Floats, v: Floats, good: Flags) -> tuple[Floats, Floats]:
    """u, v (ny, nx) with planes through good neighbours where not ``good``, from the rim of a gap inwards.

    Zero everywhere if nothing is good; the median where fewer than three are.
    """
    u, v, good = np.where(good, u, 0.0), np.where(good, v, 0.0), good.copy()
    if not good.any():
        return u, v
    middle_u, middle_v = float(np.median(u[good])), float(np.median(v[good]))
    done = np.zeros_like(good)
    while not good.all():
        new_u, new_v = u.copy(), v.copy()
        done[:] = False
        fill_once(u, v, good, new_u, new_v, done)
        if not done.any():
            return np.where(good, u, middle_u), np.where(good, v, middle_v)
        u, v = new_u, new_v
        good |= done
    return u, v
