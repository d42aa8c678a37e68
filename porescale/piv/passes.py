"""Passes over a pair, or over many pairs of one steady flow: coarse to fine correlation, then Gauss-Newton updates.

Both pictures are deformed by half the last estimate each (symmetric window deformation; Scarano 2002, Meas. Sci.
Technol. 13, R1), so that what is left to measure is small, and interpolation errs alike in both.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

import cv2
import numpy as np
from numpy.typing import NDArray

from porescale.piv.correlate import Layout, correlation, peaks
from porescale.piv.grid import Grid
from porescale.piv.interpolate import sample
from porescale.piv.prepare import Ready
from porescale.piv.refine import BLOCK, refine
from porescale.piv.tilt import tilted

Array = NDArray[np.float64]
Single = NDArray[np.float32]
Pairs = Sequence[tuple[Ready, Ready]]

SLOPE = np.array([1.0, -8.0, 0.0, 8.0, -1.0]) / 12.0
"""Fourth-order central difference."""


LEAST_WINDOW = 16
"""Windows, px of the picture they are cut from, are correlated no smaller: fewer tracers match by chance."""
NORMAL = 1.4826
"""Standard deviation over the median size of normal errors."""


@dataclass(frozen=True)
class Correlated:
    """What a correlation pass found on its grid, each (ny, nx): px, height of the peak, ratio to the second."""

    u: Array
    v: Array
    value: Array
    ratio: Array


@dataclass(frozen=True)
class Updated:
    """A Gauss-Newton update on its grid, each (ny, nx): px, standard deviations px, correlation; nan where none."""

    u: Array
    v: Array
    error_u: Array
    error_v: Array
    correlation: Array


class Paths(NamedTuple):
    """Where each pixel of the pictures at mid time is in the first and in the second, less where it is: float32, px."""

    first: tuple[Single, Single]
    second: tuple[Single, Single]


def paths(grid: Grid, u: Array, v: Array, *, curved: bool) -> Paths:
    """Half a displacement back and half forward from every pixel, along a parabola where ``curved``.

    In a steady flow the mid-point between X(-1/2) and X(+1/2) lies (d . grad) d/8 off the material's place at mid time.
    """
    bend_u, bend_v = np.zeros_like(u), np.zeros_like(v)
    if curved and min(grid.shape) > 3:
        (ux, uy), (vx, vy) = grid.slopes(u), grid.slopes(v)
        bend_u, bend_v = (u * ux + v * uy) / 8, (u * vx + v * vy) / 8
    back = grid.at_pixels(bend_u - 0.5 * u), grid.at_pixels(bend_v - 0.5 * v)
    forward = grid.at_pixels(bend_u + 0.5 * u), grid.at_pixels(bend_v + 0.5 * v)
    return Paths(back, forward)


def correlation_pass(
    pairs: Iterable[tuple[Ready, Ready]], grid: Grid, search: int, along: Paths | None, *, halved: bool
) -> Correlated:
    """Correlate windows of all pairs, deformed along ``along``, over ``search`` px; peaks of the sum of correlations.

    halved : at half the resolution.
    """
    ny, nx = grid.shape
    part = 2 if halved else 1
    step = max(1, grid.step // part)
    search = -(-search // part)
    blocks = max(1, round(max(LEAST_WINDOW, grid.window / part) / step))
    size = blocks * step  # the window, to a whole number of blocks
    pad = search + size
    layout = Layout((ny, nx), step, blocks, pad + grid.start // part - size // 2, search)
    total = np.zeros((ny, nx, 2 * search + 1, 2 * search + 1), np.float32)
    for pair in pairs:
        arrays = []
        for number, one in enumerate(pair):
            grey, mask = (one.half_contrast, one.half_fluid) if halved else (one.contrast, one.fluid)
            if along is not None:
                at = _places(_thinned(along[number]) if halved else along[number])
                mask = _moved(mask, at, cv2.INTER_NEAREST) if one.solid else mask
                grey = _moved(grey, at, cv2.INTER_CUBIC) * mask
            arrays.append((_padded(grey, pad), _padded(mask, pad)))
        (a, ma), (b, mb) = arrays
        # Once pictures are deformed well, shifts are small and solids cut the same off both windows, where both are
        # zero: their own energies are those of the fluid that both show, to a rim of a pixel or two.
        masks = (ma, mb) if halved and (pair[0].solid or pair[1].solid) else None
        square: Any = b * b
        energy = np.asarray(cv2.boxFilter(square, cv2.CV_32F, (size, size), anchor=(0, 0), normalize=False), np.float32)
        total += correlation(layout, a, b, masks, energy)
    found = Correlated(*(np.empty((ny, nx)) for _ in range(4)))
    peaks(total, found.u, found.v, found.value, found.ratio)
    return Correlated(part * found.u, part * found.v, found.value, found.ratio)


def _thinned(way: tuple[Single, Single]) -> tuple[Single, Single]:
    """Displacements for a picture of half the resolution: every second one, half as long."""
    rows, columns = way[0].shape
    thin = slice(0, rows // 2 * 2, 2), slice(0, columns // 2 * 2, 2)
    half = np.float32(0.5)
    return np.asarray(half * way[0][thin], np.float32), np.asarray(half * way[1][thin], np.float32)


def bell(reach: float) -> Single:
    """Weights (n,) along a side, n a multiple of BLOCK, at -n/2 … n/2 - 1 px: (1 - (s/reach)^2)^2, zero beyond."""
    half = BLOCK // 2 * -(-int(np.ceil(reach)) // (BLOCK // 2))
    at = np.arange(-half, half)
    return np.asarray(np.maximum(0.0, 1 - (at / reach) ** 2) ** 2, np.float32)


def update_pass(
    pairs: Iterable[tuple[Ready, Ready]],
    grid: Grid,
    weights: Single,
    noise: float,
    slack: float,
    along: Paths,
    cut: NDArray[np.int64],
) -> Updated:
    """One Gauss-Newton update of the displacement whose paths are ``along``, from all pairs together.

    cut : row and column (n, 2) of the windows that a solid cuts; their updates are planes' values at the centres.
    """
    ny, nx = grid.shape
    pad = len(weights)
    wide = (grid.size[0] + 2 * pad, grid.size[1] + 2 * pad)
    plane = np.zeros((len(cut), 2))
    own = np.empty_like(plane)
    sums, lanes, known = (
        np.zeros((ny, nx, 9)),
        np.empty((ny, 11, wide[1]), np.float32),
        np.empty((ny, 5, wide[1]), np.float32),
    )
    one, two = np.zeros(wide, np.float32), np.zeros(wide, np.float32)
    count = 0
    first_at, second_at = _places(along.first), _places(along.second)
    for first, second in pairs:
        sample(first.coefficients, *along.first, pad, one)
        sample(second.coefficients, *along.second, pad, two)
        mask = _seen(first, along.first, first_at) * _seen(second, along.second, second_at)
        mean = 0.5 * (one + two)
        gx = cv2.sepFilter2D(mean, cv2.CV_32F, SLOPE, np.ones(1))
        gy = cv2.sepFilter2D(mean, cv2.CV_32F, np.ones(1), SLOPE)
        bound = noise * NORMAL * float(np.median(np.abs(one[pad:-pad:3, pad:-pad:3] - two[pad:-pad:3, pad:-pad:3])))
        shown = _padded(mask, pad)
        refine(one, two, shown, gx, gy, weights, pad, grid.start, grid.step, np.float32(bound),
               np.float32(slack**2), lanes, known, sums)  # fmt: skip
        if len(cut):
            tilted(
                one,
                two,
                shown,
                gx,
                gy,
                weights,
                pad,
                grid.start,
                grid.step,
                np.float32(bound),
                np.float32(slack**2),
                cut,
                own,
            )
            plane += own
        count += 1
    found = _solved(sums, count)
    if len(cut):
        found.u[cut[:, 0], cut[:, 1]], found.v[cut[:, 0], cut[:, 1]] = (plane / count).T
    return found


def _solved(sums: Array, count: int) -> Updated:
    """Updates and their standard deviations from the sums of ``refine``."""
    hxx, hxy, hyy, bx, by, qxx, qxy, qyy = (sums[..., k] for k in range(8))
    det = hxx * hyy - hxy * hxy
    good = det > 1e-6 * (hxx + hyy) ** 2
    safe = np.where(good, det, np.nan)
    ixx, ixy, iyy = hyy / safe, -hxy / safe, hxx / safe
    return Updated(
        ixx * bx + ixy * by,
        ixy * bx + iyy * by,
        np.sqrt(np.maximum(0, ixx * ixx * qxx + 2 * ixx * ixy * qxy + ixy * ixy * qyy)),
        np.sqrt(np.maximum(0, ixy * ixy * qxx + 2 * ixy * iyy * qxy + iyy * iyy * qyy)),
        np.where(good, sums[..., 8] / max(1, count), np.nan),
    )


def _places(way: tuple[Single, Single]) -> tuple[Single, Single]:
    """Where each pixel comes from, for OpenCV."""
    rows, columns = way[0].shape
    x, y = np.arange(columns, dtype=np.float32), np.arange(rows, dtype=np.float32)[:, None]
    return np.asarray(way[0] + x, np.float32), np.asarray(way[1] + y, np.float32)


def _seen(one: Ready, way: tuple[Single, Single], at: tuple[Single, Single]) -> Single:
    """1 where the picture shows fluid at places, else 0."""
    if one.solid:
        return _moved(one.fluid, at, cv2.INTER_NEAREST)
    rows, columns = way[0].shape
    rim = 1 + int(np.ceil(max(float(np.abs(it).max()) for it in way)))  # only from here a path leaves the picture
    found = np.ones((rows, columns), np.float32)
    for part in (np.s_[:rim], np.s_[max(0, rows - rim) :], np.s_[:, :rim], np.s_[:, max(0, columns - rim) :]):
        x, y = at[0][part], at[1][part]
        found[part] = (x >= -0.5) & (x <= columns - 0.5) & (y >= -0.5) & (y <= rows - 0.5)
    return found


def _moved(image: Single, at: tuple[Single, Single], how: int) -> Single:
    """``image`` at places, zero outside."""
    found: Any = cv2.remap(image, at[0], at[1], how, borderMode=cv2.BORDER_CONSTANT, borderValue=0)
    return np.asarray(found, np.float32)


def _padded(image: Single, pad: int) -> Single:
    """``image`` with a border of zeros."""
    return np.asarray(cv2.copyMakeBorder(image, pad, pad, pad, pad, cv2.BORDER_CONSTANT, value=0))
