"""Smoothing of a field no more than its own noise asks for.

Penalised least squares, sum (z - y)^2 + s sum |second differences of z|^2, natural at the edges, so that planes are
left as they are (Whittaker 1923; Eilers & Marx 2003); s by generalised cross-validation (Craven & Wahba 1979, Numer.
Math. 31, 377), as Garcia 2011 (Exp. Fluids 50, 1247) smooths displacements.  Where windows overlap by more than half,
errors of neighbours are alike, and plain cross-validation takes them for flow: the trace then counts for several
(Lukas 2006, Inverse Problems 22, 1883).
"""

from __future__ import annotations

from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

STRENGTHS = np.logspace(-3, 6, 73)
"""Candidates for s."""


@lru_cache(maxsize=64)
def _modes(count: int) -> tuple[Array, Array]:
    """Eigenvalues (n,) and eigenvectors (n, n) of the squared second difference with free ends."""
    if count < 3:
        return np.zeros(count), np.eye(count)
    second = np.diff(np.eye(count), 2, axis=0)
    values, vectors = np.linalg.eigh(second.T @ second)
    return np.maximum(values, 0.0), vectors


def smoothed(u: Array, v: Array, alike: float = 1.0) -> tuple[Array, Array]:
    """u, v (ny, nx) smoothed with one s for both.  ``alike`` : vectors that share one error, >= 1."""
    (down, rows), (across, columns) = _modes(u.shape[0]), _modes(u.shape[1])
    penalty = (np.sqrt(down)[:, None] + np.sqrt(across)) ** 2
    found = [rows.T @ it @ columns for it in (u, v)]
    power = sum(it * it for it in found)
    best, strength = np.inf, 0.0
    for s in STRENGTHS:
        kept = 1 / (1 + s * penalty)
        free = 1 - alike * float(kept.mean())
        score = float((power * (1 - kept) ** 2).mean()) / free**2 if free > 0 else np.inf
        if score < best:
            best, strength = score, s
    kept = 1 / (1 + strength * penalty)
    one, two = (rows @ (kept * it) @ columns.T for it in found)
    return one, two
