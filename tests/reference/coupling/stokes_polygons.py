"""Slow flow past convex polygons that repeat with a square lattice: forces all along their sides (single layer).

u(x) = flow + integral of S(x - y) f(y) over the outline, equal to the body's velocity on it; S: stokes_array.py.  Each
side is cut into panels that halve towards its corners, where f grows like a power of the distance (1/2 - 0.955 at a
right angle), with Gauss's points of order ``order`` on each.  Where a panel lies near the point, the integral is cut
towards the nearest place until each piece is as short as it is far: the logarithm needs no other care.  A normal force
all round moves nothing: least squares.  What is left is measured by more levels and order.
"""

from dataclasses import dataclass

import numpy as np

from tests.reference.coupling.stokes_array import periodic_point_forces


def regular(corners, area, turn=0.0):
    """Corners (k, 2) of a regular polygon with this area, the first at the angle ``turn``."""
    radius = np.sqrt(2 * area / (corners * np.sin(2 * np.pi / corners)))
    angle = turn + 2 * np.pi * np.arange(corners) / corners
    return radius * np.column_stack((np.cos(angle), np.sin(angle)))


def lagrange(nodes, at):
    """Values (n_at, n_nodes) of the polynomials that are 1 at one node and 0 at the others."""
    found = np.ones((len(at), len(nodes)))
    for k, node in enumerate(nodes):
        for m, other in enumerate(nodes):
            if m != k:
                found[:, k] *= (at - other) / (node - other)
    return found


@dataclass(frozen=True)
class Turning:
    """One polygon (k, 2), counterclockwise, about 0 in a square cell of side 1."""

    corners: np.ndarray
    levels: int = 12
    order: int = 8

    def panels(self):
        """Ends (p, 2, 2) of all panels."""
        share = 0.5 ** np.arange(1, self.levels + 1)
        cuts = np.concatenate(([0.0], share[::-1], 1 - share[1:], [1.0]))
        ends = np.stack((self.corners, np.roll(self.corners, -1, axis=0)), 1)
        return np.concatenate(
            [np.stack((a + np.outer(cuts[:-1], b - a), a + np.outer(cuts[1:], b - a)), 1) for a, b in ends]
        )

    @staticmethod
    def kernel(at, sources):
        """4 pi mu velocity (n_at, 2, n_sources, 2)."""
        gap = at[:, None] - sources
        xx, xy, yy = periodic_point_forces(gap[..., 0], gap[..., 1], 1.0, 1.0)
        return np.stack((np.stack((xx, xy), -1), np.stack((xy, yy), -1)), 1)

    def near(self, point, a, b, nodes, weights):
        """Integrals of S times each polynomial over a panel close to ``point``: (2, order, 2)."""
        way = b - a
        nearest = np.clip(np.dot(point - a, way) / np.dot(way, way), 0.0, 1.0)
        away = np.hypot(*(point - a - nearest * way)) / np.hypot(*way)
        cuts = {0.0, 1.0, float(nearest)}
        size = 1.0
        while size > max(away, 1e-9):
            size *= 0.5
            cuts |= {c for c in (nearest - size, nearest + size) if 0.0 < c < 1.0}
        cuts = np.array(sorted(cuts))
        long = np.diff(cuts)
        t = (cuts[:-1, None] + long[:, None] * nodes).ravel()
        w = (long[:, None] * weights).ravel() * np.hypot(*way)
        s = self.kernel(point[None], a + np.outer(t, way))[0]
        return np.einsum("anb,n,nk->akb", s, w, lagrange(nodes, t))

    def loads(self, flow, spin=0.0):
        """Force (2,) and torque of the fluid on the polygon that turns with ``spin``, per mu; flow: superficial."""
        nodes, weights = np.polynomial.legendre.leggauss(self.order)
        nodes, weights = 0.5 * (nodes + 1), 0.5 * weights
        panels = self.panels()
        way = panels[:, 1] - panels[:, 0]
        at = (panels[:, :1] + nodes[None, :, None] * way[:, None]).reshape(-1, 2)
        size = np.hypot(*way.T)
        weight = np.outer(size, weights).ravel()
        matrix = self.kernel(at, at + 1e-12) * weight[:, None]
        middle = panels.mean(axis=1)
        for n, point in enumerate(at):
            for p in np.flatnonzero(np.hypot(*(point - middle).T) < 1.6 * size):
                own = slice(p * self.order, (p + 1) * self.order)
                matrix[n, :, own] = self.near(point, *panels[p], nodes, weights)
        wanted = spin * np.column_stack((-at[:, 1], at[:, 0])) - np.asarray(flow, float)
        scale = np.sqrt(weight)
        flat = (matrix / (4 * np.pi)).reshape(2 * len(at), -1) * np.repeat(scale, 2)[:, None]
        push = np.linalg.lstsq(flat / np.repeat(scale, 2), (wanted * scale[:, None]).ravel(), rcond=1e-14)[0]
        push = push.reshape(-1, 2) / scale[:, None] * weight[:, None]
        return -push.sum(axis=0), -float(np.sum(at[:, 0] * push[:, 1] - at[:, 1] * push[:, 0]))
