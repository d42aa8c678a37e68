"""A displacement field fitted to two pictures at once: Gauss-Newton on the coefficients of cubic splines.

Minimised over all pixels of the fluid is sum w (r - g . d)^2 + s sum |second derivatives of the field|^2, with r = a -
k b both less their local mean, k the ratio of their contrasts, g the gradient of (a + k b)/2, w weights that take
pixels which show different tracers out (Cauchy; Black & Anandan 1996, Comput. Vis. Image Underst. 63, 75), d the
update.  A window is a local fit of a constant; splines do not average the flow over it, use every pixel once, and carry
the field to a solid's rim along its own slope (B-splines for displacements: Rueckert et al. 1999, IEEE Trans. Med.
Imaging 18, 712; regularised fits to tracers: Gesemann et al. 2016, 18th Lisbon Symp.).
"""

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any

import cv2
import numpy as np

from porescale.common.core.types import Floats, Singles
from porescale.piv.estimate.grid import Axis, Grid, expand
from porescale.piv.estimate.interpolate import sample
from porescale.piv.estimate.passes import Paths, moved, places, seen
from porescale.piv.estimate.rims import WEIGHT, Rims
from porescale.piv.estimate.splines import bending, collect, moments, weighted
from porescale.piv.images.prepare import Ready

NORMAL = 1.4826
"""Standard deviation over the median size of normal errors."""
BLOCK = 4
"""Side of the blocks that pixels are summed over, px: about a spot; within one the field is taken as one."""
AROUND = 6.0
"""Standard deviation of the bell that local means, contrast and correlation are taken over, px."""
FLAT = 1e-6
"""Share of the largest variance of grey levels, or of their slopes, below which there is nothing to see."""
ROUND = 0.01
"""Determinant of H over its squared trace, 1/4 for round spots and 0 for straight edges, from which both components are
determined.
"""
LEAST_FREE = np.float32(0.25)
"""Share of the spots' freedom that is left at least, when variances are estimated."""
ROUNDS, CLOSE = 30, 0.02
"""Conjugate gradients: most rounds, and the residual over the right side that ends them; updates follow anyway."""


@dataclass(frozen=True)
class Equations:
    """Share of pixels in an update, by blocks, float32: sums of w gx gx, w gx gy, w gy gy, w gx r, w gy r; of the
    products of the last two; and m, their correlation.
    """

    sums: Singles
    squares: Singles
    correlation: Singles
    seen: Singles


def equations(
    pairs: Iterable[tuple[Ready, Ready]], along: Paths, noise: float, slack: float, *, exact: bool
) -> Equations:
    """Deform all pairs along paths and sum up their contributions; ``noise``, ``slack`` as in ``Settings``.

    exact : by quintic splines, without bias, rather than by OpenCV's cubic ones, in a fifth of the time; paths are
    displacements then, else places.
    """
    rows, columns = along.first[0].shape
    down, across = -(-rows // BLOCK), -(-columns // BLOCK)
    lanes = np.empty((down, 9, columns), np.float32)
    found, sums = np.empty((6, down, across), np.float32), np.empty((5, down, across), np.float32)
    total, squares = np.zeros_like(sums), np.zeros((3, down, across), np.float32)
    match, shown = np.zeros((down, across), np.float32), np.zeros((down, across), np.float32)
    one, two = np.empty((rows, columns), np.float32), np.empty((rows, columns), np.float32)
    count = 0
    first_at, second_at = (places(it) for it in along[:2]) if exact else along[:2]
    for first, second in pairs:
        if exact:
            sample(first.coefficients, *along.first, 0, one)
            sample(second.coefficients, *along.second, 0, two)
        else:
            one = moved(first.contrast, first_at, cv2.INTER_CUBIC)
            two = moved(second.contrast, second_at, cv2.INTER_CUBIC)
        mask = seen(first, first_at, along.reach) * seen(second, second_at, along.reach)
        least = (noise * NORMAL * float(np.median(np.abs(one[::3, ::3] - two[::3, ::3])))) ** 2
        moments(one, two, mask, BLOCK, lanes, found)
        known, alike = _local(found, least)
        weighted(one, two, mask, known, np.float32(slack**2), BLOCK, lanes, sums)
        total += sums
        squares += sums[[3, 3, 4]] * sums[[3, 4, 4]]
        match += alike
        shown += found[0]
        count += 1
    return Equations(total, squares, np.asarray(match / max(1, count), np.float32), shown)


def _local(sums: Singles, least: float) -> tuple[Singles, Singles]:
    """Mean a, mean b, gain and n^2 (4, …) around each block, and the correlation there; zero where nothing is seen."""
    around = [blurred(it) for it in sums]
    light = np.maximum(around[0], np.float32(1e-6))
    a, b = around[1] / light, around[2] / light
    var_a, var_b = around[3] / light - a * a, around[4] / light - b * b
    good = (around[0] > 0) & (np.minimum(var_a, var_b) > FLAT * max(1e-30, float(var_a.max()), float(var_b.max())))
    gain = np.sqrt(np.where(good, var_a, 1) / np.where(good, var_b, 1))
    alike = np.where(good, (around[5] / light - a * b) / np.sqrt(np.where(good, var_a * var_b, 1)), 0)
    floor = np.maximum(np.float32(least), np.float32(1e-6) * np.where(good, var_a, 1))
    return np.array([a, b, gain, floor], np.float32), np.asarray(alike, np.float32)


def blurred(blocks: Singles) -> Singles:
    """Means around each block, by a bell of standard deviation AROUND."""
    sigma = AROUND / BLOCK
    found: Any = cv2.GaussianBlur(blocks, (0, 0), sigma, borderType=cv2.BORDER_REFLECT_101)
    return np.asarray(found, np.float32)


BENT = 20.0
"""Diagonal of ``bending`` away from the edges."""


def solved(grid: Grid, c: Singles, known: Equations, stiffness: float, still: Rims | None = None) -> Singles:
    """Update of the coefficients c (2, m, n) of u and v, by conjugate gradients.

    stiffness : s over the mean of w g^2 in the fluid and the square of a step;  still : rims where the field is zero.
    """
    down, across = grid.axes(BLOCK)
    hxx, hxy, hyy, bx, by = known.sums
    mean = 0.5 * float((hxx + hyy).sum(dtype=np.float64)) / max(1.0, float(known.seen.sum(dtype=np.float64)))
    s = np.float32(stiffness * mean * grid.step**2)
    held = np.float32(WEIGHT * mean)
    spare = np.empty((2, hxx.shape[0], c.shape[2]), np.float32)
    at = np.empty((2, *hxx.shape), np.float32)

    def carried(values: tuple[Singles, Singles], axes: tuple[Axis, Axis] = (down, across)) -> Singles:
        """Values of pixels gathered at the knots by the splines' weights."""
        found = np.empty_like(c)
        for k in (0, 1):
            collect(values[k], axes[0].first, axes[0].weights, axes[1].first, axes[1].weights, spare[k], found[k])
        return found

    def bent(p: Singles) -> Singles:
        """What stiffness, and rims that are still, take of the coefficients p."""
        found = np.empty_like(p)
        for k in (0, 1):
            bending(p[k], found[k])
            found[k] *= s
            if still is not None:
                found[k] += held * still.pulled(p[k])
        return found

    def applied(p: Singles) -> Singles:
        """The whole matrix times p; overwrites ``spare`` and ``at``."""
        for k in (0, 1):
            expand(p[k], down.first, down.weights, across.first, across.weights, spare[k], at[k])
        u, v = at
        return carried((hxx * u + hxy * v, hxy * u + hyy * v)) + bent(p)

    squared = down._replace(weights=down.weights**2), across._replace(weights=across.weights**2)
    diagonal = carried((hxx, hyy), squared) + np.float32(BENT) * s + np.float32(1e-12)
    if still is not None:
        diagonal += held * still.diagonal((c.shape[1], c.shape[2]))
    left = carried((bx, by)) - bent(c)
    found = np.zeros_like(c)
    eased = left / diagonal
    p, power = eased.copy(), _dot(left, eased)
    end = CLOSE**2 * power
    for _ in range(ROUNDS):
        if power <= end:
            break
        image = applied(p)
        length = np.float32(power / _dot(p, image))
        found += length * p
        left -= length * image
        eased = left / diagonal
        last, power = power, _dot(left, eased)
        p = eased + np.float32(power / last) * p
    return found


def _dot(a: Singles, b: Singles) -> float:
    """Sum of products, in one order whatever the number of threads."""
    return float((a * b).sum(dtype=np.float64))


def variances(known: Equations, freedom: float) -> Singles:
    """Variance of a component at each block, px^2, if one square px of data gave it: of H^-1 Q H^-1, H the information
    of pictures on an update, Q its variance, found from how it scatters (White 1980, Econometrica 48, 817).

    freedom : of the fit, coefficients a square px of one component.  Spots are few: with n of them to p coefficients
    residuals are short by 1 - p/n, and scattered spots weigh less than the same light spread out by as much again (n of
    blocks: squared mean over mean square of H).  Infinite where pictures show nothing, or of one component only, as
    a straight edge does.
    """
    area = np.float32(BLOCK**2)
    hxx, hxy, hyy = (blurred(it) / area for it in known.sums[:3])
    qxx, qxy, qyy = (blurred(it) / area for it in known.squares)
    trace = known.sums[0] + known.sums[2]
    spots = blurred(trace) ** 2 / np.maximum(blurred(trace * trace), np.float32(1e-12)) / area
    short = np.maximum(LEAST_FREE, 1 - np.float32(freedom) / np.maximum(spots, np.float32(1e-12)))
    det = hxx * hyy - hxy * hxy
    good = (det > ROUND * (hxx + hyy) ** 2) & (hxx + hyy > FLAT * float((hxx + hyy).max()))
    safe = np.where(good, det, np.inf)
    xx, xy, yy = hyy / safe, -hxy / safe, hxx / safe
    both = xx * xx * qxx + 2 * xx * xy * qxy + xy * xy * qyy + xy * xy * qxx + 2 * xy * yy * qxy + yy * yy * qyy
    return np.where(good, 0.5 * np.maximum(0, both) / short**2, np.inf).astype(np.float32)


def at_places(blocks: Singles, x: Floats, y: Floats) -> Floats:
    """Values of blocks at columns x and rows y, px, straight between the blocks' middles."""
    across, down = np.meshgrid((x + 0.5) / BLOCK - 0.5, (y + 0.5) / BLOCK - 0.5)
    found: Any = cv2.remap(
        blocks, across.astype(np.float32), down.astype(np.float32), cv2.INTER_LINEAR, borderMode=cv2.BORDER_REPLICATE
    )
    return np.asarray(found, float)
