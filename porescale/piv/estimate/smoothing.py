"""Smoothing of a field no more than its own noise supports.

Penalised least squares, sum (z - y)^2 + s sum |second differences of z|^2, natural at the edges, so that planes are
left as they are (Whittaker 1923; Eilers & Marx 2003); s by generalised cross-validation (Craven & Wahba 1979, Numer.
Math. 31, 377), as Garcia 2011 (Exp. Fluids 50, 1247) smooths displacements.  Where windows overlap by more than half,
errors of neighbours are alike, and plain cross-validation takes them for flow: the trace then counts for several
(Lukas 2006, Inverse Problems 22, 1883).
"""

from functools import lru_cache
from typing import NamedTuple

import numpy as np

from porescale.common.core.types import Floats

STRENGTHS = np.logspace(-3, 6, 46)
"""Candidates for the smoothing parameter s."""


@lru_cache(maxsize=64)
def _modes(count: int) -> tuple[Floats, Floats]:
    """Eigenvalues (n,) and eigenvectors (n, n) of the squared second difference with free ends."""
    if count < 3:
        return np.zeros(count), np.eye(count)
    second = np.diff(np.eye(count), 2, axis=0)
    values, vectors = np.linalg.eigh(second.T @ second)
    return np.maximum(values, 0.0), vectors


class Smoothed(NamedTuple):
    """u, v (ny, nx) px;  noise : variance of a vector over that of the data of one square px;  freedom : coefficients a
    square px that the field may choose;  bias_u, bias_v : what smoothing once more would take off, which is about what
    it took.
    """

    u: Floats
    v: Floats
    noise: float
    freedom: float
    bias_u: Floats
    bias_v: Floats


def smoothed(u: Floats, v: Floats, step: int, stiffness: float, alike: float = 1.0, *, choose: bool = True) -> Smoothed:
    """A field as a fit with the stiffness of the least cross-validation score would have made it.

    u, v : at the knots, ``step`` px apart, of a fit with ``stiffness``, which is undone to evaluate the data of the
    pictures; less is not tried, nor more unless ``choose``;  alike : knots that share the tracers of one, >= 1.
    """
    (down, rows), (across, columns) = _modes(u.shape[0]), _modes(u.shape[1])
    py, px = np.sqrt(down)[:, None], np.sqrt(across)
    weight, height = _gram(py) * _gram(px), (1 - py / 6) * (1 - px / 6)
    penalty = (py + px) ** 2 / weight
    undone = 1 + stiffness * penalty
    found = [rows.T @ it @ columns for it in (u, v)]
    power = sum(it * it for it in found) * weight * (undone / height) ** 2
    best, strength = np.inf, stiffness
    for s in STRENGTHS[stiffness < STRENGTHS] if choose else ():
        kept = 1 / (1 + s * penalty)
        free = 1 - alike * float(kept.mean())
        score = float((power * (1 - kept) ** 2).mean()) / free**2 if free > 0 else np.inf
        if score < best:
            best, strength = score, float(s)
    kept = 1 / (1 + strength * penalty)
    noise = float((height**2 * kept**2 / weight).mean()) / step**2
    one, two = (kept * undone * it for it in found)
    fields = (rows @ it @ columns.T for it in (one, two, (1 - kept) * one, (1 - kept) * two))
    u, v, bias_u, bias_v = fields
    return Smoothed(u, v, noise, float(kept.mean()) / step**2, bias_u, bias_v)


def _gram(p: Floats) -> Floats:
    """Sum of squares of cubic B-splines over that of their coefficients, where first differences square to p times."""
    c = np.clip(1 - 0.5 * p, -1.0, 1.0)  # cosine of the mode's angle
    return np.asarray((2416 + 2382 * c + 240 * (2 * c * c - 1) + 2 * (4 * c**3 - 3 * c)) / 5040)
