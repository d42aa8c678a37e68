"""What there is to say of the second fluid in a tank: where it is, how it rises, how round, in how many pieces."""

from __future__ import annotations

import numpy as np
from contourpy import contour_generator
from numpy.typing import NDArray
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components
from scipy.spatial import cKDTree

from continuum_sph.water.step import Flow

Floats = NDArray[np.float64]

SMOOTH = 2.6  # spacings, the kernel that draws an outline: with half of that each particle is a bump in it
TOUCH = 1.6  # spacings: particles nearer belong together; neighbours across a diagonal are at 1.41


def bubble(flow: Flow) -> dict[str, float]:
    """Columns of the series: centre and mean velocity by volume, circularity, pieces of four particles and more."""
    layer, n = flow.layer, flow.layer.fluid
    own = layer.material[:n] == 1
    x, volume = layer.x[:n][own], layer.mass[:n][own] / layer.density[own]
    share = volume / volume.sum()
    return {
        "bubble centre x (m)": float(share @ x[:, 0]),
        "bubble centre (m)": float(share @ x[:, 1]),
        "bubble rise (m/s)": float(share @ layer.v[:n, 1][own]),
        "bubble area (m2)": float(volume.sum()),
        "bubble circularity ()": circularity(layer.x[:n], layer.material[:n], flow.law.spacing),
        "bubble pieces ()": float(pieces(x, flow.law.spacing)),
    }


def circularity(x: Floats, fluid: NDArray[np.int64], spacing: float) -> float:
    """Girth of the circle of equal area over that of the second fluid: 1 when it is one round piece.

    Its outline is where the ``fluid`` (n,), 0 or 1, of the particles at ``x`` (n, 2) m, averaged over a kernel of
    SMOOTH ``spacing`` (m), is one half; area and girth are both the outline's.  Particles strewn over exact shapes say
    how good that is: a disc of ten spacings and more has 0.996 to 0.999; an ellipse whose ends are as blunt as four
    spacings is right to 0.5 %; sharper corners are cut off, which makes the shape too round.
    """
    h = SMOOTH * spacing
    own = x[fluid == 1]
    low, high = own.min(axis=0) - 4.0 * h, own.max(axis=0) + 4.0 * h
    near = ((x > low - 2.0 * h) & (x < high + 2.0 * h)).all(axis=1)
    xs, ys = (np.arange(low[axis], high[axis], 0.5 * spacing) for axis in (0, 1))
    places = np.column_stack([axis.ravel() for axis in np.meshgrid(xs, ys)])
    pairs = cKDTree(places).sparse_distance_matrix(cKDTree(x[near]), 2.0 * h, output_type="ndarray")
    rest = 1.0 - 0.5 * pairs["v"] / h
    weight = rest**4 * (5.0 - 4.0 * rest)  # Wendland C2
    below = np.bincount(pairs["i"], weight, len(places))
    above = np.bincount(pairs["i"], weight * fluid[near][pairs["j"]], len(places))
    share = np.divide(above, below, out=np.zeros(len(places)), where=below > 0.0)
    girth = area = 0.0
    for line in contour_generator(xs, ys, share.reshape(len(ys), len(xs))).lines(0.5):
        at = np.asarray(line)
        steps = np.diff(at, axis=0)
        girth += float(np.hypot(steps[:, 0], steps[:, 1]).sum())
        area += 0.5 * float((at[:-1, 0] * steps[:, 1] - at[:-1, 1] * steps[:, 0]).sum())
    return float(2.0 * np.sqrt(np.pi * abs(area)) / girth) if girth > 0.0 else 0.0


def pieces(x: Floats, spacing: float) -> int:
    """Number of groups of four and more of the points ``x`` (n, 2) m that hang together within `TOUCH` spacings."""
    pairs = cKDTree(x).query_pairs(TOUCH * spacing, output_type="ndarray")
    links = coo_array((np.ones(len(pairs)), (pairs[:, 0], pairs[:, 1])), shape=(len(x), len(x)))
    _, label = connected_components(links, directed=False)
    return int((np.bincount(label) >= 4).sum())
